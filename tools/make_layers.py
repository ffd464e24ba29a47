"""Makes the pictures of docs/layers.md from the bundled robot: its layers side by side, poses, and a motion.

Run from the project's root: python tools/make_layers.py
docs/images/layers.png: the layers pulled apart and the drawing, then frames of its recording, in which an arm
passes behind the body, eyes and mouth ride on the head and mouths are switched. docs/images/robot.webp plays
the beginning of the recording, and then returns to the rest pose, so that it plays in a loop.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from akap_editor.deform.pose_interpolation import InterpolationCache
from akap_editor.editor.animation.frames import Frame
from akap_editor.editor.animation.motion import Motion
from akap_editor.editor.document.easing import easing_function
from akap_editor.editor.session.replay import replay
from akap_editor.geometry.validation import Floats
from akap_editor.io.akap.recording import read_recording, recorded_drawing
from akap_editor.io.images import Picture
from akap_editor.io.layers.open_layers import open_layers
from akap_editor.layers.layered_picture import LayeredPicture
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource

STILLS, MOVING = Path("docs/images/layers.png"), Path("docs/images/robot.webp")
TIMES = (2.25, 3.2, 6.5, 9.5)  # of the stills, seconds of the recording
END, RETURN_SECONDS, PAUSE = 6.6, 0.7, 0.3  # of what moves; then
FPS, QUALITY = 15, 55
BOX = (-10, 0, 1000, 960)  # of the drawing, pixels
STILL_HEIGHT, MOVING_HEIGHT, GAP = 330, 380, 10
GROUND = (0.96, 0.95, 0.93)
SHEET, SPACE = (430, 330), 10  # of the layers pulled apart; between them, pixels


def layer_sheet(layered: LayeredPicture) -> Picture:
    """The layers of a picture side by side in rows, as large as they fit on a sheet, (h, w, 4) uint8."""
    pictures = sorted((layer.picture for layer in layered.layers), key=len, reverse=True)
    scale = 1.0
    while (places := _shelves([_size(picture, scale) for picture in pictures])) is None:
        scale *= 0.97
    ground = (*(round(255 * share) for share in GROUND), 255)
    sheet = Image.new("RGBA", SHEET, ground)
    for picture, place in zip(pictures, places, strict=True):
        size = _size(picture, scale)
        sheet.alpha_composite(Image.fromarray(picture).resize(size, Image.Resampling.LANCZOS), place)
    return np.asarray(sheet)


def _size(picture: Picture, scale: float) -> tuple[int, int]:
    return max(1, round(scale * picture.shape[1])), max(1, round(scale * picture.shape[0]))


def _shelves(sizes: list[tuple[int, int]]) -> list[tuple[int, int]] | None:
    """The corners of boxes in rows on a sheet, in order; None if they do not fit."""
    corners, x, y, row = [], SPACE, SPACE, 0
    for width, height in sizes:
        if x + width + SPACE > SHEET[0]:
            x, y, row = SPACE, y + row + SPACE, 0
        corners.append((x, y))
        x, row = x + width + SPACE, max(row, height)
    fits = y + row + SPACE <= SHEET[1] and all(width + 2 * SPACE <= SHEET[0] for width, _ in sizes)
    return corners if fits else None


def returning(last: Frame, rest: Floats) -> Iterator[Frame]:
    """The frames from the last one back to the rest pose (n, 2), and a pause there."""
    cache, ease = InterpolationCache(), easing_function("in-out")
    for number in range(round((RETURN_SECONDS + PAUSE) * FPS)):
        progress = ease(min(number / FPS / RETURN_SECONDS, 1.0))
        yield last._replace(pose=cache.pose(last.drawing.mesh, last.pose, rest, progress))


def main() -> None:
    """Write both pictures."""
    recording = read_recording(resource("assets", "recordings", "robot.akaprec"))
    drawing = recorded_drawing(recording)
    count = round(END * FPS)
    times = sorted({*TIMES, *(number / FPS for number in range(count))})
    frames = dict(zip(times, Motion(drawing, replay(recording, drawing)).frames(times), strict=True))

    def picture(renderer: OffscreenRenderer, frame: Frame, height: int) -> Picture:
        scale = height / (BOX[3] - BOX[1])
        return renderer.render(frame.drawing, frame.pose, BOX, scale, GROUND, frame.order)

    with OffscreenRenderer() as renderer:
        stills = [layer_sheet(open_layers(resource("assets", "drawings", "robot.ora")))]
        stills += [picture(renderer, frames[time], STILL_HEIGHT) for time in TIMES]
        played = [frames[number / FPS] for number in range(count)]
        shown = [*played, *returning(played[-1], drawing.mesh.vertices)]
        moving = [Image.fromarray(picture(renderer, each, MOVING_HEIGHT)).convert("RGB") for each in shown]
    gap = np.full((STILL_HEIGHT, GAP, 4), 255, np.uint8)
    row = [part for still in stills for part in (still[:STILL_HEIGHT], gap)][:-1]
    image = Image.fromarray(np.concatenate(row, axis=1)).convert("RGB")
    image.quantize(128, dither=Image.Dither.NONE).save(STILLS)
    moving[0].save(
        MOVING,
        save_all=True,
        append_images=moving[1:],
        duration=round(1000 / FPS),
        loop=0,
        quality=QUALITY,
        method=6,
    )
    for path in (STILLS, MOVING):
        print(path, path.stat().st_size, "bytes")


if __name__ == "__main__":
    main()
