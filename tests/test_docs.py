"""The pages in docs: links lead somewhere, and pictures of the window are made by the script."""

import importlib.util
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = sorted([*(ROOT / "docs").glob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
LINK = re.compile(r"\]\(([^)#\s]+)[^)]*\)")


def tool(name):
    pytest.importorskip("imgui_bundle")
    spec = importlib.util.spec_from_file_location(name, ROOT / "tools" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_files_that_are_there(page):
    links = [link for link in LINK.findall(page.read_text("utf-8")) if "://" not in link]
    missing = [link for link in links if not (page.parent / link).exists()]
    assert not missing


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


def test_the_page_of_keys_is_that_of_the_program():
    """Where this fails: python tools/make_shortcuts.py"""
    assert (ROOT / "docs" / "shortcuts.md").read_text("utf-8") == tool("make_shortcuts").page()
