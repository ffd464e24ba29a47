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

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .library import (
        AkapError as AkapError,
    )
    from .library import (
        Deformer as Deformer,
    )
    from .library import (
        DisplayError as DisplayError,
    )
    from .library import (
        Distortion as Distortion,
    )
    from .library import (
        Document as Document,
    )
    from .library import (
        Drawing as Drawing,
    )
    from .library import (
        EditState as EditState,
    )
    from .library import (
        ExportOptions as ExportOptions,
    )
    from .library import (
        GraphicsError as GraphicsError,
    )
    from .library import (
        InputError as InputError,
    )
    from .library import (
        Layer as Layer,
    )
    from .library import (
        LayeredPicture as LayeredPicture,
    )
    from .library import (
        LayerGroup as LayerGroup,
    )
    from .library import (
        MeshPoints as MeshPoints,
    )
    from .library import (
        Outline as Outline,
    )
    from .library import (
        Pin as Pin,
    )
    from .library import (
        Settings as Settings,
    )
    from .library import (
        SolverError as SolverError,
    )
    from .library import (
        StepReport as StepReport,
    )
    from .library import (
        StepResult as StepResult,
    )
    from .library import (
        TriMesh as TriMesh,
    )
    from .library import (
        bake as bake,
    )
    from .library import (
        composite as composite,
    )
    from .library import (
        distortion as distortion,
    )
    from .library import (
        export as export,
    )
    from .library import (
        load as load,
    )
    from .library import (
        make_deformer as make_deformer,
    )
    from .library import (
        make_drawing as make_drawing,
    )
    from .library import (
        method_names as method_names,
    )
    from .library import (
        new_document as new_document,
    )
    from .library import (
        open_document as open_document,
    )
    from .library import (
        open_layers as open_layers,
    )
    from .library import (
        outlines as outlines,
    )
    from .library import (
        precompile as precompile,
    )
    from .library import (
        read_image as read_image,
    )
    from .library import (
        save as save,
    )
    from .library import (
        triangulate as triangulate,
    )
    from .library import (
        write_png as write_png,
    )

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
    "__version__",
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


def __getattr__(name: str) -> Any:
    """A name of the library: it takes a second to load, which programs with other aims need not wait for."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import library

    return getattr(library, name)


def __dir__() -> list[str]:
    return sorted(__all__)
