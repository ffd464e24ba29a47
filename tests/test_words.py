"""Looking up words, and the stored translations: with the fields of their texts, read as Babel reads them."""

import ast
import re
import string
from pathlib import Path

import pytest
from babel import Locale
from babel.messages.catalog import Catalog
from babel.numbers import format_decimal

from akap_editor import words
from akap_editor.app.commands import registry
from akap_editor.app.commands.menu_bar import access_letters
from akap_editor.app.panels import history
from akap_editor.words import (
    LANGUAGES,
    number_text,
    po_path,
    read_translations,
    tr,
    tr_in,
    tr_plural,
    use_language,
)
from tools import translations

PACKAGE = Path(words.__file__).parent
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


# -- numbers -------------------------------------------------------------------------------------------------


@pytest.fixture(params=LANGUAGES)
def language(request):
    """Each language in turn."""
    use_language(request.param)
    yield request.param
    use_language("en")


def test_numbers_have_the_marks_of_the_language(language):
    """Babel's; in French the font lacks the narrow space that does not break."""
    shown = [
        number_text(1234567.5, ",.2f"),
        number_text(0.05, "g"),
        number_text(12),
        number_text(-0.5, "+.1f"),
    ]
    locale = Locale.parse(language)
    expected = format_decimal(1234567.5, "#,##0.00", locale).replace("\u202f", "\xa0")
    point = locale.number_symbols["latn"]["decimal"]
    assert shown == [expected, f"0{point}05", "12", f"-0{point}5"]


def test_fields_of_texts_are_numbers_of_the_language(language):
    values = {"size": 2.5, "name": "a.b", "count": 3, "share": 0.125}
    text = tr("{size:,.1f} {name} {count} {name!r:.60} {share:.1%}", **values)
    point = number_text(0.5)[1]
    assert text == f"2{point}5 a.b 3 'a.b' 12{point}5%"
    assert tr_plural("{count}, {more} s", "{count}, {more} s", 2, more=0.5) == f"2, 0{point}5 s"


# A format that may give a point or a comma: with decimals, without a set number of them, or with thousands.
DECIMALS = re.compile(r",|\.[1-9]\d*[f%]|[0-9]*(?<!\.0)[fge%]$")


def unlocalized_numbers(path: Path) -> list[str]:
    """The f-strings of a module of the window that write numbers themselves."""
    return [
        f"{path.name}:{node.lineno}: {ast.unparse(node)}"
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.FormattedValue)
        and node.format_spec is not None
        and DECIMALS.search("".join(str(getattr(part, "value", "")) for part in node.format_spec.values))
    ]


def test_no_number_is_drawn_with_the_marks_of_english_only():
    """Numbers on the screen are written by `number_text`, or by `tr` as fields of a text."""
    assert [text for path in (PACKAGE / "app").rglob("*.py") for text in unlocalized_numbers(path)] == []


@pytest.mark.parametrize(
    ("form", "is_found"),
    [(".2f", 1), ("g", 1), (",", 1), ("+.1f", 1), (".1%", 1), (".0f", 0), (".0%", 0), ("02x", 0), ("d", 0)],
)
def test_numbers_with_the_marks_of_english_are_found(monkeypatch, form, is_found):
    monkeypatch.setattr(Path, "read_text", lambda *_: f'imgui.text(f"{{value:{form}}} px")')
    assert len(unlocalized_numbers(Path("made_up.py"))) == is_found


# -- the stored translations ---------------------------------------------------------------------------------


CATALOG = """
msgid ""
msgstr "Plural-Forms: nplurals=2; plural=(n != 1);"

msgid "Whole"
msgstr "Ganz"

msgid "Empty"
msgstr ""

#, fuzzy
msgid "Guessed"
msgstr "Geraten"

msgid "{count} blank"
msgid_plural "{count} blanks"
msgstr[0] "{count} leere Form"
msgstr[1] " "
"""


def test_missing_translations_are_found(tmp_path, monkeypatch):
    (tmp_path / "de.po").write_text(CATALOG, "utf-8")
    monkeypatch.setattr(words, "_FOLDER", tmp_path)
    texts = Catalog()
    for text in ("Whole", "Empty", "Guessed", ("{count} blank", "{count} blanks"), "Absent"):
        texts.add(text)
    texts.add("Whole", context="of other meaning")
    assert translations.missing(translations.translation("de"), texts) == [
        *("Empty", "Guessed", "('{count} blank', '{count} blanks')", "Absent", "Whole"),
    ]


