"""`akap-editor compare`: what it measures, the page and the JSON that it writes, and bad input."""

import json
import re
import sys
from functools import cache
from html.parser import HTMLParser

import numpy as np
import pytest

from akap_editor import cli
from akap_editor.cli import compare
from akap_editor.compare.report import PAPER
from akap_editor.compare.run import bend, run
from akap_editor.deform.deformer import make_deformer
from akap_editor.editor.document.document import new_document
from akap_editor.editor.document.drawing import make_drawing
from akap_editor.editor.session.edits import SetTargets
from akap_editor.editor.session.pin_edits import add_pin
from akap_editor.editor.session.session import Session
from akap_editor.geometry.distortion import distortion
from akap_editor.io.akap.recording import read_recording, recorded_drawing, write_recording
from akap_editor.io.images import read_image
from akap_editor.resources import resource

SPECS = ["akap", "akap:memory=1", "arap", "igarashi", "cauchy-green", "mls"]


def picture():
    """(50, 150, 4): a bar."""
    image = np.zeros((50, 150, 4), dtype=np.uint8)
    image[10:40, 10:140] = (250, 130, 20, 255)
    return image


def recorded(drawing, places, ways, steps=12):
    """A session in which pins at ``places`` go along ``ways`` in a few moves."""
    session = Session(new_document(drawing), clock=iter(np.arange(1e4) / 30).__next__)
    session.begin("Add pins")
    pins = [add_pin(session, place) for place in places]
    session.commit()
    session.begin("Drag")
    for step in range(1, steps + 1):
        goals = np.add(places, np.multiply(ways, step / steps)).tolist()
        session.apply(SetTargets({pin: tuple(goal) for pin, goal in zip(pins, goals, strict=True)}))
        session.step()
    session.commit()
    return session.recording


@pytest.fixture(scope="module")
def drawing():
    return make_drawing(picture(), vertices=120, name="plank")


@pytest.fixture(scope="module")
def recording(drawing):
    places = [(20.0, 20.0), (20.0, 32.0), (130.0, 25.0)]
    return recorded(drawing, places, [(0.0, 0.0), (0.0, 0.0), (-15.0, 30.0)])


@pytest.fixture
def file(tmp_path, recording, drawing):
    write_recording(recording, tmp_path / "plank.akaprec", drawing)
    return tmp_path / "plank.akaprec"


@pytest.fixture
def call(monkeypatch, capfd, tmp_path):
    """Runs the program in an empty folder: (exit code, stdout, stderr)."""
    monkeypatch.chdir(tmp_path)

    def run_program(*arguments):
        monkeypatch.setattr(sys, "argv", ["akap-editor", "compare", *map(str, arguments)])
        code = 0
        try:
            cli.main()
        except SystemExit as leaving:
            code = leaving.code or 0
        return code, *capfd.readouterr()

    return run_program


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


# -- what is measured ----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def ran(recording, drawing):
    """The run of a method, made once."""
    return cache(lambda spec: run(recording, drawing, spec))


@pytest.mark.parametrize("spec", SPECS)
def test_a_run_ends_at_rest_under_its_pins(ran, drawing, spec):
    found = ran(spec)
    assert found.pin_error < (3.0 if spec == "mls" else 0.25)  # whose map is evaluated at vertices only
    measured = distortion(drawing.mesh, found.pose)
    assert (found.after.area, found.after.angle) == (measured.area, measured.angle)
    assert len(found.times) == len(found.trace.area) == len(found.step_seconds) == 12
    assert (np.diff(found.times) > 0).all()
    assert found.trace.area[-1] > found.trace.area[0] >= 2
    assert found.setup_seconds > 0


@pytest.mark.parametrize("spec", ["igarashi", "cauchy-green", "mls"])
def test_methods_without_iterations_are_one_step_away(ran, drawing, spec):
    """So their curves of convergence are flat, and they come home exactly."""
    found = ran(spec)
    assert found.jump.area[0] == pytest.approx(2.0, abs=1e-12)
    assert np.ptp(found.jump.area[1:]) == 0
    name, _, _ = spec.partition(":")
    deformer = make_deformer(name, drawing.mesh)
    deformer.set_pins(found.points)
    assert np.abs(deformer.step(drawing.mesh.vertices, found.targets).positions - found.pose).max() < 1e-9
    assert found.back < 1e-9


def test_the_way_back_shows_who_remembers(ran):
    back = {spec: ran(spec).back for spec in ("akap", "akap:memory=1", "arap")}
    assert back["akap:memory=1"] < 1e-3
    assert back["arap"] < 1e-3
    assert back["akap"] > 10 * back["akap:memory=1"]


def test_iterations_converge(ran):
    curve, end = ran("arap").jump, ran("arap").after.area
    assert abs(curve.area[-1] - end) < 0.01 * abs(curve.area[1] - end)
    assert (curve.pin_error[1:] < 1e-9).all()


