"""Axial law of elements without bending stiffness: they go slack instead of bearing compression.

Chain and rope can't be pressed, as they buckle at once. A taut element has the tension EA e at the strain e, one that
is slack almost none,

    N = EA e        taut,
    N = r EA (1 + e)    slack,

so that it pulls its nodes towards each other like a weak spring of no length of its own: N > 0 always, so no slack
element makes the line unstable, and what lies in a heap on the seabed spreads evenly. The lines meet at e0 = r/(1 - r).
From e0 - soft to e0 + soft the stiffness grows steadily from one to the other; outside, the law is as above. N is the
derivative of the energy EA psi(e) per length. Lines with bending stiffness have N = EA e always, and so have those of
their elements with r = 1 which hang on a chain.

Where nothing pulls, nothing keeps a slack element's ends from turning over under its weight. The energy fold b^3/3 per
length does, b being half the mean square slope over the chord (`beam2d.bow`): on a taut element it is of the sixth
order in its small angles, and doesn't count.

In a heap chords l are short, and may vanish. The angles from a chord mean nothing there, and forces that turn it grow
beyond all bounds as moments over l. So an element whose chord is a share l/L of its length has the energy

    U = g U_bowed + (1 - g) U_heaped,    g(l/L) from 0 below GONE to 1 above BOWED,

U_bowed being all of the above with the load on its bow, and U_heaped that of a spring without a bow,

    U_heaped = r EA L [(l/L)^2 + (1 - cos of the angle between its ends)]/2,

whose forces are linear in the chord, so that its direction does not matter. The second term keeps its ends from
spinning.
"""

from typing import Any, NamedTuple

from riser_soil.core.arrays import Array
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.compiled import njit

GONE, BOWED = 0.5, 0.9  # chord over length: shares between which an element gets its bow


class Linear(NamedTuple):
    """The law of a line whose elements all bend."""


class TensionOnly(NamedTuple):
    """Constants (ne,) of a line with elements that go slack; fold N."""

    share: Array
    soft: Array
    fold: Array


class SlackElement(NamedTuple):
    """Constants of one element."""

    share: float
    soft: float
    fold: float


Law = Linear | TensionOnly  # of a line
ElementLaw = Linear | SlackElement


@bound_by_type
def law_at(law: Any, e: int) -> Any:
    """Law of element e."""


@law_at.of(Linear)
def _linear_at(law: Linear, e: int) -> Linear:
    return law


@law_at.of(TensionOnly)
def _slack_at(law: TensionOnly, e: int) -> SlackElement:
    return SlackElement(law.share[e], law.soft[e], law.fold[e])


@bound_by_type
def pulled(law: Any, strain: float) -> Any:
    """N/EA and its derivative by the strain."""


@pulled.of(Linear)
def _linear(law: Linear, strain: float) -> tuple[float, float]:
    return strain, 1.0


@pulled.of(SlackElement)
def _pulled(law: SlackElement, strain: float) -> tuple[float, float]:
    share, soft = law.share, law.soft
    if share == 1.0:
        return strain, 1.0
    beyond = strain - share / (1.0 - share) + soft  # of the strain where the stiffness begins to grow
    if beyond >= 2.0 * soft:
        return strain, 1.0
    if beyond <= 0.0:
        return share * (1.0 + strain), share
    grown = (1.0 - share) * 0.5 * beyond / soft
    return share * (1.0 + strain) + 0.5 * grown * beyond, share + grown


@bound_by_type
def stored(law: Any, strain: float) -> Any:
    """psi, the integral of N/EA, never negative: r (1 + e)^2/2 where slack, beyond a constant e^2/2 where taut."""


@stored.of(Linear)
def _square(law: Linear, strain: float) -> float:
    return 0.5 * strain * strain


@stored.of(SlackElement)
def _stored(law: SlackElement, strain: float) -> float:
    share, soft = law.share, law.soft
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


@bound_by_type
def with_fold(law: Any, N: float, bow: float) -> Any:
    """N and what fold b^3/3 adds to it for b = bow [N]."""


@with_fold.of(Linear)
def _alone(law: Linear, N: float, bow: float) -> float:
    return N


@with_fold.of(SlackElement)
def _with_fold(law: SlackElement, N: float, bow: float) -> float:
    return N + law.fold * bow * bow


@bound_by_type
def with_fold_change(law: Any, value: float, lever: float, bow: float, change: float) -> Any:
    """A value and what `with_fold` adds to it on a lever [m] as the bow changes."""


@with_fold_change.of(Linear)
def _value_alone(law: Linear, value: float, lever: float, bow: float, change: float) -> float:
    return value


@with_fold_change.of(SlackElement)
def _with_fold_change(law: SlackElement, value: float, lever: float, bow: float, change: float) -> float:
    return value + lever * 2.0 * law.fold * bow * change


@bound_by_type
def with_fold_energy(law: Any, energy: float, bow: float) -> Any:
    """An energy per length and fold b^3/3 [N]."""


@with_fold_energy.of(Linear)
def _energy_alone(law: Linear, energy: float, bow: float) -> float:
    return energy


@with_fold_energy.of(SlackElement)
def _with_fold_energy(law: SlackElement, energy: float, bow: float) -> float:
    return energy + law.fold * bow**3 / 3.0


class Heaped(NamedTuple):
    """An element's state as a spring: g and its derivatives by the chord's length over L; stiffness r EA/L [N/m].

    Elements with g = 1 have all of their bow.
    """

    g: float
    slope: float
    bend: float
    stiffness: float


@bound_by_type
def heaped(law: Any, e: int, chord: Array, L: float, EA: float) -> Any:
    """State of element e with its chord (d,) m; None in a line whose elements all bend. A kernel that gets it and
    returns first if it is None has nothing more compiled for such a line.
    """


