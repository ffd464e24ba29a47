"""The architecture beyond the import contracts of pyproject.toml, and a check that these contracts work."""

import os
import re
import shutil
import subprocess
import sys
import zipfile
from graphlib import TopologicalSorter
from pathlib import Path

import grimp
import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "akap_editor"

# -- imports -------------------------------------------------------------------------------------------------

OPENGL = frozenset({"glfw", "imgui_bundle", "moderngl"})


class PackageCopy:
    """A copy of the package and its import contracts, where a test can break one of them."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        shutil.copy(ROOT / "pyproject.toml", folder)
        shutil.copytree(PACKAGE, folder / "akap_editor", ignore=shutil.ignore_patterns("__pycache__"))

    def check_contracts(self, *contracts: str) -> subprocess.CompletedProcess[str]:
        """Run lint-imports with these contracts only, or with all of them if none is named."""
        program = "from importlinter.cli import lint_imports_command; lint_imports_command()"
        command = [sys.executable, "-c", program, "--no-logo", "--no-cache"]
        command += [argument for contract in contracts for argument in ("--contract", contract)]
        environment = {**os.environ, "PYTHONPATH": str(self._folder)}
        return subprocess.run(command, cwd=self._folder, env=environment, capture_output=True, text=True)

    def check_with(self, path: str, source: str, contract: str) -> subprocess.CompletedProcess[str]:
        """Run lint-imports with one contract while a module ends with ``source``; the module may be new."""
        module = self._folder / "akap_editor" / path
        original = module.read_text("utf-8") if module.exists() else None
        module.write_text(f"{original or ''}\n{source}\n", "utf-8")
        try:
            return self.check_contracts(contract)
        finally:
            if original is None:
                module.unlink()
            else:
                module.write_text(original, "utf-8")


@pytest.fixture(scope="module")
def package_copy(tmp_path_factory: pytest.TempPathFactory) -> PackageCopy:
    return PackageCopy(tmp_path_factory.mktemp("package"))


def test_package_keeps_its_import_contracts(package_copy: PackageCopy) -> None:
    process = package_copy.check_contracts()
    assert process.returncode == 0, process.stdout + process.stderr


@pytest.mark.parametrize(
    ("contract", "path", "source"),
    [
        ("layers", "errors.py", "from .resources import resource"),
        ("layers", "resources.py", "from .geometry import mesh"),
        ("layers", "geometry/mesh.py", "from ..deform import akap"),
        ("layers", "geometry/mesh.py", "import akap_editor.deform.akap.deformer"),
        ("layers", "meshing/outline.py", "from ..deform.methods import make_deformer"),
        ("layers", "deform/akap/deformer.py", "from ...editor.document.pin import Pin"),
        ("layers", "deform/akap/deformer.py", "if True:\n    from ...io.images import read_image"),
        ("layers", "deform/cholesky.py", "class A:\n    def f(self):\n        from ..render import renderer"),
        ("layers", "deform/islands.py", "from ..meshing import triangulate"),
        ("layers", "editor/editor.py", "from ..io.akap import project"),
        ("layers", "editor/camera.py", "from ..render.renderer import Renderer"),
        ("layers", "editor/document/pin.py", "from ...app import window"),
        ("layers", "io/images.py", "from ..render.renderer import Renderer"),
        ("layers", "io/images.py", "def f():\n    from ..app.window import Window"),
        ("layers", "io/images.py", "from ..cli import main"),
        ("layers", "render/renderer.py", "from ..io import images"),
        ("layers", "render/renderer.py", "from ..app import theme"),
        ("layers", "compare/report.py", "from ..cli import main"),
        ("layers", "plugins.py", ""),
        ("editor-layers", "editor/document/pin.py", "from ..session.session import Session"),
        ("editor-layers", "editor/session/history.py", "from ..animation.motion import Motion"),
        ("editor-layers", "editor/animation/motion.py", "from ..tools.base import Tool"),
        ("editor-layers", "editor/tools/base.py", "from ..editor import Editor"),
        ("editor-layers", "editor/new.py", ""),
        ("no-circles", "deform/akap/deformer.py", "from ..methods import METHODS"),
        ("bundled-files", "geometry/mesh.py", "from akap_editor.resources import resource"),
        ("engine-without-opengl", "geometry/mesh.py", "def f():\n    import moderngl"),
        ("engine-without-opengl", "deform/islands.py", "import numpy, moderngl"),
        ("engine-without-opengl", "editor/editor.py", "try:\n    import glfw\nexcept ImportError:\n    pass"),
        ("engine-without-opengl", "io/images.py", "from imgui_bundle import imgui"),
        ("render-without-window", "render/renderer.py", "def f():\n    import glfw"),
        ("render-without-window", "render/renderer.py", "from imgui_bundle import imgui"),
        ("compare-through-render", "compare/report.py", "import moderngl"),
        ("triangle", "meshing/triangulate.py", "import triangle"),
        ("triangle", "meshing/triangulate.py", "import pythoncdt"),
        ("triangle", "app/window.py", "import triangle"),
        ("numba", "deform/islands.py", "from numba import njit"),
        ("psd-tools", "io/images.py", "import psd_tools"),
    ],
)
def test_forbidden_import_breaks_the_contract(
    package_copy: PackageCopy, contract: str, path: str, source: str
) -> None:
    process = package_copy.check_with(path, source, contract)
    assert process.returncode == 1, process.stdout + process.stderr
    assert "Contracts: 0 kept, 1 broken." in process.stdout


def test_no_circle_of_imports() -> None:
    """Modules can be sorted so that each imports only earlier ones; imports for type checking count."""
    graph = grimp.build_graph("akap_editor", cache_dir=None)
    imports = {module: graph.find_modules_directly_imported_by(module) for module in graph.modules}
    TopologicalSorter(imports).prepare()


# -- sizes ---------------------------------------------------------------------------------------------------

MAX_LINES, MAX_MODULES = 400, 13
LONGER = {  # modules with more lines, and why
    "deform/methods.py": "the one table of methods",
    "deform/multifrontal.py": "compiled functions that call one another, see `geometry/jit.py`",
}


def test_modules_are_short() -> None:
    lengths = {
        module.relative_to(PACKAGE).as_posix(): len(module.read_text("utf-8").splitlines())
        for module in PACKAGE.rglob("*.py")
    }
    assert LONGER.keys() <= lengths.keys()
    assert {name for name, length in lengths.items() if length > MAX_LINES} <= LONGER.keys()


def test_folders_have_at_most_a_dozen_modules() -> None:
    sizes = {folder: len(list(folder.glob("*.py"))) for folder in [PACKAGE, *PACKAGE.rglob("*/")]}
    assert not {str(folder): size for folder, size in sizes.items() if size > MAX_MODULES}


# -- tests mirror the package --------------------------------------------------------------------------------

# Test files about no module of the package.
OVERALL = {
    "test_architecture",
    "test_dependencies",
    "test_docs",
    "io/test_fuzz_files",  # runs benchmarks/fuzz_files.py
}


def test_every_test_file_names_a_module() -> None:
    """It is called test_<module> or test_<module>_<topic>, in the folder of the module or package."""
    unknown = set()
    for path in (ROOT / "tests").rglob("test_*.py"):
        folder, name = path.relative_to(ROOT / "tests").parent, path.stem.removeprefix("test_")
        modules = {module.stem for module in (PACKAGE / folder).iterdir()} | {folder.name}
        if not any(name == module or name.startswith(f"{module}_") for module in modules - {""}):
            unknown.add((folder / path.stem).as_posix())
    assert unknown == OVERALL


# -- OpenGL --------------------------------------------------------------------------------------------------

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


# -- wheels --------------------------------------------------------------------------------------------------


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


def test_links_of_the_page_on_pypi_have_whole_addresses(unpacked_wheel: Path) -> None:
    (metadata,) = unpacked_wheel.glob("*.dist-info/METADATA")
    _, _, page = metadata.read_text("utf-8").partition("\n\n")
    links = re.findall(r"\]\(([^)#]+)", page)
    assert len(links) > 5
    assert not [link for link in links if not link.startswith("https://")]


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
