"""Line types that change along the riser: stiffeners, joints with jumps, unequal neighbours, kinks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_bvp

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser import shapes
from riser_soil.riser.beam import Beam
from riser_soil.riser.catenary import catenary
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End
from riser_soil.riser.loads import AppliedLoad, PointLoads
from riser_soil.riser.section_forces import element_residual
from riser_soil.riser.sections import Elements, elements
from riser_soil.riser.sections import joined as in_a_row
from riser_soil.scene.riser import graded_lengths
from tests.support.dense_chain import solve
from tests.support.pipes import IN_AIR, WEIGHTLESS, pipe
from tests.support.sections import section_forces

UP = np.array([0.0, 0.0, 1.0])


def bent(e: Elements, curve: shapes.Curve, force: Array) -> Line:
    """A cantilever under a force at its end, in the plane."""
    line = Line(2, shapes.layout(e.arc, e.outer_diameter, curve, curve), End(True, rotation_fixed=True), End(False))
    solve(line, [Beam(line, e), PointLoads(line, [AppliedLoad(lambda t: 1.0, e.arc[-1], force)])], tolerance=1e-7)
    return line


# A bend stiffener: segments whose stiffness follows a cone.

L, BASE, TIP, FORCE = 3.0, 8.0e5, 1.0e5, 1.0


def stiffness(s: Array) -> Array:
    """Stiffness of a stiffener that tapers linearly in stiffness from its base to its tip."""
    return BASE + (TIP - BASE) * s / L


def deflection(count: int, per_segment: int = 2) -> float:
    """Deflection of the tip, by segments that have the stiffness of their middles."""
    joints = np.linspace(0.0, L, count + 1)
    EI = stiffness(0.5 * (joints[1:] + joints[:-1]))
    e = in_a_row([pipe(L / count, per_segment, WEIGHTLESS, EA=1.0e7, EI=each) for each in EI])
    line = bent(e, shapes.straight(e.arc), FORCE * UP)
    return float(line.to_global(line.x)[-1, 2])


def integral_of_pieces(count: int) -> float:
    """F times the integral of (L - s)^2/EI over pieces of constant EI."""
    joints = np.linspace(0.0, L, count + 1)
    EI = stiffness(0.5 * (joints[1:] + joints[:-1]))
    cubes = (L - joints) ** 3 / 3.0
    return float(FORCE * np.sum((cubes[:-1] - cubes[1:]) / EI))


def integral_of_taper() -> float:
    """F times the integral of x^2/(b + c x) from 0 to L, x = L - s."""
    b, c = TIP, (BASE - TIP) / L
    return FORCE * (L**2 / (2.0 * c) - b * L / c**2 + b**2 / c**3 * np.log(1.0 + c * L / b))


@pytest.mark.parametrize("count", [1, 3, 8])
def test_a_stepped_stiffener_bends_by_the_integral_of_its_pieces(count: int) -> None:
    assert deflection(count) == pytest.approx(integral_of_pieces(count), rel=1e-6)


def test_stiffeners_of_graded_segments_converge_to_the_taper() -> None:
    errors = np.array([deflection(n) / integral_of_taper() - 1.0 for n in (5, 10, 20)])
    orders = np.log2(np.abs(errors[:-1] / errors[1:]))
    assert abs(errors[-1]) < 2e-3
    assert np.all(orders > 1.9), f"errors {errors}, orders {orders}"


# A kink in the unstressed shape, at a joint of two line types.


def test_an_angle_of_two_pipes_bends_as_a_frame() -> None:
    """A column of height a that carries an arm b, loaded at its tip: the corner turns and keeps its right angle."""
    a, b, columns, arms, P = 2.0, 3.0, 4.0e5, 1.0e5, 2.0
    column, arm = pipe(a, 2, WEIGHTLESS, EA=1.0e9, EI=columns), pipe(b, 3, WEIGHTLESS, EA=1.0e9, EI=arms)
    e = in_a_row([column, arm])
    position = np.array([[max(s - a, 0.0), 0.0, min(s, a)] for s in e.arc])
    across, up = np.array([1.0, 0.0, 0.0]), UP
    tangent = np.array([[up, up] if s < a else [across, across] for s in e.arc[:-1]])
    line = bent(e, shapes.Curve(position, tangent), -P * UP)
    moved = line.to_global(line.x) - position
    turned = P * b * a / columns
    assert moved[2] == pytest.approx([0.5 * P * b * a**2 / columns, 0.0, 0.0], rel=1e-4, abs=1e-8)
    assert moved[-1, 2] == pytest.approx(-(P * b**3 / (3.0 * arms) + turned * b), rel=1e-4)


# A riser of two stiffnesses and weights hangs between pinned ends.

LENGTHS, WEIGHTS, STIFFNESSES, EA = (60.0, 90.0), (400.0, 250.0), (4.0e5, 2.0e4), 1.0e9
TOP = np.array([80.0, 0.0, 70.0])
UNIT = 1.0e4  # of forces [N] and moments [N.m] in the reference, which then is of order one


@dataclass(frozen=True)
class Joined:
    """The riser at rest: H [N], moment at the joint [N.m] and angle there [rad]."""

    H: float
    joint_moment: float
    joint_angle: float  # rad


def joined(n: int) -> Joined:
    """Equal elements in the stiff part, and beyond the joint graded ones, the first half as long as their neighbour."""
    h = LENGTHS[0] / n
    lengths = (h,) * n, graded_lengths(LENGTHS[1], 0.5 * h, 1.5 * h)
    each = zip(lengths, STIFFNESSES, WEIGHTS, strict=True)
    e = in_a_row([elements(L, IN_AIR, EA=EA, EI_y=EI, EI_z=EI, submerged_weight=w) for L, EI, w in each])
    first = catenary(e.arc, np.zeros(3), TOP, float(np.average(e.weight, weights=e.length)), EA)
    layout = shapes.layout(e.arc, e.outer_diameter, shapes.straight(e.arc), first.curve)
    line = Line(2, layout, End(True), End(True))
    beam = Beam(line, e)
    solve(line, [beam])
    state = State.at_rest(1.0, line.size)
    forces = section_forces(line, e, state, element_residual(line, [beam], state))
    tangent = line.trial(state).turn.tangent[n, 0]
    return Joined(float(forces.force[-1, 0]), float(forces.moment[n, 1]), float(np.arctan2(tangent[1], tangent[0])))


def reference() -> tuple[float, float, float]:
    """H, moment and angle at the joint by the equations of the two pieces, each over its own scaled arc.

    x' = e cos th, z' = e sin th, th' = M/EI, M' = e (H sin th - V cos th), V' = w, e = 1 + (H cos th + V sin th)/EA.
    """

    def slopes(_: Array, y: Array, p: Array) -> Array:
        pieces = []
        for k in range(2):
            _, _, th, M, V = y[5 * k : 5 * k + 5]
            EI, w = STIFFNESSES[k] / UNIT, WEIGHTS[k] / UNIT
            stretch = 1.0 + UNIT / EA * (p[0] * np.cos(th) + V * np.sin(th))
            x, z, moment = np.cos(th), np.sin(th), p[0] * np.sin(th) - V * np.cos(th)
            right = [stretch * x, stretch * z, M / EI, stretch * moment, np.full_like(V, w)]
            pieces += [LENGTHS[k] * value for value in right]
        return np.array(pieces)

    def ends(a: Array, b: Array, p: Array) -> Array:
        return np.concatenate([[a[0], a[1], a[3]], b[:5] - a[5:], [b[5] - TOP[0], b[6] - TOP[2], b[8]]])

    s = np.linspace(0.0, 1.0, 401)
    arc = np.concatenate([LENGTHS[0] * s, LENGTHS[0] + LENGTHS[1] * s[1:]])
    guess = catenary(arc, np.zeros(3), TOP, 310.0, EA)
    y = np.zeros((10, s.size))
    for k, part in enumerate((slice(0, s.size), slice(s.size - 1, 2 * s.size - 1))):
        x = guess.curve.position[part]
        th = np.arctan2(np.gradient(x[:, 2]), np.gradient(x[:, 0]))
        y[5 * k : 5 * k + 5] = [x[:, 0], x[:, 2], th, 0.0 * th, guess.H / UNIT * np.tan(th)]
    solution = solve_bvp(slopes, ends, s, y, p=[guess.H / UNIT], tol=1e-8, max_nodes=20_000)
    assert solution.success, solution.message
    return UNIT * float(solution.p[0]), UNIT * float(solution.y[3, -1]), float(solution.y[2, -1])


def test_a_joint_of_unequal_pipes_converges_at_fourth_order() -> None:
    H, M, angle = reference()
    moments = [joined(n) for n in (30, 60, 120)]
    errors = np.array([[j.H / H - 1.0, -j.joint_moment / M - 1.0, j.joint_angle - angle] for j in moments])
    assert np.abs(errors[-1]).max() < 1e-5, errors
    orders = np.log2(np.abs(errors[:-1] / errors[1:]))
    assert np.all(orders > 3.7), f"errors {errors}, orders {orders}"
