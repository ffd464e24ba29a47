"""Groups of layers: each is deformed on its own, so that its lengths are those of its own size.

The lengths of a method (steps, tolerances, radii around pins) are shares of √area. On a mesh of many layers
they would be too long for a small one, for example an eye, and layers that no pin moves would be solved for
nothing. Of components that joints hold together, those with pins and those on the way between them are
solved together; the others ride.
"""

import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..geometry.joints import NO_JOINTS, MeshJoints
from ..geometry.mesh import NO_POINTS, MeshPoints, TriMesh
from ..geometry.operators import to_complex
from ..geometry.validation import Floats, Ints, as_indices, as_numbers, as_points
from .deformer import Deformer, Flow, StepReport, StepResult, as_targets

DeformerFactory = Callable[..., Deformer]  # of a mesh, with parameters by keyword
_MAX_KEPT = 16  # groups whose parts are kept when pins come and go


class _Part:
    """Components of a mesh, joined with one another, as a mesh of their own, and its deformer.

    The deformer is made when it is first needed. While pins are added one after another, most groups are
    never solved for; and a step may run in another thread, while pins are changed in that of the window.

    vertices: (v,) of the whole mesh; faces: (m,) the number of each of its faces in the part, −1 of others.
    """

    def __init__(self, vertices: Ints, faces: Ints, make: Callable[[], Deformer]) -> None:
        self.vertices, self.faces, self._make = vertices, faces, make
        self._points = NO_POINTS
        self._scales: Floats | None = None
        self._made: Any = None

    @property
    def deformer(self) -> Any:
        """The deformer, with the pins and scales last set; it may have more methods than the contract."""
        if self._made is None:
            self._made = self._make()
            self._made.set_pins(self._points)
            if self._made.takes_scales:
                self._made.set_scales(self._scales)
        return self._made

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the part."""
        self._points = points
        if self._made is not None:
            self._made.set_pins(points)

    def prepare(self, pose: Floats) -> None:
        """Announce the next pose of the part to its deformer, if that has been made."""
        if self._made is not None:
            self._made.prepare(pose)

    def set_scales(self, scales: Floats | None) -> None:
        """Take scales of the part's faces, if its deformer takes them."""
        self._scales = scales
        if self._made is not None:
            self._made.set_scales(scales)


class _Group(NamedTuple):
    """A part with pins, and the indices (p,) of the pins on it."""

    part: _Part
    pins: Ints