def test_bar_of_the_paper_gives_its_figures():
    """Table 1, first row: the bundled recording is the bend at which conformal maps and ARAP agree."""
    recording = read_recording(resource("assets", "recordings", "bar.akaprec"))
    drawing = recorded_drawing(recording)
    found = {spec: bend(recording, drawing, spec).pose for spec in ("cauchy-green", "arap", "mls")}
    after = {spec: distortion(drawing.mesh, pose) for spec, pose in found.items()}
    area, angle = PAPER["bar"]["cauchy-green"]
    assert after["cauchy-green"].area == pytest.approx(area, abs=0.01)
    assert after["cauchy-green"].angle == pytest.approx(angle, abs=0.002)
    area, angle = PAPER["bar"]["arap"]
    assert after["arap"].area == pytest.approx(area, abs=0.005)
    assert after["arap"].angle == pytest.approx(angle, abs=0.01)
    assert min(after["mls"].area, after["mls"].angle) > 3.0


@pytest.mark.parametrize("name", ["dancer", "gecko"])
def test_real_cartoons(shared_data, name):
    """The order of Table 1 holds: conformal maps keep angles best and areas worst."""
    drawing = make_drawing(read_image(shared_data / "noto" / f"{name}.png"), vertices=400, name=name)
    mesh = drawing.mesh
    low, high = mesh.vertices.argmin(axis=0)[1], mesh.vertices.argmax(axis=0)[1]
    left, right = mesh.vertices.argmin(axis=0)[0], mesh.vertices.argmax(axis=0)[0]
    faces = [
        int(np.flatnonzero((mesh.faces == corner).any(axis=1))[0]) for corner in (low, high, left, right)
    ]
    places = mesh.vertices[mesh.faces[faces]].mean(axis=1)
    size = mesh.length
    ways = size * np.array([[0.2, 0.1], [0.0, 0.0], [0.1, -0.25], [-0.1, 0.2]])
    recording = recorded(drawing, [tuple(place) for place in places.tolist()], 0.5 * ways, steps=6)
    after = {
        spec: distortion(mesh, bend(recording, drawing, spec).pose)
        for spec in ("akap:memory=1", "arap", "cauchy-green")
    }
    assert after["cauchy-green"].area > max(after["arap"].area, after["akap:memory=1"].area)
    assert after["cauchy-green"].angle < min(after["arap"].angle, after["akap:memory=1"].angle)


# -- what is written -----------------------------------------------------------------------------------------


def test_report_and_json_say_the_same(call, file, recording, drawing, tmp_path):
    code, output, errors = call(
        file, "-m", "arap cauchy-green", "-m", "mls", "--vertices", "60", "-o", "report"
    )
    assert (code, errors) == (0, "")
    assert "index.html" in output
    assert "comparison.json" in output
    assert sorted(path.name for path in (tmp_path / "report").iterdir()) == ["comparison.json", "index.html"]
    (model,) = json.loads((tmp_path / "report" / "comparison.json").read_text())["models"]
    assert [method["spec"] for method in model["methods"]] == ["arap", "cauchy-green", "mls"]
    text = (tmp_path / "report" / "index.html").read_text()
    page = Page(text)
    assert page.open == []
    for method in model["methods"]:
        after = distortion(drawing.mesh, bend(recording, drawing, method["spec"]).pose)
        assert method["E_area"] == pytest.approx(after.area, abs=1e-9)
        assert method["E_angle"] == pytest.approx(after.angle, abs=1e-9)
        assert any(f"{after.area:.3f}" in row and f"{after.angle:.3f}" in row for row in page.rows)
        assert len(method["frames"]["area"]) == model["frames"] == 12
        counts = [count for count, _, _ in method["finer"]]
        assert counts == sorted(counts)
        assert len(counts) == 2


def test_report_needs_nothing_else(call, file, tmp_path):
    assert call(file, "-m", "igarashi mls", "-o", tmp_path / "new" / "report")[0] == 0
    text = (tmp_path / "new" / "report" / "index.html").read_text()
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
    header = (tmp_path / "bar.akaprec").read_text().replace('"name":"plank"', '"name":"bar"', 1)
    (tmp_path / "bar.akaprec").write_text(header)
    assert call("bar.akaprec", "-m", "mls arap:iterations=3 arap igarashi", "-o", "report")[0] == 0
    rows = Page((tmp_path / "report" / "index.html").read_text()).rows
    assert ["in the paper", "4.951", "2.042", "", ""] in rows
    assert ["in the paper", "8.158", "2.036", "", ""] in rows


def test_default_methods_are_all_there_are():
    names = {spec.partition(":")[0] for spec in compare.METHODS}
    assert names == {"akap", "arap", "igarashi", "cauchy-green", "mls"}


# -- bad input -----------------------------------------------------------------------------------------------


def assert_one_line(result, *parts):
    code, _, errors = result
    assert code == 2
    assert errors.startswith("akap-editor: ")
    assert errors.count("\n") == 1
    for part in parts:
        assert part in errors


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
