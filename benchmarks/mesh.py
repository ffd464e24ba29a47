"""Time and quality of meshing a few hundred generated cartoons of 512 × 512 pixels.

Run from the project's root: python benchmarks/mesh.py [--count 300] [--vertices 2000] [--mesher NAME]
[--folder DIR]
Every cartoon is drawn from a seed: a body of overlapping ellipses with limbs, hair, holes, islands and dust.
Times are those from alpha to mesh, without reading files and measuring quality.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import argparse
import time
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from akap_editor.io.images import read_image
from akap_editor.meshing.meshers import MESHERS, default_mesher
from akap_editor.meshing.picture_mesh import mesh_picture
from akap_editor.meshing.quality import mesh_quality, smallest_angles

SIZE, SAMPLES = 512, 2
SLIVER = 5.0  # degrees


def cartoon(seed: int) -> np.ndarray:
    """The alpha channel (512, 512) of a random figure."""
    random = np.random.default_rng(seed)
    canvas = Image.new("L", (SIZE * SAMPLES, SIZE * SAMPLES))
    draw = ImageDraw.Draw(canvas)
    middle = SIZE / 2 + random.normal(0, 20, 2)
    body = random.uniform(50, 110, 2)
    _ellipse(draw, middle, body)
    for angle in random.uniform(0, 2 * np.pi) + np.arange(random.integers(3, 9)) * random.uniform(0.6, 1.5):
        _limb(draw, random, middle + 0.8 * body * [np.cos(angle), np.sin(angle)], angle)
    head = middle - [0, 1.1 * body[1]]
    _ellipse(draw, head, random.uniform(35, 70, 2))
    for _ in range(random.integers(0, 12)):
        _stroke(draw, random, head, random.uniform(1, 4))
    for _ in range(random.integers(0, 3)):
        _ellipse(draw, middle + random.normal(0, 30, 2), random.uniform(3, 18, 2), 0)
    for _ in range(random.integers(0, 4)):
        _ellipse(draw, random.uniform(30, SIZE - 30, 2), random.uniform(3, 15, 2))
    for _ in range(random.integers(0, 30)):
        _ellipse(draw, random.uniform(0, SIZE, 2), random.uniform(0.3, 1.2, 2))
    return np.asarray(canvas.resize((SIZE, SIZE), Image.Resampling.BOX))


def _ellipse(draw: ImageDraw.ImageDraw, center: np.ndarray, radii: np.ndarray, fill: int = 255) -> None:
    low, high = (center - radii) * SAMPLES, (center + radii) * SAMPLES
    draw.ellipse((*low, *high), fill=fill)


def _limb(draw: ImageDraw.ImageDraw, random: np.random.Generator, at: np.ndarray, angle: float) -> None:
    """Draw discs along a curve, smaller towards its end."""
    width = random.uniform(5, 24)
    bend, taper = random.normal(0, 0.05), random.uniform(0.95, 1.0)
    for _ in range(random.integers(10, 30)):
        _ellipse(draw, at, np.array([width, width]))
        at = at + 6 * np.array([np.cos(angle), np.sin(angle)])
        angle, width = angle + bend, max(width * taper, 1.5)


def _stroke(draw: ImageDraw.ImageDraw, random: np.random.Generator, at: np.ndarray, width: float) -> None:
    """Draw a line that may leave the head: hair, whiskers."""
    ends = [at + random.normal(0, 30, 2), at + random.normal(0, 90, 2)]
    draw.line([tuple(end * SAMPLES) for end in ends], fill=255, width=max(round(width * SAMPLES), 1))


def main() -> None:
    """Print the results of all figures, and one line for each of the five worst."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=300)
    parser.add_argument("--vertices", type=int, default=2000)
    parser.add_argument("--expand", type=float, default=2.0)
    parser.add_argument("--folder", type=Path, help="the pictures in a folder instead of generated ones")
    parser.add_argument("--mesher", choices=MESHERS, default=default_mesher())
    options = parser.parse_args()
    if options.folder:
        names = sorted(path for path in options.folder.iterdir() if path.suffix == ".png")
        pictures = ((path.name, np.ascontiguousarray(read_image(path)[..., 3])) for path in names)
    else:
        pictures = ((f"cartoon {seed}", cartoon(seed)) for seed in range(options.count))
    mesh_picture(cartoon(0), mesher=options.mesher)  # starts the child process
    seconds, cpu, qualities, missed, slivers, rows = [], [], [], 0, 0, []
    for name, alpha in pictures:
        started, used = time.perf_counter(), time.process_time()
        result = mesh_picture(alpha, options.vertices, options.expand, mesher=options.mesher)
        seconds.append(time.perf_counter() - started)
        cpu.append(time.process_time() - used)
        quality = mesh_quality(result.mesh, alpha)
        qualities.append(quality)
        visible = result.mesh.rest_areas.sum() * (1 - quality.outside) / quality.covered
        covered = quality.covered + result.speck_area / visible
        slivers += int((smallest_angles(result.mesh) < SLIVER).sum())
        missed += abs(quality.vertices - options.vertices) > 0.1 * options.vertices
        rows.append((covered, quality, result.specks, name))
    print(
        f"{len(rows)} pictures, {sum(q.faces for q in qualities)} faces\n"
        f"time: median {1000 * np.median(seconds):.1f} ms, 95 % {1000 * np.percentile(seconds, 95):.1f} ms, "
        f"worst {1000 * max(seconds):.1f} ms; of this process {1000 * np.median(cpu):.1f} ms\n"
        f"covered, without specks: worst {min(row[0] for row in rows):.4%}; "
        f"specks left out: {sum(row[2] for row in rows)}\n"
        f"slivers under {SLIVER:g}°: {slivers}; worst angle {min(q.worst_angle for q in qualities):.1f}°; "
        f"worst 1st percentile {min(q.low_angle for q in qualities):.1f}°\n"
        f"vertices off by more than 10 %: {missed}"
    )
    for covered, quality, specks, name in sorted(rows, key=lambda row: row[1].worst_angle)[:5]:
        print(
            f"  {name}: {quality.parts} parts, {quality.holes} holes, {specks} specks, "
            f"{quality.vertices} vertices, worst angle {quality.worst_angle:.1f}°, covered {covered:.3%}"
        )


if __name__ == "__main__":
    main()
