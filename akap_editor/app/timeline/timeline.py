"""The motions that the timeline shows: the session so far and the keyframes, one of them at a time."""

from typing import Literal

from ...editor.animation.frames import Frame
from ...editor.animation.keyframe_playback import KeyframePlayback
from ...editor.animation.keyframe_times import TIME_STEP
from ...editor.animation.playback import Playback
from ...editor.animation.session_playback import SessionPlayback
from ...editor.document.named_poses import NamedPose
from ...editor.editor import Editor
from ...words import tr

TimelineMode = Literal["session", "keyframes"]


class Timeline:
    """Both playbacks of a drawing, and the one that is shown.

    is_shown: whether the timeline panel is visible; mode: the motion in it; keyframe_menu_requested: whether
    a command has asked for the menu of the selected keyframe.
    """

    def __init__(self, editor: Editor) -> None:
        self._editor = editor
        self.is_shown = False
        self.mode: TimelineMode = "session"
        self.session_playback = SessionPlayback()
        self.keyframe_playback = KeyframePlayback(editor)
        self.keyframe_menu_requested = False

    @property
    def playback(self) -> Playback:
        """The playback of the current mode."""
        return self.keyframe_playback if self.mode == "keyframes" else self.session_playback

    @property
    def shows_another_time(self) -> bool:
        """Whether the canvas shows the pose at the playhead instead of the present one."""
        if self.mode == "keyframes":
            return self.keyframe_playback.is_previewing
        return self.session_playback.time is not None

    @property
    def shows_keyframes(self) -> bool:
        """Whether the panel is visible and shows keyframes."""
        return self.is_shown and self.mode == "keyframes"

    def frame(self, time: float) -> Frame:
        """What the current mode shows at a time in seconds."""
        if self.mode == "keyframes":
            return self.keyframe_playback.frame(time)
        return self.session_playback.frame(time)

    def follow(self) -> str:
        """Record the session's state, once a frame; a sentence if it was continued from an earlier moment."""
        if not self.shows_keyframes:
            self.keyframe_playback.auto_key.forget()
        if self.session_playback.follow(self._editor.session):
            return tr("Continued from an earlier moment: what came after it is cut off. Undo brings it back.")
        return ""

    def set_mode(self, mode: TimelineMode) -> None:
        """Show the other motion; the canvas goes back to the present pose."""
        if mode != self.mode:
            self.show_present()
            self.mode = mode

    def show_keyframes(self) -> None:
        """Show the panel with the keyframes."""
        self.set_mode("keyframes")
        self.is_shown = True

    def add_keyframe(self, pose: NamedPose | None = None) -> None:
        """Set a keyframe at the playhead and show the keyframes.

        pose: by default, the one on the canvas.
        """
        session = self._editor.session
        shown = session.state if session is not None and session.is_previewing else None
        self.keyframe_playback.update()
        self.show_keyframes()
        source = pose or shown
        if source is None:
            self.keyframe_playback.set_keyframe()
        else:
            self.keyframe_playback.set_keyframe(None, source.positions, source.crossings)

    def show_present(self) -> None:
        """Show the present pose on the canvas instead of another moment's."""
        if self.session_playback.time is not None:
            self.session_playback.show_present()
        if self.keyframe_playback.is_previewing:
            self.keyframe_playback.show_present()


def snap_time(time: float) -> float:
    """The nearest multiple of `TIME_STEP`; seconds."""
    return round(time / TIME_STEP) * TIME_STEP
