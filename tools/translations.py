"""Bring the translations up to date with the code: `make translations`, after words on the screen changed.

Collects all texts that are passed to `tr`, `tr_in`, `tr_plural` and `mark` of akap_editor/words.py, and the
names in a few tables, adds new ones to each akap_editor/locale/*.po without a translation, drops those that
are gone, and prints what is missing.
"""

from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.pofile import read_po, write_po

from akap_editor.words import LANGUAGES, po_path

ROOT = Path(__file__).resolve().parents[1]
KEYWORDS = {
    "tr": None,
    "mark": None,
    "tr_in": ((1, "c"), 2),
    "tr_plural": (1, 2),
    "Command": None,
    "_tool": None,
    "Submenu": None,
    "CommandGroup": None,
    "_part": None,
    "_tab": None,
    "Section": None,
    "begin_dialog": None,  # their first argument
}


def template() -> Catalog:
    """All texts of the code, without translations."""
    catalog = Catalog(project="akap-editor", charset="utf-8")
    found = extract_from_dir(
        ROOT / "akap_editor", [("**.py", "python")], keywords=KEYWORDS, comment_tags=["For translators:"]
    )
    for file, _, text, comments, context in found:
        catalog.add(text, None, [(file, None)], auto_comments=comments, context=context)
    return catalog


def translation(language: str) -> Catalog:
    """The translations into a language as they are stored."""
    with po_path(language).open("rb") as file:
        return read_po(file, locale=language)


def missing(catalog: Catalog, texts: Catalog) -> list[str]:
    """The texts that a catalog has no translation of, or not of each plural form."""

    def is_missing(identifier: object, context: str | None) -> bool:
        message = catalog.get(identifier, context)
        strings = message.string if message is not None else ""
        return not all(strings) if isinstance(strings, tuple) else not strings

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
        with po_path(language).open("wb") as file:
            write_po(file, catalog, width=0, no_location=True, omit_header=False, sort_by_file=True)
        left = missing(catalog, texts)
        print(f"{language}: {len(texts) - len(left)} texts, {len(left)} without a translation")


if __name__ == "__main__":
    main()
