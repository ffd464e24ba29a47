"""The named poses of a drawing inside its .akap file: an index, and one array each."""

import json
from collections.abc import Sequence

from ...editor.document.named_poses import NamedPose
from ...errors import InputError, error_context
from .archive import Archive, Entry
from .json_records import parse_record, require

INDEX = "poses.json"
MAX_POSES = 1000
MAX_POINTS = 2**24  # of all poses: 256 MB
_MAX_INDEX_BYTES = 2**20


def pose_entries(poses: Sequence[NamedPose]) -> list[Entry]:
    """The entries of a file; none without poses."""
    if not poses:
        return []
    points = sum(len(pose.positions) for pose in poses)
    if points > MAX_POINTS:
        raise InputError(f"expected at most {MAX_POINTS} vertices in all poses, got {points}")
    index = json.dumps({"poses": [pose.name for pose in poses]}).encode()
    arrays = [
        (f"poses/{number}", pose.positions.astype("<f8").tobytes(), True) for number, pose in enumerate(poses)
    ]
    return [(INDEX, index, True), *arrays]


def read_poses(archive: Archive, vertices: int) -> tuple[NamedPose, ...]:
    """What `pose_entries` wrote, in order; nothing where there is no index. Raises InputError."""
    if INDEX not in archive:
        return ()
    text = archive.read(INDEX, _MAX_INDEX_BYTES)
    with error_context(INDEX):
        names = require(parse_record(text), "poses", list)
        if len(names) > MAX_POSES:
            raise InputError(f"expected at most {MAX_POSES} poses, got {len(names)}")
        if not all(type(name) is str for name in names) or len(set(names)) < len(names):
            raise InputError("expected names of poses, each once, got something else")
        points = len(names) * vertices
        if points > MAX_POINTS:
            raise InputError(f"expected at most {MAX_POINTS} vertices in all poses, got {points}")
    arrays = (archive.read_array(f"poses/{number}", "<f8", vertices, 2) for number in range(len(names)))
    with error_context("poses"):
        return tuple(NamedPose(name, array) for name, array in zip(names, arrays, strict=True))
