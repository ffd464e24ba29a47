"""The Drawing section: name and size of the picture."""

from .. import widgets
from ..app_state import AppState


def draw(state: AppState, scale: float) -> None:
    """Draw the section. scale: points per design point."""
    assert state.document is not None
    drawing = state.document.drawing
    widgets.row("Name", drawing.name)
    widgets.row("Picture", f"{drawing.size[0]} × {drawing.size[1]} px")
