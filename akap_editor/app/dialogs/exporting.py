"""What is chosen in the export dialog."""

from dataclasses import dataclass

from ...editor.document.document import Document
from ...editor.document.framing import CROPS, crop_box, picture_size
from ...io.export import FORMATS, ExportOptions, Format

Color = tuple[float, float, float]

SCALES = (0.5, 1.0, 2.0, 4.0)
SMALLEST, LARGEST = 0.01, 100.0  # scales that can be chosen


@dataclass
class PoseExportOptions:
    """shown: whether the dialog is open; the rest is kept for the next time. See `ExportOptions`."""

    shown: bool = False
    format: Format = FORMATS[0]
    scale: float = 1.0
    opaque: bool = False
    background: Color = (1.0, 1.0, 1.0)
    crop: str = CROPS[0]
    rest: bool = False

    @property
    def options(self) -> ExportOptions:
        """As the exporter takes them."""
        return ExportOptions(self.scale, self.background if self.opaque else None, self.crop, self.rest)

    def size(self, document: Document) -> tuple[int, int]:
        """Width and height in pixels of what would be written. Raises InputError where that is too large."""
        pose = document.drawing.mesh.vertices if self.rest else document.state.positions
        return picture_size(crop_box(document.drawing, pose, self.crop), self.scale)

    def file_name(self, document: Document) -> str:
        """A name to begin with; not that of the picture, which may be beside it."""
        return f"{document.drawing.name}-{'rest' if self.rest else 'posed'}{self.format.suffix}"
