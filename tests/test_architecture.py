"""Layers, held by a machine: who imports whom, what loads without OpenGL, what a wheel carries."""

import ast
import os
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import resolve_name
from pathlib import Path, PurePosixPath

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "akap_editor"

WINDOW = frozenset({"glfw", "imgui_bundle"})
OPENGL = WINDOW | {"moderngl"}

BASE = frozenset({"errors", "resources"})
EDITOR = BASE | {"geometry", "meshing", "deform", "editor"}
ALL = EDITOR | {"io", "render", "compare", "app", "cli", "__init__"}


@dataclass(frozen=True)
class Rule:
    """What a layer may import of ours, and must not import of others: ever, or at its own import time."""

    ours: frozenset[str]
    never: frozenset[str] = frozenset()
    not_at_import: frozenset[str] = frozenset()


# A layer is a package or module at the top of akap_editor; itself it may always import.
RULES = {
    "errors": Rule(frozenset(), never=OPENGL),
    "resources": Rule(frozenset({"errors"}), never=OPENGL),
    "geometry": Rule(frozenset({"errors"}), never=OPENGL),
    "meshing": Rule(frozenset({"errors", "geometry"}), never=OPENGL),
    "deform": Rule(BASE | {"geometry"}, never=OPENGL),
    "editor": Rule(BASE | {"geometry", "meshing", "deform"}, never=OPENGL),
    "io": Rule(EDITOR),
    "render": Rule(EDITOR, never=WINDOW),
    "compare": Rule(EDITOR | {"io", "render", "__init__"}, never=OPENGL),
    "app": Rule(ALL),
    "cli": Rule(ALL, not_at_import=OPENGL),
    "__init__": Rule(ALL, not_at_import=OPENGL),
    "__main__": Rule(frozenset({"cli"}), never=OPENGL),
}

# Libraries that one place wraps for all others.
WRAPPED = {
    "triangle": {"meshing/triangulate.py", "meshing/triangle_worker.py"},
    "cvxopt": {"deform/cholesky.py"},
    "numba": {"geometry/jit.py"},
}


@dataclass(frozen=True)
class Import:
    """One imported name, absolute and dotted; ``deferred``: inside a function, so not at import time."""

    name: str
    line: int
    deferred: bool


def imports(node: ast.AST, package: str, deferred: bool = False) -> Iterator[Import]:
    """Every import below ``node``, a part of a module of ``package``; import_module("...") counts as well."""
    for child in ast.iter_child_nodes(node):
        names: list[str] = []
        match child:
            case ast.Import():
                names = [alias.name for alias in child.names]
            case ast.ImportFrom():
                origin = resolve_name("." * child.level + (child.module or ""), package)
                names = [f"{origin}.{alias.name}" for alias in child.names]
            case ast.Call(args=[ast.Constant(str(name)), *_]):
                if ast.unparse(child.func).split(".")[-1] in ("import_module", "__import__"):
                    names = [resolve_name(name, package)]
        yield from (Import(name, child.lineno, deferred) for name in names)
        inside = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
        yield from imports(child, package, deferred or inside)


def violations(path: str, source: str) -> list[str]:
    """The imports that a module must not have, one sentence each; ``path`` is relative to the package."""
    where = PurePosixPath(path)
    layer = where.with_suffix("").parts[0]
    if layer not in RULES:
        return [f"{path}: the layer {layer} has no rule in this test"]
    rule, found = RULES[layer], []
    for item in imports(ast.parse(source), ".".join(["akap_editor", *where.parts[:-1]])):
        top, _, rest = item.name.partition(".")
        if top == "akap_editor":
            target = rest.split(".")[0] if rest.split(".")[0] in RULES else "__init__"
            wrong = target != layer and target not in rule.ours
        else:
            wrong = top in rule.never or (top in rule.not_at_import and not item.deferred)
            wrong = wrong or (top in WRAPPED and path not in WRAPPED[top])
        if wrong:
            found.append(f"{path}:{item.line}: {layer} must not import {item.name}")
    return found


def test_no_module_imports_what_its_layer_must_not() -> None:
    sources = sorted(PACKAGE.rglob("*.py"))
    assert sources
    found = [
        problem
        for source in sources
        for problem in violations(source.relative_to(PACKAGE).as_posix(), source.read_text("utf-8"))
    ]
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    ("path", "source"),
    [
        ("errors.py", "from .resources import resource"),
        ("resources.py", "from .geometry import mesh"),
        ("geometry/mesh.py", "from ..deform import akap"),
        ("geometry/mesh.py", "from .. import deform"),
        ("geometry/mesh.py", "import akap_editor.deform.akap.deformer"),
        ("geometry/mesh.py", "from akap_editor.resources import resource"),
        ("geometry/mesh.py", "from akap_editor import make_drawing"),
        ("geometry/mesh.py", "import akap_editor"),
        ("geometry/mesh.py", "def f():\n    import moderngl"),
        ("geometry/parts/ring.py", "from ...editor import history"),
        ("geometry/outline.py", "import triangle"),
        ("deform/akap.py", "from ..editor.document import Pin"),
        ("deform/akap.py", "if True:\n    from ..io.images import read_image"),
        ("deform/akap.py", "class A:\n    def f(self):\n        from ..render import renderer"),
        ("deform/akap.py", "from cvxopt import cholmod"),
        ("deform/akap.py", "import numpy, moderngl"),
        ("editor/editor.py", "from ..io import project_file"),
        ("editor/editor.py", "from ..render.renderer import Renderer"),
        ("editor/editor.py", "from ..app import window"),
        ("editor/editor.py", "try:\n    import glfw\nexcept ImportError:\n    pass"),
        ("editor/editor.py", "def f():\n    return importlib.import_module('imgui_bundle')"),
        ("editor/editor.py", "import_module('..io.images')"),
        ("io/export.py", "from ..render.renderer import Renderer"),
        ("io/export.py", "def f():\n    from ..app.window import run"),
        ("io/export.py", "from ..cli import main"),
        ("render/renderer.py", "def f():\n    import glfw"),
        ("render/renderer.py", "from imgui_bundle import imgui"),
        ("render/renderer.py", "from ..io import images"),
        ("render/renderer.py", "from ..app import theme"),
        ("compare/report.py", "from ..cli import main"),
        ("compare/report.py", "import moderngl"),
        ("app/window.py", "import triangle"),
        ("cli/edit.py", "import moderngl"),
        ("cli/edit.py", "try:\n    from imgui_bundle import imgui\nfinally:\n    pass"),
        ("__init__.py", "import glfw"),
        ("__main__.py", "from .app.window import run"),
        ("plugins/new.py", ""),
    ],
)
def test_forbidden_import_is_found(path: str, source: str) -> None:
    assert len(violations(path, source)) == 1


