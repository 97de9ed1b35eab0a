"""Vessels of a data file: where they are, and how they answer the waves.

A vessel's axes are those of a scene: x forward, y to port, z up; directions of RAOs count from its heading, 0 from
astern. Signs and phases of RAOs are as the vessel type says.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator
from typing import Any

from riser_soil.orcaflex.data_file import DataFile, Item, unit_vector
from riser_soil.scene.rao import MODES, ROTATIONS

Table = dict[tuple[float, float], list[complex]]
"""Responses in six modes by frequency [rad/s] and direction [deg]: amplitude [m/m, deg/m] times exp(-i lag)."""

_SIGNS = {
    "surge": ("SurgePositive", "forward", "aft"), "sway": ("SwayPositive", "port", "starboard"),
    "heave": ("HeavePositive", "up", "down"), "roll": ("RollPositiveStarboard", "down", "up"),
    "pitch": ("PitchPositiveBow", "down", "up"), "yaw": ("YawPositiveBow", "port", "starboard"),
}  # fmt: skip
_AFTER_CREST = {"crest": 0.0, "zero down-crossing": 90.0, "trough": 180.0, "zero up-crossing": 270.0}  # deg
_MIRRORED = (1.0, -1.0, 1.0, -1.0, 1.0, -1.0)  # in a vessel's xz plane
_FREQUENCY = {
    "period (s)": lambda value: 2.0 * math.pi / value if value else math.inf,
    "frequency (rad/s)": lambda value: value,
    "frequency (Hz)": lambda value: 2.0 * math.pi * value,
}
_KNOWN: dict[str, Collection[str]] = {
    "WavesReferredToBy": _FREQUENCY, "RAOPhaseRelativeToConvention": _AFTER_CREST,
    "RAOPhaseConvention": ("lags", "leads"), "RAOPhaseUnitsConvention": ("degrees", "radians"),
    "RAOResponseUnits": ("degrees", "radians"), "RAOWaveUnit": ("amplitude",), "Symmetry": ("None", "xz plane"),
}  # fmt: skip


def place_on(vessel: Item, local: list[float]) -> list[float]:
    """Global position of a point in the vessel's axes [m]."""
    heel, trim, heading = _orientation(vessel)
    if heel or trim:
        raise vessel.error("Orientation", f"heel {heel:g} and trim {trim:g}: give what sits on the vessel as Fixed")
    c, s = unit_vector(heading)
    x, y, z = vessel.numbers("InitialPosition", 3)
    return [x + c * local[0] - s * local[1], y + s * local[0] + c * local[1], z + local[2]]


def motion(file: DataFile, vessel: Item, rao: str) -> tuple[dict[str, Any], str] | None:
    """The motion of an end on a vessel, with RAOs in a file of this name, and that file's text.

    None, and remarks, where the vessel does not move by displacement RAOs alone, or by some that can't be read.
    """
    primary, superimposed = vessel.word("PrimaryMotion", "None"), vessel.word("SuperimposedMotion", "None")
    if primary != "None":
        vessel.left("PrimaryMotion", f"PrimaryMotion {primary}: the vessel has its superimposed motion alone here")
    if "RAOs" not in superimposed:
        if superimposed != "None":
            vessel.left("SuperimposedMotion", f"SuperimposedMotion {superimposed}: the vessel rests here")
        return None
    kind = file.named("VesselTypes", vessel.word("VesselType"), vessel, "VesselType")
    draughts = [each for each in kind.items("Draughts") if each.word("Name") == vessel.word("Draught")]
    raos = draughts[0].part("DisplacementRAOs") if draughts else None
    if raos is None:
        vessel.left("Draught", f"there is no draught {vessel.word('Draught')}: the vessel rests here")
        return None
    if unlike := _unlike(kind, raos):
        item, key, why = unlike
        item.left(key, f"{key} {why}: RAOs are not carried over, the vessel rests here")
        return None
    found = {"rao": rao, "reference": place_on(vessel, raos.numbers("RAOOrigin", 3))}
    return found | {"heading_deg": _orientation(vessel)[2]}, _text(_table(kind, raos))


def _orientation(vessel: Item) -> list[float]:
    return vessel.numbers("Orientation" if vessel.has("Orientation") else "InitialAttitude", 3)


def _unlike(kind: Item, raos: Item) -> tuple[Item, str, str] | None:
    """Object and key by which RAOs can't be read, and why; None where they can."""
    origin = raos.numbers("RAOOrigin", 3)
    if any(a != b for a, b in zip(raos.numbers("PhaseOrigin", 3, math.nan), origin, strict=True) if a == a):
        return raos, "PhaseOrigin", "is not RAOOrigin"
    for key, known in (*_KNOWN.items(), *((key, values) for key, *values in _SIGNS.values())):
        if kind.word(key) not in known:
            return kind, key, f"{kind.word(key) or '~'} is none of {', '.join(known)}"
    return None


def _table(kind: Item, raos: Item) -> Table:
    found: Table = {}
    limits = list[Item]()
    for direction, row in _rows(raos):
        frequency = _FREQUENCY[kind.word("WavesReferredToBy")](row.stiffness("RAOPeriodOrFrequency"))
        if not 0.0 < frequency < math.inf:
            limits.append(row)
            continue
        responses = [_response(kind, row, mode) for mode in MODES]
        found[frequency, direction % 360.0] = responses
        if kind.word("Symmetry") == "xz plane":
            mirrored = [sign * each for sign, each in zip(_MIRRORED, responses, strict=True)]
            found.setdefault((frequency, -direction % 360.0), mirrored)
    for row in limits[:1]:
        row.left("RAOPeriodOrFrequency", "waves of no frequency, or an infinite one, in all directions: not in a table")
    return found


def _rows(raos: Item) -> Iterator[tuple[float, Item]]:
    for each in raos.items("RAOs"):
        direction = each.number("RAODirection")
        yield from ((direction, row) for row in each.rows("RAOPeriodOrFrequency"))


def _response(kind: Item, row: Item, mode: str) -> complex:
    in_degrees, later = kind.word("RAOPhaseUnitsConvention") == "degrees", kind.word("RAOPhaseConvention") == "lags"
    phase = row.number(f"RAO{mode.capitalize()}Phase")
    lag = (phase if in_degrees else math.degrees(phase)) * (1.0 if later else -1.0)
    lag += _AFTER_CREST[kind.word("RAOPhaseRelativeToConvention")]
    key, ours, _ = _SIGNS[mode]
    size = row.number(f"RAO{mode.capitalize()}Amp") * (1.0 if kind.word(key) == ours else -1.0)
    if mode in ROTATIONS and kind.word("RAOResponseUnits") == "radians":
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
