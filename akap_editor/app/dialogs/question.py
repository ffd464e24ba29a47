"""The dialog that asks before something is lost: the safe answer, the other one, or Cancel."""

from collections.abc import Callable
from dataclasses import dataclass

from imgui_bundle import imgui

from ...words import tr
from .. import widgets
from ..app_state import AppState

_WIDTH = 420  # design points


@dataclass(frozen=True)
class Question:
    """What is asked, and what follows.

    title: names the dialog, it is not shown; text: says what is about to happen, and why this is asked;
    safe_label, answer_safely: the button that Enter presses, and what it does; other_label, answer_otherwise:
    the button beside it.
    """

    title: str
    text: str
    safe_label: str
    answer_safely: Callable[[], None]
    other_label: str
    answer_otherwise: Callable[[], None]


class QuestionDialog:
    """Asks one question at a time; Cancel does nothing."""

    def __init__(self) -> None:
        self._question: Question | None = None

    @property
    def is_open(self) -> bool:
        """Whether a question is to be answered."""
        return self._question is not None

    def ask(self, question: Question) -> None:
        """Show the dialog."""
        self._question = question

    def draw(self, _: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        question = self._question
        if question is None or not widgets.begin_dialog(question.title):
            return
        widgets.paragraph(question.text, min(imgui.calc_text_size(question.text).x + 1, _WIDTH * scale))
        imgui.spacing()
        answer: Callable[[], None] | None = None
        if widgets.button(question.safe_label, primary=True) or widgets.confirm_pressed():
            answer = question.answer_safely
        imgui.same_line()
        if widgets.button(question.other_label):
            answer = question.answer_otherwise
        imgui.same_line()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            answer = _do_nothing
        if answer is not None:
            self._question = None  # first, because an answer may ask the next question
            widgets.close_popup()
            answer()
        imgui.end_popup()


def _do_nothing() -> None:
    pass
