"""Looking up words, and the stored translations: with the fields of their texts, read as Babel reads them."""

import re
import string
from pathlib import Path

import pytest

from akap_editor import words
from akap_editor.words import LANGUAGES, po_path, read_translations, tr, tr_in, tr_plural, use_language
from tools import translations

TRANSLATED = [language for language in LANGUAGES if language != "en"]

PO = r"""# A comment.
msgid ""
msgstr ""
"Language: de\n"
"Plural-Forms: nplurals=2; plural=(n != 1);\n"
"Content-Type: text/plain; charset=utf-8\n"

#. For translators: of a dialog
msgid "Close"
msgstr "Schließen"

msgctxt "adjective"
msgid "Close"
msgstr "Nah"

msgid "“{name}” has\n"
"two \"lines\""
msgstr "„{name}“ hat\n"
"zwei \"Zeilen\""

msgid "{count} pin"
msgid_plural "{count} pins"
msgstr[0] "{count} Pin"
msgstr[1] "{count} Pins"

msgid "Not yet"
msgstr ""

#~ msgid "Gone"
#~ msgstr "Weg"
"""


@pytest.fixture
def german(tmp_path, monkeypatch):
    (tmp_path / "de.po").write_text(PO, "utf-8")
    monkeypatch.setattr(words, "_FOLDER", tmp_path)
    use_language("de")
    yield
    use_language("en")


@pytest.mark.usefixtures("german")
def test_looks_up_plain_texts_contexts_fields_and_plurals():
    assert (tr("Close"), tr_in("adjective", "Close"), tr("")) == ("Schließen", "Nah", "")
    assert tr('“{name}” has\ntwo "lines"', name="{x}") == '„{x}“ hat\nzwei "Zeilen"'
    assert [tr_plural("{count} pin", "{count} pins", count) for count in (1, 2)] == ["1 Pin", "2 Pins"]


@pytest.mark.usefixtures("german")
def test_a_text_without_translation_stays_english():
    assert [tr("Not yet"), tr("Gone"), tr("{count} of them", count=3)] == ["Not yet", "Gone", "3 of them"]
    use_language("en")
    assert [tr("Close"), tr_in("adjective", "Close")] == ["Close", "Close"]
    assert [tr_plural("{count} pin", "{count} pins", count) for count in (1, 2)] == ["1 pin", "2 pins"]


@pytest.mark.parametrize(
    ("variables", "language"),
    [
        ({"LANG": "de_DE.UTF-8"}, "de"),
        ({"LANG": "fr_CA"}, "fr"),
        ({"LANG": "C.UTF-8"}, "en"),
        ({"LANG": "pl_PL.UTF-8"}, "en"),
        ({}, "en"),
        ({"LANG": "de_DE.UTF-8", "LC_ALL": "ja_JP.UTF-8"}, "ja"),
        ({"LANG": "de_DE.UTF-8", "LANGUAGE": "pl:zh_CN:es"}, "zh"),
        ({"LANG": "de_DE.UTF-8", "AKAP_EDITOR_LANGUAGE": "es"}, "es"),
    ],
)
def test_the_language_of_the_system(monkeypatch, variables, language):
    for name in ("AKAP_EDITOR_LANGUAGE", "LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    monkeypatch.setattr(words.sys, "platform", "linux")
    assert words.system_language() == language


# -- the stored translations ---------------------------------------------------------------------------------


def fields(text: str) -> set[str | None]:
    return {name for _, name, _, _ in string.Formatter().parse(text) if name is not None}


@pytest.mark.parametrize("language", TRANSLATED)
def test_translations_have_the_fields_of_their_texts(language):
    for message in translations.translation(language):
        if not message.id:
            continue
        originals = message.id if isinstance(message.id, tuple) else (message.id,)
        for text in message.string if isinstance(message.string, tuple) else (message.string,):
            assert not text or fields(text) == fields(originals[-1]), (message.id, text)


@pytest.mark.parametrize("language", TRANSLATED)
def test_files_are_read_as_babel_reads_them(language):
    read, catalog = read_translations(po_path(language)), translations.translation(language)
    missing = translations.missing(catalog, catalog)
    for message in catalog:
        if not message.id or str(message.id) in missing:
            continue
        if isinstance(message.id, tuple):
            forms = {read.ngettext(*message.id, count) for count in range(3)}
            assert forms == set(message.string)
        elif message.context:
            assert read.pgettext(message.context, message.id) == message.string
        else:
            assert read.gettext(message.id) == message.string


def test_texts_of_the_code_are_found():
    found = {message.id for message in translations.template()}
    assert {"Open...", "Pin Tool", "Bending", "Language", "System ({language})"} <= found


def test_no_text_is_an_f_string():
    """Its fields would be filled in before it is looked up."""
    pattern = re.compile(r"\b(?:tr|tr_in|tr_plural|mark)\(\s*f[\"']")
    package = Path(words.__file__).parent
    assert [path for path in package.rglob("*.py") if pattern.search(path.read_text("utf-8"))] == []
