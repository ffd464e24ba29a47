"""The words on the screen in the user's language: GNU gettext, with the translations of ``locale/*.po``.

Texts in the code are English. `tr` looks up the translation when a text is drawn or an error is raised; what
is in a table at import time is only marked there (`mark`) and looked up where it is drawn. Only the window
chooses a language, so that the library and the command line speak English.
"""

import ast
import gettext
import io
import locale
import os
import re
import string
import struct
import subprocess
import sys
from numbers import Real
from pathlib import Path
from typing import Any

LANGUAGES = {
    "en": "English",
    "de": "Deutsch",
    "es": "Español",
    "fr": "Français",
    "ja": "日本語",
    "zh": "简体中文",
}
# The decimal mark and the one between thousands, where they are not those of English. In French the latter is
# a narrow space, which the font of the window lacks; this one is wider.
_NUMBER_MARKS = {"de": ",.", "es": ",.", "fr": ",\N{NO-BREAK SPACE}"}
LANGUAGE_VARIABLE = "AKAP_EDITOR_LANGUAGE"  # environment variable: another language than the system's
_VARIABLES = (LANGUAGE_VARIABLE, "LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG")
_FOLDER = Path(__file__).resolve().parent / "locale"
_FIELD = re.compile(r'(msgctxt|msgid_plural|msgid|msgstr)(?:\[\d+\])?\s*(".*")')
_CONTEXT_END = "\x04"  # between a context and its text, in .mo files
_QUERY_SECONDS = 2.0

_translations: gettext.NullTranslations = gettext.NullTranslations()
_language = "en"
_number_marks: dict[int, str] = {}  # for `str.translate`


def tr(text: str, /, **fields: object) -> str:
    """The text in the current language. fields: values of its fields, as in "{count} pins"."""
    found = _translations.gettext(text) if text else ""
    return _filled(found, fields) if fields else found


def tr_in(context: str, text: str, /, **fields: object) -> str:
    """`tr` for a text that means several things in English, and here what ``context`` says."""
    found = _translations.pgettext(context, text)
    return _filled(found, fields) if fields else found


def tr_plural(one: str, many: str, count: int, /, **fields: object) -> str:
    """The text for a number of things, in the current language's plural form; ``count`` is a field of it."""
    return _filled(_translations.ngettext(one, many, count), {"count": count, **fields})


def number_text(value: float, form: str = "") -> str:
    """A number as the current language writes it. form: Python's format specification, as in ",.1f"."""
    return format(value, form).translate(_number_marks)


class _LocalizedFormatter(string.Formatter):
    """Fills the fields of a text with numbers as the current language writes them."""

    def format_field(self, value: Any, format_spec: str) -> str:
        text = format(value, format_spec)
        return text.translate(_number_marks) if isinstance(value, Real) else text


def _filled(text: str, fields: dict[str, object]) -> str:
    return _LocalizedFormatter().vformat(text, (), fields) if _number_marks else text.format(**fields)


def mark(text: str) -> str:
    """The text itself: it is to be translated, by `tr`, where it is drawn."""
    return text


def mark_in(context: str, text: str) -> str:
    """`mark` for a text that is translated by `tr_in`, with the same context."""
    return text


def use_language(language: str = "") -> None:
    """Choose the language, one of `LANGUAGES`; empty: the system's, or else English."""
    global _translations, _language, _number_marks
    _language = language if language in LANGUAGES else system_language()
    _translations = gettext.NullTranslations() if _language == "en" else read_translations(po_path(_language))
    _number_marks = dict(zip((ord("."), ord(",")), _NUMBER_MARKS.get(_language, ""), strict=False))


def current_language() -> str:
    """The language in use, one of `LANGUAGES`."""
    return _language


def system_language() -> str:
    """The user's first language that the program has; English if it has none of them."""
    wanted = [name for variable in _VARIABLES for name in os.environ.get(variable, "").split(":") if name]
    if not wanted and sys.platform == "win32":
        import ctypes

        identifier = ctypes.windll.kernel32.GetUserDefaultUILanguage()
        wanted = [locale.windows_locale.get(identifier, "")]
    elif sys.platform == "darwin" and not os.environ.get(LANGUAGE_VARIABLE):
        wanted = _languages_of_macos() or wanted  # a program of the Finder has no LANG
    return next((name[:2].lower() for name in wanted if name[:2].lower() in LANGUAGES), "en")


def _languages_of_macos() -> list[str]:
    """The languages of the system's preferences, e.g. "de-DE", the first one first."""
    command = ["defaults", "read", "-g", "AppleLanguages"]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=_QUERY_SECONDS, check=True)
    except (OSError, subprocess.SubprocessError):
        return []
    return re.findall(r"[a-z]{2,3}(?:-\w+)*", run.stdout)


# -- .po files -----------------------------------------------------------------------------------------------


def po_path(language: str) -> Path:
    """The file with the translations into a language."""
    return _FOLDER / f"{language}.po"


def read_translations(path: Path) -> gettext.GNUTranslations:
    """The translations of a .po file.

    The module gettext reads only compiled files; this compiles one in memory, so that no step of a build can
    be forgotten and none of its results be out of date.
    """
    entries: list[dict[str, list[str]]] = []
    texts: list[str] = []
    for line in path.read_text("utf-8").splitlines():
        found = _FIELD.match(line)
        if found is not None:
            field = found[1]
            if field == "msgctxt" or (field == "msgid" and (not entries or "msgstr" in entries[-1])):
                entries.append({})
            texts = entries[-1].setdefault(field, [])
            texts.append(ast.literal_eval(found[2]))
        elif line.startswith('"'):
            texts[-1] += ast.literal_eval(line)
    catalog = {}
    for entry in entries:
        context = "".join(text + _CONTEXT_END for text in entry.get("msgctxt", ()))
        key = context + "\0".join(entry["msgid"] + entry.get("msgid_plural", []))
        if all(entry["msgstr"]):
            catalog[key] = "\0".join(entry["msgstr"])
    return gettext.GNUTranslations(io.BytesIO(_compiled(catalog)))


def _compiled(catalog: dict[str, str]) -> bytes:
    """The content of a .mo file: a header, two tables of lengths and offsets, and the texts."""
    texts = [key.encode() for key in sorted(catalog)]
    texts += [catalog[key].encode() for key in sorted(catalog)]
    count, offset, table = len(catalog), 28 + 16 * len(catalog), b""
    for text in texts:
        table += struct.pack("<2I", len(text), offset)
        offset += len(text) + 1
    header = struct.pack("<7I", 0x950412DE, 0, count, 28, 28 + 8 * count, 0, 0)
    return header + table + b"".join(text + b"\0" for text in texts)
