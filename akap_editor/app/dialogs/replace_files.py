"""Asks before files are replaced that the user did not name."""

from collections.abc import Callable
from pathlib import Path

from ...display_text import display_name
from ...io.outputs import quoted_names
from ...words import tr, tr_plural
from ..app_state import AppState
from .question import Question, QuestionDialog


def ask_unless_new(
    state: AppState,
    paths: list[Path],
    replace: Callable[[], None],
    rename: Callable[[], None],
    source: Path | None = None,
) -> None:
    """Call ``replace`` at once if ``paths``, the files that exist, are none; else ask first.

    rename: leads to another name; source: a file that will be replaced, too, and that the drawing was opened
    from; None if there is none.
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
        state.part(QuestionDialog).ask(
            replace_question(" ".join(sentences), replace, tr("Other Name..."), rename)
        )
    else:
        replace()


def replace_question(
    text: str, replace: Callable[[], None], rename_label: str, rename: Callable[[], None]
) -> Question:
    """The question whether files may be replaced. text: says which, and why this is asked."""
    return Question("Replace files", text, rename_label, rename, tr("Replace"), replace)
