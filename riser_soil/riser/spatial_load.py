"""Uniform load per length on elements in space, seen from the element's frame: what it does to their bow.

An element bows from its chord by a cubic with the swings (y_i, z_i) of its ends, see `swing_twist`. So a load w per
unstressed length L, of components (w_1, w_2, w_3) along the frame, has the potential

    V = -w.(x1 + x2) L/2 - [w_2 (z_1 - z_2) - w_3 (y_1 - y_2)] L^2/12.

Its first part is a constant force on each node. The second is here; it changes with the swings, and as the frame turns
under the load. Swings are the angles by which `strain3d` measures bending: the cubic through the unit tangents would
cost accuracy on coarse meshes. In a plane `planar_load` is the same.
"""

from typing import NamedTuple

from riser_soil.core.compiled import njit
from riser_soil.riser.vectors import Mat, Vec, cross, matvec


class BowLoad(NamedTuple):
    """A load on an element, seen from its frame."""

    twelfth: float  # L^2/12, m2
    w: Vec  # per length, N/m


NO_LOAD = BowLoad(0.0, (0.0, 0.0, 0.0))


@njit
def bow_load(axes: Mat, L: float, w: Vec) -> BowLoad:
    """That of w [N/m], in global axes, on an element of arc length L whose frame has these axes."""
    return BowLoad(L * L / 12.0, matvec(axes, w))


@njit
def turned(load: BowLoad, spin: Vec) -> BowLoad:
    """How a load that is fixed in space changes as the frame spins."""
    return BowLoad(load.twelfth, cross(load.w, spin))


@njit
def bow_potential(load: BowLoad, a: Vec, b: Vec) -> float:
    """Second part of V [J], for the angles a and b (tau, y, z) of the ends."""
    return -load.twelfth * (load.w[1] * (a[2] - b[2]) - load.w[2] * (a[1] - b[1]))


@njit
def end_moment(load: BowLoad) -> Vec:
    """Fixed-end moment: conjugate to the angles of the first end [N m]; that of the second is its opposite."""
    return (0.0, load.twelfth * load.w[2], -load.twelfth * load.w[1])


@njit
def chord_force(load: BowLoad, length: float, a: Vec, b: Vec) -> Vec:
    """Force on node 2 [N], as the frame of a chord of this length turns under the load; linear in the angles."""
    along = load.twelfth * load.w[0] / length
    return (0.0, along * (a[2] - b[2]), -along * (a[1] - b[1]))
