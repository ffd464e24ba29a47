"""Recordings that are opened: done again, so that they end in a session to go on with."""

from collections.abc import Callable
from pathlib import Path

from ...editor.animation.session_playback import SessionPlayback
from ...editor.session.replay import Replay
from ...editor.session.session import Session
from ...errors import InputError, error_context
from ...io.akap.recording import read_recording, recorded_drawing
from .task import Progress, Steps, Task

Show = Callable[[Session, SessionPlayback], None]


def reenacting(path: Path, show: Show) -> Task:
    """Does the recording in a file again, then shows its session, and the player that has watched it.

    Raises InputError where the file is no recording.
    """
    recording = read_recording(path)
    with error_context(path):
        replay = Replay(recording, recorded_drawing(recording))
    playback = SessionPlayback(replay.clock)
    if not recording.events:
        raise InputError(f"{path}: expected a recording of something that was done, got none")
    wanted = True

    def stop() -> None:
        nonlocal wanted
        wanted = False

    def steps() -> Steps:
        times = [float(recorded["t"]) for recorded in recording.events]
        for number, event in enumerate(replay.events(), start=1):
            if number == len(times) or times[number] > event.time:  # the last of what was done then
                playback.watch(replay.session)
            yield Progress(number / len(times), f"At {event.time:.0f} of {recording.duration:.0f} s")
            if not wanted:
                break
        session = replay.end()
        playback.watch(session)
        show(session, playback)

    return Task(f"Opening {path.name}", steps(), stop)
