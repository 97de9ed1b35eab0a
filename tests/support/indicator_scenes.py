"""Scenes in steps and elements of several sizes: what the indicators of a run are calibrated on."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage
from riser_soil.whole_run import run
from tests.support.scenes import Mapping, dynamic, prescribed, riser_scene, static

FIRST_SCENE = Path(__file__).parents[2] / "demos" / "first_scene.yaml"
GENERALISED: Mapping = {"generalized_alpha": {"rho_inf": 0.8}}
MIDPOINT: Mapping = {"midpoint": {}}
DAMPED: Mapping = {"newmark": {"beta": 0.3025, "gamma": 0.6}}
ROPE: Mapping = {"EA": 15.38e8, "EI": 20.96e3, "mass": 57.5, "outer_diameter": 0.26, "inner_diameter": 0.2}
ROPE |= {"drag": {"normal": 1.0}, "added_mass": {"normal": 1.0}}
LONG: Mapping = {"EA": 3e9, "EI": 5e4, "mass": 120.0, "outer_diameter": 0.3, "submerged_weight": 700.0}


def last_stage(scene: Scene) -> Mapping:
    """The summary of a scene's last stage."""
    with tempfile.TemporaryDirectory() as folder:
        run(scene, Path(folder) / "out")
        stage: Mapping = Run(Path(folder) / "out").summary["stages"][-1]
        return stage


def heaved(amplitude: float, period: float, duration: float, ramp: float = 10.0) -> Callable[[float], Scene]:
    """The first scene with another heave."""
    motion = f"stages.1.motion.end.harmonic.amplitude=[0.0, 0.0, {amplitude}]"
    times = (f"stages.1.motion.end.harmonic.{name}={time}" for name, time in (("period", period), ("ramp", ramp)))
    given = (motion, *times, f"stages.1.duration={duration}", "output.interval=1.0")
    return lambda dt: read_scene(FIRST_SCENE, [*given, f"stages.1.time_step={dt}"])


def moved(height: float, within: float, duration: float) -> Callable[[float], Scene]:
    """The first scene, its floater moved up by a height [m] in half a cosine within some time [s], then still."""

    def made(dt: float) -> Scene:
        t = np.linspace(0.0, duration, round(duration / 0.05) + 1)
        z = 0.5 * height * (1.0 - np.cos(np.pi * np.minimum(t / within, 1.0)))
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "heave.csv"
            rows = (f"{a:.6f},0,0,{b:.9f}" for a, b in zip(t, z, strict=True))
            table.write_text("t [s],x [m],y [m],z [m]\n" + "\n".join(rows) + "\n")
            motion = f"stages.1.motion.end={{table: {table}}}"
            step = f"stages.1.time_step={dt}"
            scene = read_scene(FIRST_SCENE, [motion, f"stages.1.duration={duration}", step, "output.interval=1.0"])
            stage = scene.stages[1]
            assert isinstance(stage, DynamicStage)
            table_of_end = stage.motion.end.table if stage.motion is not None and stage.motion.end is not None else None
            assert table_of_end is not None
            assert table_of_end.columns  # read while the file is there
            return scene

    return made


def surged(
    amplitude: list[float], period: float, cycles: float, scheme: Mapping, **more: Any
) -> Callable[[float], Scene]:
    """The published 350 m riser, its top in harmonic motion."""
    motion = {"end": {"harmonic": {"amplitude": amplitude, "period": period, "ramp": period}}}
    return lambda dt: scene_from_mapping(
        riser_scene(
            static(),
            dynamic(cycles * period, dt, motion=motion, scheme=scheme),
            pipe=ROPE,
            length=350.0,
            elements=35,
            start=prescribed(0.0, 0.0, 0.0),
            end=prescribed(150.0, 0.0, 150.0),
            gravity=9.81,
            water={"density": 1025.0},
            output={"interval": period},
            dimension=2,
            **more,
        )
    )


@dataclass(frozen=True)
class Stepped:
    """A scene by its time step, the steps to try [s], and the same in steps of negligible error."""

    scene: Callable[[float], Scene]
    steps: tuple[float, ...]
    fine: Callable[[], Scene]


def stepped(scene: Callable[[float], Scene], steps: tuple[float, ...], fine: float) -> Stepped:
    return Stepped(scene, steps, lambda: scene(fine))


