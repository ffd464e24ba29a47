"""A picture that is kept: the same pixels, drawn only where something in it has changed."""

import numpy as np
import pytest

from akap_editor.render.frame_cache import FrameCache

SIZE = (40, 30)
THING, OTHER = np.zeros(3), np.zeros(3)


@pytest.fixture
def kept(ctx):
    made = FrameCache(ctx)
    yield made
    made.release()


@pytest.fixture
def show(ctx, kept):
    """Shows a picture of which the left half has a color; what was read from the target, and the calls."""
    calls = []

    def show(color, values=(1.0, True), things=(THING, None), size=SIZE):
        target = ctx.simple_framebuffer(size)
        target.clear(1.0, 0.0, 1.0, 1.0)

        def draw(framebuffer):
            calls.append(color)
            framebuffer.use()
            ctx.viewport = (0, 0, *size)
            ctx.scissor = None
            framebuffer.clear(0.0, 0.0, 0.0, 1.0)
            ctx.scissor = (0, 0, size[0] // 2, size[1])
            framebuffer.clear(*color, 1.0)

        with ctx.scope(target):  # moderngl trips over a framebuffer that is released while bound
            kept.show(target, size, draw, values, things)
        pixels = np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(*size[::-1], 3)
        target.release()
        return pixels

    show.calls = calls
    return show


def test_it_is_shown_again_without_being_drawn(show):
    first, second = show((0.2, 0.4, 0.6)), show((0.9, 0.9, 0.9))
    assert show.calls == [(0.2, 0.4, 0.6)]
    np.testing.assert_array_equal(first[:, :20], np.full((30, 20, 3), (51, 102, 153)))
    assert not first[:, 20:].any()
    np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize(
    "change",
    [
        {"values": (1.0, False)},
        {"things": (OTHER, None)},
        {"things": (THING, OTHER)},
        {"things": (THING, None, OTHER)},
        {"size": (20, 30)},
    ],
)
def test_whatever_changes_it_is_drawn_anew(show, change):
    show((0.2, 0.4, 0.6))
    changed = show((1.0, 0.0, 0.0), **change)
    assert len(show.calls) == 2
    assert tuple(changed[0, 0]) == (255, 0, 0)
    assert tuple(show((0.0, 0.0, 1.0), **change)[0, 0]) == (255, 0, 0)
    assert len(show.calls) == 2


def test_after_a_failure_nothing_old_is_shown(ctx, kept, show):
    show((0.2, 0.4, 0.6))

    def fail(_):
        raise ValueError("a bug")

    target = ctx.simple_framebuffer(SIZE)
    with ctx.scope(target), pytest.raises(ValueError, match="a bug"):
        kept.show(target, SIZE, fail, (2.0,), (THING,))
    target.release()
    assert tuple(show((1.0, 0.0, 0.0))[0, 0]) == (255, 0, 0)
