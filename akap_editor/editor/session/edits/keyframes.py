"""Edits of keyframes."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self

from numpy.typing import ArrayLike

from ....errors import InputError
from ....layers.layer_view import LayerView
from ....words import tr
from ...document.document import EditState
from ...document.drawing import Drawing
from ...document.keyframes import Animation, Keyframe, as_keyframe_time
from ...document.pin import PinDepths, as_pin_depths
from .edit import (
    Edit,
    Json,
    ReplayTarget,
    crossings_from_json,
    crossings_to_json,
    layer_view_from_json,
    layer_view_to_json,
    pose_and_crossings,
    positions_from_json,
    positions_to_json,
)


class KeyframeEdit(Edit):
    """An edit that changes the keyframes only."""

    def apply(self, state: EditState, drawing: Drawing) -> EditState:
        return replace(state, animation=self.animate(state.animation, state, drawing))

    @abstractmethod
    def animate(self, animation: Animation, state: EditState, drawing: Drawing) -> Animation:
        """The animation after the edit. Raises InputError."""


@dataclass(frozen=True, eq=False)
class SetKeyframe(KeyframeEdit):
    """Make a keyframe of a pose (n, 2), by default the current one, at a time in seconds.

    Replaces a keyframe at this time. ease: see `easing.check_keyframe_easing`; None keeps the easing of a
    replaced keyframe. crossings: which part passes in front in ``positions``, see `EditState`. layers: which
    are visible from here on, and their order, by default the current ones. depths: of the pins from here on,
    by id.
    """

    name = "key"
    fields = ("time",)

    time: float
    positions: ArrayLike | None = None
    ease: str | None = None
    crossings: ArrayLike | None = None
    layers: LayerView | None = None
    depths: PinDepths = ()

    def animate(self, animation: Animation, state: EditState, drawing: Drawing) -> Animation:
        positions, crossings = pose_and_crossings(self.positions, self.crossings, state, drawing)
        layers = drawing.layer_view
        if self.layers is not None and drawing.layers:
            layers = drawing.with_layer_view(self.layers).layer_view
        return animation.with_keyframe(
            Keyframe(self.time, positions, self.ease, crossings, layers, self.depths)
        )

    def to_json(self, drawing: Drawing) -> Json:
        ease = {} if self.ease is None else {"ease": self.ease}
        pose = {**positions_to_json(self.positions), **crossings_to_json(self.crossings)}
        layers = {} if self.layers is None else {"layers": layer_view_to_json(self.layers)}
        depths = {"depths": {str(pin): depth for pin, depth in self.depths}} if self.depths else {}
        return {"time": self.time, **ease, **pose, **layers, **depths}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        positions = positions_from_json(event, target, drawing)
        layers = layer_view_from_json(event["layers"]) if "layers" in event else None
        depths = as_pin_depths({int(pin): depth for pin, depth in event.get("depths", {}).items()})
        return cls(event["time"], positions, event.get("ease"), crossings_from_json(event), layers, depths)


@dataclass(frozen=True)
class DeleteKeyframes(KeyframeEdit):
    """Delete the keyframes at the given times, seconds."""

    name = "unkey"
    fields = ("times",)

    times: Sequence[float]

    def animate(self, animation: Animation, state: EditState, drawing: Drawing) -> Animation:
        return animation.without_keyframes(map(as_keyframe_time, self.times))

    def to_json(self, drawing: Drawing) -> Json:
        return {"times": list(self.times)}


@dataclass(frozen=True)
class MoveKeyframes(KeyframeEdit):
    """Move keyframes to other times, or copy them if ``copy``; replaces keyframes that are there already.

    moves: new times by old ones, seconds.
    """

    name = "rekey"
    fields = ("from", "to")

    moves: Mapping[float, float]
    copy: bool = False

    def animate(self, animation: Animation, state: EditState, drawing: Drawing) -> Animation:
        moves = {as_keyframe_time(old): as_keyframe_time(new) for old, new in self.moves.items()}
        return animation.with_moved_keyframes(moves, self.copy)

    def to_json(self, drawing: Drawing) -> Json:
        return {"from": list(self.moves), "to": list(self.moves.values()), "copy": self.copy}

    @classmethod
    def from_json(cls, event: Json, target: ReplayTarget, drawing: Drawing) -> Self:
        return cls(dict(zip(event["from"], event["to"], strict=True)), event.get("copy") is True)


@dataclass(frozen=True)
class SetEasing(KeyframeEdit):
    """Set the easing after the keyframes at ``times``, seconds; times None sets that of the animation.

    ease: see `easing.check_keyframe_easing`; None lets keyframes follow the animation.
    """

    name = "ease"
    fields = ("times", "ease")

    times: Sequence[float] | None
    ease: str | None

    def animate(self, animation: Animation, state: EditState, drawing: Drawing) -> Animation:
        times = None if self.times is None else [as_keyframe_time(time) for time in self.times]
        return animation.with_easing(times, self.ease)

    def to_json(self, drawing: Drawing) -> Json:
        return {"times": None if self.times is None else list(self.times), "ease": self.ease}


@dataclass(frozen=True)
class SetLoop(KeyframeEdit):
    """Set whether the keyframes play over and over."""

    name = "loop"
    fields = ("loop",)

    loop: bool

    def animate(self, animation: Animation, state: EditState, drawing: Drawing) -> Animation:
        if type(self.loop) is not bool:
            raise InputError(tr("loop: expected true or false, got {loop!r}", loop=self.loop))
        return replace(animation, loop=self.loop)
