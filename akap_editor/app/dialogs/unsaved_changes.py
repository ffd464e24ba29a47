"""The dialog that asks what happens to unsaved changes before a document is closed."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import imgui

from ...words import tr
from .. import widgets
from ..app_state import AppState

_WIDTH = 420  # design points


@dataclass(frozen=True)
class UnsavedChangesQuestion:
    """A document that is about to be closed.

    name: of the document; save: saves it, then closes it; discard: closes it without saving.
    """

    name: str
    save: Callable[[], None]
    discard: Callable[[], None]


class UnsavedChangesDialog:
    """Asks one question at a time; Cancel does nothing."""

    def __init__(self) -> None:
        self._question: UnsavedChangesQuestion | None = None

    @property
    def is_open(self) -> bool:
        """Whether a question is to be answered."""
        return self._question is not None

    def ask(self, question: UnsavedChangesQuestion) -> None:
        """Show the dialog."""
        self._question = question

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        question = self._question
        if question is None or state.document is None:
            self._question = None
            return
        if not widgets.begin_dialog("Unsaved changes"):
            return
        text = tr("Save changes to “{name}” before closing?", name=question.name)
        widgets.paragraph(text, min(imgui.calc_text_size(text).x + 1, _WIDTH * scale))
        imgui.spacing()
        if widgets.button(tr("Save"), primary=True) or widgets.confirm_pressed():
            self._close()
            question.save()
        imgui.same_line()
        if widgets.button(tr("Don't Save")):
            self._close()
            question.discard()
        imgui.same_line()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            self._close()
        imgui.end_popup()

    def _close(self) -> None:
        self._question = None
        widgets.close_popup()
