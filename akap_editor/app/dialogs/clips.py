"""The dialog that applies a clip to the drawing."""

from dataclasses import replace
from functools import partial
from pathlib import Path

from imgui_bundle import ImVec2, imgui

from ...display_text import display_name, file_stem
from ...editor.animation.clips.clip import Clip, clip_from_keyframes, named_pins, pins_with_names
from ...editor.animation.clips.retargeting import apply_clip
from ...editor.document.document import Document
from ...editor.document.keyframes import Keyframe, as_keyframe_time
from ...editor.document.pin import Pin
from ...errors import InputError
from ...io.akap.clip import CLIP_SUFFIX, bundled_clips, bundled_pins, clips_for, load_clip, save_clip
from ...words import mark, tr, tr_plural
from .. import widgets
from ..app_state import AppState
from ..jobs.task import Progress, Steps, Task
from .file_dialog import FileDialog, FileRequest

_LABEL_WIDTH, _WIDTH, _LIST_WIDTH, _HEIGHT = 92, 540, 190, 190  # design points
_SPEEDS, _MAX_REPEATS = (0.1, 10.0), 20


class ClipsDialog:
    """Asks for a clip and how it is played.

    clips: the bundled ones, those that suit the drawing first, and one that was opened from a file; chosen:
    its index.
    """

    def __init__(self) -> None:
        self.is_open = False
        self.clips: list[Clip] = []
        self.chosen = 0
        self.start, self.speed, self.repeats, self.is_mirrored = 0.0, 1.0, 1, False

    def open(self, state: AppState) -> None:
        """Show the dialog; the clip starts at the playhead of the keyframes."""
        if state.document is None:
            return
        suited = clips_for(state.document.drawing.name)
        names = {clip.name for clip in suited}
        self.clips = [*suited, *(clip for clip in bundled_clips() if clip.name not in names)]
        self.chosen = min(self.chosen, len(self.clips) - 1)
        playback = state.timeline.keyframe_playback
        playback.stop()
        self.start = as_keyframe_time(playback.time) if playback.stored_animation.keyframes else 0.0
        self.is_open = True

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        if state.document is None:
            self.is_open = False
            return
        if not widgets.begin_dialog("Clips"):
            return
        self._draw_list(scale)
        imgui.same_line(0, 18 * scale)
        imgui.begin_child("##clip", ImVec2((_WIDTH - _LIST_WIDTH - 18) * scale, _HEIGHT * scale))
        self._draw_options(state.document, scale)
        imgui.end_child()
        imgui.spacing()
        accepted = widgets.button(tr("Apply") + "###apply", primary=True)
        imgui.same_line()
        opens = widgets.button(tr("Open...") + "###open")
        imgui.same_line()
        if widgets.button(tr("Cancel") + "###cancel") or widgets.cancel_pressed():
            self._close()
        elif opens:
            self._close()
            use = partial(self._add, state)
            request = FileRequest(tr("Open clip"), (CLIP_SUFFIX,), state.folder, use)
            state.part(FileDialog).ask(request)
        elif accepted or (widgets.confirm_pressed() and not imgui.get_io().want_text_input):
            self._close()
            clip = self.clips[self.chosen]
            clip = clip.mirrored() if self.is_mirrored else clip
            start_clip(state, clip, as_keyframe_time(self.start), self.speed, self.repeats)
        imgui.end_popup()

    def _draw_list(self, scale: float) -> None:
        size = ImVec2(_LIST_WIDTH * scale, _HEIGHT * scale)
        imgui.begin_child("##clips", size, imgui.ChildFlags_.borders | widgets.NAV_FLATTENED)
        for number, clip in enumerate(self.clips):
            flags = imgui.SelectableFlags_.no_auto_close_popups
            label = f"{tr(clip.name)}##{number}"
            if imgui.selectable(label, number == self.chosen, flags)[0]:
                self.chosen = number
        imgui.end_child()

    def _draw_options(self, document: Document, scale: float) -> None:
        clip = self.clips[self.chosen]
        clip = clip.mirrored() if self.is_mirrored else clip
        have = {*named_pins(document.state.pins), *bundled_pins(document.drawing)}
        moved = [name for name in clip.names if name in have]
        missing = [name for name in clip.names if name not in have]
        width = (_WIDTH - _LIST_WIDTH - 18) * scale
        widgets.paragraph(tr("Pins: {names}", names=", ".join(moved) or tr("none of this drawing")), width)
        if missing:
            widgets.secondary_text(widgets.wrapped(tr("Not here: {names}", names=", ".join(missing)), width))
        imgui.spacing()
        widgets.label(tr("Starts at"), _LABEL_WIDTH * scale)
        imgui.set_next_item_width(110 * scale)
        _, start = imgui.input_float("##start", self.start, 0.0, 0.0, "%.3f s")
        self.start = max(float(start), 0.0)
        widgets.label(tr("Speed"), _LABEL_WIDTH * scale)
        flags = imgui.SliderFlags_.logarithmic
        _, self.speed, _ = widgets.slider("##speed", self.speed, _SPEEDS, "%.2f ×", flags)
        widgets.label(tr("Repeat"), _LABEL_WIDTH * scale)
        imgui.set_next_item_width(110 * scale)
        _, repeats = imgui.input_int("##repeats", self.repeats)
        self.repeats = min(max(repeats, 1), _MAX_REPEATS)
        widgets.switch_label(tr("Direction"), _LABEL_WIDTH * scale)
        _, self.is_mirrored = widgets.switch(tr("Mirrored"), self.is_mirrored)

    def _add(self, state: AppState, path: Path) -> None:
        """Open a clip from a file and choose it."""

        def add() -> None:
            clip = load_clip(path)
            self.open(state)
            self.clips.append(clip)
            self.chosen = len(self.clips) - 1

        state.run_reporting_errors(add)

    def _close(self) -> None:
        self.is_open = False
        widgets.close_popup()


