"""Stiffnesses of a line's elements as the beam's kernels read them."""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.tension_only import ElementLaw, Law, law_at

Number = TypeVar("Number", Array, float)
AxialLaw = TypeVar("AxialLaw", Law, ElementLaw)


class Stiffness(NamedTuple, Generic[Number, AxialLaw]):
    """Arc length and section stiffnesses: of all elements of a line, each (ne,), or of one of them.

    Viscosities, times seconds, are made of them by `viscosity`.
    """

    L: Number  # m
    EA: Number  # N
    EI_y: Number  # N m2, bending about the second section axis, in a plane the one normal to it
    EI_z: Number  # N m2, bending about the third section axis
    GJ: Number  # N m2, positive in space
    law: AxialLaw  # `tension_only`


LineStiffness = Stiffness[Array, Law]
ElementStiffness = Stiffness[float, ElementLaw]


def viscosity(D: LineStiffness, time: Array) -> LineStiffness:
    """The stiffnesses times seconds (ne,)."""
    return Stiffness(D.L, time * D.EA, time * D.EI_y, time * D.EI_z, time * D.GJ, D.law)


@njit
def of_element(line: LineStiffness, e: int) -> ElementStiffness:
    """The stiffnesses of element e."""
    return Stiffness(line.L[e], line.EA[e], line.EI_y[e], line.EI_z[e], line.GJ[e], law_at(line.law, e))


@njit
def with_EA(D: ElementStiffness, EA: float) -> ElementStiffness:
    """The stiffnesses with another EA [N]."""
    return Stiffness(D.L, EA, D.EI_y, D.EI_z, D.GJ, D.law)
