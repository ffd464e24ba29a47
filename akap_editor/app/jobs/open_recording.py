"""Opens a recording: replays it, so that it ends in a session that one can continue."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from ...display_text import display_name
from ...editor.animation.session_playback import SessionPlayback
from ...editor.session.recording import Recording
from ...editor.session.replay import Replay
from ...editor.session.session import Session
from ...errors import FileError, file_errors
from ...io.akap.recording import read_recording, recorded_drawing
from ...words import tr
from .task import Progress, Steps, Task

Show = Callable[[Session, SessionPlayback], None]


@dataclass(frozen=True, eq=False)
class ReadRecording:
    """The recording in a file, ready to be replayed on its drawing."""

    path: Path
    recording: Recording
    replay: Replay


def read_for_replay(path: Path) -> ReadRecording:
    """Read a recording and make its drawing. Raises InputError if it is no recording or an empty one."""
    recording = read_recording(path)
    if not recording.events:
        raise FileError("open", path, tr("the recording is empty"))
    with file_errors("open", path):
        return ReadRecording(path, recording, Replay(recording, recorded_drawing(recording)))


def replay_task(read: ReadRecording, show: Show) -> Task:
    """A task that replays a recording and passes the session and its playback to ``show``.

    If the task is finished early, the session ends there. It raises InputError at an event that cannot be
    replayed.
    """
    recording, replay = read.recording, read.replay
    playback = SessionPlayback(replay.clock)
    is_finished_early = False

    def finish_early() -> None:
        nonlocal is_finished_early
        is_finished_early = True

    def steps() -> Steps:
        times = [float(recorded["t"]) for recorded in recording.events]
        with file_errors("open", read.path):
            for count, event in enumerate(replay.events(), start=1):
                is_last_of_its_time = count == len(times) or times[count] > event.time
                if is_last_of_its_time:
                    playback.follow(replay.session)
                text = tr("At {time:.0f} of {duration:.0f} s", time=event.time, duration=recording.duration)
                yield Progress(count / len(times), text)
                if is_finished_early:
                    break
            session = replay.end()
        playback.follow(session)
        show(session, playback)

    return Task(tr("Opening {file}", file=display_name(read.path)), steps(), finish_early)
