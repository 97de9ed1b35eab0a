"""A clamped bar whose support turns many times and stops."""

from __future__ import annotations

from typing import Any

from tests.support.coupled_scenes import Mapping
from tests.support.riser_scenes import dynamic, prescribed, riser_scene


def turned_bar(turns: int, dt: float = 0.01, rest: float = 1.0, **more: Any) -> Mapping:
    """A bar of 1 m that turns in steps of dt [s] for 20 s and rests for some time [s]; `more`: of the first stage."""
    turn = {"axis": [0.0, 1.0, 0.0], "amplitude_deg": 360.0 * turns, "period": 80.0, "ramp": 20.0}
    return riser_scene(
        dynamic(20.0, dt, "turn", motion={"start": {"rotation": turn}}, **more),
        dynamic(rest, 0.01, "rest"),
        pipe={"EA": 1e6, "EI": 1e3, "mass": 1.0, "damping": {"ratio": 0.05, "frequency": 5.0}},
        length=1.0,
        elements=10,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={"unstressed": {"points": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]}},
        output={"interval": 0.1},
    )
