"""The section of the side panel for how the picture is cut out and meshed."""

from dataclasses import replace
from functools import lru_cache

from imgui_bundle import ImVec2, ImVec4, imgui

from ...editor.document.drawing import Meshing
from ...geometry.mesh import TriMesh
from ...meshing.background import DEFAULT_TOLERANCE
from ...meshing.quality import smallest_angles
from .. import widgets
from ..app_state import AppState
from ..theme import QUIET

FEWEST, MOST = 200, 50_000
WIDEST = 20.0  # pixels of expansion
_LABEL = 6.4  # width of the labels, in heights of the font


def draw(state: AppState, scale: float) -> None:
    """Sliders, the background, and the mesh in numbers."""
    wanted = state.remesher.meshing
    assert state.document is not None
    assert wanted is not None
    _background(state, wanted)
    logarithmic = imgui.SliderFlags_.logarithmic
    vertices = _slider(
        state,
        "Vertices",
        float(min(max(wanted.vertices, FEWEST), MOST)),
        (FEWEST, MOST, "%.0f"),
        "More bend more smoothly, fewer bend faster. The outline may need more than are wanted.",
        logarithmic,
    )
    if vertices is not None:
        state.remesher.request(replace(wanted, vertices=_rounded(vertices)), dragging=True)
    expand = _slider(
        state,
        "Expansion",
        wanted.expand,
        (0.0, WIDEST, "%.1f px"),
        "How far the mesh goes beyond the outline. Parts that are nearer to one another become one.",
    )
    if expand is not None:
        state.remesher.request(replace(wanted, expand=round(expand, 1)), dragging=True)
    threshold = _slider(
        state,
        "Edge",
        100 * wanted.threshold,
        (1.0, 99.0, "%.0f %%"),
        "How opaque the picture must be to belong to the drawing. Lower it to keep what is faint.",
    )
    if threshold is not None:
        state.remesher.request(replace(wanted, threshold=round(threshold) / 100), dragging=True)
    _numbers(state.document.drawing.mesh)


def _background(state: AppState, wanted: Meshing) -> None:
    assert state.document is not None
    if wanted.background is not None:
        tolerance = _slider(
            state,
            "Background",
            100 * wanted.background,
            (0.0, 60.0, "%.0f %%"),
            "How far a color may be from that of the border and still be background.",
        )
        if tolerance is not None:
            state.remesher.request(replace(wanted, background=round(tolerance) / 100), dragging=True)
        if imgui.button("Keep the background", ImVec2(widgets.FULL, 0)):
            state.remesher.request(replace(wanted, background=None))
    elif state.document.drawing.is_opaque:
        widgets.secondary_text("This picture has no transparency, so all of its rectangle bends.")
        if imgui.button("Remove background", ImVec2(widgets.FULL, 0)):
            state.notice = ""
            state.remesher.request(replace(wanted, background=DEFAULT_TOLERANCE))
        widgets.show_tooltip("Makes transparent what has the color of the border and is joined to it.")


def _slider(
    state: AppState, label: str, value: float, scope: tuple[float, float, str], tooltip: str, flags: int = 0
) -> float | None:
    """A slider below its label; the new value while it is moved, else None."""
    low, high, text = scope
    imgui.align_text_to_frame_padding()
    imgui.text_colored(ImVec4(*QUIET), label)
    widgets.show_tooltip(tooltip)
    imgui.same_line(_LABEL * imgui.get_font_size())
    moved, chosen, released = widgets.slider(f"##{label}", value, (low, high), text, flags)
    if released:
        state.remesher.end_drag()
    if moved:
        state.notice = ""
    return chosen if moved else None


def _rounded(count: float) -> int:
    """To two digits: nobody means 2,013 vertices."""
    return int(round(count, -2 if count >= 1000 else -1))


@lru_cache(maxsize=1)
def _facts(mesh: TriMesh) -> tuple[tuple[str, str, str], ...]:
    parts = int(mesh.component.max()) + 1
    holes = len(mesh.boundary_loops) - parts
    return (
        ("Parts", f"{parts:,}", "Pieces of the mesh. One without a pin rides with the one nearest to it."),
        ("Holes", f"{holes:,}", "Openings within the outline."),
        ("Vertices made", f"{len(mesh.vertices):,}", "The drawing bends at the vertices of its mesh."),
        (
            "Smallest angle",
            f"{smallest_angles(mesh).min():.0f}°",
            "Of all triangles. Thin ones bend badly; below 25° the outline is so sharp there.",
        ),
    )


def _numbers(mesh: TriMesh) -> None:
    for label, value, tooltip in _facts(mesh):
        widgets.row(label, value, tooltip)
