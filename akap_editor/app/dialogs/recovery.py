"""After a crash: offers the drawings that were not saved, with a picture of each."""

import time
from pathlib import Path

import moderngl
from imgui_bundle import ImVec2, imgui

from ...editor.document.document import Document
from ...editor.document.framing import frame_box
from ...errors import AkapError
from ...io.akap.autosave import RecoveryCopy
from .. import files, widgets
from ..app_state import AppState
from ..theme import DARK, QUIET, packed

_SIDE = 220  # of the thumbnail, in design points


class Recovery:
    """Draws the dialog for the first of the lost copies; owns its thumbnail, in the context ``ctx``."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._copy: RecoveryCopy | None = None
        self._document: Document | None = None
        self._texture: moderngl.Texture | None = None

    def release(self) -> None:
        """Free the thumbnail."""
        if self._texture is not None:
            self._texture.release()
            self._texture = None

    def draw(self, state: AppState, scale: float) -> None:
        """One frame of the dialog; there must be something lost."""
        copy = state.lost[0]
        if copy is not self._copy and not self._read(state, copy, _SIDE * scale):
            return
        document = self._document
        assert document is not None
        if not widgets.begin_dialog("Recover unsaved work"):
            return
        self._thumbnail(_SIDE * scale)
        imgui.same_line(0, 20 * scale)
        imgui.begin_group()
        _facts(copy, document, len(state.lost), 300 * scale)
        imgui.end_group()
        imgui.spacing()
        if widgets.button("Recover", primary=True) or widgets.confirm_pressed():
            imgui.close_current_popup()
            state.run_reporting_errors(lambda: recover(state, copy, document))
        imgui.same_line()
        if widgets.button("Discard"):
            _drop(state)
            copy.discard()
        imgui.same_line()
        if widgets.button("Later") or widgets.cancel_pressed():
            _drop(state)
            copy.leave()
        imgui.end_popup()

    def _read(self, state: AppState, copy: RecoveryCopy, pixels: float) -> bool:
        """Read a copy and draw its pose; one that cannot be read stays where it is."""
        try:
            document = copy.read()
            low_x, low_y, high_x, high_y = frame_box(document.drawing, [document.state.positions])
            scale = pixels / max(high_x - low_x, high_y - low_y)
            picture = state.exporter.render(
                document.drawing, document.state.positions, scale=scale, order=document.face_order
            )
        except AkapError as error:
            state.lost.pop(0).leave()
            state.error = f"Unsaved work could not be recovered: {error}"
            return False
        self.release()
        self._copy, self._document = copy, document
        self._texture = self._ctx.texture(picture.shape[1::-1], 4, picture.tobytes(), alignment=1)
        return True

    def _thumbnail(self, side: float) -> None:
        assert self._texture is not None
        corner = imgui.get_cursor_screen_pos()
        width, height = self._texture.size
        low = ImVec2(round(corner.x + (side - width) / 2), round(corner.y + (side - height) / 2))
        draw = imgui.get_window_draw_list()
        draw.add_rect_filled(corner, ImVec2(corner.x + side, corner.y + side), packed(DARK), 0.03 * side)
        draw.add_image(imgui.ImTextureRef(self._texture.glo), low, ImVec2(low.x + width, low.y + height))
        imgui.dummy(ImVec2(side, side))


def recover(state: AppState, copy: RecoveryCopy, document: Document) -> None:
    """Go on with what a program that crashed has left; what else is lost is asked for another time."""
    assert state.autosave is not None
    files.show_document(state, document)
    assert state.editor.session is not None
    state.editor.session.mark_unsaved()
    state.autosave.adopt(copy, document)
    for other in state.lost:
        if other is not copy:
            other.leave()
    state.lost = []
    state.notice = f"Recovered {document.drawing.name}, which is not saved yet"


def _facts(copy: RecoveryCopy, document: Document, count: int, width: float) -> None:
    imgui.push_font(None, imgui.get_style().font_size_base * 1.25)
    widgets.paragraph(document.drawing.name, width)
    imgui.pop_font()
    imgui.spacing()
    widgets.paragraph("The program ended before this drawing was saved.", width)
    imgui.spacing()
    widgets.paragraph(
        f"As it was on {time.strftime('%d %B, %H:%M', time.localtime(copy.time))}", width, QUIET
    )
    widgets.paragraph(_place(document.path), width, QUIET)
    if count > 1:
        widgets.paragraph(f"{count - 1} more to come", width, QUIET)
    imgui.dummy(ImVec2(width, 0))


def _place(path: Path | None) -> str:
    return f"Belongs to {path}" if path is not None else "Was never saved to a file"


def _drop(state: AppState) -> None:
    imgui.close_current_popup()
    state.lost.pop(0)
