"""Water, current, waves and seabed of a data file.

Waves of a data file.

Their directions are those of a scene: towards which they run, from x towards y. Their clock is another: OrcaFlex's time
is 0 where the build-up ends, and a scene's where its first dynamic stage begins, which is the build-up here.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from riser_soil.orcaflex.data_file import FORCE, MASS, Item, unit_vector
from riser_soil.sea.components import wave_number
from riser_soil.sea.spectra import mean_period

_DEPTHS = ("WaterDepth", "SeabedOriginDepth")
_REGULAR = {"Airy": "airy", "Single Airy": "airy", "Stokes' 5th": "stokes", "Dean stream": "stream-function"}
_PEAKED = {"JONSWAP": "jonswap", "ISSC": "pierson_moskowitz"}
_STRETCHING = {"Vertical stretching": "vertical", "Wheeler stretching": "wheeler"}


def water_depth(environment: Item) -> float:
    """From the surface to a level seabed [m]; SceneError of one that is not level."""
    for key in ("SeabedSlope", "SeabedProfileFile"):
        if environment.word(key) not in ("", "0", "0.0"):
            raise environment.error(key, f"is {environment.word(key)}: only a level seabed can be carried over")
    if environment.word("SeabedType", "Flat") != "Flat":
        raise environment.error("SeabedType", "only a level seabed (Flat) can be carried over")
    environment.get("SeabedSlopeDirection")
    key = next((key for key in _DEPTHS if environment.has(key)), _DEPTHS[0])
    if not environment.has(key):
        raise environment.error(key, "is missing; give the water's depth [m]")
    return environment.number(key)


def water(environment: Item) -> dict[str, Any]:
    """The scene's water without waves."""
    current = _current(environment)
    found: dict[str, Any] = {
        "density": environment.number("Density") * MASS,
        "surface_level": surface_level(environment),
        "depth": water_depth(environment),
    }
    return found | ({"current": {"profile": current}} if current else {})


def surface_level(environment: Item) -> float:
    """Height of the surface [m]."""
    return environment.number("WaterSurfaceZ", 0.0)


def seabed(environment: Item, diameter: float) -> dict[str, Any]:
    """Springs whose stiffness [kN/m per m2 of contact] counts for pipe as wide as its contact diameter [m]."""
    if environment.word("SeabedModel", "Elastic") != "Elastic":
        raise environment.error("SeabedModel", "only Elastic can be carried over; choose it, or give the seabed anew")
    if environment.word("SeabedShearStiffness"):
        environment.left("SeabedShearStiffness", "SeabedShearStiffness: friction takes effect over D/30 here")
    stiffness = environment.number("SeabedNormalStiffness") * FORCE * diameter
    level = surface_level(environment) - water_depth(environment)
    return {"kind": "spring", "stiffness": stiffness, "level": level, "contact_at": "outer"}


def _current(environment: Item) -> list[list[float]]:
    """Velocities [z, ux, uy] from below; empty without a current."""
    speed = environment.number("RefCurrentSpeed", 0.0)
    direction, surface = environment.number("RefCurrentDirection", 0.0), surface_level(environment)
    rows = environment.rows("CurrentDepth")
    if speed == 0.0:
        _ = [row.get(key) for row in rows for key in row.values]
        return []
    method = environment.word("VerticalCurrentVariationMethod", "Interpolated")
    if method != "Interpolated" or environment.word("CurrentModel", "Variation scheme") != "Variation scheme":
        environment.left("VerticalCurrentVariationMethod", f"current by {method}: only one by depth, interpolated")
        return []
    turns = {row.number("CurrentRotation", 0.0) for row in rows}
    if len(turns) > 1:
        environment.left("RefCurrentDirection", "CurrentRotation: between depths the velocity's components are linear")
    found = [_velocity(row, speed, direction, surface) for row in rows]
    return sorted(found) or [[surface, *_along(speed, direction)]]


def _velocity(row: Item, speed: float, direction: float, surface: float) -> list[float]:
    size = speed * row.number("CurrentFactor", 1.0)
    return [surface - row.number("CurrentDepth"), *_along(size, direction + row.number("CurrentRotation", 0.0))]


def _along(speed: float, direction: float) -> list[float]:
    return [speed * part for part in unit_vector(direction)]