@heaped.of(Linear)
def _never(law: Linear, e: int, chord: Array, L: float, EA: float) -> None:
    return None


@heaped.of(TensionOnly)
def _heaped(law: TensionOnly, e: int, chord: Array, L: float, EA: float) -> Heaped:
    square, k = _square_of(chord), law.share[e] * EA / L
    if law.share[e] >= 1.0 or square >= (BOWED * L) ** 2:
        return Heaped(1.0, 0.0, 0.0, k)
    x = (square**0.5 / L - GONE) / (BOWED - GONE)
    if x <= 0.0:
        return Heaped(0.0, 0.0, 0.0, k)
    y, width = 1.0 - x, BOWED - GONE
    g = x * x * x * (10.0 - 15.0 * x + 6.0 * x * x)
    return Heaped(g, 30.0 * x * x * y * y / width, 60.0 * x * y * (y - x) / (width * width), k)


@njit
def _square_of(chord: Array) -> float:
    square = 0.0
    for i in range(chord.size):
        square += chord[i] * chord[i]
    return square


@njit
def blended(at: Heaped, bowed: float, spring: float) -> float:
    """An energy, force or stiffness of both; where there is no bow its own may be no number."""
    return spring if at.g == 0.0 else at.g * bowed + (1.0 - at.g) * spring


@njit
def spring_energy(at: Heaped, chord: Array) -> float:
    """Energy of the chord's stretch alone [J]."""
    return 0.5 * at.stiffness * _square_of(chord)


@njit
def set_spring_forces(at: Heaped, chord: Array, L: float, w: Array, f: Array) -> None:
    """Set f (n,): the chord's pull on both nodes, and half of the load w per length [N/m] on each."""
    d, half = chord.size, f.size // 2
    f[:] = 0.0
    for i in range(d):
        f[i] = -at.stiffness * chord[i] - 0.5 * L * w[i]
        f[half + i] = at.stiffness * chord[i] - 0.5 * L * w[i]


@njit
def set_spring_tangent(at: Heaped, d: int, K: Array) -> None:
    """Set K (n, n), the derivative of `set_spring_forces`."""
    half = K.shape[0] // 2
    K[:, :] = 0.0
    for i in range(d):
        K[i, i] = K[half + i, half + i] = at.stiffness
        K[i, half + i] = K[half + i, i] = -at.stiffness


@njit
def blend_tangent(at: Heaped, chord: Array, L: float, more: float, f: Array, K: Array, fs: Array, Ks: Array) -> None:
    """Make K (n, n) of the bowed element that of both, before `blend_forces`; more: energy of the bowed element less
    that of the spring [J]; f and fs (n,): of both, Ks of the spring.
    """
    n, d = f.size, chord.size
    half = n // 2
    for i in range(n):
        for j in range(n):
            K[i, j] = blended(at, K[i, j], Ks[i, j])
    if at.g == 0.0:
        return
    length = _square_of(chord) ** 0.5
    by, round_chord = at.slope / L, more * at.slope / (L * length)
    along = more * at.bend / (L * L) - round_chord
    for i in range(d):
        x = chord[i] / length
        for k in range(n):
            change = by * x * (f[k] - fs[k])
            K[i, k] -= change
            K[half + i, k] += change
            K[k, i] -= change
            K[k, half + i] += change
        for j in range(d):
            own = along * x * chord[j] / length + (round_chord if i == j else 0.0)
            K[i, j] += own
            K[half + i, half + j] += own
            K[i, half + j] -= own
            K[half + i, j] -= own


@njit
def blend_forces(at: Heaped, chord: Array, L: float, more: float, f: Array, fs: Array) -> None:
    """Make forces f (n,) of the bowed element those of both; arguments as in `blend_tangent`."""
    n, d = f.size, chord.size
    for i in range(n):
        f[i] = blended(at, f[i], fs[i])
    if at.g == 0.0:
        return
    by = more * at.slope / (L * _square_of(chord) ** 0.5)
    for i in range(d):
        f[i] -= by * chord[i]
        f[n // 2 + i] += by * chord[i]


@njit
def blend_viscous_forces(at: Heaped, rate: Array, f: Array) -> None:
    """Make viscous forces f (n,) of the bowed element those of both; rate (d,): of the chord [m/s]. The state is that
    of viscosities in place of stiffnesses.
    """
    half = f.size // 2
    for i in range(f.size):
        f[i] = 0.0 if at.g == 0.0 else at.g * f[i]
    for i in range(rate.size):
        pull = (1.0 - at.g) * at.stiffness * rate[i]
        f[i] -= pull
        f[half + i] += pull


@njit
def blend_viscous_tangent(
    at: Heaped, chord: Array, L: float, rate: Array, shift_v: float, f: Array, K: Array
) -> None:
    """Make the derivative K (n, n) of the bowed element's viscous forces f (n,) that of both; rates follow by shift_v
    [1/s].
    """
    n, d = f.size, chord.size
    half = n // 2
    for i in range(n):
        for j in range(n):
            K[i, j] = 0.0 if at.g == 0.0 else at.g * K[i, j]
    for i in range(d):
        own = (1.0 - at.g) * at.stiffness * shift_v
        K[i, i] += own
        K[half + i, half + i] += own
        K[i, half + i] -= own
        K[half + i, i] -= own
    if at.g == 0.0:
        return
    by = at.slope / (L * _square_of(chord) ** 0.5)
    for i in range(n):
        less = 0.0
        if i < d:
            less = -at.stiffness * rate[i]
        elif half <= i < half + d:
            less = at.stiffness * rate[i - half]
        for j in range(d):
            change = by * (f[i] - less) * chord[j]
            K[i, j] -= change
            K[i, half + j] += change
