"""Playback and editing of the keyframes: scrub, play, select, drag, ease; and the onion skin."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from time import monotonic

import numpy as np

from ...geometry.validation import Floats, Ints
from ...words import mark
from ..document.crossings import draw_order
from ..document.drawing import Drawing
from ..document.keyframes import MAX_KEYFRAME_TIME, NO_ANIMATION, Animation, Keyframe, as_keyframe_time
from ..document.pin import Pin, pin_depths
from ..document.pin_angles import pins_fixed_at_pose
from ..gestures import EditContext
from ..session.edits import DeleteKeyframes, Edit, MoveKeyframes, SetEasing, SetLoop, SetPins
from ..session.session import Session
from .auto_key import AutoKey, KeyedValues, key_edits, keyed_values
from .crossing_blend import CrossingBlend
from .frames import Frame
from .keyframe_poses import KeyframePoses, animation_crossings, period_of
from .keyframe_times import EasingDrag, TimesDrag, counted, mirror_times, within_limits
from .keyframing.group_edits import insert_edits, reverse_edits
from .keyframing.key_moves import KeyMoves
from .keyframing.keyframe_clipboard import KeyframeClipboard
from .keyframing.onion_skin import OnionSkin
from .keyframing.unkeyed import differs, is_keyed
from .loose_motion import Crossed, Instant
from .playback import Playback, VisibleRange

_DUPLICATE_GAP = 0.5  # seconds between the last keyframe and duplicates
_MIN_TOTAL_SECONDS = 2.0  # shown by the timeline, even if the animation is shorter


class KeyframePlayback(Playback):
    """Shows the keyframes of the open document at any time, and edits them; see `Session.preview`.

    Scrubbing edits nothing. The next gesture starts from the pose at the playhead, which becomes the present
    pose. selected: times of the selected keyframes.
    """

    time: float

    def __init__(self, editor: EditContext, clock: Callable[[], float] = monotonic) -> None:
        super().__init__(clock)
        self.onion_skin = OnionSkin()
        self.auto_key = AutoKey()
        self._editor = editor
        self._poses = KeyframePoses()
        self._crossings = CrossingBlend()
        self._session: Session | None = None
        self._clipboard, self._moves = KeyframeClipboard(), KeyMoves()
        self._reset()

    def _reset(self) -> None:
        self.time = 0.0
        self.marked_range = self._last_update = None
        self.selected: frozenset[float] = frozenset()
        self.visible_range = VisibleRange(_MIN_TOTAL_SECONDS)
        self._drag: TimesDrag | EasingDrag | None = None
        self._present: KeyedValues | None = None  # while the pose at the playhead is shown instead

    # -- state ---------------------------------------------------------------------------------------------

    @property
    def stored_animation(self) -> Animation:
        """The animation of the document, without the drag under way."""
        session = self._editor.session
        return NO_ANIMATION if session is None else session.present.animation

    @property
    def animation(self) -> Animation:
        """The animation as the drag under way would leave it."""
        animation = self.stored_animation
        return animation if self._drag is None else self._drag.apply(animation)

    @property
    def duration(self) -> float:
        """Seconds from 0 to the last keyframe."""
        return self.animation.duration

    @property
    def loop(self) -> bool:
        """Whether playing starts over at the end; a part of the animation."""
        return self.animation.loop

    @loop.setter
    def loop(self, loop: bool) -> None:
        self._edit(mark("Loop Forever") if loop else mark("Play Once"), SetLoop(loop))

    @property
    def is_previewing(self) -> bool:
        """Whether the pose at the playhead is shown instead of the present one."""
        return self._present is not None

    @property
    def is_dragging(self) -> bool:
        """Whether keyframes, or handles of their easing, are being dragged."""
        return self._drag is not None

    @property
    def selected_in_drag(self) -> frozenset[float]:
        """Times of the selected keyframes, as the drag under way would leave them."""
        if not isinstance(self._drag, TimesDrag):
            return self.selected
        return frozenset(self._drag.moves.get(time, time) for time in self.selected)

    def pose(self, time: float) -> Floats | None:
        """The pose (n, 2) at a time; None without keyframes."""
        session, animation = self._editor.session, self.animation
        if session is None or not animation.keyframes:
            return None
        return self._poses.moment(session.drawing.mesh, animation, time).pose

    @property
    def period(self) -> float | None:
        return period_of(self.animation)

    @property
    def content(self) -> tuple[object, ...]:
        """What the poses depend on; equal as long as they are the same."""
        session = self._editor.session
        return session, self.animation, None if session is None else session.present.loose

    def pose_at(self, time: float) -> tuple[Drawing, Floats]:
        """The drawing and its pose (n, 2) at a time; there must be keyframes."""
        session, pose = self._editor.session, self.pose(time)
        assert session is not None
        assert pose is not None, "expected keyframes"
        return self._drawing(session, time), pose

    def _drawing(self, session: Session, time: float) -> Drawing:
        """The drawing with the layers that are visible at a time."""
        return self._poses.drawing(session.present_document.drawing, self.animation, time)

    def instant(self, time: float) -> Instant:
        session, (drawing, pose) = self._editor.session, self.pose_at(time)
        assert session is not None
        return Instant(drawing, session.present, pose)

    def crossed(self, time: float) -> Crossed:
        session, animation = self._editor.session, self.animation
        assert session is not None
        mesh, pins, blend = session.drawing.mesh, session.present.pins, self._crossings
        pose, crossings = animation_crossings(self._poses, blend, mesh, pins, animation, time)
        return Crossed(animation.pins_at(pins, time), pose, crossings)

    def plain_frame(self, time: float) -> Frame:
        drawing, crossed = self.pose_at(time)[0], self.crossed(time)
        return Frame(drawing, crossed.positions, draw_order(drawing, *crossed))

    def onion_poses(self) -> tuple[list[Floats], list[Floats]]:
        """The poses of the onion skin before and after the playhead, the nearest ones first."""
        animation, onion_skin = self.animation, self.onion_skin
        if self.is_playing or not onion_skin.is_shown or not animation.keyframes:
            return [], []
        return onion_skin.poses(animation, self.time, self.pose)

    # -- playhead ------------------------------------------------------------------------------------------

    def update(self) -> None:
        """Adapt to edits since the last call; to be called once a frame."""
        session = self._editor.session
        if session is not self._session:
            self._session = session
            self._reset()
            self.time = self._time_of_present()
        if session is None:
            return
        if self.auto_key.update(self._editor, self.time) and self.is_previewing:
            self._show()
        self.time, self.selected = self._moves.view(self.stored_animation, (self.time, self.selected))
        self.selected &= set(self.stored_animation.times)
        if not self.is_dragging:
            self.visible_range.fit(max(_MIN_TOTAL_SECONDS, 1.2 * self.duration, self.time))
        if self._present is None or session.is_previewing or session.history.is_open:
            return
        if keyed_values(session).differs_from(self._present):
            self._present = self._last_update = None
        else:  # an edit of something else
            self._show()

    def _time_of_present(self) -> float:
        """The time of the first keyframe whose pose is the present one; 0 if there is none."""
        session = self._editor.session
        if session is None:
            return 0.0
        pose, keyframes = session.present.positions, self.stored_animation.keyframes
        return next((each.time for each in keyframes if np.array_equal(each.positions, pose)), 0.0)

    @property
    def shows_unkeyed_pose(self) -> bool:
        """Whether the pose that is shown differs from that of the animation at the playhead."""
        session = self._editor.session
        if session is None or not self.animation.keyframes or self.is_previewing:
            return False
        is_drawn = self._drawing(session, self.time) is session.drawing
        return not is_drawn or differs(session.drawing, session.state, self.crossed(self.time))

    def scrub(self, time: float) -> None:
        """Move the playhead and show the pose there, also after the last keyframe."""
        self.time = min(max(time, 0.0), MAX_KEYFRAME_TIME)
        self.visible_range.reveal(self.time)
        self._show()

    def _show(self) -> None:
        session = self._editor.session
        if session is None or session.history.is_open:
            return
        if not self.animation.keyframes:
            self.show_present()
            return
        present, crossed = session.present, self.crossed(self.time)
        self._present = keyed_values(session)
        pins = pins_fixed_at_pose(session.drawing.mesh, crossed.pins, crossed.positions)
        drawing, current = self._drawing(session, self.time), session.present_document.drawing
        shown = replace(
            present,
            positions=crossed.positions,
            crossings=crossed.crossings,
            pins=pins,
            drawing=present.drawing if drawing is current else drawing,
        )
        session.preview(shown, takes_pose=True)

    def _refresh(self) -> None:
        if self.is_previewing:
            self._show()

    def show_present(self) -> None:
        """Show the present pose."""
        self._present = self._last_update = None
        session = self._editor.session
        if session is not None and not session.history.is_open:
            session.end_preview()

    def go_to_keyframe(self, forward: bool) -> None:
        """Move the playhead to the next keyframe or the previous one, and select it."""
        now, times = as_keyframe_time(self.time), self.animation.times
        ahead = [time for time in times if (time > now if forward else time < now)]
        if ahead:
            time = ahead[0 if forward else -1]
            self.selected = frozenset({time})
            self.scrub(time)

    # -- edits ---------------------------------------------------------------------------------------------

    def set_keyframe(
        self, time: float | None = None, positions: Floats | None = None, crossings: Ints | None = None
    ) -> None:
        """Set a keyframe and select it; replaces a keyframe at the same time.

        time: that of the playhead by default; positions: a pose (n, 2), by default the one that is shown;
        crossings: its crossings (s, 2).
        """
        session = self._editor.session
        if session is None or self._editor.is_busy:
            return
        time = as_keyframe_time(self.time if time is None else time)
        if positions is None and is_keyed(self.animation, time, session.drawing, session.state):
            self.selected, self.time = frozenset({time}), time
            return
        layers, depths = session.drawing.layer_view, pin_depths(session.state.pins)
        if positions is None and self.is_previewing:
            positions, crossings = session.state.positions, session.state.crossings
        label = mark("Update Keyframe") if time in self.animation.times else mark("Add Keyframe")
        self._edit(label, *key_edits(self.animation, time, positions, crossings, layers, depths))
        self.selected, self.time = frozenset({time}), time

    def delete_keyframes(self) -> None:
        """Delete the selected keyframes, or the one at the playhead."""
        times = self._affected_times()
        if times:
            self._edit(counted("Delete", times), DeleteKeyframes(times))
            self.selected = frozenset()

    def duplicate_keyframes(self) -> None:
        """Copy the selected keyframes, or the one at the playhead, to the end."""
        times = self._affected_times()
        if times:
            shift = self.duration + _DUPLICATE_GAP - times[0]
            self._move({time: within_limits(time + shift) for time in times}, copy=True)

    def reverse_keyframes(self, copy: bool = False) -> None:
        """Play the selected keyframes, or all, backwards; copy: after the last one, and the others stay."""
        animation = self.animation
        times = sorted(self.selected) if len(self.selected) > 1 else list(animation.times)
        if len(times) < 2:
            return
        start = self.duration + _DUPLICATE_GAP if copy else times[0]
        moves = {old: within_limits(new) for old, new in mirror_times(times, start).items()}
        self._edit(counted("Duplicate" if copy else "Reverse", times), *reverse_edits(animation, moves, copy))
        self.selected = frozenset(moves.values())
        self._refresh()

    def insert_keyframes(
        self, label: str, keyframes: Sequence[Keyframe], pins: tuple[Pin, ...] | None = None
    ) -> None:
        """Add keyframes in one gesture, instead of those in their time, and select them.

        pins: replace those of the drawing.
        """
        changes = [] if pins is None else [SetPins(pins)]
        before, view = self.stored_animation, (self.time, self.selected)
        self._edit(label, *changes, *insert_edits(self.animation, keyframes))
        self.selected = frozenset(each.time for each in keyframes)
        self.scrub(keyframes[0].time)
        self._moves.add(before, view, self.stored_animation, (self.time, self.selected))

    def copy_keyframes(self) -> None:
        """Remember the selected keyframes, or the one at the playhead, for `paste_keyframes`."""
        session, times = self._editor.session, self._affected_times()
        if session is not None and times:
            self._clipboard.copy(session.drawing.mesh, self.animation, times)

    def can_paste(self) -> bool:
        """Whether keyframes of the drawing's present mesh were copied."""
        session = self._editor.session
        return session is not None and self._clipboard.fits(session.drawing.mesh)

    def paste_keyframes(self, reverse: bool = False) -> None:
        """Add the copied keyframes at the playhead, instead of those in their time; reverse: backwards."""
        if self.can_paste():
            keyframes = self._clipboard.pasted(as_keyframe_time(self.time), reverse)
            self.insert_keyframes(counted("Paste", [each.time for each in keyframes]), keyframes)

    def shift_keyframes(self, by: float) -> None:
        """Move the selected keyframes, or the one at the playhead, by seconds; the first not before 0."""
        times = self._affected_times()
        if times:
            shift = max(by, -times[0])
            self._move({time: within_limits(time + shift) for time in times})

    def move_keyframe(self, old: float, new: float) -> None:
        """Move the keyframe at the time ``old`` to ``new``."""
        self._move({old: within_limits(new)})

    def set_easing(self, easing: str | None) -> None:
        """Set the easing after the selected keyframes, or the one at the playhead; None: the default."""
        if times := self._affected_times():
            self._edit(mark("Change Easing"), SetEasing(times, easing))

    def set_default_easing(self, easing: str) -> None:
        """Set the easing after all keyframes that have none of their own."""
        self._edit(mark("Change Easing"), SetEasing(None, easing))

    def drag_keyframes(self, moves: Mapping[float, float], copy: bool = False) -> None:
        """Show the animation with keyframes at other times; `drop_keyframes` makes it an edit.

        moves: old times to new ones; copy: whether the keyframes also stay at the old times.
        """
        self._show_drag(TimesDrag({old: within_limits(new) for old, new in moves.items()}, copy))

    def drag_easing(self, time: float, easing: str) -> None:
        """Show the animation with another easing after a keyframe; `drop_keyframes` makes it an edit."""
        self._show_drag(EasingDrag(time, easing))

    def _show_drag(self, drag: TimesDrag | EasingDrag) -> None:
        self._drag = drag
        self._refresh()

    def drop_keyframes(self, keep: bool = True) -> None:
        """End the drag: edit the animation as it is shown, or return to the one before the drag."""
        if self._drag is None:
            return
        drag, self._drag = self._drag, None
        if keep and isinstance(drag, EasingDrag):
            self._edit(mark("Change Easing"), SetEasing([drag.time], drag.easing))
        elif keep and isinstance(drag, TimesDrag) and drag.changes_times:
            self._move(drag.moves, drag.copy)
        else:
            self._refresh()

    def _affected_times(self) -> list[float]:
        """Times of the selected keyframes, or of the one at the playhead, ascending."""
        playhead = as_keyframe_time(self.time)
        return sorted(self.selected) or [time for time in self.animation.times if time == playhead]

    def _move(self, moves: Mapping[float, float], copy: bool = False) -> None:
        """Move or copy keyframes; selection and playhead move along."""
        before, view = self.stored_animation, (self.time, self.selected)
        self._edit(counted("Duplicate" if copy else "Move", moves), MoveKeyframes(dict(moves), copy))
        if self.selected or copy:
            self.selected = frozenset(moves.get(time, time) for time in self.selected or moves)
        playhead = as_keyframe_time(self.time)
        if not copy and playhead in moves:
            self.time = moves[playhead]
            self._refresh()
        self._moves.add(before, view, self.stored_animation, (self.time, self.selected))

    def _edit(self, label: str, *edits: Edit) -> None:
        session = self._editor.session
        if session is None or self._editor.is_busy:
            return
        session.end_preview()
        self._editor.apply(label, *edits)
        self._refresh()
