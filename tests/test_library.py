"""The package as a library: the examples of its documentation, with and without OpenGL."""

import os
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import akap_editor as akap
from akap_editor.resources import resource

ROOT = Path(__file__).parents[1]

EXAMPLE = """
import akap_editor as akap

drawing = akap.make_drawing(akap.read_image("cat.png"), vertices=2000)
points = drawing.mesh.locate([[140.0, 120.0], [300.0, 410.0]])
deformer = akap.make_deformer("akap", drawing.mesh, memory=1.0)
deformer.set_pins(points)
pose = drawing.mesh.vertices
pose = deformer.step(pose, targets=[[150.0, 110.0], [300.0, 410.0]]).positions
distortion = akap.distortion(drawing.mesh, pose)
field = deformer.vector_field(pose, velocities=[[1.0, 0.0], [0.0, 1.0]])
"""

BLOCKED = """
import sys


class NoWindows:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {"moderngl", "glfw", "imgui_bundle"}:
            raise ImportError(f"{name} is blocked")


sys.meta_path.insert(0, NoWindows())
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The current folder, with cat.png in it."""
    shutil.copy(resource("assets", "drawings", "cat.png"), tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def example(folder):
    """The variables of the example after it ran."""
    names: dict[str, Any] = {}
    exec(EXAMPLE, names)
    return names


def test_the_example_bends_the_cat(example):
    drawing, pose, points = example["drawing"], example["pose"], example["points"]
    count = len(drawing.mesh.vertices)
    assert 1000 < count < 4000
    assert pose.shape == (count, 2)
    assert pose.dtype == np.float64
    before = drawing.mesh.evaluate(points, drawing.mesh.vertices)
    after = drawing.mesh.evaluate(points, pose)
    targets = np.array([[150.0, 110.0], [300.0, 410.0]])
    on_pins = np.linalg.norm(before - [[140.0, 120.0], [300.0, 410.0]], axis=1) < 1e-6
    assert on_pins.all(), "both points lie on the cat"
    assert (
        np.linalg.norm(after - targets, axis=1).max() < 0.5 * np.linalg.norm(before - targets, axis=1).max()
    )


def test_distortion_is_2_at_rest_and_more_in_a_bent_pose(example):
    bent = example["distortion"]
    assert bent.area >= 2.0
    assert bent.angle > 2.0
    assert bent.flipped == 0
    mesh = example["drawing"].mesh
    rest = akap.distortion(mesh, mesh.vertices)
    assert rest.area == pytest.approx(2.0, abs=1e-12)
    assert rest.angle == pytest.approx(2.0, abs=1e-12)
    assert rest.flipped == 0


def test_a_vector_field_is_one_velocity_per_vertex(example):
    field = example["field"]
    assert field.shape == (len(example["drawing"].mesh.vertices), 2)
    assert np.isfinite(field).all()


def test_pins_that_rotate_together_rotate_the_whole_drawing(example):
    def rotation(points):
        return (points - [200.0, 300.0]) @ [[0.0, 0.01], [-0.01, 0.0]] + [1.0, 2.0]

    mesh, pose = example["drawing"].mesh, example["pose"]
    velocities = rotation(mesh.evaluate(example["points"], pose))
    field = example["deformer"].vector_field(pose, velocities)
    np.testing.assert_allclose(field, rotation(pose), atol=1e-5 * abs(field).max())


def test_the_example_in_the_package_runs(monkeypatch):
    monkeypatch.chdir(ROOT)
    code = textwrap.dedent((akap.__doc__ or "").partition("::")[2])
    assert "make_deformer" in code
    names: dict[str, Any] = {}
    exec(code, names)
    rest = names["drawing"].mesh.vertices
    assert names["pose"].shape == rest.shape
    assert (names["pose"] != rest).any()


def test_the_example_runs_without_windows_and_opengl(folder):
    program = f"{BLOCKED}{EXAMPLE}\nprint(pose.shape == drawing.mesh.vertices.shape)"
    command = [sys.executable, "-c", program]
    result = subprocess.run(command, capture_output=True, text=True, cwd=folder, env=environment())
    assert (result.stdout, result.stderr, result.returncode) == ("True\n", "", 0)


def test_every_public_name_exists():
    for name in akap.__all__:
        assert getattr(akap, name) is not None


def environment():
    """This process's environment, with the checkout on the path, whatever the current folder is."""
    return {**os.environ, "PYTHONPATH": str(ROOT)}


def test_the_example_in_the_readme_runs(monkeypatch, capsys):
    monkeypatch.chdir(ROOT)
    example = (ROOT / "README.md").read_text("utf-8").partition("```python\n")[2].partition("```")[0]
    exec(compile(example, "README.md", "exec"), {})
    assert "Distortion(area=2.0" in capsys.readouterr().out


# -- arguments that make no sense ---------------------------------------------------------------------------

NONSENSE = {
    "0": 0,
    "-1": -1,
    "1.5": 1.5,
    "True": True,
    "None": None,
    "NaN": float("nan"),
    "infinity": float("inf"),
    "1e300": 1e300,
    "an integer of 400 digits": 10**400,
    "text": "x",
    "bytes": b"x",
    "an empty list": [],
    "a ragged list": [[1, 2], [3]],
    "a dictionary": {},
    "an object": object(),
    "an array": np.zeros(3),
}


def sensible_calls(folder: Path) -> dict[str, tuple[Any, dict[str, Any]]]:
    """Every public function and class with arguments that it takes."""
    image = np.zeros((60, 90, 4), dtype=np.uint8)
    image[10:50, 9:81] = (250, 130, 20, 255)
    drawing = akap.make_drawing(image, vertices=60)
    mesh, document = drawing.mesh, akap.new_document(drawing)
    akap.write_png(folder / "picture.png", image)
    akap.save(document, folder / "drawing.akap")
    still = {"positions": mesh.vertices, "targets": np.zeros((0, 2))}
    return {
        "TriMesh": (akap.TriMesh, {"vertices": mesh.vertices, "faces": mesh.faces}),
        "MeshPoints": (akap.MeshPoints, {"faces": [0], "weights": [[1.0, 0.0, 0.0]]}),
        "TriMesh.locate": (mesh.locate, {"points": [[40.0, 30.0]]}),
        "TriMesh.evaluate": (
            mesh.evaluate,
            {"points": mesh.locate([[40.0, 30.0]]), "values": mesh.vertices},
        ),
        "Drawing": (akap.Drawing, {"image": image, "mesh": mesh, "uv": drawing.uv}),
        "Pin": (akap.Pin, {"weights": [1, 0, 0], "target": [1, 2], "id": 1, "face": 0}),
        "EditState": (akap.EditState, {"positions": mesh.vertices, "pins": ()}),
        "make_drawing": (
            akap.make_drawing,
            {
                "image": image,
                "mask": image[..., 3],
                "vertices": 60,
                "expand": 2.0,
                "threshold": 0.5,
                "background": None,
            },
        ),
        "outlines": (
            akap.outlines,
            {"alpha": image[..., 3], "threshold": 0.5, "expand": 2.0, "tolerance": 0.5},
        ),
        "triangulate": (akap.triangulate, {"parts": akap.outlines(image[..., 3]), "vertices": 60}),
        "distortion": (akap.distortion, {"mesh": mesh, "positions": mesh.vertices}),
        "make_deformer": (
            lambda method, mesh, **parameters: akap.make_deformer(method, mesh, **parameters),
            {
                "method": "akap",
                "mesh": mesh,
                "memory": 1.0,
                "dirichlet": True,
                "trajectory": "spiral",
                "pin_weight": 100.0,
                "max_step": 0.05,
                "constraints": "soft",
                "exact": False,
                "stiffness": np.ones(len(mesh.faces)),
            },
        ),
        **{
            f"{method}.step": (akap.make_deformer(method, mesh).step, still) for method in akap.method_names()
        },
        "new_document": (akap.new_document, {"drawing": drawing, "settings": document.state.settings}),
        "bake": (akap.bake, {"document": document}),
        "read_image": (akap.read_image, {"path": folder / "picture.png"}),
        "write_png": (akap.write_png, {"path": folder / "out.png", "image": image}),
        "open_document": (akap.open_document, {"path": folder / "picture.png"}),
        "load": (akap.load, {"path": folder / "drawing.akap"}),
        "save": (akap.save, {"document": document, "path": folder / "out.akap"}),
        "export": (
            akap.export,
            {"document": document, "path": folder / "out.obj", "options": akap.ExportOptions()},
        ),
    }


@pytest.mark.parametrize("value", NONSENSE.values(), ids=NONSENSE)
def test_nonsense_is_refused_in_one_sentence_by_every_public_function(tmp_path, monkeypatch, value):
    """Or taken, where it makes sense after all; but never a TypeError from somewhere inside."""
    monkeypatch.chdir(tmp_path)  # where files of the names "x" may appear
    messages = []
    for name, (function, arguments) in sensible_calls(tmp_path).items():
        function(**arguments)
        for argument in arguments:
            try:
                with np.errstate(all="ignore"):
                    function(**{**arguments, argument: value})
            except akap.AkapError as error:
                messages.append(f"{name}({argument}): {error}")
    assert len(messages) > 20
    assert not [message for message in messages if len(message) > 400]
