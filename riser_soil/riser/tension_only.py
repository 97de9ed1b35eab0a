"""Axial law of elements without bending stiffness: they go slack instead of bearing compression.

Chain and rope can't be pressed, as they buckle at once. A taut element has the tension EA e at the strain e, one that
is slack almost none,

    N = EA e        taut,
    N = r EA (1 + e)    slack,

so that it pulls its nodes towards each other like a weak spring of no length of its own: N > 0 always, so no slack
element makes the line unstable, and what lies in a heap on the seabed spreads evenly. The lines meet at e0 = r/(1 - r).
From e0 - soft to e0 + soft the stiffness grows steadily from one to the other; outside, the law is as above. N is the
derivative of the energy EA psi(e) per length. Elements with bending stiffness have r = 1: N = EA e always.

Where nothing pulls, nothing keeps a slack element's ends from turning over under its weight. The energy fold b^3/3 per
length does, b being half the mean square slope over the chord (`beam2d.bow`): the slack element sags to angles of some
30 degrees. On a taut one it is of the sixth order in its small angles, and doesn't count.
"""

from riser_soil.core.compiled import njit


@njit
def pulled(strain: float, share: float, soft: float) -> tuple[float, float]:
    """N/EA and its derivative by the strain."""
    if share == 1.0:
        return strain, 1.0
    beyond = strain - share / (1.0 - share) + soft  # of the strain where the stiffness begins to grow
    if beyond >= 2.0 * soft:
        return strain, 1.0
    if beyond <= 0.0:
        return share * (1.0 + strain), share
    grown = (1.0 - share) * 0.5 * beyond / soft
    return share * (1.0 + strain) + 0.5 * grown * beyond, share + grown


@njit
def stored(strain: float, share: float, soft: float) -> float:
    """psi, the integral of N/EA, never negative: r (1 + e)^2/2 where slack, beyond a constant e^2/2 where taut."""
    if share == 1.0:
        return 0.5 * strain * strain
    middle = share / (1.0 - share)
    beyond = strain - middle + soft
    if beyond >= 2.0 * soft:
        return 0.5 * strain * strain + 0.5 * middle + (1.0 - share) * soft * soft / 6.0
    psi = 0.5 * share * (1.0 + strain) ** 2
    if beyond > 0.0:
        psi += (1.0 - share) * beyond**3 / (12.0 * soft)
    return psi


@njit
def unfolding(bow: float, fold: float) -> tuple[float, float]:
    """Derivative of fold b^3/3 by b = bow [N], and its own."""
    return fold * bow * bow, 2.0 * fold * bow
