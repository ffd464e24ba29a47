"""The dialog about the program, its method and its license."""

from imgui_bundle import imgui

from ... import __version__
from ...words import tr
from .. import widgets
from ..app_state import AppState
from ..theme import SECONDARY

_WIDTH = 380  # design points


class AboutDialog:
    """Shows version, method and license."""

    def __init__(self) -> None:
        self.is_open = False

    def open(self) -> None:
        """Show the dialog."""
        self.is_open = True

    def draw(self, state: AppState, scale: float) -> None:
        """Draw one frame. scale: points per design point."""
        if not widgets.begin_dialog("About akap-editor"):
            return
        imgui.text(f"akap-editor {__version__}")
        widgets.paragraph(
            tr(
                "A puppet-warp editor for cartoons. Method: Solomon, Ben-Chen, Butscher and Guibas, "
                "“As-Killing-As-Possible Vector Fields for Planar Deformation”, SGP 2011."
            ),
            _WIDTH * scale,
        )
        widgets.paragraph(
            tr(
                "Free software; the file LICENSE holds its license. Of its meshers, Triangle may be used "
                "non-commercially only, PythonCDT for everything."
            ),
            _WIDTH * scale,
            SECONDARY,
        )
        imgui.spacing()
        if widgets.button(tr("Close"), primary=True) or widgets.cancel_pressed() or widgets.confirm_pressed():
            self.is_open = False
            widgets.close_popup()
        imgui.end_popup()
