"""Strain energy of a two-node Euler-Bernoulli element in one bending plane.

The end rotations a and b (rad) are measured from the chord. Bending follows from the cubic deflection;
half its square slope, averaged over the element, is the shallow-arch term of the axial strain

    strain = (l - l0)/L + bow(a, b) - bow(a0, b0),    bow(a, b) = (2 a^2 - a b + 2 b^2)/30,

which makes the two-node element fourth-order accurate on curved lines.
Source: Crisfield, Non-linear Finite Element Analysis of Solids and Structures, vol. 1 (1991), chapter
7.
"""

from riser_soil.core.compiled import njit


@njit
def bow(a: float, b: float) -> float:
    """Half the mean square slope of the deflection from the chord."""
    return (2.0 * a * a - a * b + 2.0 * b * b) / 30.0


@njit
def bow_slopes(a: float, b: float) -> tuple[float, float]:
    """Derivatives of `bow` by a and b; linear, so they map variations too."""
    return (4.0 * a - b) / 30.0, (4.0 * b - a) / 30.0


@njit
def end_moments(EI_per_L: float, a: float, b: float) -> tuple[float, float]:
    """Moments (N m) conjugate to the end rotations a and b of a cubic deflection."""
    return EI_per_L * (4.0 * a + 2.0 * b), EI_per_L * (2.0 * a + 4.0 * b)
