"""Makes the moving picture of the README from a bundled recording: a hand adds pins and drags them.

Run from the project's root: python tools/make_moving_picture.py [--size 560] [--fps 20]
At the end, the pins go one by one and the drawing returns to its rest pose, so that it plays in a loop.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw

from akap_editor.deform.pose_interpolation import InterpolationCache
from akap_editor.editor.animation.frames import Frame
from akap_editor.editor.animation.motion import Motion
from akap_editor.editor.document.document import EditState
from akap_editor.editor.document.drawing import Drawing
from akap_editor.editor.document.easing import easing_function
from akap_editor.editor.framing import fitted_box
from akap_editor.editor.session.recording import Recording
from akap_editor.editor.session.replay import ReplayedEvent, replay
from akap_editor.geometry.validation import Floats
from akap_editor.io.akap.recording import read_recording, recorded_drawing
from akap_editor.render.offscreen import OffscreenRenderer
from akap_editor.resources import resource

OUTPUT = Path("docs/images/elephant.webp")
MARGIN = 24  # pixels of the drawing around all poses
PIN_SECONDS, RETURN_SECONDS, PAUSE = 0.09, 0.7, 0.35  # until a pin goes; back to rest; after that
GROUND = (0.96, 0.95, 0.93)
PIN, RIM, HAND = (255, 180, 58), (43, 36, 58), (255, 255, 255)
SAMPLES = 3  # along each side of a pixel, for what is drawn over the drawing
ARROW = np.array([[0, 0], [0, 17], [4, 13.4], [7, 20], [9.6, 18.9], [6.7, 12.5], [12, 12.1]])


class Moment(NamedTuple):
    """One frame: what is drawn, the pins (k, 2), the tip of the hand (2,) and whether it presses."""

    frame: Frame
    pins: Floats
    hand: Floats
    is_pressed: bool


def moments(recording: Recording, drawing: Drawing, fps: float) -> Iterator[Moment]:
    """The frames of the recording, then those in which the pins go and the drawing returns."""
    states: list[tuple[float, EditState]] = []

    def watched() -> Iterator[ReplayedEvent]:
        for event in replay(recording, drawing):
            states.append((event.time, event.state))
            yield event

    mesh, times, places, presses = drawing.mesh, *hand_path(recording)
    moment: Moment | None = None
    motion = Motion(drawing, watched()).frames(np.arange(0, recording.duration + 0.2, 1 / fps).tolist())
    for number, frame in enumerate(motion):
        time = number / fps
        pins = next((state.points for at, state in reversed(states) if at <= time), None)
        pin_places = np.zeros((0, 2)) if pins is None else mesh.evaluate(pins, frame.pose)
        hand = np.array([np.interp(time, times, places[:, axis]) for axis in (0, 1)])
        moment = Moment(frame, pin_places, hand, any(start <= time <= end for start, end in presses))
        yield moment
    assert moment is not None
    for count in range(round(len(moment.pins) * PIN_SECONDS * fps)):
        gone = int(count / fps / PIN_SECONDS) + 1
        rest = moment.pins[: len(moment.pins) - gone]
        yield moment._replace(pins=rest, hand=moment.pins[-gone], is_pressed=True)
    cache, ease = InterpolationCache(), easing_function("in-out")
    hand = moment.pins[0]
    for count in range(round((RETURN_SECONDS + PAUSE) * fps)):
        progress = ease(min(count / fps / RETURN_SECONDS, 1.0))
        pose = cache.pose(mesh, moment.frame.pose, mesh.vertices, progress)
        at = hand + progress * (places[0] - hand)
        yield Moment(Frame(drawing, pose, moment.frame.order), moment.pins[:0], at, False)


def hand_path(recording: Recording) -> tuple[Floats, Floats, list[tuple[float, float]]]:
    """When the hand is where, (p,) seconds and (p, 2) places, and from when to when it presses."""
    times, places, presses, started, count = [], [], [], 0.0, 0
    for event in recording.events:
        match event["do"]:
            case "begin":
                started = event["t"]
            case "commit":
                presses.append((started, max(event["t"], started + 0.06)))
            case "pins" if len(event["pins"]) > count:
                count = len(event["pins"])
                times.append(event["t"])
                places.append(event["pins"][-1]["target"])
            case "targets":
                times.append(event["t"])
                places.append(list(event["targets"].values())[-1])
    return np.array(times), np.array(places, dtype=float), presses


def with_hand(picture: np.ndarray, moment: Moment, low: Floats, scale: float) -> Image.Image:
    """A rendered picture (h, w, 4) with the pins and the hand. low: the drawing's point at its corner."""
    height, width = picture.shape[:2]
    image = Image.fromarray(picture).convert("RGB")
    layer = Image.new("RGBA", (SAMPLES * width, SAMPLES * height))
    draw = ImageDraw.Draw(layer)
    for pin in SAMPLES * scale * (moment.pins - low):
        for radius, color in ((7.5, RIM), (6.0, PIN), (2.2, RIM)):
            draw.ellipse((*(pin - SAMPLES * radius), *(pin + SAMPLES * radius)), fill=color)
    tip = SAMPLES * scale * (moment.hand - low)
    if moment.is_pressed:
        draw.ellipse((*(tip - SAMPLES * 13), *(tip + SAMPLES * 13)), outline=HAND, width=2 * SAMPLES)
    corners = [tuple(tip + SAMPLES * 1.25 * corner) for corner in ARROW]
    draw.polygon(corners, fill=HAND, outline=RIM, width=SAMPLES)
    layer = layer.resize((width, height), Image.Resampling.BOX)
    image.paste(layer, mask=layer)
    return image


def main() -> None:
    """Write docs/images/elephant.webp."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--size", type=int, default=560, help="width in pixels")
    parser.add_argument("--fps", type=float, default=20.0)
    parser.add_argument("--quality", type=int, default=60)
    options = parser.parse_args()
    recording = read_recording(resource("assets", "recordings", "elephant.akaprec"))
    drawing = recorded_drawing(recording)
    shown = list(moments(recording, drawing, options.fps))
    poses = np.concatenate([moment.frame.pose for moment in shown])
    left, top = np.floor(poses.min(axis=0)).astype(int) - MARGIN
    right, bottom = np.ceil(poses.max(axis=0)).astype(int) + MARGIN
    box, scale = fitted_box((int(left), int(top), int(right), int(bottom)), options.size)
    with OffscreenRenderer() as renderer:
        images = [
            with_hand(
                renderer.render(drawing, moment.frame.pose, box, scale, GROUND, moment.frame.order),
                moment,
                np.array(box[:2]),
                scale,
            )
            for moment in shown
        ]
    images[0].save(
        OUTPUT,
        save_all=True,
        append_images=images[1:],
        duration=round(1000 / options.fps),
        loop=0,
        quality=options.quality,
        method=6,
    )
    print(OUTPUT, len(images), "frames,", images[0].size, OUTPUT.stat().st_size, "bytes")


if __name__ == "__main__":
    main()
