"""The real cartoons: pictures and masks in shared/data beside the checkout, which may be absent."""

from pathlib import Path

import pytest

SHARED_DATA = Path(__file__).resolve().parents[3] / "shared" / "data"


def cartoon_paths(*patterns: str) -> list:
    """Return parameters for a fixture or test: the paths that match, or a skipped None if there are none."""
    paths = sorted(path for pattern in patterns for path in SHARED_DATA.glob(pattern))
    absent = pytest.param(None, id="absent", marks=pytest.mark.skip(f"{SHARED_DATA} is absent"))
    return [pytest.param(path, id=path.stem) for path in paths] or [absent]
