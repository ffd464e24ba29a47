"""The dialog that offers the unsaved drawings of a program that has crashed, with a thumbnail of each."""

import time

from imgui_bundle import ImVec2, imgui

from ...display_text import display_text
from ...editor.document.document import Document
from ...editor.framing import frame_box
from ...errors import AkapError
from ...io.akap.autosave import RecoveryCopy
from ...io.images import Picture
from ...words import tr, tr_plural
from .. import files, widgets
from ..app_state import AppState
from ..theme import DARK, SECONDARY, packed

_SIDE = 220  # of the thumbnail, in design points
_WIDTH = 300  # of the text, in design points


class RecoveryDialog:
    """Offers one copy after the other.

    copies: those that are still to be offered.
    """

    def __init__(self) -> None:
        self.copies: list[RecoveryCopy] = []
        self._content: tuple[RecoveryCopy, Document, Picture] | None = None  # the first copy and its picture

    @property
    def is_open(self) -> bool:
        """Whether there is a copy to offer."""
        return bool(self.copies)

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame; at least one copy must be left. scale: points per design point."""
        if self._content is None:
            self._content = self._read_first(state, _SIDE * scale)
        if self._content is None or not widgets.begin_dialog("Recover unsaved work"):
            return
        copy, document, picture = self._content
        _draw_thumbnail(state, copy, picture, _SIDE * scale)
        imgui.same_line(0, 20 * scale)
        imgui.begin_group()
        _draw_facts(copy, document, len(self.copies), _WIDTH * scale)
        imgui.end_group()
        imgui.spacing()
        if widgets.button(tr("Recover"), primary=True) or widgets.confirm_pressed():
            imgui.close_current_popup()
            state.run_reporting_errors(lambda: self._recover(state, copy, document))
        imgui.same_line()
        if widgets.button(tr("Discard")):
            self._drop(copy)
            copy.discard()
        imgui.same_line()
        if widgets.button(tr("Later")) or widgets.cancel_pressed():
            self._drop(copy)
            copy.release()
        imgui.end_popup()

    def _read_first(self, state: AppState, pixels: float) -> tuple[RecoveryCopy, Document, Picture] | None:
        """Read the first copy and draw it with ``pixels`` a side.

        A copy that cannot be read leaves the list and stays on the disk.
        """
        copy = self.copies[0]
        try:
            document = copy.read()
            positions = document.state.positions
            low_x, low_y, high_x, high_y = frame_box(document.drawing, [positions])
            scale = pixels / max(high_x - low_x, high_y - low_y)
            picture = state.offscreen_renderer.render(
                document.drawing, positions, scale=scale, order=document.draw_order
            )
        except AkapError as error:
            self.copies.remove(copy)
            copy.release()
            state.error = tr("Couldn't recover an unsaved drawing. {error}", error=error)
            return None
        return copy, document, picture

    def _recover(self, state: AppState, copy: RecoveryCopy, document: Document) -> None:
        """Open the document of a copy; the other copies are offered again at the next start."""
        assert state.autosave is not None
        files.show_document(state, document)
        assert state.editor.session is not None
        state.editor.session.mark_unsaved()
        state.autosave.adopt(copy, document)
        for other in self.copies:
            if other is not copy:
                other.release()
        self.copies, self._content = [], None
        state.notice = tr("Recovered {name}, which is not saved yet", name=document.drawing.name)

    def _drop(self, copy: RecoveryCopy) -> None:
        imgui.close_current_popup()
        self.copies.remove(copy)
        self._content = None


def _draw_thumbnail(state: AppState, copy: RecoveryCopy, picture: Picture, side: float) -> None:
    """Draw the picture of a copy in a square; side: in points."""
    corner = imgui.get_cursor_screen_pos()
    high = ImVec2(corner.x + side, corner.y + side)
    imgui.get_window_draw_list().add_rect_filled(corner, high, packed(DARK), 0.03 * side)
    state.thumbnails.draw((copy.path, side), corner, side, lambda: picture)
    imgui.dummy(ImVec2(side, side))


def _draw_facts(copy: RecoveryCopy, document: Document, count: int, width: float) -> None:
    """Draw what is known about a copy. count: of all copies that are left; width: in points."""
    imgui.push_font(None, imgui.get_style().font_size_base * 1.25)
    widgets.paragraph(document.drawing.name, width)
    imgui.pop_font()
    imgui.spacing()
    widgets.paragraph(tr("The program ended before this drawing was saved."), width)
    imgui.spacing()
    widgets.paragraph(
        tr("Last change: {date}", date=time.strftime(tr("%Y-%m-%d, %H:%M"), time.localtime(copy.time))),
        width,
        SECONDARY,
    )
    origin = (
        tr("File: {file}", file=display_text(document.path))
        if document.path is not None
        else tr("Not saved to a file yet")
    )
    widgets.paragraph(origin, width, SECONDARY)
    if count > 1:
        widgets.paragraph(
            tr_plural("{count} more to recover", "{count} more to recover", count - 1), width, SECONDARY
        )
    imgui.dummy(ImVec2(width, 0))