@pytest.mark.parametrize(
    ("path", "source"),
    [
        (
            "geometry/mesh.py",
            "from ..errors import InputError\nfrom . import validation\nfrom .validation import as_points",
        ),
        ("geometry/__init__.py", "from .mesh import TriMesh\nimport akap_editor.geometry.mesh"),
        ("meshing/triangle_worker.py", "import triangle"),
        ("deform/cholesky.py", "import cvxopt.cholmod"),
        ("deform/akap.py", "from .. import errors, geometry\nfrom ..geometry.mesh import TriMesh"),
        ("editor/editor.py", "from ..deform.deformer import Deformer\nfrom ..resources import resource"),
        ("io/images.py", "from ..editor.document import Drawing\nfrom PIL import Image"),
        ("render/renderer.py", "import moderngl\nfrom ..editor.camera import Camera"),
        (
            "app/window.py",
            "import glfw, imgui_bundle\nfrom ..render import renderer\nfrom .. import io, __version__",
        ),
        ("cli/edit.py", "def main():\n    import moderngl\n    from ..app import window"),
        ("__init__.py", "from .io.images import read_image\nfrom .geometry.mesh import TriMesh"),
        ("__main__.py", "from .cli import main\nfrom akap_editor.cli import main"),
    ],
)
def test_allowed_import_is_let_through(path: str, source: str) -> None:
    assert violations(path, source) == []


# Run with module names as arguments: blocks OpenGL and windows, then imports the modules one by one.
LOADER = f"""
import importlib, sys, traceback

class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in {sorted(OPENGL)}:
            raise ModuleNotFoundError(name + " is blocked", name=name)

sys.meta_path.insert(0, Blocked())
for module in sys.argv[1:]:
    try:
        importlib.import_module(module)
    except Exception:
        traceback.print_exc()
        sys.exit(module + " does not load without OpenGL")
"""


def load_without_opengl(modules: list[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", LOADER, *modules], cwd=ROOT, capture_output=True, text=True)


def modules_without_opengl() -> list[str]:
    """The package itself, cli, and every module of the layers that a script may use without a display."""
    layers = ("geometry", "meshing", "deform", "editor", "io")
    files = [file for layer in layers for file in sorted((PACKAGE / layer).rglob("*.py"))]
    dotted = [".".join(file.relative_to(ROOT).with_suffix("").parts) for file in files]
    return ["akap_editor", *(name.removesuffix(".__init__") for name in dotted), "akap_editor.cli"]


def test_library_loads_without_opengl() -> None:
    process = load_without_opengl(modules_without_opengl())
    assert process.returncode == 0, process.stderr


@pytest.mark.parametrize("module", sorted(OPENGL))
def test_loader_does_block_opengl(module: str) -> None:
    process = load_without_opengl([module])
    assert process.returncode == 1
    assert f"{module} is blocked" in process.stderr


@pytest.fixture(scope="module")
def unpacked_wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that holds what an installed wheel puts into site-packages."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    process = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert process.returncode == 0, process.stderr
    (wheel,) = folder.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "site-packages")
    return folder / "site-packages"


def files_below(folder: Path) -> set[str]:
    files = (file for file in folder.rglob("*") if file.is_file() and "__pycache__" not in file.parts)
    return {file.relative_to(folder).as_posix() for file in files}


def test_wheel_carries_package_shaders_and_assets_only(unpacked_wheel: Path) -> None:
    carried = files_below(unpacked_wheel)
    expected = {f"akap_editor/{name}" for name in files_below(PACKAGE)}
    for folder in ("shaders", "assets"):
        inside = files_below(ROOT / folder)
        assert inside, f"{folder} is empty"
        expected |= {f"akap_editor/{folder}/{name}" for name in inside}
    assert {name for name in carried if ".dist-info/" not in name} == expected


def test_resources_are_found_in_an_installed_wheel(unpacked_wheel: Path) -> None:
    code = (
        "from akap_editor.resources import bundled_drawings, resource\n"
        "print(resource('shaders'), resource('assets'), *bundled_drawings(), sep='\\n')"
    )
    # PYTHONPATH comes before site-packages, hence before the editable install of the checkout.
    process = subprocess.run(
        [sys.executable, "-c", code],
        cwd=unpacked_wheel.parent,
        env={**os.environ, "PYTHONPATH": str(unpacked_wheel), "PYTHONDONTWRITEBYTECODE": "1"},
        capture_output=True,
        text=True,
    )
    assert process.returncode == 0, process.stderr
    found = [Path(line) for line in process.stdout.splitlines()]
    assert len(found) > 2, "no drawing is bundled"
    assert all(path.is_relative_to(unpacked_wheel) for path in found), found
