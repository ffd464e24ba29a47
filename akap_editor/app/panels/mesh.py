"""The sections Mesh and Figures: how the picture is cut out and meshed, and figures of the result."""

import math
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from ...editor.document.drawing import Meshing
from ...geometry.mesh import TriMesh
from ...meshing import meshers
from ...meshing.background import DEFAULT_TOLERANCE
from ...meshing.quality import smallest_angles
from ...words import mark, number_text, tr
from .. import widgets
from ..app_state import AppState
from . import parts

MIN_VERTICES, MAX_VERTICES = 200, 50_000
MAX_MARGIN = 20.0  # pixels
MAX_TOLERANCE = 60.0  # percent
_CUT_ROWS = 5  # cuts that are visible at once
_LABELS = mark("Detail"), mark("Margin"), mark("Alpha threshold"), mark("Tolerance"), mark("Mesher")


def draw(state: AppState, scale: float) -> None:
    """Draw the Mesh section. scale: points per design point."""
    meshing = state.remesher.meshing
    assert state.document is not None
    assert meshing is not None
    _draw_background(state, meshing)
    vertices = _slider(
        state,
        tr("Detail"),
        float(min(max(meshing.vertices, MIN_VERTICES), MAX_VERTICES)),
        (MIN_VERTICES, MAX_VERTICES, "%.0f"),
        tr("Number of vertices. More bend more smoothly, fewer bend faster. The outline may need more."),
        imgui.SliderFlags_.logarithmic,
    )
    if vertices is not None:
        state.remesher.request(replace(meshing, vertices=_two_digits(vertices)), imgui.is_item_active())
    if parts.draw_advanced(state, "Mesh parameters"):
        _draw_outline(state, meshing)
        _draw_mesher(state, meshing)
    _draw_cuts(state, meshing)


def draw_drawing(state: AppState, scale: float) -> None:
    """Draw the Drawing section: its name, size and mesh. scale: points per design point."""
    assert state.document is not None
    drawing = state.document.drawing
    widgets.row(tr("Name"), drawing.name)
    widgets.row(tr("Picture"), f"{drawing.size[0]} × {drawing.size[1]} px")
    for label, value, unit, tooltip in _figures(drawing.mesh):
        widgets.row(tr(label), number_text(value, ",") + unit, tr(tooltip))


def _draw_outline(state: AppState, meshing: Meshing) -> None:
    """Draw what decides on the outline: how far it is from the picture, and what belongs to the picture."""
    margin = _slider(
        state,
        tr("Margin"),
        meshing.expand,
        (0.0, MAX_MARGIN, "%.1f px"),
        tr("How far the mesh extends beyond the outline. Parts that are closer to each other are joined."),
    )
    if margin is not None:
        state.remesher.request(replace(meshing, expand=round(margin, 1)), imgui.is_item_active())
    threshold = _slider(
        state,
        tr("Alpha threshold"),
        100 * meshing.threshold,
        (1.0, 99.0, "%.0f %%"),
        tr("How opaque a pixel must be to belong to the drawing. Lower it to include faint parts."),
    )
    if threshold is not None:
        state.remesher.request(replace(meshing, threshold=round(threshold) / 100), imgui.is_item_active())


def _draw_background(state: AppState, meshing: Meshing) -> None:
    """Draw what removes or restores the background of an opaque picture."""
    assert state.document is not None
    if meshing.background is not None:
        tolerance = _slider(
            state,
            tr("Tolerance"),
            100 * meshing.background,
            (0.0, MAX_TOLERANCE, "%.0f %%"),
            tr("How different from the border's color the background may be."),
        )
        if tolerance is not None:
            state.remesher.request(
                replace(meshing, background=round(tolerance) / 100), imgui.is_item_active()
            )
        if imgui.button(tr("Restore Background"), ImVec2(widgets.FULL, 0)):
            state.remesher.request(replace(meshing, background=None))
    elif state.document.drawing.is_opaque:
        widgets.secondary_text(tr("This picture has no transparency, so the whole rectangle bends."))
        if imgui.button(tr("Remove Background"), ImVec2(widgets.FULL, 0)):
            state.notice = ""
            state.remesher.request(replace(meshing, background=DEFAULT_TOLERANCE))
        widgets.show_tooltip(tr("Makes the area transparent that touches the border and has its color."))


