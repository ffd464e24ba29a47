"""Bring the translations up to date with the code: `make translations`, after words on the screen changed.

Collects all texts that are passed to `tr`, `tr_in`, `tr_plural` and `mark` of akap_editor/words.py, and the
names in a few tables, adds new ones to each akap_editor/locale/*.po without a translation, drops those that
are gone, and prints what is missing.
"""

import ast
from collections.abc import Container, Iterator
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.pofile import read_po, write_po

from akap_editor.words import LANGUAGES, po_path

ROOT = Path(__file__).resolve().parents[1]
_NOISE = tuple(
    f'"{field}:'
    for field in (
        *("Report-Msgid-Bugs-To", "POT-Creation-Date", "PO-Revision-Date", "Last-Translator"),
        *("Language-Team", "Generated-By"),
    )
)
KEYWORDS = {
    "tr": None,
    "mark": None,
    "tr_in": ((1, "c"), 2),
    "mark_in": ((1, "c"), 2),
    "tr_plural": (1, 2),
    "Command": None,
    "_tool": None,
    "_switch": None,
    "_distortion": None,
    "Submenu": None,
    "CommandGroup": None,
    "_part": None,
    "_tab": None,
    "Section": None,
    "begin_dialog": None,  # their first argument
}


def extract_calls(
    file: BinaryIO, keywords: Container[str], comment_tags: object, options: object
) -> Iterator[tuple[int, str, tuple[str | None, ...], list[str]]]:
    """Line, function and texts of each call of a function among ``keywords``, for Babel.

    Babel's own method overlooks calls inside f-strings.
    """
    calls = [node for node in ast.walk(ast.parse(file.read())) if isinstance(node, ast.Call)]
    for node in sorted(calls, key=lambda node: (node.lineno, node.col_offset)):
        name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        if name in keywords and node.args:
            values = [getattr(argument, "value", None) for argument in node.args]
            yield node.lineno, name, tuple(each if isinstance(each, str) else None for each in values), []


def template() -> Catalog:
    """All texts of the code, without translations."""
    catalog = Catalog(project="akap-editor", charset="utf-8")
    found = extract_from_dir(ROOT / "akap_editor", [("**.py", extract_calls)], keywords=KEYWORDS)
    for file, _, text, comments, context in found:
        catalog.add(text, None, [(file, None)], auto_comments=comments, context=context)
    return catalog


def translation(language: str) -> Catalog:
    """The translations into a language as they are stored."""
    with po_path(language).open("rb") as file:
        return read_po(file, locale=language)


def store(catalog: Catalog, language: str) -> None:
    """Write a file, without the lines of its header that change with each call or say nothing."""
    content = BytesIO()
    write_po(content, catalog, width=0, no_location=True, sort_by_file=True)
    lines = content.getvalue().decode().splitlines()
    kept = [line for line in lines if not line.startswith(_NOISE)]
    po_path(language).write_text("\n".join(kept) + "\n", "utf-8")


def missing(catalog: Catalog, texts: Catalog) -> list[str]:
    """The texts that a catalog has no translation of, not of each plural form, or one marked as fuzzy."""

    def is_missing(identifier: object, context: str | None) -> bool:
        message = catalog.get(identifier, context)
        if message is None or message.fuzzy:
            return True
        strings = message.string if isinstance(message.string, tuple) else (message.string,)
        return not all(text and text.strip() for text in strings)

    return [str(each.id) for each in texts if each.id and is_missing(each.id, each.context)]


def main() -> None:
    """Update all files."""
    texts = template()
    for language in LANGUAGES:
        if language == "en":
            continue
        catalog = translation(language)
        catalog.update(texts, no_fuzzy_matching=True, update_header_comment=False)
        catalog.obsolete.clear()
        store(catalog, language)
        left = missing(catalog, texts)
        print(f"{language}: {len(texts) - len(left)} texts, {len(left)} without a translation")


if __name__ == "__main__":
    main()