def waves(environment: Item, build_up: float, g: float, depth: float) -> dict[str, Any] | None:
    """The scene's waves, which grow in the build-up [s]; None where there are none."""
    trains = environment.items("WaveTrains") or ([environment] if environment.has("WaveType") else [])
    found = [train for each in trains if (train := _train(each, build_up, g, depth))]
    alone = [train for train in found if "regular" in train]
    if not found:
        return None
    kinds = found[0] if len(found) == 1 else alone[0] if alone else {"trains": found}
    for _ in found[1:] if alone else []:
        environment.left("WaveTrains", "a wave of finite height is alone here; the other trains are left out")
    ramp = {"ramp": build_up} if build_up else {}
    return kinds | ramp | ({} if "regular" in kinds else _stretching(environment))


def _stretching(environment: Item) -> dict[str, str]:
    given = environment.word("KinematicStretchingMethod")
    if given not in _STRETCHING:
        environment.left("KinematicStretchingMethod", f"KinematicStretchingMethod {given or '~'}: Wheeler's here")
        return {}
    return {"stretching": _STRETCHING[given]}


def _train(train: Item, build_up: float, g: float, depth: float) -> dict[str, Any] | None:
    kind = train.word("WaveType")
    if kind in _REGULAR:
        return _regular(train, _REGULAR[kind], build_up, g, depth)
    if kind in _PEAKED:
        return _peaked(train, _PEAKED[kind])
    if kind not in ("None", ""):
        train.left("WaveType", f"WaveType {kind}: give the waves anew")
    return None


def _regular(train: Item, kind: str, build_up: float, g: float, depth: float) -> dict[str, Any] | None:
    height, direction = train.number("WaveHeight"), train.number("WaveDirection", 0.0)
    if height == 0.0:
        return None
    period = train.number("WavePeriod")
    x, y = train.numbers("WaveOrigin", 2)
    w, toward = 2.0 * math.pi / period, math.radians(direction)
    if kind != "airy" and (x or y):
        train.left("WaveOrigin", "WaveOrigin: the crest passes x = y = 0 here at that time")
        x = y = 0.0
    k = float(wave_number(np.array([w]), g, depth)[0])
    lag = w * (build_up + train.number("WaveTimeOrigin", 0.0)) - k * (x * math.cos(toward) + y * math.sin(toward))
    found = {"height": height, "period": period, "direction_deg": direction, "phase_deg": math.degrees(lag) % 360.0}
    train.get("WaveStreamFunctionOrder")  # ours has as many terms as the crest needs
    return {"airy": found} if kind == "airy" else {"regular": found | {"theory": kind}}


def _peaked(train: Item, kind: str) -> dict[str, Any] | None:
    found = {"Hs": train.number("WaveHs"), "direction_deg": train.number("WaveDirection", 0.0)}
    if found["Hs"] == 0.0:
        return None
    train.get("WaveJONSWAPParameters")
    if kind == "jonswap" and not train.has("WaveGamma"):
        train.left("WaveType", "WaveGamma is not given: no such waves here; give them anew")
        return None
    gamma = train.number("WaveGamma") if kind == "jonswap" else 1.0
    peak = _peak_period(train, gamma)
    if peak is None:
        train.left("WaveType", "neither WaveTp nor WaveTz is given: no such waves here; give them anew")
        return None
    found |= {"Tp": peak} | ({"gamma": gamma} if kind == "jonswap" else {})
    if train.has("WaveNumberOfComponents"):
        found["components"] = int(train.number("WaveNumberOfComponents"))
    train.left("WaveType", f"phases and frequencies of {train.word('WaveType')}: they are drawn anew, by `seed`")
    if train.number("WaveNumberOfSpectralDirections", 1.0) > 1.0:
        train.left("WaveNumberOfSpectralDirections", "directional spreading: give `spreading: {s, directions}`")
    return {kind: found}


def _peak_period(train: Item, gamma: float) -> float | None:
    """As it is given, or by the mean zero-crossing period of the whole spectrum [s]."""
    for key in ("WaveTp", "WavePeakPeriod"):
        if train.has(key):
            return train.number(key)
    return train.number("WaveTz") / mean_period(gamma) if train.has("WaveTz") else None
