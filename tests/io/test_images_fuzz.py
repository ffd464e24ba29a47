"""Damaged pictures of every kind open or are refused in one sentence; nothing else ever happens."""

import io
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PIL import Image

from akap_editor.errors import InputError
from akap_editor.io.images import read_image

KINDS = [
    ("PNG", "RGBA"),
    ("PNG", "P"),
    ("PNG", "LA"),
    ("PNG", "I;16"),
    ("JPEG", "RGB"),
    ("JPEG", "CMYK"),
    ("WEBP", "RGBA"),
    ("BMP", "RGB"),
    ("TIFF", "RGBA"),
    ("GIF", "P"),
]


def encoded(kind: str, mode: str) -> bytes:
    """A small picture with a transparent rim, where its kind knows such."""
    y, x = np.mgrid[0:24, 0:32]
    rgba = np.zeros((24, 32, 4), dtype=np.uint8)
    rgba[..., 0], rgba[..., 1], rgba[..., 2] = 8 * x, 10 * y, 90
    rgba[..., 3] = 255 * (np.hypot(x - 16, y - 12) < 9)
    picture = Image.fromarray(rgba)
    if mode == "I;16":
        picture = Image.fromarray((257 * rgba[..., 0].astype(np.uint16)).astype(np.uint16))
    else:
        picture = picture.convert(mode)
    stream = io.BytesIO()
    picture.save(stream, kind)
    return stream.getvalue()


WHOLE = {f"{kind} {mode}": (kind, encoded(kind, mode)) for kind, mode in KINDS}


@pytest.mark.parametrize("name", WHOLE)
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_a_damaged_picture_opens_or_is_refused(tmp_path: Path, name: str, data: st.DataObject) -> None:
    kind, whole = WHOLE[name]
    damaged = bytearray(whole)
    for _ in range(data.draw(st.integers(1, 6))):
        damaged[data.draw(st.integers(0, len(damaged) - 1))] = data.draw(st.integers(0, 255))
    end = data.draw(st.integers(0, len(damaged)))
    path = tmp_path / f"picture.{kind.lower()}"
    path.write_bytes(bytes(damaged[:end] if data.draw(st.booleans()) else damaged))
    refusal, image = "", None
    try:
        image = read_image(path)
    except InputError as error:
        refusal = str(error)
    if image is None:
        assert 0 < len(refusal) < 500
        assert "\n" not in refusal
    else:
        assert image.dtype == np.uint8
        assert image.ndim == 3
        assert image.shape[2] == 4
        assert image.size


@pytest.mark.parametrize("name", WHOLE)
def test_the_whole_picture_opens(tmp_path: Path, name: str) -> None:
    kind, whole = WHOLE[name]
    path = tmp_path / f"picture.{kind.lower()}"
    path.write_bytes(whole)
    assert read_image(path).shape == (24, 32, 4)
