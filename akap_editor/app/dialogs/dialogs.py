"""Chooses which dialog is drawn: one at a time, the most urgent first."""

from typing import Protocol

from ...errors import AkapError
from ..app_state import AppState
from ..commands.shortcuts_page import ShortcutsPage
from . import message, progress
from .about import AboutDialog
from .clips import ClipsDialog
from .export.animation import ExportAnimationDialog
from .export.pose import ExportPoseDialog
from .file_dialog import FileDialog
from .preferences_page import PreferencesPage
from .question import QuestionDialog
from .recovery import RecoveryDialog
from .take import TakeDialog


class Dialog(Protocol):
    """A dialog that knows whether it is open."""

    @property
    def is_open(self) -> bool:
        """Whether it is to be drawn."""

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""


DIALOGS: tuple[type[Dialog], ...] = (
    QuestionDialog,
    RecoveryDialog,
    FileDialog,
    ExportPoseDialog,
    ExportAnimationDialog,
    TakeDialog,
    ClipsDialog,
    ShortcutsPage,
    AboutDialog,
    PreferencesPage,
)


def draw(state: AppState, scale: float) -> None:
    """Draw the dialog that must be answered first, if any. An error and a running task go before all."""
    if state.error:
        message.draw(state, scale)
    elif state.task is not None and state.task.is_blocking:
        progress.draw(state, state.task, scale)
    else:
        for kind in DIALOGS:
            dialog = state.part(kind)
            if dialog.is_open:
                try:
                    dialog.draw(state, scale)
                except AkapError:
                    raise  # what the user chose is not possible; the dialog stays
                except Exception:
                    state.reset_part(kind)  # otherwise it would fail again in every frame
                    raise
                return
