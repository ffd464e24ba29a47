"""After `precompile`, the first drag compiles nothing."""

import subprocess
import sys

PROGRAM = """
import sys
import numpy as np
from numba.core.dispatcher import Dispatcher
import akap_editor as akap
import akap_editor.library
from akap_editor.deform import precompile
from akap_editor.resources import resource

def compiled():
    modules = [module for name, module in list(sys.modules.items()) if name.startswith("akap_editor")]
    values = [(f"{m.__name__}.{n}", v) for m in modules for n, v in vars(m).items()]
    return {name: len(value.signatures) for name, value in values if isinstance(value, Dispatcher)}

def make_sure_that_nothing_was_compiled():
    more = {name: count for name, count in compiled().items() if count != before[name]}
    assert not more, more

precompile.precompile_new_mesh()
precompile.precompile_loops()
precompile.precompile_factors()
before = compiled()
drawing = akap.make_drawing(akap.read_image(resource("assets", "drawings", "gingerbread.png")), vertices=400)
stiffness = np.linspace(1, 10, len(drawing.mesh.faces))
points = drawing.mesh.locate(drawing.mesh.vertices[[5, 200, 300]])
start = drawing.mesh.vertices[[5, 200, 300]]
for memory in (0.0, 1.0):
    for settings in ({}, {"stiffness": stiffness}):
        deformer = akap.make_deformer("akap", drawing.mesh, memory=memory, **settings)
        deformer.set_pins(points)
        pose = drawing.mesh.vertices
        for move in (0.0, 3.0, 6.0, 6.0, 6.0):
            pose = deformer.step(pose, start + [0.0, move]).positions
        deformer.step(pose, start, angles=[0.1, np.nan, np.nan])
drawing = akap.make_drawing(drawing.image, vertices=2600)
deformer = akap.make_deformer("akap", drawing.mesh, memory=1.0)
pose = drawing.mesh.vertices
start = pose[[5, 1000, 2000]]
deformer.set_pins(drawing.mesh.locate(start))
for move in (1.0, 10.0):  # a few faces change much
    pose = deformer.step(pose, start + np.outer([0, 0, move], [1, 0])).positions
make_sure_that_nothing_was_compiled()
precompile.precompile()
before = compiled()
drawing = akap.make_drawing(drawing.image, vertices=400)
deformer = akap.make_deformer("akap", drawing.mesh, exact=True, memory=1.0)
pose = drawing.mesh.vertices
start = pose[[5, 100, 200]]
deformer.set_pins(drawing.mesh.locate(start))
for move in (1.0, 3.0, 3.0):
    pose = deformer.step(pose, start + np.outer([0, 0, move], [1, 0])).positions
deformer.vector_field(pose, start)
make_sure_that_nothing_was_compiled()
print(sum(count == 1 for count in before.values()))
"""


def test_first_drag_compiles_nothing():
    run = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr
    assert int(run.stdout) > 10
