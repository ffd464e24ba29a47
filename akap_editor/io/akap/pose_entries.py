"""Named poses and keyframes as entries of an .akap file: a JSON index and one array per pose each."""

import json
from collections.abc import Sequence

from ...editor.document.keyframes import NO_ANIMATION, Animation, Keyframe
from ...editor.document.named_poses import NamedPose
from ...errors import InputError, error_context
from ...geometry.validation import Floats, freeze
from ...words import tr
from .archive import Archive, ArchiveEntry
from .json_records import Json, numbers, optional, parse_record, require
from .layer_entries import read_layer_view, write_layer_view
from .state_records import read_crossings, read_depths, write_crossings, write_depths

POSES_INDEX, KEYFRAMES_INDEX = "poses.json", "animation.json"
MAX_POSES, MAX_KEYFRAMES = 1000, 10_000
MAX_POINTS = 2**24  # of all named poses, and of all keyframes: 256 MB
_MAX_INDEX_BYTES = 2**24


# -- named poses ---------------------------------------------------------------------------------------------


def named_pose_entries(poses: Sequence[NamedPose]) -> list[ArchiveEntry]:
    """The entries for named poses: the index and poses/0, poses/1, ...; none without poses.

    Raises InputError for more than `MAX_POINTS` vertices in all.
    """
    if not poses:
        return []
    _check_points(sum(len(pose.positions) for pose in poses))
    record: Json = {"poses": [pose.name for pose in poses]}
    if any(len(pose.crossings) for pose in poses):
        record["crossings"] = [pose.crossings.tolist() for pose in poses]
    index = json.dumps(record).encode()
    return [
        (POSES_INDEX, index, True),
        *(_pose_entry(f"poses/{number}", pose.positions) for number, pose in enumerate(poses)),
    ]


def read_named_poses(archive: Archive, vertices: int) -> tuple[NamedPose, ...]:
    """The named poses of an archive, in order; () without an index. Raises InputError.

    vertices: number of vertices of the drawing's mesh.
    """
    if POSES_INDEX not in archive:
        return ()
    text = archive.read(POSES_INDEX, _MAX_INDEX_BYTES)
    with error_context(POSES_INDEX):
        record = parse_record(text)
        names = require(record, "poses", list)
        if len(names) > MAX_POSES:
            raise InputError(
                tr("expected at most {most} poses, got {count}", most=MAX_POSES, count=len(names))
            )
        if not all(type(name) is str for name in names) or len(set(names)) < len(names):
            raise InputError(tr("expected names of poses, each once, got something else"))
        _check_points(len(names) * vertices)
        rows = optional(record, "crossings", list, [[]] * len(names))
        if len(rows) != len(names):
            raise InputError(
                tr("expected crossings of {count} poses, got {rows}", count=len(names), rows=len(rows))
            )
        crossings = [read_crossings({"crossings": each}) for each in rows]
    arrays = [_read_pose(archive, f"poses/{number}", vertices) for number in range(len(names))]
    with error_context("poses"):
        return tuple(map(NamedPose, names, arrays, crossings))


def _check_points(count: int) -> None:
    if count > MAX_POINTS:
        raise InputError(
            tr("expected at most {most} vertices in all poses, got {count}", most=MAX_POINTS, count=count)
        )


# -- keyframes -----------------------------------------------------------------------------------------------


def keyframe_entries(animation: Animation) -> list[ArchiveEntry]:
    """The entries for an animation: the index and animation/0, animation/1, ...; none for the default one.

    Keyframes that share a pose share its entry. Raises InputError for more than `MAX_KEYFRAMES` keyframes or
    `MAX_POINTS` vertices in all.
    """
    if not animation.keyframes and animation.ease == Animation.ease and animation.loop:
        return []
    poses: dict[int, tuple[int, Floats]] = {}  # number and positions, by the identity of the positions
    for key in animation.keyframes:
        poses.setdefault(id(key.positions), (len(poses), key.positions))
    points = sum(len(pose) for _, pose in poses.values())
    if len(animation.keyframes) > MAX_KEYFRAMES or points > MAX_POINTS:
        raise InputError(
            tr(
                "expected at most {most} keyframes with {points_limit} vertices in all, "
                "got {count} with {points}",
                most=MAX_KEYFRAMES,
                points_limit=MAX_POINTS,
                count=len(animation.keyframes),
                points=points,
            )
        )
    keys: list[Json] = [
        {
            "time": key.time,
            "pose": poses[id(key.positions)][0],
            **({} if key.ease is None else {"ease": key.ease}),
            **write_crossings(key.crossings),
            **write_layer_view(key.layers),
            **write_depths(key.depths),
        }
        for key in animation.keyframes
    ]
    loop = {} if animation.loop else {"loop": False}
    index = json.dumps({"ease": animation.ease, **loop, "poses": len(poses), "keyframes": keys}).encode()
    return [
        (KEYFRAMES_INDEX, index, True),
        *(_pose_entry(f"animation/{number}", pose) for number, pose in poses.values()),
    ]


def read_keyframes(archive: Archive, vertices: int) -> Animation:
    """The animation of an archive; an empty one without an index. Raises InputError.

    vertices: number of vertices of the drawing's mesh.
    """
    if KEYFRAMES_INDEX not in archive:
        return NO_ANIMATION
    text = archive.read(KEYFRAMES_INDEX, _MAX_INDEX_BYTES)
    with error_context(KEYFRAMES_INDEX):
        record = parse_record(text)
        keys, count = require(record, "keyframes", list), require(record, "poses", int)
        if len(keys) > MAX_KEYFRAMES:
            raise InputError(
                tr("expected at most {most} keyframes, got {count}", most=MAX_KEYFRAMES, count=len(keys))
            )
        if not 0 <= count <= len(keys) or count * vertices > MAX_POINTS:
            most = min(len(keys), MAX_POINTS // vertices)
            raise InputError(
                tr("expected poses to be a number from 0 to {most}, got {count}", most=most, count=count)
            )
    poses = [_read_pose(archive, f"animation/{number}", vertices) for number in range(count)]
    with error_context(KEYFRAMES_INDEX):
        ease = optional(record, "ease", str, Animation.ease)
        loop = optional(record, "loop", bool, Animation.loop)
        return Animation(tuple(_read_keyframe(key, poses) for key in keys), ease, loop)


def _read_keyframe(record: Json, poses: list[Floats]) -> Keyframe:
    if type(record) is not dict:
        raise InputError(tr("expected keyframes to be objects, got {record!r:.40}", record=record))
    time, number = numbers([record.get("time")], "time")[0], require(record, "pose", int)
    if not 0 <= number < len(poses):
        raise InputError(tr("expected a pose below {count}, got {number}", count=len(poses), number=number))
    ease = require(record, "ease", str) if "ease" in record else None
    layers, depths = read_layer_view(record), read_depths(record)
    return Keyframe(float(time), poses[number], ease, read_crossings(record), layers, depths)


# -- arrays --------------------------------------------------------------------------------------------------


def _pose_entry(name: str, positions: Floats) -> ArchiveEntry:
    return name, positions.astype("<f8").tobytes(), True


def _read_pose(archive: Archive, name: str, vertices: int) -> Floats:
    """Positions (vertices, 2), read-only, so that keyframes share them. Raises InputError."""
    return freeze(archive.read_array(name, "<f8", vertices, 2))
