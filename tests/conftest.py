"""What every test may use: the real cartoons, reproducible random cases, and windows last."""

import os

# Before numpy is loaded: threads of BLAS wait for one another on small machines, longer than the work takes.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import json
from pathlib import Path

import pytest
from hypothesis import settings

ROOT = Path(__file__).resolve().parents[1]

# The same cases on every run, and no limit by the clock: a slow machine is not a failure.
settings.register_profile("reproducible", derandomize=True, deadline=None)
settings.load_profile("reproducible")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Tests that open a real window are slow, so everything else reports first."""
    items.sort(key=lambda item: item.get_closest_marker("window") is not None)


@pytest.fixture(scope="session", autouse=True)
def preferences_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Nobody's own preferences are read or written; the hints for newcomers have been seen."""
    folder = tmp_path_factory.mktemp("preferences")
    (folder / "preferences.json").write_text(json.dumps({"first steps done": True}))
    os.environ["AKAP_EDITOR_CONFIG"] = os.environ["AKAP_EDITOR_STATE"] = str(folder)
    return folder


class Clock:
    """Stands still but where a test moves it on."""

    now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """The folder of real cartoons beside the checkout; the test is skipped where it is absent."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip(f"the folder of real cartoons {folder} is absent")
    return folder