@pytest.fixture(scope="module")
def texts_of_the_code():
    return translations.template()


@pytest.mark.parametrize("language", TRANSLATED)
def test_each_text_has_a_translation(language, texts_of_the_code):
    """If it fails: `make translations`, then fill in what akap_editor/locale/*.po lacks."""
    assert translations.missing(translations.translation(language), texts_of_the_code) == []


def fields(text: str) -> set[tuple[str, str | None, str | None]]:
    """Names, formats and conversions of the fields of a text."""
    parsed = string.Formatter().parse(text)
    return {(name, form, conversion) for _, name, form, conversion in parsed if name is not None}


@pytest.mark.parametrize("language", TRANSLATED)
def test_translations_have_the_fields_of_their_texts(language):
    for message in translations.translation(language):
        if not message.id:
            continue
        originals = message.id if isinstance(message.id, tuple) else (message.id,)
        for text in message.string if isinstance(message.string, tuple) else (message.string,):
            assert fields(text) == fields(originals[-1]), (message.id, text)


@pytest.mark.parametrize("language", ["ja", "zh"])
def test_only_titles_of_menus_name_their_keys(language):
    """As in 表示(V), where the title itself has no letter."""
    catalog = translations.translation(language)
    assert {each.context for each in catalog if re.search(r"\([A-Z]\)$", str(each.string))} == {"menu"}


@pytest.mark.parametrize("language", TRANSLATED)
def test_files_are_read_as_babel_reads_them(language):
    read, catalog = read_translations(po_path(language)), translations.translation(language)
    for message in catalog:
        if not message.id:
            continue
        if isinstance(message.id, tuple):
            forms = {read.ngettext(*message.id, count) for count in range(3)}
            assert forms == set(message.string)
        elif message.context:
            assert read.pgettext(message.context, message.id) == message.string
        else:
            assert read.gettext(message.id) == message.string


@pytest.mark.parametrize("language", TRANSLATED)
def test_names_of_commands_differ(language):
    """ImGui and the palette tell the lines of a menu apart by their names."""
    use_language(language)
    try:
        for name, items in registry.MENUS:
            names = [item.text for item in items if item is not None]
            assert len(set(names)) == len(names), name
        assert len({command.name for command in registry.COMMANDS}) == len(
            {command.label.rstrip(".") for command in registry.COMMANDS}
        )
        assert all(access_letters([tr_in("menu", name) for name, _ in registry.MENUS]))
    finally:
        use_language("en")


@pytest.mark.parametrize("label", ["Drag 12 Pins", "Delete 3 Keyframes", "Apply Drag 3 Pins", "Move Pin"])
def test_labels_of_the_history_are_translated(label):
    use_language("de")
    try:
        shown = history.shown_label(label)
    finally:
        use_language("en")
    assert shown != label
    assert re.findall(r"\d+", shown) == re.findall(r"\d+", label)
    assert history.shown_label(label) == label


def test_texts_of_the_code_are_found(texts_of_the_code):
    found = {message.id for message in texts_of_the_code}
    assert {"Open...", "Pin Tool", "Bending", "Language", "System ({language})"} <= found


def test_no_text_is_an_f_string():
    """Its fields would be filled in before it is looked up."""
    pattern = re.compile(r"\b(?:tr|tr_in|tr_plural|mark)\(\s*f[\"']")
    package = Path(words.__file__).parent
    assert [path for path in package.rglob("*.py") if pattern.search(path.read_text("utf-8"))] == []


# -- no text is forgotten ------------------------------------------------------------------------------------

