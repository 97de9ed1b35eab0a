"""What is recorded of bodies, joints and clearances: their variables in results.nc, and values at a state.

The clearance of two lines is the least distance of polygons through their nodes. Two segments p + s d and q + t e, s
and t from 0 to 1, are nearest where the gradient of their squared distance is zero, or on the border: s and t follow in
turn, each kept within its segment (Ericson, Real-Time Collision Detection, 2005, section 5.1.9).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.bodies.body import MovingBody
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.compiled import njit
from riser_soil.core.part import State
from riser_soil.results.netcdf_layout import Variable
from riser_soil.riser import rotations
from riser_soil.riser.vectors import add, dot, matrix, norm, scale, sub, vector
from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.lines import apart_from_joints
from riser_soil.scene.output import Clearance

GAPES = 0.01  # of the diameter, by which a rigid joint may gape
_OF_BODY = {
    "position": ("m", "place of the origin of the body's axes"),
    "rotation": ("rad", "rotation vector from the axes at first, no longer than pi"),
    "velocity": ("m/s", "velocity of the origin of the body's axes"),
}
_ON_SEABED = {
    "contact_force": ("N", "force of the seabed on the body, friction included, positive upwards"),
    "penetration": ("m", "how deep the body's lowest side is in the seabed"),
}
_OF_JOINT = {
    "force": ("N", "force of the first point on the second"),
    "moment": ("N m", "moment of the first point on the second, at the second"),
    "gap": ("m", "way from the second point to the first, which a rigid joint leaves small"),
}
_OF_PAIR = {
    "distance": ("m", "least distance of the surfaces of two lines, negative where they overlap"),
    "arc_1": ("m", "arc length of the first line where they are nearest"),
    "arc_2": ("m", "arc length of the second line where they are nearest"),
}


class BodiesAndJointsReader:
    """Looks at bodies, joints and clearances of a scene with several lines. Joints are in the order of the scene."""

    def __init__(self, assembly: Assembly) -> None:
        self._assembly, present = assembly, assembly.bodies_and_joints
        self._bodies: dict[str, MovingBody] = {} if present is None else present.bodies
        self._joints = None if present is None else present.joints
        self._contacts = {} if present is None else present.contacts
        self._frictions = {} if present is None else present.frictions
        self._pairs = [_Pair(assembly, spec) for spec in assembly.scene.output.clearance]

    @property
    def variables(self) -> dict[str, Variable]:
        """Variables of bodies, joints and clearances by path in results.nc."""
        variables: dict[str, Variable] = {}
        for name, body in self._bodies.items():
            quantities = _OF_BODY if body.turns else {key: _OF_BODY[key] for key in ("position", "velocity")}
            variables |= {f"bodies/{name}/{key}": _vector(*texts) for key, texts in quantities.items()}
        for name in self._contacts:
            force, depth = _ON_SEABED.items()
            variables |= {f"bodies/{name}/{force[0]}": _vector(*force[1])}
            variables |= {f"bodies/{name}/{depth[0]}": Variable(("time",), *depth[1])}
        for joint in self._assembly.scene.joints:
            variables |= {f"joints/{joint}/{key}": _vector(*texts) for key, texts in _OF_JOINT.items()}
        for pair in self._pairs:
            variables |= {f"{pair.path}/{key}": Variable(("time",), *texts) for key, texts in _OF_PAIR.items()}
        return variables

    def values(self, state: State) -> dict[str, Array]:
        """Values at an accepted state."""
        values: dict[str, Array] = {}
        for name, body in self._bodies.items():
            values[f"bodies/{name}/position"] = body.x[0]
            values[f"bodies/{name}/velocity"] = body.nodal(state.v)[0, :3].copy()
            if body.turns:
                values[f"bodies/{name}/rotation"] = np.array(rotations.log(matrix(body.frames.R[0])))
        for name, contact in self._contacts.items():
            friction = self._frictions.get(name)
            rubbed = np.zeros(3) if friction is None else friction.force_on_body(state)
            values[f"bodies/{name}/contact_force"] = contact.force_on_body(state) + rubbed
            values[f"bodies/{name}/penetration"] = np.array(contact.penetration(state))
        if self._joints is not None:
            for key, of_joints in zip(_OF_JOINT, self._joints.acting(state), strict=True):
                of_each = zip(self._assembly.scene.joints, of_joints, strict=True)
                values |= {f"joints/{joint}/{key}": row for joint, row in of_each}
        for pair in self._pairs:
            values |= {f"{pair.path}/{key}": value for key, value in zip(_OF_PAIR, pair.nearest(), strict=True)}
        return values

    def warnings(self, figures: Mapping[str, Any]) -> list[str]:
        """Warnings of rigid joints that gape and of bodies below ground.

        figures: of a stage, see `BodiesAndJointsExtremes`.
        """
        joints = () if self._joints is None else self._joints.joints
        joints_of_scene = self._assembly.scene.joints
        warnings = []
        for joint in joints:
            stiffness = joints_of_scene[joint.name].stiffness
            gap = figures["joints"][joint.name]["gap"]
            largest = float(np.linalg.norm(np.fmax(np.abs(gap["min"]), np.abs(gap["max"]))))
            allowed = GAPES * self._assembly.scales.diameter
            if largest > allowed and (stiffness is None or stiffness.translation is None):
                warnings.append(
                    f"joint {joint.name} gapes by up to {largest:.3g} m (limit {GAPES:g} diameters): it gives as "
                    "the elements beside it do, which stretch as much; take shorter ones there, and check what pulls"
                )
        return [*warnings, *self._sunk(figures)]

    def _sunk(self, figures: Mapping[str, Any]) -> Iterator[str]:
        """Warnings of bodies below ground that they have no contact with."""
        scene = self._assembly.scene
        view = next(iter(self._assembly.lines.values())).scene
        for name in self._bodies if scene.has_ground else ():
            x, y, z = map(float, figures["bodies"][name]["position"]["final"])
            if name not in self._contacts and z < (level := ground_height(view, (x, y, z))):
                yield (
                    f"body {name} is at z = {z:.4g} m, {level - z:.4g} m below the ground, and has no contact with it: "
                    "bodies touch a seabed, not soil, and those that float with all that hangs on them touch none"
                )


class _Pair:
    """A pair of lines, and the elements of each that count."""

    def __init__(self, assembly: Assembly, spec: Clearance) -> None:
        self.path = f"clearance/{spec.key}"
        self._lines = [assembly.lines[name].line for name in spec.between]
        self._counts = [np.array(apart_from_joints(assembly.scene, name, spec.beyond)) for name in spec.between]

    def nearest(self) -> tuple[Array, Array, Array]:
        """Distance and both arc lengths, each without axes [m]."""
        (one, other), (counts, other_counts) = self._lines, self._counts
        both = [(line.to_global(line.x), 0.5 * line.outer_diameter) for line in (one, other)]
        distance, e, s, f, t = clearance(*both[0], counts, *both[1], other_counts)
        arcs = (line.arc[at] + share * line.length[at] for line, at, share in ((one, e, s), (other, f, t)))
        first, second = arcs
        return np.array(distance), np.array(first), np.array(second)


def _vector(units: str, text: str) -> Variable:
    return Variable(("time", "component"), units, text)


@njit
def clearance(
    x: Array, radius: Array, counts: BoolArray, other: Array, other_radius: Array, other_counts: BoolArray
) -> tuple[float, int, float, int, float]:
    """Least distance of the surfaces of two lines [m], negative where they overlap; element and place in it, 0 to 1, on
    the one and the other.

    x, other (nn, 3): nodes; radius (ne,) [m]; counts (ne,): the elements that are looked at.
    """
    least, e, s, f, t = np.inf, 0, 0.0, 0, 0.0
    for i in range(radius.size):
        if not counts[i]:
            continue
        for j in range(other_radius.size):
            if not other_counts[j]:
                continue
            distance, along, beside = between_segments(x[i], x[i + 1], other[j], other[j + 1])
            if distance - radius[i] - other_radius[j] < least:
                least, e, s, f, t = distance - radius[i] - other_radius[j], i, along, j, beside
    return least, e, s, f, t


@njit
def between_segments(first: Array, second: Array, third: Array, fourth: Array) -> tuple[float, float, float]:
    """Least distance of two segments, and where on each, from 0 to 1; ends (3,)."""
    p, q = vector(first), vector(third)
    d, e, r = sub(vector(second), p), sub(vector(fourth), q), sub(p, q)
    dd, ee, de, dr, er = dot(d, d), dot(e, e), dot(d, e), dot(d, r), dot(e, r)
    det = dd * ee - de * de
    s = _from_0_to_1((de * er - dr * ee) / det) if det > 1e-12 * dd * ee else 0.0
    t = (de * s + er) / ee
    if t < 0.0 or t > 1.0:
        t = _from_0_to_1(t)
        s = _from_0_to_1((de * t - dr) / dd)
    return norm(sub(add(p, scale(s, d)), add(q, scale(t, e)))), s, t


@njit
def _from_0_to_1(value: float) -> float:
    return min(1.0, max(0.0, value))
