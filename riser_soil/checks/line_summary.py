"""Line summary of `riser-soil check`: segments with masses, weights and stiffnesses, and tensions at rest by hand."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import accumulate

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.assembly.shape import tensions_of_taut
from riser_soil.core.arrays import Array
from riser_soil.riser.catenary import Catenary
from riser_soil.riser.sections import Elements
from riser_soil.scene.riser import Support

HEADS = ("line type", "from m", "to m", "OD m", "ID m", "empty kg/m", "filled kg/m", "in air N/m", "in water N/m")
STIFFNESSES = ("EA N", "EI N.m2")
TOUCHING = 1e-6  # of the length: what rests on the seabed


def line_summary(assembly: Assembly) -> list[str]:
    """Lines of text."""
    return [*_table(_rows(assembly)), *_whole(assembly), *tensions_by_hand(assembly)]


def _table(rows: list[tuple[str, ...]]) -> Iterator[str]:
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    for row in rows:
        name, *numbers = zip(row, widths, strict=True)
        yield "  ".join([f"  {name[0]:<{name[1]}}", *(f"{cell:>{width}}" for cell, width in numbers)])


def _rows(assembly: Assembly) -> list[tuple[str, ...]]:
    scene, elements = assembly.scene, assembly.elements
    rows: list[tuple[str, ...]] = [(*HEADS, *STIFFNESSES)]
    begin = 0.0
    firsts = accumulate((segment.element_count for segment in scene.riser.segments), initial=0)
    for segment, first in zip(scene.riser.segments, firsts, strict=False):
        e = first + segment.element_count // 2  # beyond bend stiffeners
        line = scene.line_types[segment.line_type]
        mass, end = float(elements.mass[e]), begin + segment.length
        numbers = (begin, end, line.outer_diameter, line.inner_diameter, line.mass, mass or None)
        weights = (scene.gravity * mass if mass else None, float(elements.weight[e]))
        rows.append((segment.line_type, *map(_told, (*numbers, *weights, line.EA, max(line.bending_stiffness)))))
        begin = end
    return rows


def _told(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _whole(assembly: Assembly) -> Iterator[str]:
    """Length and weights of the whole line."""
    elements = assembly.elements
    mass, wet = (float(each @ elements.length) for each in (elements.mass, elements.weight))
    held = sum(attachment.net_weight for attachment in assembly.attachments)
    parts = [f"line: {elements.length.sum():.6g} m"]
    if mass > 0.0:
        parts.append(f"{mass / 1e3:.4g} t with contents, weight in air {assembly.scene.gravity * mass / 1e3:.4g} kN")
    parts.append(f"in water {wet / 1e3:.4g} kN")
    if assembly.attachments:
        parts.append(f"with attachments {(wet + held) / 1e3:.4g} kN")
    yield ", ".join(parts)


def tensions_by_hand(assembly: Assembly) -> Iterator[str]:
    """Effective tensions at the ends, at rest: of the cable without bending stiffness, and by formula beside it."""
    start, end = assembly.scene.riser.start, assembly.scene.riser.end
    if not (isinstance(start, Support) and isinstance(end, Support)):
        return
    places = np.array(start.position), np.array(end.position)
    if assembly.catenary is not None and assembly.catenary.slack == 0.0:
        yield from _of_cable(assembly, assembly.catenary)
    elif (tension := tensions_of_taut(assembly.elements, *places)) is not None:
        yield _of_taut(assembly.elements, tension, *places)


def _of_cable(assembly: Assembly, cable: Catenary) -> Iterator[str]:
    """Beside the cable's tensions H + sum of w dz, from the lowest point up: dT = w dz along a cable, whatever its
    shape. An attachment's weight P adds some P sin(slope).
    """
    z = cable.curve.position[:, 2]
    low, near = int(z.argmin()), TOUCHING * float(assembly.line.arc[-1])
    yield f"tensions at rest, as a cable: horizontal {_kN(cable.H)} kN, lowest at z = {z[low]:.4g} m"
    for name, at, part in (("start", 0, slice(None, low)), ("end", -1, slice(low, None))):
        if z[at] - z[low] > near:
            terms = _by_weight(assembly.elements.weight[part], np.diff(z)[part] * (1.0 if name == "end" else -1.0))
            held = _held(assembly, cable, low, name == "end")
            told = [_kN(cable.H), *(f"{w / 1e3:.4g} * {h:.5g}" for w, h in terms), *([_kN(held)] if held else [])]
            by_hand = cable.H + sum(w * h for w, h in terms) + held
            formula = "H + sum of w h" + (" + attachments" if held else "")
            yield f"  {name}: {_kN(cable.tension[at])} kN; by hand {formula} = {' + '.join(told)} = {_kN(by_hand)} kN"


def _by_weight(weight: Array, climb: Array) -> list[tuple[float, float]]:
    """Height climbed (m) in pipe of each weight per length (N/m), in the order along the riser."""
    distinct = dict.fromkeys(float(w) for w in weight)
    return [(w, float(climb[weight == w].sum())) for w in distinct]


def _held(assembly: Assembly, cable: Catenary, low: int, towards_end: bool) -> float:
    """Of the attachments between the lowest point and an end: weight times the sine of the slope there [N]."""
    arc, z = assembly.line.arc, cable.curve.position[:, 2]
    steep = np.diff(z) / np.linalg.norm(cable.curve.chord, axis=1) * (1.0 if towards_end else -1.0)
    here = (each for each in assembly.attachments if (each.arc > arc[low]) == towards_end)
    return float(sum(each.net_weight * steep[assembly.line.place(each.arc)[0]] for each in here))


def _of_taut(elements: Elements, tension: Array, start: Array, end: Array) -> str:
    distance, rise = float(np.linalg.norm(end - start)), float(end[2] - start[2])
    half = 0.5 * elements.weight * elements.length * rise / distance
    first, last = tension[0] - half[0], tension[-1] + half[-1]
    return (
        f"tensions at rest by hand, pulled straight to {distance:.6g} m, by the sum of T l/EA and T growing by w dz: "
        f"start {_kN(first)} kN, end {_kN(last)} kN"
    )


def _kN(force: float) -> str:
    return f"{force / 1e3:.4g}"