# Rooms whose errors an artist can cause by files and gestures; the others check arguments of programs.
SHOWN = ("app", "editor", "io", "layers", "meshing")
DRAWING = frozenset(
    [
        "imgui.text",
        "text_colored",
        "text_unformatted",
        "text_wrapped",
        "button",
        "small_button",
        "checkbox",
        "radio_button",
        "selectable",
        "menu_item",
        "menu_item_simple",
        "begin_menu",
        "set_tooltip",
        "tree_node_ex",
        "input_int",
        "input_float",
        "drag_int",
        "drag_float",
        "switch",
        "radio",
        "row",
        "label",
        "switch_label",
        "paragraph",
        "secondary_text",
        "show_tooltip",
        "icon_switch",
        "draw_label",
        "announce",
        "announced",
        "background_task",
        "Task",
        "Progress",
        "FileRequest",
        "replace_question",
        "InputError",
        "FileError",
        "SolverError",
        "DisplayError",
        "GraphicsError",
        "NoOutlineError",
        "Cancelled",
    ]
)
HISTORY = frozenset(
    ["edit", "apply", "begin", "rename", "set_layers", "set_joints", "set_pose", "CutsRequest"]
)
STATES = frozenset(("notice", "error", "hint", "press_hint", "keyboard_hint"))  # variables that are shown
# Units, names and signs that are the same in each language
SAME = re.compile(
    r"^(%[^ ]*|[-+\d., ×÷°()%:/]|px|fps|ms|s|GB|MB|kB|E_area|E_angle|akap-editor|F2|OK|X|Y|K)*$"
)


def bare_words(node: ast.expr) -> str:
    """What a string or an f-string would show by itself; empty if that is the same in each language."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        shown = node.value
    elif isinstance(node, ast.JoinedStr):
        shown = "".join(str(part.value) for part in node.values if isinstance(part, ast.Constant))
    else:
        return ""
    shown = shown.partition("##")[0].strip()
    is_sentence = " " in shown or shown[:1].isupper()
    return shown if is_sentence and not SAME.match(shown) else ""


def forgotten_texts(path: Path) -> list[str]:
    found = []
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            last = name.rpartition(".")[2]
            is_drawing = last in DRAWING or name == "imgui.text"
            is_label = last in HISTORY and not name.startswith("imgui.")
            values = [*node.args, *(keyword.value for keyword in node.keywords)]
            labels = [each for each in values if is_label and not is_template(each)]
            shown = values if is_drawing else labels
            if name == "widgets.icon_switch":
                shown = shown[3:4]  # after the icon, its id, and whether it is on
        elif isinstance(node, ast.Assign):
            targets = {getattr(target, "attr", getattr(target, "id", "")) for target in node.targets}
            shown = [node.value] if targets & STATES else []
        elif isinstance(node, ast.FunctionDef) and node.name in STATES:
            shown = [each.value for each in ast.walk(node) if isinstance(each, ast.Return) and each.value]
        else:
            continue
        branches = [branch for each in shown for branch in _branches(each)]
        texts = [(each.lineno, bare_words(each)) for each in branches]
        found += [f"{path.relative_to(PACKAGE)}:{line}: {text}" for line, text in texts if text]
    return found


def is_template(node: ast.expr) -> bool:
    """Whether a label of the history with a field has its template in the History section."""
    branches = [each for each in _branches(node) if isinstance(each, ast.JoinedStr)]
    templates = {re.sub(r"{\w+}", "", template).strip() for template in history._TEMPLATES}
    return bool(branches) and {bare_words(each) for each in branches} <= templates


def _branches(node: ast.expr) -> list[ast.expr]:
    """Both values of a conditional expression, or the operands of "or"."""
    if isinstance(node, ast.IfExp):
        return [*_branches(node.body), *_branches(node.orelse)]
    if isinstance(node, ast.BoolOp):
        return [each for value in node.values for each in _branches(value)]
    return [node]


def test_no_text_is_drawn_without_being_looked_up():
    assert [
        text for room in SHOWN for path in (PACKAGE / room).rglob("*.py") for text in forgotten_texts(path)
    ] == []


def test_forgotten_texts_are_found(monkeypatch):
    source = 'imgui.text("Add Pins")\nwidgets.row("Size", f"{w} × {h} px")\nstate.notice = f"Saved {name}"\n'
    path = PACKAGE / "made_up.py"
    monkeypatch.setattr(Path, "read_text", lambda *_: source)
    found = sorted(text.partition(": ")[2] for text in forgotten_texts(path))
    assert found == ["Add Pins", "Saved", "Size"]
