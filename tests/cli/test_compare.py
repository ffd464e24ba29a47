"""`akap-editor compare`: the page and the JSON that it writes, and bad input."""

import json
import re
import sys
from functools import partial
from html.parser import HTMLParser

import pytest

from akap_editor.compare.run import replay_method
from akap_editor.deform.methods import compared_methods, method_names
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.session import Session
from akap_editor.geometry.distortion import distortion
from akap_editor.io.akap.recording import write_recording
from tests.support.command_line import assert_one_line
from tests.support.recorded_drag import plank_drawing, plank_recording
from tests.support.toy_method import TOY, add_toy_method


@pytest.fixture(scope="module")
def drawing():
    return plank_drawing()


@pytest.fixture(scope="module")
def recording():
    return plank_recording()


@pytest.fixture
def file(tmp_path, recording, drawing):
    write_recording(recording, tmp_path / "plank.akaprec", drawing)
    return tmp_path / "plank.akaprec"


@pytest.fixture
def call(run):
    """Runs `akap-editor compare` with arguments in an empty folder: (exit code, stdout, stderr)."""
    return partial(run, "compare")


class Page(HTMLParser):
    """Tags that are open, what is loaded from where, and the rows of tables as text."""

    VOID = frozenset({"meta", "img", "br", "path", "use", "rect", "line"})

    def __init__(self, text):
        super().__init__()
        self.open, self.sources, self.rows, self.figures = [], [], [], 0
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        attributes = dict(attrs)
        self.sources += [attributes[key] for key in ("src", "href", "xlink:href") if key in attributes]
        self.figures += tag == "figure"
        if tag not in self.VOID:
            self.open.append(tag)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_startendtag(self, tag, attrs):
        self.sources += [value for key, value in attrs if key in ("src", "href", "xlink:href")]

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open and self.rows and any(tag in ("td", "th") for tag in self.open):
            self.rows[-1][-1] += data


def test_report_and_json_say_the_same(call, file, recording, drawing, tmp_path):
    code, output, errors = call(
        file, "-m", "arap cauchy-green", "-m", "mls", "--vertices", "60", "-o", "report"
    )
    assert (code, errors) == (0, "")
    assert "index.html" in output
    assert "comparison.json" in output
    assert sorted(path.name for path in (tmp_path / "report").iterdir()) == ["comparison.json", "index.html"]
    (model,) = json.loads((tmp_path / "report" / "comparison.json").read_text("utf-8"))["models"]
    assert [method["spec"] for method in model["methods"]] == ["arap", "cauchy-green", "mls"]
    text = (tmp_path / "report" / "index.html").read_text("utf-8")
    page = Page(text)
    assert page.open == []
    for method in model["methods"]:
        after = distortion(drawing.mesh, replay_method(recording, drawing, method["spec"]).pose)
        assert method["E_area"] == pytest.approx(after.area, abs=1e-9)
        assert method["E_angle"] == pytest.approx(after.angle, abs=1e-9)
        assert any(f"{after.area:.3f}" in row and f"{after.angle:.3f}" in row for row in page.rows)
        assert len(method["frames"]["area"]) == model["frames"] == 12
        counts = [count for count, _, _ in method["finer"]]
        assert counts == sorted(counts)
        assert len(counts) == 2


def test_report_needs_nothing_else(call, file, tmp_path):
    assert call(file, "-m", "igarashi mls", "-o", tmp_path / "new" / "report")[0] == 0
    text = (tmp_path / "new" / "report" / "index.html").read_text("utf-8")
    page = Page(text)
    assert page.figures >= 4
    assert (
        len([source for source in page.sources if source.startswith("data:image/png;base64,")]) == 3 * 2 + 2
    )
    assert all(source.startswith(("data:", "#")) for source in page.sources)
    assert not re.search(r"url\((?!#)|@import|<script|<link", text)
    assert "igarashi" in text
    assert "pin_weight 1000" in text
    assert "Schaefer, McPhail and Warren 2006" in text


def test_figures_of_the_paper_stand_beside(call, drawing, recording, tmp_path):
    bar = make_drawing(drawing.image, vertices=120, name="bar")
    write_recording(recording, tmp_path / "bar.akaprec", bar)
    header = (tmp_path / "bar.akaprec").read_text("utf-8").replace('"name":"plank"', '"name":"bar"', 1)
    (tmp_path / "bar.akaprec").write_text(header)
    assert call("bar.akaprec", "-m", "mls arap:iterations=3 arap igarashi", "-o", "report")[0] == 0
    rows = Page((tmp_path / "report" / "index.html").read_text("utf-8")).rows
    assert ["in the paper", "4.951", "2.042", "", ""] in rows
    assert ["in the paper", "8.158", "2.036", "", ""] in rows


def test_all_methods_of_the_table_are_compared_by_default(call, file, tmp_path, monkeypatch):
    """Also one without presets and without parameters."""
    add_toy_method(monkeypatch)
    assert call(file, "-o", "report")[0] == 0
    (model,) = json.loads((tmp_path / "report" / "comparison.json").read_text("utf-8"))["models"]
    assert [method["spec"] for method in model["methods"]] == compared_methods()
    assert {method["method"] for method in model["methods"]} == {*method_names()}
    assert model["methods"][-1]["spec"] == TOY
    text = (tmp_path / "report" / "index.html").read_text("utf-8")
    assert Page(text).open == []
    assert f"<dt>{TOY} <code>{TOY}</code></dt><dd>{TOY}.<br>" in text


@pytest.mark.parametrize(
    ("options", "parts"),
    [
        (["-m", "magic"], ["method", "cauchy-green", "'magic'"]),
        (["-m", "arap:speed=1"], ["arap", "iterations", "'speed'"]),
        (["-m", "arap:iterations=0"], ["iterations", "from 1"]),
        (["--vertices", "many"], ["--vertices", "'many'"]),
        (["--vertices", "5"], ["--vertices", "50 to 20000"]),
    ],
)
def test_bad_options_are_told_in_one_line(call, file, tmp_path, options, parts):
    assert_one_line(call(file, *options, "-o", "report"), *parts)
    assert not (tmp_path / "report" / "index.html").exists()


def test_recording_that_is_missing_or_bends_nothing(call, drawing, tmp_path):
    assert_one_line(call("none.akaprec", "-o", "report"), "none.akaprec", "no such file")
    write_recording(Session(new_document(drawing)).recording, tmp_path / "still.akaprec", drawing)
    assert_one_line(call("still.akaprec", "-o", "report"), "still.akaprec", "pins on it")


def test_without_matplotlib_it_says_what_to_install(call, file, monkeypatch):
    for name in ("report", "plots"):
        monkeypatch.delitem(sys.modules, f"akap_editor.compare.{name}")
        monkeypatch.delattr(f"akap_editor.compare.{name}")
    monkeypatch.setitem(sys.modules, "akap_editor.compare.plots", None)
    assert_one_line(call(file, "-o", "report"), "akap-editor[report]")
