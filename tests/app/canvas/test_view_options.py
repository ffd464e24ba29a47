"""Overlays: what they compute, and that they are seen in the window and not in an export."""

from imgui_bundle import imgui  # isort: skip
import numpy as np
import pytest

from akap_editor.app import file_commands
from akap_editor.app.canvas.view_options import RANGES, arrows, heat, softened, spread
from akap_editor.geometry.distortion import distortion
from akap_editor.io.images import write_png


def canvas(ui, shot):
    left, top, right, bottom = map(round, ui.editor.canvas)
    return shot[top:bottom, left:right].astype(int)


# -- what is computed ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("stretch", "area", "angle"),
    [((1, 1), 0.5, 0.0), ((1.2, 1.2), "up", 0.0), ((0.8, 0.8), "down", 0.0), ((1.2, 1 / 1.2), 0.5, "up")],
)
def test_levels_of_even_stretches(drawing, stretch, area, angle):
    found = distortion(drawing.mesh, drawing.mesh.vertices * stretch)
    product, ratio = np.log(stretch[0] * stretch[1]), abs(np.log(stretch[0] / stretch[1]))
    span = np.log(1.5)
    expected = {0.5: 0.5, "up": 0.5 + 0.5 * product / span, "down": max(0.5 + 0.5 * product / span, 0)}[area]
    np.testing.assert_allclose(heat(found, "area", 1.5).levels, expected, atol=1e-6)
    expected = 0.0 if angle == 0.0 else ratio / span
    np.testing.assert_allclose(heat(found, "angle", 1.5).levels, expected, atol=1e-5)


def test_flipped_and_collapsed_faces_are_off_the_scale(drawing):
    for factor in (-1, 0):
        found = distortion(drawing.mesh, drawing.mesh.vertices * (factor, 1))
        for measure in ("area", "angle"):
            assert (heat(found, measure, 2.0).levels == -1).all()


def test_arrows_stand_a_spacing_apart_and_cover_the_drawing(drawing):
    chosen = spread(drawing, 30.0)
    places = drawing.mesh.vertices
    assert len(np.unique(np.floor(places[chosen] / 30), axis=0)) == len(chosen)
    nearest = np.linalg.norm(places[:, None] - places[chosen], axis=2).min(axis=1)
    assert nearest.max() < 30 * np.sqrt(2) + 1e-9


def test_an_arrow_is_a_shaft_with_two_even_barbs():
    shaft, first, second = arrows(np.array([[1.0, 2.0]]), np.array([[10.0, 0.0]]), 3.0)
    np.testing.assert_allclose(shaft, [[1, 2], [11, 2]])
    np.testing.assert_allclose(first[0], (11, 2))
    np.testing.assert_allclose(first[1] - (11, 2), (second[1] - (11, 2)) * (1, -1))
    assert np.isfinite(arrows(np.zeros((1, 2)), np.zeros((1, 2)), 3.0)).all()


def test_slow_places_show():
    lengths = np.linalg.norm(softened(np.array([[1.0, 0], [0.25, 0], [0, 0]]), 8.0), axis=1)
    np.testing.assert_allclose(lengths, [8, 4, 0])


# -- what is seen -------------------------------------------------------------------------------------------


def exported(ui):
    return ui.state.exporter.render(ui.document.drawing, ui.session.state.positions)


def bend(ui):
    start = ui.screen(ui.pin_place(3))
    ui.drag(start, (start[0] - 30, start[1] - 120))


@pytest.mark.parametrize("name", ["heat", "ghost", "trails", "reference"])
def test_an_overlay_is_seen_and_gone_again_and_never_exported(pinned, name):
    bend(pinned)
    plain = canvas(pinned, pinned.screenshot())
    before = exported(pinned)
    if name == "reference":
        pinned.state.view.set_reference(np.full((30, 30, 4), (200, 0, 0, 255), dtype=np.uint8))
    else:
        setattr(pinned.state.view, name, "area" if name == "heat" else True)
    shown = canvas(pinned, pinned.screenshot())
    assert (shown != plain).any(axis=2).sum() > 300
    assert (exported(pinned) == before).all()
    if name == "reference":
        pinned.state.view.show_reference = False
    else:
        setattr(pinned.state.view, name, None if name == "heat" else False)
    assert (canvas(pinned, pinned.screenshot()) == plain).all()


def test_the_fields_are_seen_during_a_drag_only(pinned):
    pinned.state.view.vectors = True
    start = pinned.screen(pinned.pin_place(3))
    counts = []

    def actions(hand):
        pinned.begin_drag(hand, start)
        hand.mouse_move_to_pos(imgui.ImVec2(start[0] - 30, start[1] - 100))
        hand.yield_(5)
        counts.append([len(s.segments) for s in pinned.state.overlays(1.0).strokes])
        hand.mouse_up(0)

    pinned.do(actions)
    (rim, blue, green) = counts[0]
    assert rim == blue == green > 30
    assert pinned.state.overlays(1.0).strokes == ()


def test_a_click_on_the_scale_chooses_another_range(pinned):
    pinned.state.view.heat = "angle"
    pinned.settle()
    before = pinned.state.view.heat_range
    pinned.do(lambda hand: hand.item_click("//##legend/##range"))
    assert pinned.state.view.heat_range == (before + 1) % len(RANGES)


def test_a_reference_picture_is_chosen_by_its_file(pinned, tmp_path, image):
    write_png(tmp_path / "behind.png", image)
    file_commands.choose_reference(pinned.state)
    pinned.settle()
    pinned.type_name("Choose reference picture", str(tmp_path / "behind.png"))
    assert (pinned.state.view.reference.image == image).all()
    file_commands.choose_reference(pinned.state)
    pinned.settle()
    (tmp_path / "broken.png").write_bytes(b"no picture")
    pinned.type_name("Choose reference picture", str(tmp_path / "broken.png"))
    assert "broken.png" in pinned.state.error
    assert (pinned.state.view.reference.image == image).all()
    pinned.state.error = ""
