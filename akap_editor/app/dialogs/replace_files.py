"""The dialog that asks before files are replaced that the user did not name, or that others have changed."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from imgui_bundle import imgui

from ...display_text import display_name
from ...io.outputs import quoted_names
from ...words import tr, tr_plural
from .. import widgets
from ..app_state import AppState

_WIDTH = 420  # design points


@dataclass(frozen=True)
class ReplaceQuestion:
    """Files that are about to be replaced.

    text: says which and why this is asked; replace: replaces them; rename_label, rename: the button that
    leads to another name, and what it does.
    """

    text: str
    replace: Callable[[], None]
    rename_label: str
    rename: Callable[[], None]


class ReplaceFilesDialog:
    """Asks one question at a time; Cancel does nothing."""

    def __init__(self) -> None:
        self._question: ReplaceQuestion | None = None

    @property
    def is_open(self) -> bool:
        """Whether a question is to be answered."""
        return self._question is not None

    def ask(self, question: ReplaceQuestion) -> None:
        """Show the dialog."""
        self._question = question

    def ask_unless_new(
        self,
        paths: list[Path],
        replace: Callable[[], None],
        rename: Callable[[], None],
        source: Path | None = None,
    ) -> None:
        """Call ``replace`` at once if ``paths``, the files that exist, are none; else ask first.

        source: a file that will be replaced, too, and that the drawing was opened from; None if there is
        none.
        """
        sentences = []
        if source is not None:
            sentences.append(
                tr("The drawing was opened from “{file}”, which will be replaced.", file=display_name(source))
            )
        if paths:
            sentences.append(
                tr_plural(
                    "{files} exists already and will be replaced.",
                    "{files} exist already and will be replaced.",
                    len(paths),
                    files=quoted_names(paths),
                )
            )
        if sentences:
            self.ask(ReplaceQuestion(" ".join(sentences), replace, tr("Other Name..."), rename))
        else:
            replace()

    def draw(self, _: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        question = self._question
        if question is None or not widgets.begin_dialog("Replace files"):
            return
        widgets.paragraph(question.text, _WIDTH * scale)
        imgui.spacing()
        if widgets.button(question.rename_label, primary=True) or widgets.confirm_pressed():
            self._close()
            question.rename()
        imgui.same_line()
        if widgets.button(tr("Replace")):
            self._close()
            question.replace()
        imgui.same_line()
        if widgets.button(tr("Cancel")) or widgets.cancel_pressed():
            self._close()
        imgui.end_popup()

    def _close(self) -> None:
        self._question = None
        widgets.close_popup()
