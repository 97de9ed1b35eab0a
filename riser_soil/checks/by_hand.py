"""Checks by hand of a line at rest: effective tensions at its ends and touchdown points, as a cable or pulled straight.

End A is the line's start, end B its end.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.assembly.shape import tensions_of_taut
from riser_soil.checks.bending_plausibility import nodes_on_ground
from riser_soil.core.arrays import Array
from riser_soil.riser.catenary import Catenary
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Support

END_NAMES = {"start": "end A", "end": "end B"}
TOUCHING = 1e-6  # of the length: what rests on the seabed


def by_hand(riser: LineAssembly) -> Iterator[str]:
    """Effective tensions at the ends and touchdown points, at rest: of the cable without bending stiffness, and by
    formula beside it.
    """
    start, end = riser.scene.line.start, riser.scene.line.end
    if not (isinstance(start, Support) and isinstance(end, Support)):
        return
    places = np.array(start.position), np.array(end.position)
    if riser.catenary is not None and riser.catenary.slack == 0.0:
        yield from _of_cable(riser, riser.catenary)
    elif (tension := tensions_of_taut(riser.elements, *places)) is not None:
        yield _of_taut(riser.elements, tension, *places)


def _of_cable(riser: LineAssembly, cable: Catenary) -> Iterator[str]:
    """Lines with the cable's tensions beside H + sum of w dz, from the lowest point up: dT = w dz along a cable,
    whatever its shape. An attachment's weight P adds some P sin(slope).
    """
    z = cable.curve.position[:, 2]
    low, near = int(z.argmin()), TOUCHING * float(riser.line.arc[-1])
    yield f"by hand, at rest as a cable: H = {_kN(cable.H)} kN, lowest at z = {z[low]:.4g} m"
    for name, at, part in (("start", 0, slice(None, low)), ("end", -1, slice(low, None))):
        if z[at] - z[low] > near:
            terms = _by_weight(riser.elements.weight[part], np.diff(z)[part] * (1.0 if name == "end" else -1.0))
            added = _attached_tension(riser, cable, low, name == "end")
            summands = [_kN(cable.H), *(f"{w / 1e3:.4g} * {h:.5g}" for w, h in terms), *([_kN(added)] if added else [])]
            total = cable.H + sum(w * h for w, h in terms) + added
            formula = "H + sum of w h" + (" + attachments" if added else "")
            where, tension = _end_words(name, z), _kN(cable.tension[at])
            yield f"  {where}: effective tension {tension} kN; {formula} = {' + '.join(summands)} = {_kN(total)} kN"
            yield from _touchdown(riser, cable, name)


def _end_words(name: str, z: Array) -> str:
    """End A is the start, end B the end; the higher one is the hang-off."""
    role = "hang-off" if (z[-1] > z[0]) == (name == "end") else "lower end"
    return f"{role} ({END_NAMES[name]})"


def _touchdown(riser: LineAssembly, cable: Catenary, name: str) -> Iterator[str]:
    """The touchdown point that hangs from an end, where the line lies on level ground: the pipe between them weighs as
    much as the cable pulls up at the end, V = sqrt(T^2 - H^2).
    """
    lying = nodes_on_ground(riser)
    if lying.size < 2:
        return
    at, near = (-1, lying[-1]) if name == "end" else (0, lying[0])
    arc, end = riser.line.arc, riser.line.arc[at]
    V = float(np.sqrt(max(cable.tension[at] ** 2 - cable.H**2, 0.0)))
    arcs = _arcs_that_carry(riser, V, name == "end")
    if not arcs.size:
        return
    touchdown = float(arcs[np.abs(arcs - arc[near]).argmin()])
    place = np.array([np.interp(touchdown, arc, each) for each in cable.curve.position[:, :2].T])
    layback = float(np.linalg.norm(cable.curve.position[at, :2] - place))
    element = min(int(lying[-1]), arc.size - 2) if name == "end" else max(int(lying[0]) - 1, 0)
    earlier = float(np.sqrt(riser.elements.EI_y[element] / cable.H))
    yield (
        f"  TDP at arc {touchdown:.5g} m, {layback:.5g} m from the {_end_words(name, cable.curve.position[:, 2])} in "
        f"plan: V = sqrt(T^2 - H^2) = {_kN(V)} kN carries {abs(end - touchdown):.5g} m; a stiff pipe touches down some "
        f"sqrt(EI/H) = {earlier:.3g} m before"
    )


def _arcs_that_carry(riser: LineAssembly, V: float, towards_end: bool) -> Array:
    """Arc lengths [m] between which and an end the line weighs V [N] in water, its attachments included."""
    arc, weight = riser.line.arc, riser.elements.weight * riser.elements.length
    for each in riser.attachments:
        weight[riser.line.element_at(each.arc)[0]] += each.net_weight
    carried = np.concatenate([[0.0], np.cumsum(weight[::-1] if towards_end else weight)]) - V
    arcs = arc[::-1] if towards_end else arc
    here = np.flatnonzero((carried[:-1] <= 0.0) != (carried[1:] <= 0.0))
    share = carried[here] / (carried[here] - carried[here + 1])
    return np.asarray(arcs[here] + share * (arcs[here + 1] - arcs[here]))


def _by_weight(weight: Array, climb: Array) -> list[tuple[float, float]]:
    """Height climbed (m) in pipe of each weight per length (N/m), in the order along the riser."""
    distinct = dict.fromkeys(float(w) for w in weight)
    return [(w, float(climb[weight == w].sum())) for w in distinct]


def _attached_tension(riser: LineAssembly, cable: Catenary, low: int, towards_end: bool) -> float:
    """Tension that attachments between the lowest point and an end add there: weight times the sine of the slope [N].
    """
    arc, z = riser.line.arc, cable.curve.position[:, 2]
    steep = np.diff(z) / np.linalg.norm(cable.curve.chord, axis=1) * (1.0 if towards_end else -1.0)
    here = (each for each in riser.attachments if (each.arc > arc[low]) == towards_end)
    return float(sum(each.net_weight * steep[riser.line.element_at(each.arc)[0]] for each in here))


def _of_taut(elements: Elements, tension: Array, start: Array, end: Array) -> str:
    distance, rise = float(np.linalg.norm(end - start)), float(end[2] - start[2])
    half = 0.5 * elements.weight * elements.length * rise / distance
    first, last = tension[0] - half[0], tension[-1] + half[-1]
    return (
        f"by hand, at rest, pulled straight to {distance:.6g} m, by the sum of T l/EA and T growing by w dz: effective "
        f"tension at end A {_kN(first)} kN, at end B {_kN(last)} kN"
    )


def _kN(force: float) -> str:
    return f"{force / 1e3:.4g}"
