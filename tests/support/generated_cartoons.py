"""Generated alpha channels that are hard to cut out, in families."""

from collections.abc import Callable, Iterator

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from scipy.ndimage import gaussian_filter

SIZE = 160
SAMPLES = 4  # per pixel and axis, for soft edges

Alpha = np.ndarray


def rasterize(draw: Callable[[ImageDraw.ImageDraw, float], None], soft: bool = True) -> Alpha:
    """Return (SIZE, SIZE) uint8, painted by ``draw(canvas, s)`` on a canvas with s pixels per pixel."""
    scale = SAMPLES if soft else 1
    canvas = Image.new("L", (SIZE * scale, SIZE * scale))
    draw(ImageDraw.Draw(canvas), scale)
    return np.asarray(canvas.resize((SIZE, SIZE), Image.Resampling.BOX))


def polygon(points: np.ndarray, soft: bool = True) -> Alpha:
    """Return a filled polygon; points (p, 2) in pixels."""
    return rasterize(lambda canvas, s: canvas.polygon([tuple(p) for p in points * s], fill=255), soft)


def around(radii: np.ndarray, first_angle: float = 0.0) -> np.ndarray:
    """Return points (p, 2) around the middle, at these distances and equal angles."""
    angles = first_angle + np.arange(len(radii)) * 2 * np.pi / len(radii)
    return SIZE / 2 + np.stack([np.cos(angles), np.sin(angles)], axis=1) * np.asarray(radii)[:, None]


def stars() -> Iterator[Alpha]:
    for points in (3, 4, 5, 7, 12, 20):
        for inner in (8, 20, 45):
            for angle in (0.0, 0.3):
                yield polygon(around(np.tile([75.0, inner], points), angle), soft=angle > 0)


def combs() -> Iterator[Alpha]:
    for tooth in (1, 2, 3, 5, 9):
        for gap in (1, 2, 4, 7, 12):
            alpha = np.zeros((SIZE, SIZE), dtype=np.uint8)
            alpha[10:30, 8:152] = 255
            for x in range(10, 150 - tooth, tooth + gap):
                alpha[30:140, x : x + tooth] = 255
            yield alpha


def spirals() -> Iterator[Alpha]:
    for turns in (2, 3, 5):
        for width in (1.0, 2.5, 5.0, 9.0):
            for start in (0.0, 1.0):
                angles = np.linspace(0, turns * 2 * np.pi, 400)
                radii = 4 + 70 * angles / angles[-1]
                line = SIZE / 2 + radii[:, None] * np.stack(
                    [np.cos(angles + start), np.sin(angles + start)], 1
                )

                def paint(canvas, s, line=line, width=width):
                    canvas.line([tuple(p) for p in line * s], fill=255, width=round(width * s), joint="curve")

                yield rasterize(paint)


def rings() -> Iterator[Alpha]:
    for count in (1, 2, 3, 4, 6):
        for share in (0.25, 0.5, 0.75):
            for shift in (0.0, 0.37):

                def paint(canvas, s, count=count, share=share, shift=shift):
                    step = 74 / count
                    for ring in range(count):
                        for radius, fill in ((74 - ring * step, 255), (74 - (ring + share) * step, 0)):
                            low, high = (SIZE / 2 - radius + shift) * s, (SIZE / 2 + radius + shift) * s
                            canvas.ellipse((low, low, high, high), fill=fill)

                yield rasterize(paint)


def glyphs() -> Iterator[Alpha]:
    font = ImageFont.load_default(size=120)
    for text in "aBeg8&@%#QW5xk?ö§Åij:":
        canvas = Image.new("L", (SIZE, SIZE))
        ImageDraw.Draw(canvas).text((SIZE / 2, SIZE / 2), text, fill=255, font=font, anchor="mm")
        yield np.asarray(canvas)
    small = ImageFont.load_default(size=14)
    for text in ("Every good\nboy does fine,\n0123456789", "il1|!;:.\n~^°\n{}[]()"):
        canvas = Image.new("L", (SIZE, SIZE))
        ImageDraw.Draw(canvas).multiline_text((8, 20), text, fill=255, font=small)
        yield np.asarray(canvas)


def blobs() -> Iterator[Alpha]:
    for seed in range(4):
        for sigma in (2.0, 4.0, 8.0):
            field = gaussian_filter(np.random.default_rng(seed).normal(size=(SIZE, SIZE)), sigma)
            yield np.rint(255 * np.clip(0.5 + 3 * field / field.std(), 0, 1)).astype(np.uint8)


def noise() -> Iterator[Alpha]:
    for seed in range(2):
        random = np.random.default_rng(seed)
        yield random.integers(0, 256, (64, 64)).astype(np.uint8)
        yield (255 * (random.random((64, 64)) < 0.3)).astype(np.uint8)
        yield np.kron(random.integers(0, 2, (24, 24)), np.full((5, 5), 255)).astype(np.uint8)
        yield random.choice([0, 51, 127, 128, 255], (40, 40)).astype(np.uint8)


def lines() -> Iterator[Alpha]:
    """Strokes of 1 to 1.5 pixels: straight, steep, crossing, round, zigzag."""
    middle = SIZE / 2
    for degrees in (0, 7, 30, 45, 80, 90):
        half = 70 * np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
        for soft, width in ((False, 1), (True, 1), (True, 1.5)):

            def paint(canvas, s, half=half, width=width):
                ends = [*(middle - half) * s, *(middle + half) * s]
                canvas.line(ends, fill=255, width=round(width * s))

            yield rasterize(paint, soft)
    for radius in (5, 20, 70):
        yield rasterize(
            lambda c, s, r=radius: c.ellipse(
                ((middle - r) * s, (middle - r) * s, (middle + r) * s, (middle + r) * s), outline=255, width=s
            )
        )
    zigzag = np.stack([np.arange(10, 150, 5), np.where(np.arange(28) % 2, 20, 140)], axis=1)
    yield rasterize(lambda c, s: c.line([tuple(p) for p in zigzag * s], fill=255, width=s), soft=False)
    grid = np.zeros((SIZE, SIZE), dtype=np.uint8)
    grid[10:150:9, 10:150] = grid[10:150, 10:150:9] = 255
    yield grid


def touching() -> Iterator[Alpha]:
    """Outlines that touch themselves in points, along sides and over long distances."""
    for cell in (3, 5, 8, 13):
        squares = np.indices((10, 10)).sum(axis=0) % 2
        yield np.kron(squares, np.full((cell, cell), 255)).astype(np.uint8)
        diagonal = np.kron(np.eye(10, dtype=int), np.full((cell, cell), 255))
        yield np.pad(diagonal, 3).astype(np.uint8)
        yield np.pad(255 - diagonal, 3).astype(np.uint8)
    for width in (1, 2, 3, 5):  # a slit that almost cuts a square in two, and an hourglass
        alpha = np.full((100, 100), 255, dtype=np.uint8)
        alpha[50 : 50 + width, : 100 - width] = 0
        yield np.pad(alpha, 4)
        y, x = np.mgrid[0:100, 0:100]
        yield np.pad(255 * (np.abs(x - 50) <= np.abs(y - 50) + width // 2), 4).astype(np.uint8)


def polygons() -> Iterator[Alpha]:
    for seed in range(24):
        random = np.random.default_rng(seed)
        yield polygon(around(random.uniform(6, 78, random.integers(5, 40)), random.uniform(0, 6)))


FAMILIES = {
    family.__name__: family
    for family in (stars, combs, spirals, rings, glyphs, blobs, noise, lines, touching, polygons)
}
