"""The dialog that makes keyframes of a take: of the marked part of the session."""

from collections.abc import Iterator
from time import perf_counter

from imgui_bundle import imgui

from ...editor.animation.keyframing.simplification import Simplification
from ...editor.animation.keyframing.take import take_poses
from ...editor.document.keyframes import MAX_KEYFRAME_TIME, as_keyframe_time
from ...words import mark, tr, tr_plural
from .. import widgets
from ..app_state import AppState

TOLERANCES = (0.25, 50.0)  # pixels of the drawing
_LABEL_WIDTH, _WIDTH = 104, 400  # design points
_SLICE = 0.04  # seconds of computing in a frame of the window


class TakeDialog:
    """Asks for the tolerance, and shows how many keyframes it leads to.

    tolerance: pixels by which the keyframes may be off; start: time of the first one, seconds.
    """

    def __init__(self) -> None:
        self.is_open = False
        self.tolerance = 2.0
        self.start = 0.0
        self._pose_count = 0
        self._simplification: Simplification | None = None
        self._work: Iterator[None] | None = None  # choosing poses, perhaps for an earlier tolerance

    def open(self, state: AppState) -> None:
        """Show the dialog for the played range of the session. Raises InputError if nothing moves in it."""
        timeline = state.timeline
        playback, session = timeline.session_playback, state.editor.session
        if session is None:
            return
        playback.end_take()
        playback.stop()
        poses = take_poses(playback.snapshots, *playback.played_range, session.drawing)
        self._pose_count = len(poses)
        self._simplification, self._work = Simplification(session.drawing.mesh, poses), None
        keys = timeline.keyframe_playback
        self.start = as_keyframe_time(keys.time) if keys.stored_animation.keyframes else 0.0
        self.is_open = True

    @property
    def count(self) -> int | None:
        """The number of keyframes; None while they are counted."""
        return None if self._simplification is None else self._simplification.count(self.tolerance)

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        if state.document is None or self._simplification is None:
            self.is_open = False
            return
        if not widgets.begin_dialog("Keyframes from take"):
            return
        self._compute(state)
        text = tr("The marked part of the session becomes keyframes with smooth motion between them.")
        widgets.paragraph(text, _WIDTH * scale)
        imgui.spacing()
        widgets.label(tr("Tolerance"), _LABEL_WIDTH * scale)
        flags = imgui.SliderFlags_.logarithmic
        tip = tr("How far the drawing may be off between the keyframes, in its pixels")
        _, self.tolerance, _ = widgets.slider(
            "##tolerance", self.tolerance, TOLERANCES, "%.2f px", flags, tip
        )
        widgets.label(tr("Starts at"), _LABEL_WIDTH * scale)
        imgui.set_next_item_width(110 * scale)
        _, start = imgui.input_float("##start", self.start, 0.0, 0.0, "%.3f s")
        self.start = min(max(float(start), 0.0), MAX_KEYFRAME_TIME)
        count = self.count
        widgets.label(tr("Result"), _LABEL_WIDTH * scale)
        if count is None:
            widgets.secondary_text(tr("Counting the keyframes…"))
        else:
            keys = tr_plural("{count} keyframe", "{count} keyframes", count)
            imgui.text_unformatted(
                tr("{keyframes}, of {poses} poses", keyframes=keys, poses=self._pose_count)
            )
        imgui.spacing()
        imgui.begin_disabled(count is None)
        accepted = widgets.button(tr("Add Keyframes") + "###add", primary=True)
        imgui.end_disabled()
        imgui.same_line()
        if widgets.button(tr("Cancel") + "###cancel") or widgets.cancel_pressed():
            self._close()
        elif count and (accepted or (widgets.confirm_pressed() and not imgui.get_io().want_text_input)):
            self._add(state)
        imgui.end_popup()

    def _compute(self, state: AppState) -> None:
        """Choose more poses, for a few milliseconds; the window is woken until there are enough."""
        assert self._simplification is not None
        if self.count is not None:
            return
        if self._work is None:
            self._work = self._simplification.refine(self.tolerance)
        end = perf_counter() + _SLICE
        while perf_counter() < end:
            if next(self._work, self) is self:
                self._work = None  # done, unless the tolerance has become lower meanwhile
                break
        state.wake()

    def _add(self, state: AppState) -> None:
        assert self._simplification is not None
        keyframes = self._simplification.keyframes(self.tolerance, as_keyframe_time(self.start))
        self._close()
        timeline = state.timeline
        timeline.show_keyframes()
        timeline.keyframe_playback.update()
        timeline.keyframe_playback.insert_keyframes(mark("Keyframes from Take"), keyframes)
        state.notice = tr_plural("Added {count} keyframe", "Added {count} keyframes", len(keyframes))

    def _close(self) -> None:
        self.is_open = False
        self._simplification = self._work = None
        widgets.close_popup()
