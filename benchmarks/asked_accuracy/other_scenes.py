"""Scenes that have chosen no factor: kinds of the calibration's, in sizes, pipes, motions and seabeds drawn at random.

The draw is always the same. `references.json` beside it has their references, computed as those of the calibration.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.error_bars.scenes import (
    CLAY_SPRINGS,
    FLEXIBLE,
    HANG,
    STEEL,
    WATER,
    Mapping,
    cantilever,
    even,
    hanging,
    line,
    loaded,
    moved,
    tensioned,
)

FILE = Path(__file__).with_name("references.json")
SEED = 20261123

Draw = random.Random


def _spread(draw: Draw, low: float, high: float) -> float:
    """A random value of three figures, evenly in the logarithm."""
    return float(f"{low * (high / low) ** draw.random():.3g}")


def _hung(draw: Draw, *stages: Mapping, **more: Any) -> Mapping:
    elements = draw.randint(20, 40)
    return hanging(elements, _spread(draw, 90.0, 280.0), *stages, EI=_spread(draw, 5.0e3, 5.0e5), **more)


def _steel(draw: Draw) -> Mapping:
    depth = _spread(draw, 150.0, 400.0)
    end = [depth * _spread(draw, 1.0, 1.8), 0.0, depth]
    length = 1.12 * (end[0] ** 2 + depth**2) ** 0.5
    return line(STEEL, [0.0, 0.0, 0.0], end, even(length, draw.randint(25, 50)), [HANG], water=WATER)


def _in_current(draw: Draw) -> Mapping:
    across = WATER | {"current": {"profile": [[0.0, 0.0, 0.2], [150.0, 0.3, _spread(draw, 0.5, 1.2)]]}}
    return _hung(draw, dimension=3, water=across)


def _beam(draw: Draw) -> Mapping:
    force = [0.0, 0.0, -_spread(draw, 5.0e3, 6.0e4)]
    return cantilever(draw.randint(4, 10), loaded(at="end", force=force))


def _stretched(draw: Draw) -> Mapping:
    return tensioned(draw.randint(8, 30), HANG, tension=_spread(draw, 2.0e5, 3.0e6))


def _touching(draw: Draw, seabed: Mapping, *stages: Mapping, **more: Any) -> Mapping:
    """A flexible riser of another stiffness, from another depth."""
    depth, size = _spread(draw, 50.0, 150.0), _spread(draw, 0.8, 1.6)
    pipe = FLEXIBLE | {"EI": _spread(draw, 1.5e4, 2.0e5)}
    segments: list[Mapping] = [{"length": 0.5 * depth, "element_length": size}]
    segments.append({"length": 0.98 * depth, "element_length": [size, 4.0 * size]})
    ends = [0.0, 0.0, 0.15], [depth * _spread(draw, 0.7, 0.9), 0.0, depth]
    contents = {"contents": {"density": 850.0}}
    return line(pipe, *ends, segments, [HANG, *stages], seabed=seabed, water=WATER, riser=contents, **more)


def _springs(draw: Draw) -> Mapping:
    return {"kind": "spring", "stiffness": _spread(draw, 3.0e4, 5.0e5)}


def _moved(draw: Draw, *parts: float) -> Mapping:
    """Harmonically, by random parts of so many metres."""
    amplitude = [part * _spread(draw, 0.5, 1.0) for part in parts]
    return moved(amplitude, _spread(draw, 7.0, 15.0), 2.0, draw.randint(40, 60))


def _rigid(draw: Draw, *stages: Mapping) -> Mapping:
    return _touching(draw, {"kind": "rigid"}, *stages, contact={"stiffness": 1.0e5})


KINDS: dict[str, Callable[[Draw], Mapping]] = {
    "catenary A": _hung,
    "catenary B": _hung,
    "steel catenary": _steel,
    "in a current across": _in_current,
    "cantilever": _beam,
    "beam under tension": _stretched,
    "on springs A": lambda draw: _touching(draw, _springs(draw)),
    "on springs B": lambda draw: _touching(draw, _springs(draw)),
    "on a rigid floor": _rigid,
    "on clay springs": lambda draw: _touching(draw, CLAY_SPRINGS),
    "surge A": lambda draw: _hung(draw, _moved(draw, 3.0, 0.0, 0.0)),
    "surge B": lambda draw: _hung(draw, _moved(draw, 3.0, 0.0, 0.0)),
    "heave": lambda draw: _hung(draw, _moved(draw, 0.0, 0.0, 3.0)),
    "surge across": lambda draw: _hung(draw, _moved(draw, 0.0, 3.0, 0.0), dimension=3),
    "heave on springs A": lambda draw: _touching(draw, _springs(draw), _moved(draw, 0.0, 0.0, 2.0)),
    "heave on springs B": lambda draw: _touching(draw, _springs(draw), _moved(draw, 1.0, 0.0, 2.0)),
    "heave on a rigid floor": lambda draw: _rigid(draw, _moved(draw, 0.0, 0.0, 1.5)),
    "heave on clay springs": lambda draw: _touching(draw, CLAY_SPRINGS, _moved(draw, 0.0, 0.0, 1.5)),
}

OTHERS: dict[str, Mapping] = {name: kind(random.Random(f"{SEED} {name}")) for name, kind in KINDS.items()}
