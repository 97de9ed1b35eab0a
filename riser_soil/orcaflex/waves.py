"""Waves of a data file.

Their directions are those of a scene: towards which they run, from x towards y. Their clock is another: OrcaFlex's time
is 0 where the build-up ends, and a scene's where its first dynamic stage begins, which is the build-up here.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from riser_soil.orcaflex.data_file import Item
from riser_soil.sea.components import wave_number
from riser_soil.sea.spectra import mean_period

_AIRY = ("airy", "single airy")
_REGULAR = {"stokes' 5th": "stokes", "stokes 5th": "stokes", "dean stream": "stream-function",
            "cnoidal": "stream-function"}  # fmt: skip
_PEAKED = {"jonswap": "jonswap", "issc": "pierson_moskowitz"}
_STRETCHING = {"vertical stretching": "vertical", "wheeler stretching": "wheeler"}
_DRAWN = (
    "WaveJONSWAPParameters", "WaveSeed", "WaveSpectrumMinRelFrequency", "WaveSpectrumMaxRelFrequency",
    "WaveSpectrumMaxComponentFrequencyRange",
)  # fmt: skip


def waves(environment: Item, build_up: float, g: float, depth: float) -> dict[str, Any] | None:
    """The scene's waves, which grow in the build-up [s]; None where there are none."""
    trains = environment.items("WaveTrains") or ([environment] if environment.has("WaveType") else [])
    data = [train for each in trains if (train := _train(each, build_up, g, depth))]
    alone = [train for train in data if "regular" in train]
    if not data:
        return None
    kinds = data[0] if len(data) == 1 else alone[0] if alone else {"trains": data}
    for _ in data[1:] if alone else []:
        environment.remark("WaveTrains", "a wave of finite height is alone here; the other trains are not carried over")
    if any(kind in train for train in data for kind in _PEAKED.values()):
        environment.get("WaveFrequencySpectrumDiscretisationMethod")
    ramp = {"ramp": build_up} if build_up else {}
    return kinds | ramp | ({} if "regular" in kinds else _stretching(environment))


def _stretching(environment: Item) -> dict[str, str]:
    given = environment.choice("KinematicStretchingMethod", "Vertical stretching")
    if given not in _STRETCHING:
        shown = environment.word("KinematicStretchingMethod")
        environment.remark("KinematicStretchingMethod", f"KinematicStretchingMethod {shown}: Wheeler's here")
        return {}
    return {"stretching": _STRETCHING[given]}


def _train(train: Item, build_up: float, g: float, depth: float) -> dict[str, Any] | None:
    kind = train.choice("WaveType")
    if kind in _AIRY:
        return _regular(train, "airy", build_up, g, depth)
    if kind in _REGULAR:
        return _regular(train, _REGULAR[kind], build_up, g, depth)
    if kind in _PEAKED:
        return _peaked(train, _PEAKED[kind])
    if kind not in ("none", ""):
        train.remark("WaveType", f"WaveType {train.word('WaveType')}: there is no such wave here; give the waves anew")
    return None


def _regular(train: Item, kind: str, build_up: float, g: float, depth: float) -> dict[str, Any] | None:
    height, direction = train.number("WaveHeight"), train.number("WaveDirection", 0.0)
    if height == 0.0:
        return None
    period = train.positive("WavePeriod")
    x, y = train.numbers("WaveOrigin", 2)
    toward = math.radians(direction)
    if kind != "airy" and (x or y):
        train.remark("WaveOrigin", "WaveOrigin: the crest passes x = y = 0 here at that time")
        x = y = 0.0
    later = build_up + train.number("WaveTimeOrigin", 0.0)
    train.get("WaveStreamFunctionOrder")  # ours has as many terms as the crest needs
    w = 2.0 * math.pi / period
    known = math.isfinite(w) and depth > 0.0
    k = float(wave_number(np.array([w]), g, depth)[0]) if known else math.nan
    lag = w * later - k * (x * math.cos(toward) + y * math.sin(toward))
    data = {"height": height, "period": period, "direction_deg": direction, "phase_deg": math.degrees(lag) % 360.0}
    return {"airy": data} if kind == "airy" else {"regular": data | {"theory": kind}}


def _peaked(train: Item, kind: str) -> dict[str, Any] | None:
    if not train.has("WaveHs"):
        train.remark("WaveType", "WaveHs is not given: no such waves here; give them anew")
        return None
    data = {"Hs": train.number("WaveHs"), "direction_deg": train.number("WaveDirection", 0.0)}
    if data["Hs"] == 0.0:
        return None
    if kind == "jonswap" and not train.has("WaveGamma"):
        train.remark("WaveType", "WaveGamma is not given: no such waves here; give them anew")
        return None
    gamma = train.number("WaveGamma") if kind == "jonswap" else 1.0
    peak = _peak_period(train, gamma)
    if peak is None:
        train.remark("WaveType", "neither WaveTp nor WaveTz is given: no such waves here; give them anew")
        return None
    data |= {"Tp": peak} | ({"gamma": gamma} if kind == "jonswap" else {})
    if train.has("WaveNumberOfComponents") and math.isfinite(count := train.number("WaveNumberOfComponents")):
        data["components"] = int(count)
    for key in _DRAWN:
        train.get(key)
    text = "seed, phases and frequencies are drawn anew, by `seed` and `components`"
    train.remark("WaveType", f"{train.word('WaveType')}: {text}")
    if train.number("WaveNumberOfSpectralDirections", 1.0) > 1.0:
        train.remark("WaveNumberOfSpectralDirections", "directional spreading: give `spreading: {s, directions}`")
    return {kind: data}


def _peak_period(train: Item, gamma: float) -> float | None:
    """Peak period [s], as given or by the mean zero-crossing period of the whole spectrum."""
    for key in ("WaveTp", "WavePeakPeriod"):
        if train.has(key):
            return train.number(key)
    if train.has("Wavefm"):
        return 1.0 / train.positive("Wavefm")
    if not train.has("WaveTz"):
        return None
    return train.number("WaveTz") / (mean_period(gamma) if math.isfinite(gamma) else math.nan)
