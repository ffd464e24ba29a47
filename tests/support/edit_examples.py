"""One example of each edit; a new edit in the table needs one here, and is then in all tests of edits."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from akap_editor.editor.document.drawing import Drawing, Meshing
from akap_editor.editor.document.pin import Pin
from akap_editor.editor.document.rig.joint import Joint, make_joint
from akap_editor.editor.document.rig.mirror import Mirror
from akap_editor.editor.document.settings import Settings
from akap_editor.editor.session.edits import (
    AddPose,
    DeleteKeyframes,
    DeletePose,
    Edit,
    KeyLayers,
    MoveKeyframes,
    OrderLayers,
    OrderLimb,
    PaintLoose,
    PaintStiffness,
    ReloadArtwork,
    Remesh,
    RenamePose,
    ReorderPoses,
    ResetPose,
    SetAngles,
    SetCrossings,
    SetEasing,
    SetJoints,
    SetKeyframe,
    SetLayers,
    SetLayerView,
    SetLoop,
    SetLoose,
    SetMirror,
    SetPins,
    SetPose,
    SetRestPose,
    SetScales,
    SetSettings,
    SetStiffness,
    SetSwing,
    SetTargets,
    ShowGroup,
)
from akap_editor.editor.session.session import Session
from akap_editor.layers.layer_view import LayerView
from akap_editor.layers.layered_picture import Layer, LayeredPicture


def _pins(session: Session) -> Edit:
    """The first pin in front of the others, and a new one."""
    first = [replace(pin, depth=2) for pin in session.state.pins[:1]]
    new_id = 1 + max((pin.id for pin in session.state.pins), default=0)
    new = Pin(new_id, 5, np.array([0.2, 0.3, 0.5]), np.array([60.0, 50.0]), 0, 0.5, "hand", True, True, 0.75)
    return SetPins((*first, new))


def _joints(session: Session) -> Edit:
    """A proposal of the program, and a weld; on a flat drawing one that is refused."""
    mesh = session.drawing.mesh
    if mesh.layers is None:
        return SetJoints((Joint(1, (0, 1), np.eye(3)[:2]),))
    shoulder = make_joint(mesh, 1, 1, 0, np.array([92.0, 118.0]), is_proposed=True)
    return SetJoints((shoulder, make_joint(mesh, 7, 2, 0, np.array([80.0, 85.0]), kind="weld")))


def _painted_anew(drawing: Drawing) -> LayeredPicture:
    """The picture of a flat drawing in other colors."""
    image = drawing.image.copy()
    image[..., :3] = 255 - image[..., :3]
    return LayeredPicture(drawing.size, (Layer(drawing.name, image),))


def _mirrored_view(drawing: Drawing) -> LayerView:
    """The other layers visible, in the reverse order."""
    shown = tuple(not layer.visible for layer in drawing.layers)
    return LayerView(shown, tuple(reversed(drawing.layer_order)))


def _first_pair(session: Session) -> tuple[tuple[int, int], ...]:
    ids = [pin.id for pin in session.state.pins]
    return ((ids[0], ids[1]),) if len(ids) > 1 else ()


def _first_pose(session: Session) -> str:
    return next((pose.name for pose in session.state.poses), "no pose")


# An edit for the current state of a session. It may be refused by InputError, for example without poses.
_CUTS = (((0.0, 40.0), (60.0, 40.0)),)
LAYER_EDITS = frozenset(
    {"layers", "layer-order", "layer-view", "key-layers", "group", "joints"}
)  # which need a drawing in layers
EDIT_EXAMPLES: dict[str, Callable[[Session], Edit]] = {
    "pins": _pins,
    "targets": lambda session: SetTargets({pin.id: (90.0, 65.0) for pin in session.state.pins[-1:]}),
    "angles": lambda session: SetAngles({pin.id: 0.25 for pin in session.state.pins[:1]}),
    "scales": lambda session: SetScales({pin.id: 1.25 for pin in session.state.pins[:1]}),
    "settings": lambda session: SetSettings(Settings.parse("akap:memory=0.5,no-dirichlet")),
    "stiffness": lambda session: SetStiffness(np.linspace(1, 1000, len(session.drawing.mesh.faces))),
    "paint": lambda session: PaintStiffness([(45.0, 40.0), (50.0, 41.0)], 12.0, 50.0),
    "paint-loose": lambda session: PaintLoose([(45.0, 40.0), (50.0, 41.0)], 12.0),
    "loose": lambda session: SetLoose(range(5, 40), 2.0, 0.25),
    "swing": lambda session: SetSwing(5.0, 0.25),
    "pose": lambda session: SetPose(session.state.positions + np.array([3.0, -2.0])),
    "reset": lambda session: ResetPose(),
    "bake": lambda session: SetRestPose(),
    "mesh": lambda session: Remesh(replace(session.drawing.meshing or Meshing(), vertices=200, cuts=_CUTS)),
    "artwork": lambda session: ReloadArtwork(_painted_anew(session.drawing)),
    "limb": lambda session: OrderLimb([pin.id for pin in session.state.pins[-1:]], False),
    "crossings": lambda session: SetCrossings(np.array([[3, 1]], dtype=np.int32)),
    "layers": lambda session: SetLayers([0], "trunk", 0.5, False, True, True, "", ["body"]),
    "layer-view": lambda session: SetLayerView(_mirrored_view(session.drawing)),
    "key-layers": lambda session: KeyLayers([0], False),
    "group": lambda session: ShowGroup(["head"], False),
    "joints": _joints,
    "layer-order": lambda session: OrderLayers(list(reversed(session.drawing.layer_order))),
    "keep": lambda session: AddPose("wave"),
    "forget": lambda session: DeletePose(_first_pose(session)),
    "rename": lambda session: RenamePose(_first_pose(session), "nod"),
    "order": lambda session: ReorderPoses([pose.name for pose in reversed(session.state.poses)]),
    "key": lambda session: SetKeyframe(0.5, ease="hold"),
    "unkey": lambda session: DeleteKeyframes([1.0]),
    "rekey": lambda session: MoveKeyframes({1.0: 2.0}, copy=True),
    "ease": lambda session: SetEasing([1.0], "out"),
    "mirror": lambda session: SetMirror(Mirror(40.5, 30.0, 1.2, True, _first_pair(session))),
    "loop": lambda session: SetLoop(not session.state.animation.loop),
}