def swung(amplitude: list[float], period: float, steps: tuple[float, ...], scheme: Mapping) -> Stepped:
    """Three periods of surge or heave, by a scheme; its reference damps what is shorter than its steps."""
    scene, damped = (surged(amplitude, period, 3.0, given) for given in (scheme, GENERALISED))
    return Stepped(scene, steps, lambda: damped(period / 160.0))


STEPPED = {
    "first scene": stepped(heaved(1.5, 10.0, 20.0), (1.0, 0.8, 0.4, 0.1), 0.025),
    "first scene, heave 3 m, 8 s": stepped(heaved(3.0, 8.0, 16.0), (0.4, 0.2, 0.1), 0.025),
    "first scene, heave 10 m, 4 s": stepped(heaved(10.0, 4.0, 4.0), (0.2, 0.1, 0.05), 0.0125),
    "let down by 5 m in 4 s": stepped(moved(-5.0, 4.0, 5.0), (0.2, 0.1, 0.05), 0.0125),
    "pulled up by 10 m in 4 s": stepped(moved(10.0, 4.0, 6.0), (0.2, 0.1, 0.05), 0.0125),
    "pulled up by 5 m in 6 s": stepped(moved(5.0, 6.0, 8.0), (0.4, 0.2, 0.1), 0.025),
    "surge": swung([2.01, 0.0, 0.0], 14.0, (3.5, 1.75, 0.7, 0.35), GENERALISED),
    "surge, midpoint rule": swung([2.01, 0.0, 0.0], 14.0, (3.5, 1.75, 0.7), MIDPOINT),
    "wide surge": swung([6.0, 0.0, 0.0], 14.0, (3.5, 1.4, 0.7, 0.35), GENERALISED),
    "heave": swung([0.0, 0.0, 2.0], 10.0, (1.0, 0.5, 0.25), GENERALISED),
    "heave, midpoint rule": swung([0.0, 0.0, 2.0], 10.0, (2.5, 1.25, 0.5), MIDPOINT),
    "heave, rho_inf 0.5": swung([0.0, 0.0, 3.0], 12.0, (1.5, 0.75, 0.375), {"generalized_alpha": {"rho_inf": 0.5}}),
    "surge, damped Newmark": swung([4.0, 0.0, 0.0], 12.0, (1.5, 0.6, 0.3), DAMPED),
}


@dataclass(frozen=True)
class Compressed:
    """A scene by its time step in which the riser is compressed and gets taut again, steps to try [s] that do not show
    with what force, and the largest tension in steps of 0.0125 s [N].
    """

    scene: Callable[[float], Scene]
    steps: tuple[float, ...]
    largest: float


COMPRESSED = {
    "heave 5 m, 8 s": Compressed(heaved(5.0, 8.0, 16.0, 8.0), (0.1, 0.05), 230.96e3),
    "heave 4 m, 7 s": Compressed(heaved(4.0, 7.0, 14.0, 7.0), (0.1, 0.05, 0.02), 194.83e3),
}

# Two periods of heaves of the first scene, amplitude [m] and period [s], the first one its ramp; in steps [s].
HEAVES = tuple(product((2.0, 4.0, 5.0, 6.0), (5.0, 7.0, 8.0, 9.0)))
HEAVE_STEPS, FINE_HEAVE_STEP = (0.2, 0.1, 0.05, 0.02), 0.01


def two_periods(amplitude: float, period: float) -> Callable[[float], Scene]:
    return heaved(amplitude, period, 2.0 * period, period)


def falling(dt: float, stiffness: float, drop: float = 0.1) -> Scene:
    """A level pipe of 40 m falls on a rigid floor without loss."""
    pipe = LONG | {"EA": 3e7}
    return scene_from_mapping(
        riser_scene(
            dynamic(0.7, dt),
            pipe=pipe,
            length=40.0,
            elements=20,
            start="free",
            end="free",
            riser={"initial": "straight"},
            gravity=9.81,
            dimension=2,
            seabed={"kind": "rigid", "level": -drop - 0.15},
            contact={"stiffness": stiffness, "smoothing": 1e-4},
            output={"interval": 0.1},
            solver={"tolerance": 1e-9},
        )
    )


def hung(elements: int, length: float, top: tuple[float, float, float], rotation: str = "free", **pipe: float) -> Scene:
    """A riser that hangs free from its top, in equal elements."""
    return scene_from_mapping(
        riser_scene(
            static(),
            pipe=LONG | pipe,
            length=length,
            elements=elements,
            start=prescribed(0.0, 0.0, 0.0, rotation=rotation),
            end=prescribed(*top),
            gravity=9.81,
            dimension=2,
        )
    )