def start_clip(state: AppState, clip: Clip, start: float = 0.0, speed: float = 1.0, repeats: int = 1) -> None:
    """Make keyframes of a clip, beside the window; pins that a bundled drawing lacks are added."""
    session = state.editor.session
    if session is None or state.editor.is_busy:
        return
    state.timeline.show_present()
    document = session.present_document
    pins = document.state.pins
    if not named_pins(pins).keys() & set(clip.names):
        pins = pins_with_names(document.drawing, document.state, bundled_pins(document.drawing))
    state.task = Task(
        tr("Applying the clip"), _clip_steps(state, clip, pins, start, speed, repeats), is_shown_late=True
    )


def _clip_steps(
    state: AppState, clip: Clip, pins: tuple[Pin, ...], start: float, speed: float, repeats: int
) -> Steps:
    """Solve the poses, then add the keyframes and show them."""
    session = state.editor.session
    assert session is not None
    document = session.present_document
    document = document.with_state(replace(document.state, pins=pins))
    keyframes: list[Keyframe] = []
    for each in apply_clip(clip, document, start, speed, repeats):
        if isinstance(each, list):
            keyframes = each
        else:
            yield Progress(each, tr("Posing the drawing"))
    timeline = state.timeline
    timeline.show_keyframes()
    timeline.keyframe_playback.update()
    changed = pins if pins is not session.present.pins else None
    timeline.keyframe_playback.insert_keyframes(mark("Apply Clip"), keyframes, changed)
    state.notice = tr_plural("Added {count} keyframe", "Added {count} keyframes", len(keyframes))


def play_clip(state: AppState, clip: Clip) -> None:
    """Make keyframes of a clip and play them."""
    start_clip(state, clip)
    if state.task is not None:
        state.task.steps = _then_play(state, state.task.steps)


def _then_play(state: AppState, steps: Steps) -> Steps:
    yield from steps
    state.timeline.keyframe_playback.toggle_playing()


def request_clip_file(state: AppState) -> None:
    """Ask for a file, then write the selected keyframes, or all, as a clip."""
    if state.document is not None:
        name = f"{file_stem(state.document.drawing.name)}{CLIP_SUFFIX}"
        use = partial(write_clip, state)
        request = FileRequest(tr("Save clip"), (CLIP_SUFFIX,), state.folder, use, name, saving=True)
        state.part(FileDialog).ask(request)


def write_clip(state: AppState, path: Path) -> None:
    """Write the selected keyframes, or all, as a clip with the name of the file."""
    session, playback = state.editor.session, state.timeline.keyframe_playback
    if session is None:
        return

    def write() -> None:
        assert session is not None
        animation = playback.stored_animation
        times = sorted(playback.selected) if len(playback.selected) > 1 else animation.times
        if len(times) < 2:
            raise InputError(tr("A clip needs keyframes; select those of the motion"))
        name = display_name(path).removesuffix(CLIP_SUFFIX)
        document = session.present_document
        save_clip(clip_from_keyframes(name, document.drawing, document.state, animation, times), path)
        state.notice = tr("Saved {file}", file=display_name(path))

    state.run_reporting_errors(write)