class LayerGroupDeformer(Deformer):
    """Deforms each group of components that has pins by a deformer of its own; the others stay.

    mesh: the rest pose; make: of a method; joints: by which components form groups, if the method takes them;
    parameters: by keyword, the stiffness (m,) among them.
    """

    def __init__(
        self, mesh: TriMesh, make: DeformerFactory, joints: MeshJoints | None = None, **parameters: Any
    ) -> None:
        self._mesh, self._make, self._parameters = mesh, make, dict(parameters)
        self._joints = NO_JOINTS if joints is None else joints
        as_indices(self._joints.faces, "joints", 2, len(mesh.faces))
        self._joined = self._joints.components(mesh)
        stiffness = self._parameters.pop("stiffness", None)
        count = len(mesh.faces)
        self._stiffness = None
        if stiffness is not None:
            self._stiffness = as_numbers(stiffness, "stiffness", count, 0.0, np.inf)
        self._face_components = mesh.component[mesh.faces[:, 0]]
        self._kept: dict[tuple[int, ...], _Part] = {}
        smallest = int(np.argmin(np.bincount(self._face_components)))
        sample = self._part((smallest,)).deformer  # also checks the parameters
        self.holds_angles, self.takes_stiffness = sample.holds_angles, sample.takes_stiffness
        self.has_memory, self.has_vector_fields = sample.has_memory, sample.has_vector_fields
        self.takes_joints = sample.takes_joints
        self.takes_scales = sample.takes_scales
        self._scales: ArrayLike | None = None
        if not self.takes_joints:
            self._joined = self._joined[:0]
        self.set_pins(NO_POINTS)

    def set_pins(self, points: MeshPoints) -> None:
        """Choose the pins, k points of the mesh; moves nothing.

        Raises InputError for points with faces that the mesh does not have.
        """
        as_indices(points.faces, "points.faces", None, len(self._mesh.faces))
        components = self._face_components[points.faces]
        groups = []
        for group in solved_groups(self._joined, np.unique(components).tolist()):
            part, pins = self._part(group), np.flatnonzero(np.isin(components, group))
            part.set_pins(MeshPoints(part.faces[points.faces[pins]], points.weights[pins]))
            groups.append(_Group(part, pins))
        self._groups, self._pin_count = groups, len(points)
        self._pass_scales()

    def set_scales(self, scales: ArrayLike | None) -> None:
        """Take scales (m,) of the faces, see `Deformer`."""
        if scales is not self._scales:
            self._scales = scales
            self._pass_scales()

    def _pass_scales(self) -> None:
        if not self.takes_scales:
            return
        for group in self._groups:
            own = None
            if self._scales is not None:
                own = np.asarray(self._scales, dtype=np.float64)[group.part.faces >= 0]
            group.part.set_scales(own)

    def _part(self, group: tuple[int, ...]) -> _Part:
        """The part of some components, the same one if it is one of those that are kept."""
        if group in self._kept:
            self._kept[group] = self._kept.pop(group)  # the last one used
            return self._kept[group]
        mesh = self._mesh
        vertices = np.flatnonzero(np.isin(mesh.component, group))
        own = np.flatnonzero(np.isin(self._face_components, group))
        faces = np.full(len(mesh.faces), -1)
        faces[own] = np.arange(len(own))
        more: dict[str, Any] = {} if self._stiffness is None else {"stiffness": self._stiffness[own]}
        if len(group) > 1:
            inside = np.isin(self._joined, group).all(axis=1)
            joints = self._joints
            more["joints"] = MeshJoints(
                faces[joints.faces[inside]], joints.weights[inside], joints.is_weld[inside]
            )
        self._kept[group] = _Part(
            *(vertices, faces, lambda: self._make(mesh.part(vertices, own), **self._parameters, **more))
        )
        while len(self._kept) > _MAX_KEPT:
            del self._kept[next(iter(self._kept))]
        return self._kept[group]

    def prepare(self, positions: ArrayLike) -> None:
        """Announce the pose (n, 2) of the next step, see `Deformer.prepare`.

        A deformer that the next step has to make is not prepared.
        """
        pose = as_points(positions, "positions", len(self._mesh.vertices))
        for group in self._groups:
            group.part.prepare(pose[group.part.vertices])

    def step(self, positions: ArrayLike, targets: ArrayLike, angles: ArrayLike | None = None) -> StepResult:
        """Move the pose (n, 2) so that its pins reach ``targets`` (k, 2), see `Deformer.step`.

        angles: (k,) as the method takes them, if it `holds_angles`. Raises InputError and SolverError.
        """
        started = time.perf_counter()
        pose = as_points(positions, "positions", len(self._mesh.vertices))
        goals = as_points(targets, "targets", self._pin_count)
        as_targets(goals, self._pin_count, self._mesh, to_complex(pose))
        wanted = None if angles is None else as_numbers(angles, "angles", self._pin_count, allow_nan=True)
        results: list[tuple[_Group, StepResult]] = []
        for group in self._groups:
            optional = () if wanted is None else (wanted[group.pins],)
            result = group.part.deformer.step(pose[group.part.vertices], goals[group.pins], *optional)
            results.append((group, result))
        moved = self._together(pose, [(group, result.positions) for group, result in results])
        fields = [(group, result.field) for group, result in results if result.field is not None]
        field = self._together(np.zeros_like(pose), fields) if fields else None
        report = _common_report([result.report for _, result in results], time.perf_counter() - started)
        return StepResult(moved, field, report, self._flow(pose, results))

    def _together(self, values: Floats, parts: list[tuple[_Group, Floats]]) -> Floats:
        """``values`` (n, 2) with those of groups in place."""
        result = values.copy()
        for group, part in parts:
            result[group.part.vertices] = part
        return result

    def _flow(self, pose: Floats, results: list[tuple[_Group, StepResult]]) -> Flow | None:
        """The flow γ(t) of all groups; None if one of them has none."""
        flows = [(group, result.flow) for group, result in results]
        if not flows or any(flow is None for _, flow in flows):
            return None

        def at(t: float) -> Floats:
            return self._together(pose, [(group, flow(t)) for group, flow in flows if flow is not None])

        return at

    def vector_field(self, positions: ArrayLike, velocities: ArrayLike) -> Floats:
        """U_opt (n, 2) at a pose (n, 2) for pin velocities (k, 2), if the method has vector fields."""
        return self.vector_fields(positions, velocities)[0]

    def vector_fields(self, positions: ArrayLike, velocities: ArrayLike) -> tuple[Floats, Floats]:
        """U_opt and U°, (n, 2) each, if the method has vector fields; otherwise like `vector_field`."""
        pose = as_points(positions, "positions", len(self._mesh.vertices))
        rates = as_points(velocities, "velocities", self._pin_count)
        optimal, smooth = np.zeros_like(pose), np.zeros_like(pose)
        for group in self._groups:
            fields = group.part.deformer.vector_fields(pose[group.part.vertices], rates[group.pins])
            optimal[group.part.vertices], smooth[group.part.vertices] = fields
        return optimal, smooth


def solved_groups(joined: Ints, pinned: list[int]) -> list[tuple[int, ...]]:
    """The components that are solved together, each group ascending: those on all ways between pins.

    joined: (j, 2) components that a joint holds together; pinned: those with pins. What hangs on a group by
    one joint only, and has no pins, is not solved.
    """
    neighbors: dict[int, set[int]] = defaultdict(set)
    for a, b in joined.tolist():
        neighbors[a].add(b)
        neighbors[b].add(a)
    ends = [each for each in neighbors if len(neighbors[each]) == 1 and each not in pinned]
    while ends:
        end = ends.pop()
        for other in neighbors.pop(end):
            neighbors[other].discard(end)
            if len(neighbors[other]) == 1 and other not in pinned:
                ends.append(other)
    groups, seen = [], set()
    for component in pinned:
        if component in seen:
            continue
        group, reached = {component}, [component]
        while reached:
            new = neighbors[reached.pop()] - group
            group |= new
            reached += new
        seen |= group
        groups.append(tuple(sorted(group)))
    return groups


def _common_report(reports: list[StepReport], seconds: float) -> StepReport:
    """The report of all groups."""
    return StepReport(
        seconds,
        max((report.substeps for report in reports), default=0),
        sum(report.energy for report in reports),
        sum(report.flipped for report in reports),
        max((report.pin_error for report in reports), default=0.0),
        any(report.blocked for report in reports),
        any(report.unfinished for report in reports),
    )
