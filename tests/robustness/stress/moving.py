"""Stress cases of lines in motion: waves in them, snaps, violent motion of an end, steps too large, many turns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from scipy.special import j1, jn_zeros

from riser_soil.results import Run
from tests.robustness.stress.bounds import Answer, between, near
from tests.robustness.stress.case import Runs, Trial, one, stress_case
from tests.support.scenes import (
    AVERAGE,
    LARGEST_AROUND,
    Mapping,
    dynamic,
    end_led_around,
    prescribed,
    riser_scene,
    static,
    turned_bar,
    way_around,
)

FIRST_SCENE = Path(__file__).parents[3] / "demos" / "first_scene.yaml"
TOO_LONG = r"time steps? of .*(tenth|long)|longer than a tenth|time_step"


def largest(run: Run, stage: int, *figure: str) -> float:
    """Largest value of a figure in a stage."""
    value: Any = run.summary["stages"][stage]["extremes"]
    for key in figure:
        value = value[key]
    return float(value["max"])


def first_scene(*stages: Mapping, **changes: Any) -> Mapping:
    """The first scene of the README at rest, then other stages."""
    scene: Mapping = deepcopy(YAML(typ="safe").load(FIRST_SCENE))
    scene["stages"] = [scene["stages"][0], *stages]
    return scene | changes


def heaved(amplitude: float, period: float, duration: float, time_step: float, ramp: float) -> Mapping:
    harmonic = {"amplitude": [0.0, 0.0, amplitude], "period": period, "ramp": ramp}
    return dynamic(duration, time_step, "heave", motion={"end": {"harmonic": harmonic}})


@stress_case()
def chain_that_swings() -> Trial:
    """A hanging chain, EI = 1e-6 N.m2, its shape a straight line 0.01 rad off, let go: the tip moves as the sum of
    8/(j^3 J1(j)) cos(j t (g/L)^0.5/2) over the zeros j of J0 (Lamb, Higher Mechanics, 1920, on Bernoulli's problem),
    for 2 periods.
    """
    L, m, g = 10.0, 10.0, 9.81
    scene = riser_scene(
        static("aside", loads=[{"distributed": [0.01 * m * g, 0.0, 0.0]}]),
        dynamic(10.0, 0.01, scheme=AVERAGE),
        pipe={"EA": 1e7, "EI": 1e-6, "mass": m},
        length=L,
        elements=80,
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        gravity=g,
        riser={"initial": {"points": [[0.0, 0.0, 0.0], [0.1, 0.0, -10.0]]}},
    )

    def answers(run: Run) -> Iterator[Answer]:
        moving = run.time > 0.0
        t, x = run.time[moving], run["position"][moving][:, -1, 0]
        j = jn_zeros(0, 200)
        exact = 0.1 * np.cos(np.outer(t, 0.5 * j * np.sqrt(g / L))) @ (8.0 / (j**3 * j1(j)))
        yield near("largest error of the tip's path [m]", float(np.abs(x - exact).max()), 0.0, within=3e-3)

    return one(scene, answers)


def jerked(time_step: float) -> Mapping:
    """A line of 100 m, EA = 1e8 N, 100 kg/m, under 50 kN, its end pulled at 0.1 m/s all of a sudden."""
    pulled = {"end": {"harmonic": {"amplitude": [100.0 / (2.0 * np.pi) * 0.1, 0.0, 0.0], "period": 100.0}}}
    return riser_scene(
        static("stretch", move={"end": [100.05, 0.0, 0.0]}),
        dynamic(0.3, time_step, motion=pulled),
        pipe={"EA": 1e8, "EI": 1.0, "mass": 100.0},
        length=100.0,
        elements=100,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(100.0, 0.0, 0.0),
    )


@stress_case(quick=True)
def end_that_starts_all_of_a_sudden() -> Trial:
    """A stress wave: T rises by EA V/c = 10 kN at the end, c = (EA/m)^0.5 = 1 km/s, and by twice that at the other,
    which it reaches after 0.1 s; means over 0.18 s.
    """

    def answers(run: Run) -> Iterator[Answer]:
        t = run.time
        for force, what, begin, rise in (("end_force", "end", 0.01, 1e4), ("start_force", "start", 0.11, 2e4)):
            over = (t > begin) & (t < begin + 0.18)
            mean = float(np.abs(run[force][over][:, 0]).mean())
            yield near(f"mean tension at the {what} [N]", mean, 5e4 + rise, rel=0.01)

    return one(jerked(1e-3), answers)


M, EA_SNAP, FALL = 1000.0, 1e6, 0.1


def snapping(time_step: float) -> Callable[[], Trial]:
    scene = riser_scene(
        dynamic(0.4, time_step),
        pipe={"EA": EA_SNAP, "EI": 1.0, "mass": 0.5},
        length=10.0,
        elements=20,
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        gravity=9.81,
        riser={
            "initial": {"points": [[0.0, 0.0, 0.0], [0.70534, 0.0, -4.95], [0.0, 0.0, -9.9]]},
            "attachments": [{"at": 10.0, "mass": M}],
        },
    )

    def answers(run: Run) -> Iterator[Answer]:
        W = 9.81 * M
        exact = W + np.sqrt(W * W + 2.0 * W * FALL * EA_SNAP / 10.0)
        for end in ("start", "end"):
            yield near(f"largest tension at the {end} [N]", largest(run, 0, end, "effective_tension"), exact, rel=0.03)

    def make() -> Trial:
        return one(scene, answers, TOO_LONG)

    make.__doc__ = (
        "Slack to snap: a mass of 1 t falls 0.1 m before its rope of 10 m, EA = 1 MN, gets taut; T = W + (W^2 + 2 W h "
        f"EA/L)^0.5 for a rope without mass, here 5 kg; steps of {1e3 * time_step:g} ms. Right, or told."
    )
    return make


for dt in (2e-4, 1e-3, 1e-2):
    stress_case(name=f"slack_to_snap_in_steps_of_{1e3 * dt:g}_ms")(snapping(dt))


@stress_case()
def heave_of_10_m_in_4_s() -> Trial:
    """The first scene, its end 10 m up and down in 4 s each: top tension in steps of 0.1 s beside steps of 0.02 s; or
    told that the steps are too long.
    """
    scenes = {name: first_scene(heaved(5.0, 8.0, 16.0, dt, 8.0)) for name, dt in (("coarse", 0.1), ("fine", 0.02))}

    def answers(runs: Runs) -> Iterator[Answer]:
        coarse, fine = (largest(runs[name], 1, "end", "effective_tension") for name in ("coarse", "fine"))
        yield near("largest top tension [N]", coarse, fine, rel=0.02)

    return Trial(scenes, answers, TOO_LONG)


@stress_case(cpu=150)
def heave_of_10_m_in_4_s_then_rest() -> Trial:
    """After three cycles of that heave, in compression at the touchdown point, the end stops where it began: the riser
    comes to rest where it was, as the equilibrium of a line on springs without friction is one; the
    shock of its stop, 3.9 m/s, may be told.
    """
    scene = first_scene(heaved(5.0, 8.0, 24.0, 0.025, 8.0), dynamic(60.0, 0.05, "rest"))
    return one(scene, as_before, r"the energy balance is")


@stress_case()
def heave_of_20_m_in_2_s() -> Trial:
    """The end 20 m down in 2 s, at up to 16 m/s, faster than the riser sinks (2 m/s): it buckles below the end; it
    comes to rest where it was, or the fold is told.
    """
    scene = first_scene(heaved(10.0, 4.0, 12.0, 0.05, 4.0), dynamic(80.0, 0.2, "rest"))
    return one(scene, as_before, r"the riser is folded at arc")


def as_before(run: Run) -> Iterator[Answer]:
    """The last stage ends as the first one did, to what drag, which goes with the square of the speed, leaves of
    motion.
    """
    first, *_, last = run.summary["stages"]
    before, after = first["final"], last["final"]
    top = ("end", "effective_tension")
    yield near("top tension [N]", after[top[0]][top[1]], before[top[0]][top[1]], rel=0.01)
    yield near("touchdown arc [m]", after["touchdown_arc"], before["touchdown_arc"], rel=0.01)


@stress_case()
def lifted_off_and_dropped() -> Trial:
    """A hoist lifts what lies of the first scene's riser 4.5 m off the ground with 20 kN, and lets go: the riser falls,
    and comes to rest where it was. (With much drag along it, as nothing else stops its sliding.)
    """
    hoist = {"at": 20.0, "force": [0.0, 0.0, 20e3]}
    scene = first_scene(static("lift", loads=[hoist]), dynamic(100.0, 0.05, "drop"))
    scene["line_types"]["flexible"]["drag"]["tangential"] = 0.5

    def answers(run: Run) -> Iterator[Answer]:
        lifted = run["position"][1]
        yield between("height of the hoist [m]", float(lifted[run.arc == 20.0, 2][0]), 4.0)
        yield from as_before(run)

    return one(scene, answers)


@stress_case(quick=True)
def steps_as_long_as_the_period() -> Trial:
    """Heave of 1.5 m in 10 s, in steps of 10 s, at which the end is always where it began: 100.25 kN at most in fine
    steps; or told.
    """

    def answers(run: Run) -> Iterator[Answer]:
        yield near("largest top tension [N]", largest(run, 1, "end", "effective_tension"), 100.25e3, rel=0.02)

    return one(first_scene(heaved(1.5, 10.0, 100.0, 10.0, 10.0)), answers, TOO_LONG)


@stress_case()
def midpoint_rule_in_steps_of_a_quarter_period() -> Trial:
    """Surge of 5 m in 8 s by the midpoint rule in steps of 2 s beside the same in steps of 0.04 s; or told."""
    scenes = {}
    for name, dt in (("coarse", 2.0), ("fine", 0.04)):
        motion = {"end": {"harmonic": {"amplitude": [5.0, 0.0, 0.0], "period": 8.0, "ramp": 8.0}}}
        scene = first_scene(dynamic(24.0, dt, "surge", motion=motion, scheme={"midpoint": {}}))
        scene["riser"]["start"] = {"position": [0.0, 0.0, 20.0]}
        del scene["seabed"]
        scenes[name] = scene

    def answers(runs: Runs) -> Iterator[Answer]:
        coarse, fine = (largest(runs[name], 1, "end", "effective_tension") for name in ("coarse", "fine"))
        yield near("largest top tension [N]", coarse, fine, rel=0.02)

    return Trial(scenes, answers, TOO_LONG)


def turned(turns: int, dt: float = 0.005, **more: Any) -> Callable[[], Trial]:
    scene = turned_bar(turns, dt, 10.0, **more)

    def answers(run: Run) -> Iterator[Answer]:
        apart = np.linalg.norm(run["position"][-1, -1] - [1.0, 0.0, 0.0])
        yield near("tip's distance from where it was [m]", float(apart), 0.0, within=1e-3)
        span = np.linalg.norm(run["position"][:, -1], axis=1)
        yield between("least distance of tip and root [m]", float(span.min()), 0.98)
        yield between("largest moment at rest [N.m]", float(run["bending_moment"][-1].max()), 0.0, 0.5)

    def make() -> Trial:
        return one(scene, answers)

    way = "one way" if turns > 0 else "the other way"
    make.__doc__ = (
        f"A clamped bar whose support turns {abs(turns)} times, {way}, and stops: straight again, and where it was."
    )
    return make


stress_case(name="ten_turns_one_way")(turned(10, scheme=AVERAGE))
stress_case(name="ten_turns_the_other_way")(turned(-10, scheme=AVERAGE))
# At 50 rad/s structural damping takes as much energy out of the turning as the fourth power of the step: 2.4 % of what
# is turned over in steps of 1 ms. In half of these the average acceleration, which damps nothing, lets the tip ring.
stress_case(name="hundred_turns", cpu=100)(turned(100, 6.25e-4))


@stress_case(cpu=240)
def ten_thousand_cycles() -> Trial:
    """A mass of 1 t on a bar of 10 m, EA = 1 MN, let go 0.1 m off by the average acceleration, 8 steps a cycle: the
    amplitude stays 0.1 m over 10,000 cycles, energy to a millionth.
    """
    k, period = 1e5, 2.0 * np.pi / 10.0
    scene = riser_scene(
        static("pull", loads=[{"at": "end", "force": [0.1 * k, 0.0, 0.0]}]),
        dynamic(10_000 * period, period / 8.0, scheme=AVERAGE),
        pipe={"EA": 1e6, "EI": 1e3, "mass": 1e-3},
        length=10.0,
        elements=1,
        start=prescribed(0.0, 0.0, 0.0, rotation="fixed"),
        end="free",
        riser={
            "unstressed": {"points": [[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]]},
            "attachments": [{"at": 10.0, "mass": 1e3}],
        },
        solver={"tolerance": 1e-9},
        output={"interval": 10.03 * period},
    )

    def answers(run: Run) -> Iterator[Answer]:
        x = run["position"][-200:, -1, 0] - 10.0
        yield near("amplitude in the last 2000 cycles [m]", float(np.abs(x).max()), 0.1, rel=2e-3)
        residual = run.summary["stages"][1]["energy"]["relative_residual"]
        yield near("energy residual at the end [-]", residual, 0.0, within=1e-5)

    return one(scene, answers)


@stress_case()
def hardly_any_torsional_stiffness() -> Trial:
    """The first scene's heave in 3D with GJ = 1 N.m2 and no rotary inertia, as in 2D."""
    heave = heaved(1.5, 10.0, 12.0, 0.1, 10.0)
    scenes = {name: first_scene(heave, dimension=d) for name, d in (("flat", 2), ("space", 3))}
    scenes["space"]["line_types"]["flexible"]["GJ"] = 1.0

    def answers(runs: Runs) -> Iterator[Answer]:
        for what, *path in (("top tension [N]", "end", "effective_tension"), ("moment [N.m]", "max_bending_moment")):
            flat, space = (largest(runs[name], 1, *path) for name in ("flat", "space"))
            yield near(f"largest {what}", space, flat, rel=1e-5)

    return Trial(scenes, answers)


def around(way: int) -> Callable[[], Trial]:
    files = {f"{side}.csv": way_around(way, sign) for side, sign in (("right", 1), ("left", -1))}
    scenes = {side: end_led_around(f"{side}.csv", sign, 0.05) for side, sign in (("right", 1), ("left", -1))}

    def answers(runs: Runs) -> Iterator[Answer]:
        right, left = (largest(runs[side], 1, "start", "effective_tension") for side in ("right", "left"))
        yield near("largest tension at the start [N]", right, LARGEST_AROUND[way], rel=0.01)
        yield near("that of the mirror image [N]", left, right, rel=1e-6)

    def make() -> Trial:
        return Trial(scenes, answers, files=files)

    make.__doc__ = (
        "The end of 60 m of riser is led once around its start on a circle of 60 m, "
        f"{'up' if way > 0 else 'down'} first, and on the mirror image: the same tension, and that of 2,000 steps. "
        "Down first the sag bend is crushed."
    )
    return make


stress_case(name="end_led_around_anticlockwise")(around(1))
stress_case(name="end_led_around_clockwise")(around(-1))