def _draw_mesher(state: AppState, meshing: Meshing) -> None:
    """Draw the choice of the mesher, for new drawings, too; nothing if only one is installed."""
    names = meshers.installed_meshers()
    if len(names) < 2:
        return
    tooltip = tr(
        "Program that makes the mesh. Triangle's license allows non-commercial use only; "
        "PythonCDT may be used for everything."
    )
    widgets.label(tr("Mesher"), _label_column(), tooltip)
    imgui.set_next_item_width(widgets.FULL)
    current = names.index(meshers.nearest_mesher(meshing.mesher))
    is_changed, index = widgets.combo("##Mesher", current, [meshers.MESHERS[name] for name in names])
    if is_changed:
        state.notice = ""
        state.preferences.mesher = names[index]
        state.remesher.request(replace(meshing, mesher=names[index]))


def _draw_cuts(state: AppState, meshing: Meshing) -> None:
    """Draw the list of the knife's strokes; the one under the pointer is shown on the canvas."""
    knife = state.editor.knife_tool
    knife.highlighted = None
    if not meshing.cuts:
        return
    widgets.row(
        tr("Cuts"), f"{len(meshing.cuts)}", tr("Strokes of the knife (X), along which limbs come apart.")
    )
    parts.begin_list("##cuts", min(len(meshing.cuts), _CUT_ROWS))
    width = imgui.get_content_region_avail().x
    for index, cut in enumerate(meshing.cuts):
        length = sum(math.dist(*pair) for pair in pairwise(cut))
        size = ImVec2(width - 2.0 * imgui.get_font_size(), 0)
        shown = tr("Cut {number}, {length:,.0f} px", number=index + 1, length=length)
        imgui.selectable(f"{shown}###cut {index}", False, size=size)
        if imgui.is_item_hovered() or imgui.is_item_focused():
            knife.highlighted = index
        imgui.same_line(imgui.get_cursor_start_pos().x + width - 1.7 * imgui.get_font_size())
        if widgets.icon_switch(icons.ICON_FA_TRASH, f"remove cut {index}", True, tr("Remove this cut"), 1.7):
            knife.remove(index)
    parts.end_list()


def _label_column() -> float:
    return widgets.label_column(*map(tr, _LABELS))


def _slider(
    state: AppState, label: str, value: float, limits: tuple[float, float, str], tooltip: str, flags: int = 0
) -> float | None:
    """Draw a label and a slider, the last item; return the new value when it is moved or typed, else None.

    limits: lowest and highest value, and the printf format.
    """
    low, high, text_format = limits
    widgets.label(label, _label_column(), tooltip)
    is_moved, value, is_released = widgets.slider(f"##{label}", value, (low, high), text_format, flags)
    if is_released:
        state.remesher.end_drag()
    if is_moved:
        state.notice = ""
    return value if is_moved else None


def _two_digits(count: float) -> int:
    """Round to a multiple of 100, below 1,000 of 10: a slider is no more precise."""
    return int(round(count, -2 if count >= 1000 else -1))


@lru_cache(maxsize=1)
def _figures(mesh: TriMesh) -> tuple[tuple[str, int, str, str], ...]:
    """Label, value, unit and tooltip of each figure."""
    parts = int(mesh.component.max()) + 1
    holes = len(mesh.boundary_loops) - parts
    return (
        (
            mark("Parts"),
            parts,
            "",
            mark("Pieces of the mesh. A piece without a pin moves with the nearest one."),
        ),
        (mark("Holes"), holes, "", mark("Openings inside the outline.")),
        (mark("Vertices"), len(mesh.vertices), "", mark("The drawing bends at the vertices of its mesh.")),
        (
            mark("Smallest angle"),
            round(smallest_angles(mesh).min()),
            "°",
            mark(
                "Of all triangles. Thin triangles bend badly; less than 25° means a sharp corner in the "
                "outline."
            ),
        ),
    )
