"""Stiffness-proportional (Kelvin-Voigt) damping of the plane elements of `beam2d`.

The stiffnesses here are viscosities beta EA [N s] and beta EI [N m2 s]. With the rates of the chord and of the section
angles as seen from the element's frame, the stresses are the Hessian of the elastic energy at no stress times the
rates of the strains. A rigid motion has none, so it is never damped, however fast it turns. All costs a quarter of
`damping3d` (`benchmarks.twins`).
"""

from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.beam2d import (
    PlanarCorotated,
    PlanarNodalForces,
    Vec2,
    bow_slopes,
    configuration_variation,
    nodal_forces,
    stress_variation,
    write_forces,
)
from riser_soil.riser.stiffness import ElementStiffness, LineStiffness, of_element

STILL = (0.0, 0.0)


class PlanarChange(NamedTuple):
    """A change of an element's configuration, or its rate."""

    stretch: float  # of the chord
    spin: float  # of the chord
    theta1: float  # of the tangents at the ends, from the chord
    theta2: float


@njit
def _move(at: PlanarCorotated, u: Vec2, w1: float, w2: float) -> PlanarChange:
    """Change of the configuration when the nodes move by u = u2 - u1, in the element's axes, and turn by w_i."""
    spin = u[1] / at.length
    return PlanarChange(u[0], spin, w1 - spin, w2 - spin)


@njit
def _rates_of(at: PlanarCorotated, chord_rate: Array, w1: float, w2: float) -> PlanarChange:
    c, s = at.axis
    return _move(at, (c * chord_rate[0] + s * chord_rate[1], c * chord_rate[1] - s * chord_rate[0]), w1, w2)


@njit
def _rates_change(at: PlanarCorotated, rates: PlanarChange, m: PlanarChange, shift_v: float) -> PlanarChange:
    """Change of the rates in a move that they follow by shift_v; the axes in which they are seen turn, too."""
    stretch = shift_v * m.stretch + m.spin * rates.spin * at.length
    lag = (m.spin * rates.stretch + m.stretch * rates.spin) / at.length
    return PlanarChange(stretch, shift_v * m.spin - lag, shift_v * m.theta1 + lag, shift_v * m.theta2 + lag)


@njit
def _stress_change(
    D: ElementStiffness, at: PlanarCorotated, N: float, rates: PlanarChange, m: PlanarChange, d: PlanarChange
) -> tuple[float, float, float]:
    """Change of the viscous stresses when the element moves by m and the rates change by d."""
    slope1, slope2 = bow_slopes(m.theta1, m.theta2)
    bowing = D.L * (slope1 * rates.theta1 + slope2 * rates.theta2)
    dN, dm1, dm2 = stress_variation(D, at, 0.0, d.stretch + bowing, d.theta1, d.theta2)
    return dN, dm1 + N * D.L * slope1, dm2 + N * D.L * slope2


@njit
def _vary(
    D: ElementStiffness,
    at: PlanarCorotated,
    N: float,
    force: Vec2,
    rates: PlanarChange,
    m: PlanarChange,
    shift_v: float,
) -> PlanarNodalForces:
    dN, dm1, dm2 = _stress_change(D, at, N, rates, m, _rates_change(at, rates, m, shift_v))
    change = nodal_forces(at, dN, dm1, dm2)
    geometric = configuration_variation(at, force, m.stretch, m.spin)
    total = (change.force[0] + geometric[0], change.force[1] + geometric[1])
    return PlanarNodalForces(total, change.moment1, change.moment2)


@njit
def write_element_forces(
    e: int,
    at: PlanarCorotated,
    viscosity: LineStiffness,
    chord_rate: Array,
    turn_rate: Array,
    f: Array,
) -> None:
    """Write viscous forces f (6,) of element e for rates of the chords (ne, 2), m/s, and of the nodes' angles (nn,),
    rad/s.
    """
    rates = _rates_of(at, chord_rate[e], turn_rate[e], turn_rate[e + 1])
    D = of_element(viscosity, e)
    N, m1, m2 = stress_variation(D, at, 0.0, rates.stretch, rates.theta1, rates.theta2)
    write_forces(at.axis, nodal_forces(at, N, m1, m2), f)


@njit
def write_element_tangent(
    e: int,
    at: PlanarCorotated,
    viscosity: LineStiffness,
    chord_rate: Array,
    turn_rate: Array,
    shift_v: float,
    K: Array,
) -> None:
    """Write their derivative K (6, 6) by displacements and angles, which the rates follow by shift_v [1/s]."""
    rates = _rates_of(at, chord_rate[e], turn_rate[e], turn_rate[e + 1])
    D = of_element(viscosity, e)
    N, m1, m2 = stress_variation(D, at, 0.0, rates.stretch, rates.theta1, rates.theta2)
    force = nodal_forces(at, N, m1, m2).force
    c, s = at.axis
    moves = (
        _move(at, STILL, 1.0, 0.0),
        _move(at, (c, -s), 0.0, 0.0),
        _move(at, (s, c), 0.0, 0.0),
        _move(at, STILL, 0.0, 1.0),
    )
    for j in range(4):
        write_forces(at.axis, _vary(D, at, N, force, rates, moves[j], shift_v), K[:, 2 + j])
    for i in range(6):
        K[i, 0], K[i, 1] = -K[i, 3], -K[i, 4]
