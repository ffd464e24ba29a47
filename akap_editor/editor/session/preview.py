"""A state that a session shows in place of the present one."""

from dataclasses import dataclass

from ..document.document import EditState
from ..document.drawing import Drawing
from ..document.pin import pin_depths, with_depths
from .edits import Edit, SetLayerView, SetPins, SetPose


@dataclass(frozen=True, eq=False)
class Preview:
    """A state that is shown in place of the present one; see `Session.preview`.

    present: the state to return to; steps_left: of its motion; shown: the previewed state; line: of the
    recording, the one after which the previewed state was the present one, or None; takes_pose: whether the
    next gesture starts from the previewed pose.
    """

    present: EditState
    steps_left: int
    shown: EditState
    line: int | None
    takes_pose: bool

    def taking_edits(self, opened: Drawing) -> list[Edit]:
        """The edits that take over the previewed pose, its layers and the depths of its pins.

        opened: the drawing of a state without one of its own.
        """
        view = (self.shown.drawing or opened).layer_view
        layers = [] if view is None else [SetLayerView(view)]
        pins = with_depths(self.present.pins, pin_depths(self.shown.pins))
        depths = [] if pins == self.present.pins else [SetPins(pins)]
        return [*layers, *depths, SetPose(self.shown.positions, self.shown.crossings)]
