"""The camera: a zoom and an offset that map the drawing to the screen."""

from dataclasses import dataclass, replace

Point = tuple[float, float]

MIN_ZOOM, MAX_ZOOM = 0.02, 64.0
ZOOM_STEP = 1.15  # zoom factor of one notch of the wheel


@dataclass(frozen=True)
class Camera:
    """screen = zoom * drawing + offset, both y down; screen units are points of the window."""

    zoom: float = 1.0
    offset: Point = (0.0, 0.0)

    def to_screen(self, point: Point) -> Point:
        """Map a point from drawing pixels to the screen."""
        return point[0] * self.zoom + self.offset[0], point[1] * self.zoom + self.offset[1]

    def to_drawing(self, point: Point) -> Point:
        """Map a point from the screen to drawing pixels."""
        return (point[0] - self.offset[0]) / self.zoom, (point[1] - self.offset[1]) / self.zoom

    def panned(self, dx: float, dy: float) -> "Camera":
        """The camera after the drawing moved by points of the screen."""
        return replace(self, offset=(self.offset[0] + dx, self.offset[1] + dy))

    def zoomed(self, factor: float, at: Point) -> "Camera":
        """The camera magnified by ``factor`` within the limits; the screen point ``at`` stays fixed."""
        zoom = min(max(self.zoom * factor, MIN_ZOOM), MAX_ZOOM)
        x, y = self.to_drawing(at)
        return Camera(zoom, (at[0] - x * zoom, at[1] - y * zoom))

    def view(self, width: float, height: float) -> tuple[float, float, float, float]:
        """(sx, sy, tx, ty) for ``ndc = s * drawing + t`` in a viewport of this size in screen units.

        Only this method turns y upwards, as normalized device coordinates need it.
        """
        return (
            2 * self.zoom / width,
            -2 * self.zoom / height,
            2 * self.offset[0] / width - 1,
            1 - 2 * self.offset[1] / height,
        )


def fit(low: Point, high: Point, canvas_low: Point, canvas_high: Point, margin: float = 0.06) -> Camera:
    """The camera that centers the box ``low``..``high`` of the drawing in a part of the screen.

    margin: on each side, as a share of that part.
    """
    width, height = canvas_high[0] - canvas_low[0], canvas_high[1] - canvas_low[1]
    span = max(high[0] - low[0], 1e-9), max(high[1] - low[1], 1e-9)
    room = 1 - 2 * margin
    zoom = min(max(min(width * room / span[0], height * room / span[1]), MIN_ZOOM), MAX_ZOOM)
    return Camera(
        zoom,
        (
            (canvas_low[0] + canvas_high[0] - zoom * (low[0] + high[0])) / 2,
            (canvas_low[1] + canvas_high[1] - zoom * (low[1] + high[1])) / 2,
        ),
    )


def shift_into(value: float, low: float, high: float, margin: float) -> float:
    """How much to add to ``value`` so that it lies between the limits, with a margin where there is room."""
    margin = min(margin, (high - low) / 2)
    return max(low + margin - value, 0.0) + min(high - margin - value, 0.0)
