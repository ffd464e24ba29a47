"""akap_editor: bend cartoons with as-Killing-as-possible vector fields.

The engine as a library, without a window::

    import akap_editor as akap

    drawing = akap.make_drawing(akap.read_image("assets/drawings/cat.png"), vertices=2000)
    points = drawing.mesh.locate([[140.0, 120.0], [300.0, 410.0]])
    deformer = akap.make_deformer("akap", drawing.mesh, memory=1.0)
    deformer.set_pins(points)
    pose = deformer.step(drawing.mesh.vertices, targets=[[150.0, 110.0], [300.0, 410.0]]).positions
    akap.distortion(drawing.mesh, pose)
"""

from .deform.deformer import Deformer, StepReport, StepResult
from .deform.methods import make_deformer, method_names
from .editor.document.document import Document, EditState, new_document
from .editor.document.drawing import Drawing, make_drawing
from .editor.document.pin import Pin
from .editor.document.rest_pose import bake
from .editor.document.settings import Settings
from .errors import AkapError, DisplayError, GraphicsError, InputError, SolverError
from .geometry.distortion import Distortion, distortion
from .geometry.mesh import MeshPoints, TriMesh
from .io.akap.project import load, save
from .io.export import ExportOptions, export
from .io.images import read_image, write_png
from .io.open_document import open_document
from .meshing.outline import Outline, outlines
from .meshing.triangulate import triangulate

__version__ = "0.1.0"

__all__ = [
    "AkapError",
    "Deformer",
    "DisplayError",
    "Distortion",
    "Document",
    "Drawing",
    "EditState",
    "ExportOptions",
    "GraphicsError",
    "InputError",
    "MeshPoints",
    "Outline",
    "Pin",
    "Settings",
    "SolverError",
    "StepReport",
    "StepResult",
    "TriMesh",
    "__version__",
    "bake",
    "distortion",
    "export",
    "load",
    "make_deformer",
    "make_drawing",
    "method_names",
    "new_document",
    "open_document",
    "outlines",
    "read_image",
    "save",
    "triangulate",
    "write_png",
]
