"""What the package offers as a library; `akap_editor` loads it when a name of it is first used."""

from .deform.deformer import Deformer, StepReport, StepResult
from .deform.methods import make_deformer, method_names
from .deform.precompile import precompile
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
from .io.layers.open_layers import open_layers
from .io.open_document import open_document
from .layers.composite import composite
from .layers.layered_picture import Layer, LayeredPicture, LayerGroup
from .meshing.outline import Outline, outlines
from .meshing.triangulate import triangulate

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
    "Layer",
    "LayerGroup",
    "LayeredPicture",
    "MeshPoints",
    "Outline",
    "Pin",
    "Settings",
    "SolverError",
    "StepReport",
    "StepResult",
    "TriMesh",
    "bake",
    "composite",
    "distortion",
    "export",
    "load",
    "make_deformer",
    "make_drawing",
    "method_names",
    "new_document",
    "open_document",
    "open_layers",
    "outlines",
    "precompile",
    "read_image",
    "save",
    "triangulate",
    "write_png",
]
