"""Gestures of the mirror: find its axis, pair pins, mirror what is done to a pin, flip the pose."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..errors import InputError
from ..geometry.validation import Floats
from ..words import mark, tr
from .camera import Point
from .document.drawing import visible_point
from .document.pin import MAX_PIN_ANGLE, Pin
from .document.rig.mirror import Mirror, suggest_pairs
from .document.rig.mirror_axis import find_mirror
from .gestures import EditContext
from .session import pin_edits
from .session.edits import ResetPose, SetAngles, SetMirror, SetPins, SetTargets
from .session.session import Session
from .session.stepper import PIN_TOLERANCE

_REACH_SHARE = 0.12  # of the drawing's length: how far a pin may be off the mirrored place of its partner
_ANGLE_TOLERANCE = 1e-3  # radians
_NEAR_SHARE = 0.03  # of the drawing's length: pins nearer to the axis, or to a partner's place, are on it


def active_mirror(session: Session) -> Mirror | None:
    """The mirror of a session, if it is on."""
    mirror = session.state.mirror
    return mirror if mirror is not None and mirror.is_on else None


def toggle_mirror(editor: EditContext) -> None:
    """Turn the mirror on, or off; at first its axis is found in the drawing. Pins in no pair are paired."""
    session = editor.session
    if session is None:
        return
    old = session.state.mirror
    if old is not None and old.is_on:
        editor.apply(mark("Mirror Off"), SetMirror(replace(old, is_on=False)))
    else:
        mirror = find_mirror(session.drawing) if old is None else old
        editor.apply(mark("Mirror On"), SetMirror(with_pairs(session, replace(mirror, is_on=True))))


def set_axis(editor: EditContext, start: Point, end: Point) -> None:
    """Let the axis be the line through two points, pixels of the rest pose; pins are paired anew."""
    session = editor.session
    direction = np.subtract(end, start)
    if session is None or not direction.any():
        return
    angle = float(np.arctan2(direction[1], direction[0])) % np.pi
    mirror = Mirror(float(start[0]), float(start[1]), angle)
    editor.apply(mark("Set Mirror Axis"), SetMirror(with_pairs(session, mirror)))


def with_pairs(session: Session, mirror: Mirror) -> Mirror:
    """A mirror with pairs of those pins, too, that are in none yet and lie across from one another."""
    mesh, places = session.drawing.mesh, rest_places(session)
    free = {
        pin: place
        for pin, place in places.items()
        if mirror.partner(pin) is None and mirror.distances([place])[0] > _NEAR_SHARE * mesh.length
    }
    return replace(mirror, pairs=(*mirror.pairs, *suggest_pairs(mirror, free, _REACH_SHARE * mesh.length)))


def rest_places(session: Session) -> dict[int, Floats]:
    """Where the pins are in the rest pose, (2,) each, by id."""
    mesh, state = session.drawing.mesh, session.state
    return dict(zip((pin.id for pin in state.pins), mesh.evaluate(state.points, mesh.vertices), strict=True))


def pair_selected(editor: EditContext) -> None:
    """Make the two selected pins a pair; the mirror is turned on. Raises InputError for another number."""
    session = editor.session
    if session is None:
        return
    if len(editor.selection) != 2:
        raise InputError(tr("selection: expected 2 pins, got {count}", count=len(editor.selection)))
    mirror = session.state.mirror or find_mirror(session.drawing)
    first, second = sorted(editor.selection)
    paired = replace(mirror.with_pair(first, second), is_on=True)
    editor.apply(mark("Pair Pins"), SetMirror(paired))


def unpair_selected(editor: EditContext) -> None:
    """End the pairs that the selected pins are in."""
    session = editor.session
    if session is not None and session.state.mirror is not None:
        editor.apply(mark("Unpair Pins"), SetMirror(session.state.mirror.without(editor.selection)))


def add_partner(session: Session, pin_id: int) -> int | None:
    """Add a pin across from one that was just added, or pair it with one that is there already.

    Part of an open gesture. Returns the id of the partner; None if the mirror is off, if the pin is on the
    axis or in a pair, or if nothing is across.
    """
    mirror = active_mirror(session)
    if mirror is None or mirror.partner(pin_id) is not None:
        return None
    mesh, places = session.drawing.mesh, rest_places(session)
    near = _NEAR_SHARE * mesh.length
    place = places.pop(pin_id)
    across = mirror.points([place])[0]
    if mirror.distances([place])[0] <= near:
        return None
    partner = min(places, key=lambda pin: float(np.hypot(*(places[pin] - across))), default=None)
    if partner is None or np.hypot(*(places[partner] - across)) > near or mirror.partner(partner) is not None:
        partner = _add_at_rest_place(session, across, session.state.pin(pin_id))
    if partner is not None:
        session.apply(SetMirror(mirror.with_pair(pin_id, partner)))
    return partner


def _add_at_rest_place(session: Session, place: Floats, like: Pin) -> int | None:
    """Add a pin at a place of the rest pose, with the depth of another one; None outside the drawing."""
    point = visible_point(session.drawing, place, session.drawing.mesh.vertices, None, unlocked=True)
    if point is None:
        return None
    pin_id = 1 + max(pin.id for pin in session.state.pins)
    (target,) = session.drawing.mesh.evaluate(point, session.state.positions)
    pin = Pin(pin_id, int(point.faces[0]), point.weights[0], target, like.depth)
    session.apply(SetPins((*session.state.pins, pin)))
    return pin_id


def mirrored_targets(
    session: Session, starts: Mapping[int, Point], moved: Floats, leader: int | None = None
) -> dict[int, Point]:
    """Targets of pins that move by a vector, and of their partners, which move by the mirrored one.

    starts: positions, pixels, of the pins that are moved and of their partners (`with_partners`); moved: (2,)
    the vector; leader: the pin under the pointer. Of two partners that are both moved, the leader moves by
    the vector itself, or else the one that is on its side of the axis.
    """
    mirror = active_mirror(session)
    if mirror is None:
        return {pin: (x + float(moved[0]), y + float(moved[1])) for pin, (x, y) in starts.items()}
    followers = _followers(session, mirror, starts, leader)
    (mirrored,) = mirror.vectors([moved])
    targets = {}
    for pin, (x, y) in starts.items():
        dx, dy = (mirrored if pin in followers else moved).tolist()
        targets[pin] = (x + dx, y + dy)
    return targets


def _followers(session: Session, mirror: Mirror, pins: Mapping[int, Point], leader: int | None) -> set[int]:
    """The pins among these that move by the mirrored vector."""
    places = rest_places(session)
    normal = np.array([-np.sin(mirror.angle), np.cos(mirror.angle)])
    heights = {pin: float((places[pin] - (mirror.x, mirror.y)) @ normal) for pin in pins}
    leading = heights.get(leader, 1.0) if leader is not None else 1.0
    followers = set()
    for first, second in mirror.pairs:
        if first in pins and second in pins:
            is_first_leading = heights[first] * leading >= heights[second] * leading
            followers.add(second if is_first_leading else first)
    if leader in followers:  # both are on one side
        partner = mirror.partner(leader) if leader is not None else None
        followers = (followers - {leader}) | ({partner} if partner is not None else set())
    return followers


def with_partners(session: Session, pins: frozenset[int]) -> frozenset[int]:
    """Pins and, if the mirror is on, their partners that are not locked."""
    mirror = active_mirror(session)
    if mirror is None:
        return pins
    partners = {partner for pin in pins if (partner := mirror.partner(pin)) is not None}
    return pins | {pin.id for pin in session.state.pins if pin.id in partners and not pin.is_locked}


def flip_pose(editor: EditContext) -> None:
    """Flip the pose left to right: each pin goes where its partner is, mirrored; one without goes across.

    Nothing is done if the pose is the same then. The axis is found in the drawing if there is none. A drawing
    that does not remember its rest shape starts from there, as it would otherwise keep both poses.
    """
    session = editor.session
    if session is None:
        return
    mirror = session.state.mirror
    if mirror is None:
        mirror = replace(with_pairs(session, find_mirror(session.drawing)), is_on=False)
    has_memory = bool(session.state.settings.get("memory", 0.0))

    if _is_symmetric(session, mirror):
        return

    def flip(session: Session) -> None:
        pin_edits.hold_stopped_pins(session)
        targets, angles, released = _flipped(session, mirror)
        session.apply(SetMirror(mirror))
        if not has_memory:
            session.apply(ResetPose())
        if released:
            pin_edits.hold_angles(session, released, False)
        session.apply(SetTargets(targets))
        if angles:
            session.apply(SetAngles(angles))

    editor.edit(mark("Flip Pose"), flip)


def _is_symmetric(session: Session, mirror: Mirror) -> bool:
    """Whether pins that have arrived have the same targets and angles in the flipped pose."""
    state = session.state
    if session.is_moving or session.pin_error() > PIN_TOLERANCE:
        return False
    if not state.settings.get("memory", 0.0) and session.is_posed:
        return False  # the pose does not depend on the pins alone
    targets, angles, released = _flipped(session, mirror)
    is_rotated = any(
        abs(angle - (state.pin(pin).angle or 0.0)) > _ANGLE_TOLERANCE for pin, angle in angles.items()
    )
    return (
        not released
        and not is_rotated
        and all(np.hypot(*(pin.target - targets[pin.id])) <= PIN_TOLERANCE for pin in state.pins)
    )


def _flipped(session: Session, mirror: Mirror) -> tuple[dict[int, Point], dict[int, float], set[int]]:
    """Targets and angles of the pins in the flipped pose, by id, and the pins that hold none there."""
    places = rest_places(session)
    targets: dict[int, Point] = {}
    angles: dict[int, float] = {}
    released = set()
    for pin in session.state.pins:
        partner = mirror.partner(pin.id)
        source = session.state.pin(pin.id if partner is None else partner)
        (moved,) = mirror.vectors([source.target - places[source.id]])
        x, y = (places[pin.id] + moved).tolist()
        targets[pin.id] = (x, y)
        if source.angle is not None:
            angles[pin.id] = max(-MAX_PIN_ANGLE, min(-source.angle, MAX_PIN_ANGLE))
        elif pin.angle is not None:
            released.add(pin.id)
    return targets, angles, released
