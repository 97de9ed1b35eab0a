"""Vessels of a data file: where they are, and how they answer the waves.

A vessel's axes are those of a scene: x forward, y to port, z up; directions of RAOs count from its heading, 0 from
astern. Signs and phases of RAOs are as the vessel type says.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator
from typing import Any

import numpy as np

from riser_soil.orcaflex.data_file import DataFile, Item, folded, unit_vector
from riser_soil.scene.rao import MODES, ROTATIONS

Table = dict[tuple[float, float], list[complex]]
"""Responses in six modes by frequency [rad/s] and direction [deg]: amplitude [m/m, deg/m] times exp(-i lag)."""

_SIGNS = {
    "surge": ("SurgePositive", "forward", "aft"), "sway": ("SwayPositive", "port", "starboard"),
    "heave": ("HeavePositive", "up", "down"), "roll": ("RollPositiveStarboard", "down", "up"),
    "pitch": ("PitchPositiveBow", "down", "up"), "yaw": ("YawPositiveBow", "port", "starboard"),
}  # fmt: skip
_AFTER_CREST = {"crest": 0.0, "zero down-crossing": 90.0, "trough": 180.0, "zero up-crossing": 270.0}  # deg
_IN_XZ = (1.0, -1.0, 1.0, -1.0, 1.0, -1.0)  # signs of the modes of a vessel that is mirrored in its xz plane
_IN_YZ = (-1.0, 1.0, 1.0, 1.0, -1.0, -1.0)  # in its yz plane
_FREQUENCY = {
    "period (s)": lambda value: 2.0 * math.pi / value if value else math.inf,
    "frequency (rad/s)": lambda value: value,
    "frequency (hz)": lambda value: 2.0 * math.pi * value,
}
_KNOWN: dict[str, Collection[str]] = {
    "WavesReferredToBy": _FREQUENCY, "RAOPhaseRelativeToConvention": _AFTER_CREST,
    "RAOPhaseConvention": ("lags", "leads"), "RAOPhaseUnitsConvention": ("degrees", "radians"),
    "RAOResponseUnits": ("degrees", "radians"), "RAOWaveUnit": ("amplitude",),
    "Symmetry": ("none", "xz plane", "yz plane", "xz and yz planes"),
}  # fmt: skip
_LONGEST = 1e-3  # rad/s, in place of waves without end
_SHORTER = (1.0 / 2.0, 1.0 / 4.0, 1.0 / 8.0, 1.0 / 100.0)  # of the shortest period, down to waves of none


def place_on(vessel: Item, local: list[float]) -> list[float]:
    """Global position of a point in the vessel's axes [m]."""
    heel, trim, heading = _orientation(vessel)
    if abs(heel) > 0.0 or abs(trim) > 0.0:
        vessel.refuse("Orientation", f"heel {heel:g} and trim {trim:g}: give what sits on the vessel as Fixed")
    c, s = unit_vector(heading)
    x, y, z = vessel.numbers("InitialPosition", 3)
    return [x + c * local[0] - s * local[1], y + s * local[0] + c * local[1], z + local[2]]


def motion(file: DataFile, vessel: Item, rao: str) -> tuple[dict[str, Any], str] | None:
    """The motion of an end on a vessel, with RAOs in a file of this name, and that file's text.

    None, and remarks, where the vessel does not move by displacement RAOs alone, or by some that can't be read.
    """
    name, draught = vessel.word("VesselType"), vessel.word("Draught")
    primary, superimposed = vessel.word("PrimaryMotion", "None"), vessel.word("SuperimposedMotion", "None")
    if folded(primary) != "none":
        vessel.remark("PrimaryMotion", f"PrimaryMotion {primary}: the vessel has its superimposed motion alone here")
    if "raos" not in folded(superimposed):
        if folded(superimposed) != "none":
            vessel.remark("SuperimposedMotion", f"SuperimposedMotion {superimposed}: the vessel rests here")
        return None
    kind = file.named("VesselTypes", name, vessel, "VesselType")
    if kind is None:
        return None
    draughts = [each for each in kind.items("Draughts") if folded(each.title) == folded(draught)]
    raos = draughts[0].part("DisplacementRAOs") if draughts else None
    if raos is None:
        vessel.remark("Draught", f"there is no draught {draught}: the vessel rests here")
        return None
    if unlike := _unlike(kind, raos):
        item, key, why = unlike
        item.remark(key, f"{key} {why}: RAOs are not carried over, the vessel rests here")
        return None
    table = _table(kind, raos)
    if not table:
        raos.remark("RAOs", "RAOs: there is no row of them; the vessel rests here")
        return None
    data = {"rao": rao, "reference": place_on(vessel, raos.numbers("RAOOrigin", 3))}
    return data | {"heading_deg": _orientation(vessel)[2]}, _text(table)


def _orientation(vessel: Item) -> list[float]:
    return vessel.numbers("Orientation" if vessel.has("Orientation") else "InitialAttitude", 3)


