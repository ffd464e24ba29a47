import pytest
from hypothesis import given
from hypothesis import strategies as st

from akap_editor.editor.camera import MAX_ZOOM, MIN_ZOOM, Camera, fit

coordinates = st.floats(-5000, 5000)
points = st.tuples(coordinates, coordinates)
cameras = st.builds(Camera, st.floats(MIN_ZOOM, MAX_ZOOM), points)


@given(cameras, points)
def test_to_drawing_is_the_inverse_of_to_screen(camera, point):
    assert camera.to_drawing(camera.to_screen(point)) == pytest.approx(point, rel=1e-9, abs=1e-6)


def test_to_screen_scales_then_moves():
    assert Camera(2.0, (10.0, -5.0)).to_screen((3.0, 4.0)) == (16.0, 3.0)


@given(cameras, points, st.floats(0.01, 100))
def test_zoom_keeps_the_point_under_the_cursor(camera, at, factor):
    zoomed = camera.zoomed(factor, at)
    assert zoomed.to_screen(camera.to_drawing(at)) == pytest.approx(at, rel=1e-9, abs=1e-6)
    assert zoomed.zoom == min(max(camera.zoom * factor, MIN_ZOOM), MAX_ZOOM)


@given(cameras, points)
def test_zoom_at_its_limits_moves_nothing(camera, at):
    for limit, factor in ((MIN_ZOOM, 0.5), (MAX_ZOOM, 2.0)):
        limited = Camera(limit, camera.offset)
        assert limited.zoomed(factor, at).zoom == limit
        assert limited.zoomed(factor, at).offset == pytest.approx(limited.offset, rel=1e-9, abs=1e-6)


@given(cameras, points, points)
def test_panning_moves_everything_on_the_screen_alike(camera, point, by):
    x, y = camera.to_screen(point)
    assert camera.panned(*by).to_screen(point) == pytest.approx((x + by[0], y + by[1]), abs=1e-6)


@given(cameras, points, st.tuples(st.floats(1, 4000), st.floats(1, 4000)))
def test_view_agrees_with_to_screen(camera, point, size):
    sx, sy, tx, ty = camera.view(*size)
    x, y = camera.to_screen(point)
    ndc = sx * point[0] + tx, sy * point[1] + ty
    # ndc runs from -1 to 1, left to right and bottom to top
    assert ((ndc[0] + 1) / 2 * size[0], (1 - ndc[1]) / 2 * size[1]) == pytest.approx(
        (x, y), rel=1e-9, abs=1e-5
    )


@given(points, st.tuples(st.floats(1, 4000), st.floats(1, 4000)), points, st.floats(100, 3000))
def test_fit_centers_the_box_and_contains_it(low, size, canvas_low, canvas_size):
    high = low[0] + size[0], low[1] + size[1]
    canvas_high = canvas_low[0] + canvas_size, canvas_low[1] + 0.7 * canvas_size
    camera = fit(low, high, canvas_low, canvas_high)
    (left, top), (right, bottom) = camera.to_screen(low), camera.to_screen(high)
    assert (left + right) / 2 == pytest.approx((canvas_low[0] + canvas_high[0]) / 2, abs=1e-6)
    assert (top + bottom) / 2 == pytest.approx((canvas_low[1] + canvas_high[1]) / 2, abs=1e-6)
    if camera.zoom > MIN_ZOOM:
        assert canvas_low[0] < left < right < canvas_high[0]
        assert canvas_low[1] < top < bottom < canvas_high[1]


def test_fit_fills_the_canvas_up_to_its_margin():
    camera = fit((0.0, 0.0), (100.0, 10.0), (0.0, 0.0), (1000.0, 1000.0), margin=0.1)
    assert camera.zoom == pytest.approx(8.0)


def test_fit_of_a_single_point_is_finite():
    assert fit((5.0, 5.0), (5.0, 5.0), (0.0, 0.0), (100.0, 100.0)).zoom == MAX_ZOOM
