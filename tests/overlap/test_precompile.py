"""The first crossing compiles nothing: all that it needs was compiled before."""

import subprocess
import sys

PROGRAM = """
import sys
import numpy as np
from numba.core.dispatcher import Dispatcher
from akap_editor.overlap.precompile import precompile
from akap_editor.overlap.overlaps import next_overlaps, no_overlaps, restored_overlaps, asked_overlaps
from akap_editor.overlap.seams import cut_along_seams
from tests.overlap.test_overlaps import ROPE, rope_pose
from tests.overlap.test_seams import with_seam

def compiled():
    modules = [module for name, module in list(sys.modules.items()) if name.startswith("akap_editor.overlap")]
    values = [(f"{m.__name__}.{n}", v) for m in modules for n, v in vars(m).items()]
    return {name: len(value.signatures) for name, value in values if isinstance(value, Dispatcher)}

precompile()
before = compiled()
assert all(before[name] for name in before if name.endswith(("_flood", "cut_signs", "_borders"))), before
for is_writable in (True, False):  # the pose of a step is, that of a state is not
    overlaps = no_overlaps(ROPE)
    for share in np.linspace(0.5, 1, 21):
        pose = rope_pose(share).copy()
        pose.flags.writeable = is_writable
        overlaps = next_overlaps(ROPE, pose, overlaps)
limb = ROPE.vertices[ROPE.faces].mean(axis=1)[:, 0] % 300 < 150
asked = asked_overlaps(ROPE, rope_pose(1.0), overlaps, limb, True)
restored_overlaps(ROPE, rope_pose(1.0), asked.crossings)
cut_along_seams(ROPE, with_seam(overlaps), np.arange(len(ROPE.faces)))
assert compiled() == before, (before, compiled())
"""


def test_the_first_crossing_compiles_nothing() -> None:
    run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
