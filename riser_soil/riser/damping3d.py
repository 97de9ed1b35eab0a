"""Stiffness-proportional (Kelvin-Voigt) damping of the spatial elements of `beam3d`.

The stiffnesses here are viscosities: beta EA [N s], beta EI and beta GJ [N m2 s]. Rates are those of the chord (m/s)
and the spatial angular velocities of the nodes (rad/s). Strains do not change in a rigid motion, so it is never damped,
however fast it turns.
"""

from typing import NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.beam3d import (
    STILL,
    Shape,
    SpatialChange,
    SpatialResponse,
    forces_change,
    move,
    respond,
    strain_of,
    write_forces,
)
from riser_soil.riser.corotation import NO_LOAD, SpatialNodalForces, rate, rate_variation
from riser_soil.riser.rotations import rows_to_increments
from riser_soil.riser.stiffness import ElementStiffness, LineStiffness, of_element
from riser_soil.riser.strain3d import linear_stress, strain_change_variation, total
from riser_soil.riser.vectors import (
    Vec,
    add,
    cross,
    matrix,
    matvec,
    scale,
    sub,
    transpose,
    vecmat,
    vector,
)


class ElementVelocities(NamedTuple):
    """Velocities of an element in its frame, and what they do to it."""

    chord: Vec  # rate of the chord
    spin1: Vec  # angular velocities of the nodes
    spin2: Vec
    rates: SpatialChange


class NodeRotations(NamedTuple):
    """Orientation of the nodes, each (nn, 3, 3) or (nn, 3): see `rotations`; R is the present frame."""

    R: Array
    H: Array
    Rn: Array
    Theta: Array


@njit
def _flow(at: Shape, chord_rate: Vec, spin1: Vec, spin2: Vec) -> ElementVelocities:
    axes = at.frame.axes
    c, o1, o2 = matvec(axes, chord_rate), matvec(axes, spin1), matvec(axes, spin2)
    return ElementVelocities(c, o1, o2, move(at, c, o1, o2))


@njit
def _respond(D: ElementStiffness, at: Shape, flow: ElementVelocities) -> SpatialResponse:
    strain_rates = strain_of(D.L, at, flow.rates)
    return respond(D.L, at, strain_rates, linear_stress(D, strain_rates), NO_LOAD)


@njit
def _rates_change(at: Shape, flow: ElementVelocities, m: SpatialChange, dc: Vec, do1: Vec, do2: Vec) -> SpatialChange:
    """Change of the rates when the element moves by m and its velocities change by dc, do1 and do2.

    The axes in which they are seen turn, and so do the ends within them.
    """
    change = move(
        at,
        sub(dc, cross(m.spin, flow.chord)),
        sub(do1, cross(m.spin, flow.spin1)),
        sub(do2, cross(m.spin, flow.spin2)),
    )
    lag = scale(m.stretch / at.frame.length, flow.rates.spin)
    spin1, spin2 = add(change.spin1, lag), add(change.spin2, lag)
    da = add(rate(at.end1, spin1), rate_variation(at.end1, flow.rates.spin1, m.spin1))
    db = add(rate(at.end2, spin2), rate_variation(at.end2, flow.rates.spin2, m.spin2))
    return SpatialChange(change.stretch, sub(change.spin, lag), spin1, spin2, da, db)


@njit
def _vary(
    D: ElementStiffness,
    at: Shape,
    flow: ElementVelocities,
    response: SpatialResponse,
    m: SpatialChange,
    d: SpatialChange,
) -> SpatialNodalForces:
    """Change of an element's forces when it moves by m and its rates change by d."""
    bending = strain_change_variation(D.L, at.stations, flow.rates.da, flow.rates.db, m.da, m.db)
    ds = linear_stress(D, total(strain_of(D.L, at, d), bending))
    return forces_change(D.L, at, response, m, strain_of(D.L, at, m), ds)


@njit
def _element(
    D: ElementStiffness, at: Shape, chord_rate: Array, spin1: Array, spin2: Array
) -> tuple[ElementVelocities, SpatialResponse]:
    flow = _flow(at, vector(chord_rate), vector(spin1), vector(spin2))
    return flow, _respond(D, at, flow)


@njit
def write_element_forces(
    e: int,
    at: Shape,
    viscosity: LineStiffness,
    chord_rate: Array,
    spin: Array,
    f: Array,
) -> None:
    """Write viscous forces f (12,) of element e, conjugate to displacements and spatial spins.

    chord_rate: (ne, 3); spin: (nn, 3) spatial angular velocities.
    """
    D = of_element(viscosity, e)
    _, response = _element(D, at, chord_rate[e], spin[e], spin[e + 1])
    write_forces(at.frame.axes, response.forces, f)


@njit
def _turn_column(
    D: ElementStiffness, at: Shape, flow: ElementVelocities, response: SpatialResponse, w: Vec, faster: Vec, end: int
) -> SpatialNodalForces:
    """Change of the forces when one end spins by w and its angular velocity grows by `faster`, both in global axes."""
    axes = at.frame.axes
    turned, spinning = matvec(axes, w), matvec(axes, faster)
    if end == 0:
        m = move(at, STILL, turned, STILL)
        d = _rates_change(at, flow, m, STILL, add(cross(turned, flow.spin1), spinning), STILL)
    else:
        m = move(at, STILL, STILL, turned)
        d = _rates_change(at, flow, m, STILL, STILL, add(cross(turned, flow.spin2), spinning))
    return _vary(D, at, flow, response, m, d)


@njit
def _shift_columns(
    D: ElementStiffness, at: Shape, flow: ElementVelocities, response: SpatialResponse, shift_v: float, K: Array
) -> None:
    """Write the columns of both nodes' displacements to K (12, 12)."""
    axes = at.frame.axes
    for k in range(3):
        unit = (axes[0][k], axes[1][k], axes[2][k])
        m = move(at, unit, STILL, STILL)
        d = _rates_change(at, flow, m, scale(shift_v, unit), STILL, STILL)
        write_forces(axes, _vary(D, at, flow, response, m, d), K[:, 6 + k])
        for i in range(12):
            K[i, k] = -K[i, 6 + k]


@njit
def write_element_tangent(
    e: int,
    at: Shape,
    viscosity: LineStiffness,
    chord_rate: Array,
    spin: Array,
    nodes: NodeRotations,
    shift_v: float,
    K: Array,
) -> None:
    """Write the derivative K (12, 12), by displacements and rotation vectors, of the forces conjugate to them.

    Velocities and body-axes angular velocities follow by shift_v [1/s].
    """
    D = of_element(viscosity, e)
    flow, response = _element(D, at, chord_rate[e], spin[e], spin[e + 1])
    _shift_columns(D, at, flow, response, shift_v, K)
    for end in range(2):
        n, first = e + end, 3 + 6 * end
        H, R = matrix(nodes.H[n]), matrix(nodes.R[n])
        for k in range(3):
            w, faster = transpose(H)[k], scale(shift_v, transpose(R)[k])
            write_forces(at.frame.axes, _turn_column(D, at, flow, response, w, faster, end), K[:, first + k])
    for end in range(2):
        n, moment = e + end, response.forces.moment2 if end else response.forces.moment1
        spatial = vecmat(moment, at.frame.axes)
        H, Rn, Theta = matrix(nodes.H[n]), matrix(nodes.Rn[n]), vector(nodes.Theta[n])
        rows_to_increments(K, 3 + 6 * end, spatial, H, Rn, Theta)
