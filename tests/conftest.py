"""Fixtures for all tests, reproducible random cases, and the tests of a real window first."""

import os

# Before numpy is loaded: on small machines, threads of BLAS wait for one another longer than they work.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import json
from pathlib import Path

import pytest
from hypothesis import settings

from akap_editor.geometry.mesh import TriMesh
from tests.support.cartoons import SHARED_DATA
from tests.support.shapes import SHAPES

# The same cases on every run, and no deadline: a slow machine is not a failure.
settings.register_profile("reproducible", derandomize=True, deadline=None)
settings.load_profile("reproducible")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run the tests of a real window first: they take longest, and all workers end with short tests."""
    items.sort(key=lambda item: item.get_closest_marker("window") is None)


@pytest.fixture(scope="session", autouse=True)
def preferences_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Keep preferences and recovery copies out of the user's folders; the first steps have been completed."""
    folder = tmp_path_factory.mktemp("preferences")
    (folder / "preferences.json").write_text(json.dumps({"first steps done": True}))
    os.environ["AKAP_EDITOR_CONFIG"] = os.environ["AKAP_EDITOR_STATE"] = str(folder)
    return folder


@pytest.fixture(scope="session", autouse=True)
def shader_cache(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Keep the shaders that Mesa compiles, 0.2 s for a first picture, for all workers and their programs."""
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent  # of the folders of all workers
    os.environ.setdefault("MESA_SHADER_CACHE_DIR", str(folder))  # not in HOME, which may be read-only


@pytest.fixture(scope="session", autouse=True)
def english() -> None:
    """Show English words, whatever the language of the system is."""
    os.environ["AKAP_EDITOR_LANGUAGE"] = "en"


@pytest.fixture(scope="session", autouse=True)
def own_file_dialog() -> None:
    """Choose files in the editor's own dialog, also on a desktop that has one; see `NativeFileDialog`."""
    os.environ["AKAP_EDITOR_FILE_DIALOG"] = "own"


class ManualClock:
    """A clock that moves only when a test sets `now`, in seconds."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> ManualClock:
    return ManualClock()


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of the real cartoons; the test is skipped if it is absent."""
    if not SHARED_DATA.is_dir():
        pytest.skip(f"{SHARED_DATA} is absent")
    return SHARED_DATA


@pytest.fixture(params=SHAPES)
def shape_name(request: pytest.FixtureRequest) -> str:
    """The name of each shape of `tests.support.shapes` in turn."""
    return request.param


@pytest.fixture
def mesh(shape_name: str) -> TriMesh:
    """Each shape of `tests.support.shapes` in turn."""
    return SHAPES[shape_name]
