"""The pages: links and names of files and commands are valid, and scripts make the screenshots."""

import ast
import doctest
import importlib
import importlib.util
import re
from functools import cache
from pathlib import Path

import pytest
from PIL import Image

from akap_editor.deform.methods import METHODS

ROOT = Path(__file__).resolve().parents[1]
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")
FILE = re.compile(r"`([\w./<>]+\.(?:py|md|toml))`")  # <name> stands for any name


def tool(name):
    """Import a script of tools/."""
    pytest.importorskip("imgui_bundle")
    spec = importlib.util.spec_from_file_location(name, ROOT / "tools" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("module", ["editor.document.drawing", "io.layers.open_layers"])
def test_examples_in_docstrings_give_what_they_say(module, monkeypatch):
    monkeypatch.chdir(ROOT / "assets" / "drawings")
    failed, attempted = doctest.testmod(importlib.import_module(f"akap_editor.{module}"))
    assert failed == 0
    assert attempted >= 3


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_files(page):
    links = [link for link in LINK.findall(page.read_text("utf-8")) if "://" not in link]
    missing = [link for link in links if not (page.parent / link).exists()]
    assert not missing


@pytest.fixture(scope="module")
def files():
    """The paths of all files of the project that pages may name."""
    folders = ("akap_editor", "benchmarks", "docs", "tests", "tools")
    paths = [*ROOT.glob("*.*"), *(path for folder in folders for path in (ROOT / folder).rglob("*.*"))]
    return [f"/{path.relative_to(ROOT).as_posix()}" for path in paths]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_named_files_exist(page, files):
    names = FILE.findall(page.read_text("utf-8"))
    patterns = [re.sub(r"<\w+>", r"\\w+", re.escape(f"/{name}")) + "$" for name in names]
    unknown = [
        name
        for name, pattern in zip(names, patterns, strict=True)
        if not any(re.search(pattern, path) for path in files)
    ]
    assert not unknown


WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))  # absent from an sdist


@pytest.mark.parametrize("page", [*PAGES, *WORKFLOWS], ids=lambda page: page.name)
def test_named_targets_of_make_exist(page):
    targets = re.findall(r"^(\w+):", (ROOT / "Makefile").read_text("utf-8"), re.MULTILINE)
    named = re.findall(r"(?:^|`|run: )make ([a-z]+)", page.read_text("utf-8"), re.MULTILINE)
    assert set(named) <= set(targets)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_named_functions_and_classes_exist(page):
    """The last part of every name in backticks is a word of the code or of a script."""
    names = re.findall(r"`[A-Za-z_.]*?([A-Za-z_]+)(?:\(\.*\))?`", page.read_text("utf-8"))
    assert not set(names) - words_of_the_code()


@cache
def words_of_the_code():
    """The words in the package, its shaders, benchmarks, tools and build files."""
    folders = ("akap_editor", "benchmarks", "shaders", "tools")
    sources = [path for folder in folders for path in (ROOT / folder).rglob("*.*")]
    sources = [path for path in sources if path.suffix in (".py", ".vert", ".frag", ".geom", ".sh")]
    paths = [*sources, ROOT / "pyproject.toml", ROOT / "Makefile"]
    text = "".join(path.read_text("utf-8") for path in paths)
    return set(re.findall(r"\w+", text))


def test_every_page_is_in_the_index():
    index = (ROOT / "docs" / "README.md").read_text("utf-8")
    assert not [
        page.name
        for page in PAGES
        if page.parent.name == "docs" and f"({page.name})" not in index and page.name != "README.md"
    ]


def test_every_screenshot_is_on_a_page():
    pages = "".join(page.read_text("utf-8") for page in PAGES)
    assert not [name for name in tool("make_screenshots").SHOTS if f"images/{name}.png" not in pages]


def test_the_moving_picture_of_the_readme_moves_and_loads_fast():
    """`python tools/make_moving_picture.py` makes it again."""
    path = ROOT / "docs" / "images" / "elephant.webp"
    with Image.open(path) as picture:
        assert picture.n_frames > 100
    assert path.stat().st_size < 3_000_000
    assert "(docs/images/elephant.webp)" in (ROOT / "README.md").read_text("utf-8")


def test_the_shortcuts_page_is_current():
    """If this fails, run python tools/make_shortcuts.py."""
    assert (ROOT / "docs" / "shortcuts.md").read_text("utf-8") == tool("make_shortcuts").page()


def test_presets_of_the_paper_have_their_labels():
    page = (ROOT / "docs" / "methods.md").read_text("utf-8")
    assert not [
        preset.label
        for preset in METHODS["akap"].presets
        if f"| `{preset.spec}` | {preset.label} |" not in page
    ]


LABEL = re.compile(r"(?<!\*)\*([A-Z][^*\n]+)\*(?!\*)")  # in italics
OTHER_PROGRAMS = {"Join as Shapes", "Window Manager Tweaks > Accessibility"}


@pytest.mark.parametrize("name", ["start", "posing", "view", "animation", "exporting"])
def test_named_labels_are_on_the_screen(name):
    labels = set(LABEL.findall((ROOT / "docs" / f"{name}.md").read_text("utf-8"))) - OTHER_PROGRAMS
    shown = labels_on_the_screen()
    unknown = [label for label in labels if not {text.rstrip("…") for text in label.split(" > ")} <= shown]
    assert not unknown


@cache
def labels_on_the_screen():
    """The constant texts of the app and of the edits, without dots at the end."""
    folders = [ROOT / "akap_editor" / "app", ROOT / "akap_editor" / "editor"]
    trees = [ast.parse(path.read_text("utf-8")) for folder in folders for path in folder.rglob("*.py")]
    texts = {node.value for tree in trees for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    return {text.rstrip(".") for text in texts if isinstance(text, str)}
