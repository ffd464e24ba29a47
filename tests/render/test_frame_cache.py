"""A cached picture: the same pixels, drawn again only if its content has changed."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from akap_editor.render.frame_cache import MIN_CHANGES, FrameCache, has_same_content
from akap_editor.render.overlays import NO_OVERLAYS, FaceColors, LineSegments, Overlays

SIZE = (40, 30)


@dataclass(frozen=True, eq=False)
class Content:
    number: float = 1.0
    array: object = None
    overlays: Overlays = NO_OVERLAYS


CONTENT = Content(array=np.zeros(3))


@pytest.fixture
def cache(ctx):
    made = FrameCache(ctx)
    yield made
    made.release()


@pytest.fixture
def show(ctx, cache):
    """Shows a picture whose left half has a color, and reads it back; `calls` lists the colors drawn."""
    calls = []

    def show(color, content=CONTENT, size=SIZE):
        target = ctx.simple_framebuffer(size)
        target.clear(1.0, 0.0, 1.0, 1.0)

        def draw(framebuffer):
            calls.append(color)
            show.is_direct = framebuffer is target
            framebuffer.use()
            ctx.viewport = (0, 0, *size)
            ctx.scissor = None
            framebuffer.clear(0.0, 0.0, 0.0, 1.0)
            ctx.scissor = (0, 0, size[0] // 2, size[1])
            framebuffer.clear(*color, 1.0)

        with ctx.scope(target):  # moderngl fails if a framebuffer is released while it is bound
            cache.show(target, size, content, draw)
        pixels = np.frombuffer(target.read(components=3, alignment=1), np.uint8).reshape(*size[::-1], 3)
        target.release()
        return pixels

    show.calls = calls
    return show


def test_a_picture_is_shown_again_without_being_drawn(show):
    first, second = show((0.2, 0.4, 0.6)), show((0.9, 0.9, 0.9), replace(CONTENT))
    assert show.calls == [(0.2, 0.4, 0.6)]
    np.testing.assert_array_equal(first[:, :20], np.full((30, 20, 3), (51, 102, 153)))
    assert not first[:, 20:].any()
    np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize(
    "change",
    [
        {"content": replace(CONTENT, number=2.0)},
        {"content": replace(CONTENT, array=np.zeros(3))},
        {"content": replace(CONTENT, array=None)},
        {"content": replace(CONTENT, overlays=Overlays(mesh_lines=True))},
        {"size": (20, 30)},
    ],
)
def test_another_content_or_size_is_drawn(show, change):
    show((0.2, 0.4, 0.6))
    changed = show((1.0, 0.0, 0.0), **change)
    assert len(show.calls) == 2
    assert tuple(changed[0, 0]) == (255, 0, 0)
    assert tuple(show((0.0, 0.0, 1.0), **change)[0, 0]) == (255, 0, 0)
    assert len(show.calls) == 2


def test_while_the_content_changes_in_each_call_nothing_is_copied(show):
    for number in range(2 * MIN_CHANGES):
        shown = show((0.0, number / 255, 1.0), replace(CONTENT, number=number))
        assert tuple(shown[0, 0]) == (0, number, 255)
        assert show.is_direct == (number >= MIN_CHANGES)
    for _ in range(2):  # the first one fills the cache
        shown = show((1.0, 0.0, 0.0), replace(CONTENT, number=number))
        assert tuple(shown[0, 0]) == (255, 0, 0)
        assert not show.is_direct
    assert len(show.calls) == 2 * MIN_CHANGES + 1


def test_after_a_failure_no_old_picture_is_shown(ctx, cache, show):
    show((0.2, 0.4, 0.6))

    def fail(_):
        raise ValueError("a bug")

    target = ctx.simple_framebuffer(SIZE)
    with ctx.scope(target), pytest.raises(ValueError, match="a bug"):
        cache.show(target, SIZE, replace(CONTENT, number=2.0), fail)
    target.release()
    assert tuple(show((1.0, 0.0, 0.0))[0, 0]) == (255, 0, 0)


# -- what is compared ---------------------------------------------------------------------------------------

LEVELS, COLORS = np.zeros(4), np.zeros((2, 3))


@pytest.mark.parametrize(
    ("first", "second", "same"),
    [
        (1.0, 1.0, True),
        (1.0, 2.0, False),
        (1, 1.0, False),
        ((1, (2, 3)), (1, (2, 3)), True),
        ((1, 2), (1, 2, 3), False),
        (LEVELS, LEVELS, True),
        (LEVELS, LEVELS.copy(), False),
        (None, LEVELS, False),
        (FaceColors(LEVELS, COLORS), FaceColors(LEVELS, COLORS), True),
        (FaceColors(LEVELS, COLORS), FaceColors(LEVELS.copy(), COLORS), False),
        (FaceColors(LEVELS, COLORS), FaceColors(LEVELS, COLORS, translucent=True), False),
        (
            Overlays(lines=(LineSegments(LEVELS, (1, 1, 1, 1), 2.0),)),
            Overlays(lines=(LineSegments(LEVELS, (1, 1, 1, 1), 2.0),)),
            True,
        ),
        (
            Overlays(lines=(LineSegments(LEVELS, (1, 1, 1, 1), 2.0),)),
            Overlays(lines=(LineSegments(LEVELS, (1, 1, 1, 1), 3.0),)),
            False,
        ),
    ],
)
def test_arrays_are_compared_by_identity_and_values_by_equality(first, second, same):
    assert has_same_content(first, second) is same


@dataclass(frozen=True, eq=False)
class NewOverlays(Overlays):
    """Overlays with a field that the cache has never heard of."""

    sparkle: float = 0.0


def test_a_new_field_takes_part_in_the_comparison():
    assert has_same_content(NewOverlays(sparkle=1.0), NewOverlays(sparkle=1.0))
    assert not has_same_content(NewOverlays(sparkle=1.0), NewOverlays(sparkle=2.0))
    assert not has_same_content(NewOverlays(), Overlays())
