"""What tests of meshing share."""

import pytest

from akap_editor.meshing.meshers import MESHERS
from tests.support.meshers import pretend_installed


@pytest.fixture(params=MESHERS)
def mesher(request, monkeypatch) -> str:
    """Each mesher in turn; it is the default one, as on a computer where only it is installed."""
    pretend_installed(monkeypatch, request.param)
    return request.param
