"""Work that announces its stages to whoever has started it."""

from threading import Thread

import pytest

from akap_editor.errors import AkapError
from akap_editor.io.open_document import open_document
from akap_editor.progress import Cancelled, announce, listening, part
from akap_editor.resources import resource


def test_work_that_nobody_listens_to_goes_on():
    announce(0.5, "Half")
    with part(0.2, 0.4):
        announce(0.5, "Half")


def test_parts_count_as_their_share_of_the_whole():
    heard = []
    with listening(lambda share, text: heard.append((share, text))):
        announce(0.0, "begin")
        with part(0.5, 0.9):
            announce(0.5, "middle of the part")
            with part(0.5, 1.0):
                announce(0.5, "inner")
        announce(1.0, "end")
    announce(0.0, "nobody")
    assert heard == [
        (0.0, "begin"),
        (pytest.approx(0.7), "middle of the part"),
        (pytest.approx(0.8), "inner"),
        (1.0, "end"),
    ]


def test_a_listener_hears_its_own_thread_only():
    heard = []
    with listening(lambda share, text: heard.append(text)):
        other = Thread(target=announce, args=(0.0, "other"))
        other.start()
        other.join()
        announce(0.0, "own")
    assert heard == ["own"]


def test_opening_a_picture_announces_growing_shares_and_ends_where_it_is_cancelled():
    picture = resource("assets", "drawings", "bar.png")
    heard = []
    with listening(lambda share, text: heard.append((share, text))):
        open_document(picture)
    shares, texts = zip(*heard, strict=True)
    assert len(set(texts)) > 2
    assert all(0 <= share <= 1 for share in shares)
    assert sorted(shares) == list(shares)

    for stage in range(len(heard)):
        count = 0

        def cancel_there(share, text, stage=stage):
            nonlocal count
            count += 1
            if count > stage:
                raise Cancelled("cancelled")

        with pytest.raises(AkapError, match=r"^cancelled$"), listening(cancel_there):
            open_document(picture)
        assert count == stage + 1, "nothing comes after the stage at which it was cancelled"
