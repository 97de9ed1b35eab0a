"""Plausible sizes of a scene's numbers: what lies far beyond them is most often in another unit, which is named.

Works on plain data, so that a scene with other mistakes is looked at, too: what is refused often follows from a unit.
A single number is compared with the sizes that its key has on risers, lines and models of them (KEYS). Of a pipe, mass,
EA, EI and forces are compared with its cross-section and its weight (`doubts_of_pipes`).
"""

from __future__ import annotations

import math
from typing import Any

from riser_soil.scene.pipe_sizes import DIAMETER, doubts_of_pipes
from riser_soil.scene.problem import matching
from riser_soil.scene.size import LINES, Doubt, Size, number_of

Pattern = tuple[str, ...]
_POUNDS = 6894.757  # Pa of a psi
_LENGTHS = DIAMETER.others
_LONG = {"mm": 1e-3, "cm": 1e-2}
_DENSITIES = {"t/m3": 1e3, "lb/ft3": 16.01846}
_STRESSES = {"MPa": 1e6, "ksi": 1e3 * _POUNDS, "kPa": 1e3, "psi": _POUNDS, "GPa": 1e9}
_STRENGTHS = {"kPa": 1e3, "MPa": 1e6}

_LENGTH = Size(0.0, 5e4, "m", _LONG)
_HEIGHT = Size(0.0, 1.2e4, "m", _LONG)
_DENSITY = Size(5.0, 5e3, "kg/m3", _DENSITIES)
_PRESSURE = Size(1e3, 1.5e8, "Pa", {"bar": 1e5, **_STRESSES})
_SU = Size(50.0, 5e5, "Pa", _STRENGTHS)
_SU_GRADIENT = Size(20.0, 1e5, "Pa/m", {"kPa/m": 1e3})
_UNIT_WEIGHT = Size(500.0, 2e4, "N/m3", {"kN/m3": 1e3})
_MODULUS = Size(1e4, 1e12, "Pa", {"kPa": 1e3, "MPa": 1e6, "GPa": 1e9})
_STIFFNESS = Size(500.0, 1e12, "N/m2", {"kN/m2": 1e3, "MN/m2": 1e6})
_SPEED = Size(0.0, 4.0, "m/s", {"knots": 0.514444, "cm/s": 0.01, "km/h": 1.0 / 3.6})
_WAVE_HEIGHT = Size(1e-3, 35.0, "m", {"cm": 0.01, "mm": 1e-3, "ft": 0.3048})
_PERIOD = Size(0.2, 60.0, "s", {"ms": 1e-3})
_STRENGTH_OF_STEEL = Size(1.5e8, 2e9, "Pa", _STRESSES)
_BEND = Size(0.01, 1e3, "m", _LONG)
_WALL = Size(0.0, 0.1, "m", _LENGTHS)
_SEA = Size(900.0, 1100.0, "kg/m3", _DENSITIES)

_OF_LINE: dict[Pattern, Size] = {
    ("contents", "density"): _DENSITY,
    ("contents", "slugs", "*", "density"): _DENSITY,
    ("contents", "pressure"): _PRESSURE,
    ("segments", "*", "length"): _LENGTH,
}
_OF_END: dict[Pattern, Size] = {
    ("position", "2"): _HEIGHT,
    ("hang_off", "angle"): Size(1.0, 90.0, "deg", {"rad": 180.0 / math.pi}),
    ("bend_stiffener", "length"): Size(0.0, 100.0, "m", _LENGTHS),
    ("bend_stiffener", "base_diameter"): Size(0.0, 5.0, "m", _LENGTHS),
    ("bend_stiffener", "tip_diameter"): Size(0.0, 5.0, "m", _LENGTHS),
    ("bend_stiffener", "E"): Size(1e5, 1e12, "Pa", _STRESSES),
    ("bend_stiffener", "density"): _DENSITY,
}
_OF_LAW = {
    ("su",): _SU,
    ("su_gradient",): _SU_GRADIENT,
    ("E",): _MODULUS,
    ("unit_weight",): _UNIT_WEIGHT,
}
_OF_WAVES = {
    **{(kind, "Hs"): _WAVE_HEIGHT for kind in ("jonswap", "pierson_moskowitz")},
    **{(kind, "Tp"): _PERIOD for kind in ("jonswap", "pierson_moskowitz")},
    **{(kind, "height"): _WAVE_HEIGHT for kind in ("airy", "regular")},
    **{(kind, "period"): _PERIOD for kind in ("airy", "regular")},
}
_OF_CODE_CHECK = {
    **dict.fromkeys(("yield_stress", "tensile_strength"), _STRENGTH_OF_STEEL),
    **dict.fromkeys(("design_pressure", "minimum_pressure"), _PRESSURE),
    **dict.fromkeys(("corrosion_allowance", "fabrication_tolerance"), _WALL),
    **dict.fromkeys(("storage_radius", "static_radius", "dynamic_radius"), _BEND),
    "E": Size(5e9, 1e12, "Pa", _STRESSES),
}
_ENDS = {(end, *path): size for end in ("start", "end") for path, size in _OF_END.items()}
_LAWS = (("seabed", "law"), ("soil", "law"), ("soil", "layers", "*", "law"))
_WAVES = (("water", "waves"), ("water", "waves", "trains", "*"))
_PROFILES = (("water", "current", "profile", "*"), ("water", "current", "history", "*", "profile", "*"))

# Plausible sizes by the key's path; `*` stands for any name or number.
KEYS: dict[Pattern, Size] = {
    ("gravity",): Size(1.0, 30.0, "m/s2", {"cm/s2": 0.01, "ft/s2": 0.3048}),
    ("water", "density"): _SEA,
    ("water", "surface_level"): _HEIGHT,
    ("water", "depth"): _HEIGHT,
    ("line_types", "*", "min_bend_radius"): _BEND,
    ("line_types", "*", "wall", "outer_diameter"): DIAMETER,
    ("line_types", "*", "wall", "inner_diameter"): DIAMETER,
    ("line_types", "*", "wall", "yield_stress"): _STRENGTH_OF_STEEL,
    ("seabed", "stiffness"): _STIFFNESS,
    ("contact", "stiffness"): _STIFFNESS,
    ("soil", "submerged_unit_weight"): _UNIT_WEIGHT,
    ("soil", "block", "depth"): Size(0.0, 1e3, "m", _LONG),
    ("stages", "*", "pressure"): _PRESSURE,
    ("stages", "*", "motion", "*", "harmonic", "amplitude", "*"): Size(0.0, 100.0, "m", _LONG),
    **{("code_check", "*", key): size for key, size in _OF_CODE_CHECK.items()},
    **{(*profile, axis): _SPEED for profile in _PROFILES for axis in ("1", "2")},
    **{(*line, *path): size for line in LINES for path, size in (_OF_LINE | _ENDS).items()},
    **{(*law, *path): size for law in _LAWS for path, size in _OF_LAW.items()},
    **{(*waves, *path): size for waves in _WAVES for path, size in _OF_WAVES.items()},
}


def doubts(data: Any) -> list[Doubt]:
    """Numbers of a scene, as plain data, that look like those of another unit, each with its likely one."""
    alone = [
        Doubt(path, text)
        for pattern, size in KEYS.items()
        for path, value in matching(data, pattern)
        if (text := size.doubt(number_of(value)))
    ]
    return [*alone, *doubts_of_pipes(data, {each.path for each in alone})]
