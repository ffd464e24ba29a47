"""The keyframes of a drawing inside its .akap file: an index, and one array for each pose."""

import json

from ...editor.document.keyframes import NO_ANIMATION, Animation, Keyframe
from ...errors import InputError, error_context
from ...geometry.validation import Floats
from .archive import Archive, Entry
from .json_records import Json, numbers, optional, parse_record, require
from .poses import MAX_POINTS

INDEX = "animation.json"
MAX_KEYS = 10_000
_MAX_INDEX_BYTES = 2**21


def keyframe_entries(animation: Animation) -> list[Entry]:
    """The entries of a file; none for an animation as it is before anything is chosen."""
    if not animation.keyframes and animation.ease == Animation.ease and animation.loop:
        return []
    poses: dict[int, tuple[int, Floats]] = {}  # keyframes that share a pose do so in the file
    for key in animation.keyframes:
        poses.setdefault(id(key.positions), (len(poses), key.positions))
    points = sum(len(pose) for _, pose in poses.values())
    if len(animation.keyframes) > MAX_KEYS or points > MAX_POINTS:
        raise InputError(
            f"expected at most {MAX_KEYS} keyframes with {MAX_POINTS} vertices in all, got "
            f"{len(animation.keyframes)} with {points}"
        )
    keys: list[Json] = [
        {
            "time": key.time,
            "pose": poses[id(key.positions)][0],
            **({} if key.ease is None else {"ease": key.ease}),
        }
        for key in animation.keyframes
    ]
    loop = {} if animation.loop else {"loop": False}
    index = json.dumps({"ease": animation.ease, **loop, "poses": len(poses), "keyframes": keys}).encode()
    arrays = [(f"animation/{number}", pose.astype("<f8").tobytes(), True) for number, pose in poses.values()]
    return [(INDEX, index, True), *arrays]


def read_keyframes(archive: Archive, vertices: int) -> Animation:
    """What `keyframe_entries` wrote; an empty one where there is no index. Raises InputError."""
    if INDEX not in archive:
        return NO_ANIMATION
    text = archive.read(INDEX, _MAX_INDEX_BYTES)
    with error_context(INDEX):
        record = parse_record(text)
        keys, count = require(record, "keyframes", list), require(record, "poses", int)
        if len(keys) > MAX_KEYS:
            raise InputError(f"expected at most {MAX_KEYS} keyframes, got {len(keys)}")
        if not 0 <= count <= len(keys) or count * vertices > MAX_POINTS:
            most = min(len(keys), MAX_POINTS // vertices)
            raise InputError(f"expected poses to be a number from 0 to {most}, got {count}")
    poses = [archive.read_array(f"animation/{number}", "<f8", vertices, 2) for number in range(count)]
    with error_context(INDEX):
        ease, loop = (
            optional(record, "ease", str, Animation.ease),
            optional(record, "loop", bool, Animation.loop),
        )
        return Animation(tuple(_key(key, poses) for key in keys), ease, loop)


def _key(record: Json, poses: list[Floats]) -> Keyframe:
    if type(record) is not dict:
        raise InputError(f"expected keyframes to be objects, got {record!r:.40}")
    time, number = numbers([record.get("time")], "time")[0], require(record, "pose", int)
    if not 0 <= number < len(poses):
        raise InputError(f"expected a pose below {len(poses)}, got {number}")
    return Keyframe(float(time), poses[number], require(record, "ease", str) if "ease" in record else None)