def _unlike(kind: Item, raos: Item) -> tuple[Item, str, str] | None:
    """Object and key by which RAOs can't be read, and why; None where they can."""
    origin = raos.numbers("RAOOrigin", 3)
    if any(a != b for a, b in zip(raos.numbers("PhaseOrigin", 3, math.nan), origin, strict=True) if a == a):
        return raos, "PhaseOrigin", "is not RAOOrigin"
    for key, known in (*_KNOWN.items(), *((key, values) for key, *values in _SIGNS.values())):
        if kind.choice(key) not in known:
            return kind, key, f"{kind.word(key) or '~'} is none of {', '.join(known)}"
    return None


def _table(kind: Item, raos: Item) -> Table:
    """RAO table by all frequencies that any direction has, in all directions of the vessel's symmetry."""
    rows = [*_rows(kind, raos)]
    frequencies = sorted({w for w, _, _ in rows if 0.0 < w < math.inf})
    if not frequencies:
        return {}
    directions = {direction: {w: response for w, at, response in rows if at == direction} for _, direction, _ in rows}
    limits = {w for known in directions.values() for w in known if w in (0.0, math.inf)}
    if limits:
        text = "waves of no period: linear in the period below the shortest; endless ones: linear in the frequency"
        raos.remark("RAOs", f"RAOs of {text}, as between all rows here")
    filled = {direction: _filled(known, frequencies, limits) for direction, known in directions.items()}
    response = {(w, direction % 360.0): each for direction, known in filled.items() for w, each in known.items()}
    for (w, direction), responses in list(response.items()):
        for turned, signs in _mirrored(direction, kind.choice("Symmetry")):
            response.setdefault((w, turned % 360.0), [sign * x for sign, x in zip(signs, responses, strict=True)])
    return response


def _rows(kind: Item, raos: Item) -> Iterator[tuple[float, float, list[complex]]]:
    """Frequencies, 0 and infinite ones among them [rad/s], directions [deg], responses."""
    turn = _FREQUENCY[kind.choice("WavesReferredToBy")]
    for each in raos.items("RAOs"):
        direction = each.number("RAODirection")
        for row in each.rows("RAOPeriodOrFrequency"):
            yield turn(row.stiffness("RAOPeriodOrFrequency")), direction, [_response(kind, row, mode) for mode in MODES]


def _filled(
    known: dict[float, list[complex]], frequencies: list[float], limits: set[float]
) -> dict[float, list[complex]]:
    """One direction's responses at all frequencies, and beyond them if the table has rows at these limits, 0 or inf.

    Towards waves of no period (an infinite frequency) they are linear in the period, towards endless ones and between
    rows linear in the frequency; without such a row constant, as a scene has them.
    """
    own = sorted(w for w in known if 0.0 < w < math.inf)
    if not own:
        return {}
    table = np.array([known[w] for w in own])
    filled = {w: [complex(np.interp(w, own, column)) for column in table.T] for w in frequencies}
    first, last = frequencies[0], frequencies[-1]
    if 0.0 in limits and first > _LONGEST:
        filled[_LONGEST] = known.get(0.0, filled[first])
    if math.inf in limits:
        for share in _SHORTER:
            pairs = zip(known.get(math.inf, filled[last]), filled[last], strict=True)
            filled[last / share] = [at_none + share * (at_last - at_none) for at_none, at_last in pairs]
    return filled


def _mirrored(direction: float, symmetry: str) -> Iterator[tuple[float, tuple[float, ...]]]:
    """Directions [deg] in which responses are alike but for these signs, itself among them."""
    across = [(1.0,) * 6] + ([_IN_XZ] if "xz" in symmetry else [])
    along = [(1.0,) * 6] + ([_IN_YZ] if "yz" in symmetry else [])
    for a in across:
        for b in along:
            turned = 180.0 - direction if b is _IN_YZ else direction
            yield (-turned if a is _IN_XZ else turned), tuple(x * y for x, y in zip(a, b, strict=True))


def _response(kind: Item, row: Item, mode: str) -> complex:
    in_degrees, later = kind.choice("RAOPhaseUnitsConvention") == "degrees", kind.choice("RAOPhaseConvention") == "lags"
    phase = row.number(f"RAO{mode.capitalize()}Phase")
    lag = (phase if in_degrees else math.degrees(phase)) * (1.0 if later else -1.0)
    lag += _AFTER_CREST[kind.choice("RAOPhaseRelativeToConvention")]
    key, ours, _ = _SIGNS[mode]
    size = row.number(f"RAO{mode.capitalize()}Amp") * (1.0 if kind.choice(key) == ours else -1.0)
    if mode in ROTATIONS and kind.choice("RAOResponseUnits") == "radians":
        size = math.degrees(size)
    return size * cmath.exp(-1j * math.radians(lag))


def _text(table: Table) -> str:
    """The table as a scene reads it."""
    units = ["deg/m" if mode in ROTATIONS else "m/m" for mode in MODES]
    columns = [f"{mode} [{unit}], {mode} phase [deg]" for mode, unit in zip(MODES, units, strict=True)]
    lines = [", ".join(["frequency [rad/s], direction [deg]", *columns])]
    for (frequency, direction), responses in sorted(table.items(), key=lambda each: each[0][::-1]):
        pairs = [f"{abs(each):.12g}, {-math.degrees(cmath.phase(each)) + 0.0:.12g}" for each in responses]
        lines.append(", ".join([f"{frequency:.12g}, {direction:.12g}", *pairs]))
    return "\n".join(lines) + "\n"
