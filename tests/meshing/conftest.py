"""What tests of meshing share."""

import pytest

from tests.support.meshers import EACH_MESHER, pretend_installed


@pytest.fixture(params=EACH_MESHER)
def mesher(request, monkeypatch) -> str:
    """Each mesher in turn; it is the default one, as on a computer where only it is installed."""
    pretend_installed(monkeypatch, request.param)
    return request.param
