"""Vortex-induced vibration through the time loop: lock-in of a rigid cylinder, its power, a riser in shear, order."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Work
from riser_soil.core.system import System
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep
from tests.support.driven_stage import built_of, take
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene, static

RHO, CD, CV, MIDDLE, WIDTH = 1025.0, 1.2, 1.2, 0.18, 0.08
FORCES: Mapping = {"drag": {"normal": CD}, "added_mass": {"normal": 1.0}, "vortex_force": {"coefficient": CV}}


@dataclass(frozen=True)
class Shaken:
    """Ends t (n,) [s] of a dynamic stage's steps, places x (n, nodes, 3) [m], what parts have turned over in each."""

    t: Array
    x: Array
    turned: list[dict[str, Work]]

    @property
    def later(self) -> slice:
        """The second half, once what began has settled."""
        return slice(len(self.t) // 2, None)

    def work(self, part: str) -> float:
        """Work put in there [J], less what is dissipated."""
        each = [turned[part] for turned in self.turned[self.later]]
        return sum(work.external - work.dissipated for work in each)


def shaken(scene: Mapping) -> Shaken:
    assembly = built_of(scene_from_mapping(scene))
    line, (rest, flow) = assembly.riser.line, assembly.scene.stages
    assert line.dimension == 3  # though all that is given lies in a plane
    before, motion = take(assembly, rest), Shaken(np.zeros(0), np.zeros(0), [])
    t, x = list[float](), list[Array]()

    def watch(system: System, step: AcceptedStep) -> None:
        t.append(step.t)
        x.append(line.to_global(line.trial(step.solution.state).x))
        motion.turned.append(step.turned)

    take(assembly, flow, before, watch)
    return Shaken(np.array(t), np.array(x), motion.turned)


# A rigid cylinder between two light cables under tension, which are its springs

D, LENGTH, MASS, CABLE, LIGHT, EA, STRAIN = 0.3, 3.0, 110.0, 30.0, 0.5, 1.0e7, 0.012
MOVED = (MASS + RHO * 0.25 * math.pi * D**2) * LENGTH + 2.0 * LIGHT * CABLE / 3.0
NATURAL = math.sqrt(2.0 * EA * STRAIN / (CABLE * (1.0 + STRAIN)) / MOVED) / (2.0 * math.pi)  # Hz


@cache
def mounted(reduced: float, steps: int = 60, periods: int = 30, in_line: float = 0.0) -> tuple[float, Shaken]:
    """The current, and the cylinder in it, by its reduced velocity U/(fn D); steps: of a natural period. in_line: the
    coefficient of vortices that shake it in line with the flow alone; across it by default.
    """
    U, cable = reduced * NATURAL * D, {"mass": LIGHT, "EA": EA, "EI": 1.0, "GJ": 1.0e3, "outer_diameter": 0.01}
    pipe: Mapping = {"mass": MASS, "outer_diameter": D, "EA": 1.0e12, "EI": 1.0e9, "GJ": 1.0e9} | FORCES
    if in_line:
        pipe |= {"vortex_force": {"coefficient": 0.0, "in_line": {"coefficient": in_line}}}
    top, elements = 2.0 * CABLE * (1.0 + STRAIN) + LENGTH, {"cable": CABLE, "pipe": LENGTH}
    segments = [{"line_type": n, "length": elements[n], "elements": 2} for n in ("cable", "pipe", "cable")]
    scene = riser_scene(
        static(),
        dynamic(periods / NATURAL, 1.0 / (steps * NATURAL)),
        pipe={},
        length=1.0,
        elements=1,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(0.0, 0.0, top),
        riser={"segments": segments, "initial": "straight"},
        line_types={"cable": cable, "pipe": pipe},
        water={"density": RHO, "current": {"profile": [[0.0, U, 0.0]]}},
    )
    return U, shaken(scene)


def oscillation(motion: Shaken, axis: int = 1) -> tuple[float, float]:
    """Frequency [Hz] and amplitude [m] of the middle along an axis: across the flow, or 0 in line with it."""
    t, y = motion.t[motion.later], motion.x[motion.later, motion.x.shape[1] // 2, axis]
    y = y - y.mean()
    (up,) = np.nonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    cross = t[up] - y[up] * (t[up + 1] - t[up]) / (y[up + 1] - y[up])
    return (len(cross) - 1) / (cross[-1] - cross[0]), math.sqrt(2.0) * y.std()


@pytest.mark.parametrize("reduced", [5.0, 5.5, 6.0])
def test_a_cylinder_locks_in_at_nearly_a_diameter(reduced: float) -> None:
    """Drag takes what the vortices give: with w = sqrt(U^2 + y'^2) the flow past it, and the lag of the force from its
    mean, f D/mean(w) = f0 + df sin(theta), the velocity's amplitude is U Cv/Cd cos(theta). This leaves
    out that the cylinder moves in line, too, at twice the frequency by a tenth of the flow's speed.
    """
    U, motion = mounted(reduced)
    f, A = oscillation(motion)
    assert 0.7 < A / D < 1.0
    assert 1.0 < f / NATURAL < 1.1
    speed = 2.0 * math.pi * f * A
    past = float(np.hypot(U, speed * np.cos(np.linspace(0.0, 2.0 * math.pi, 400, endpoint=False))).mean())
    lag = (f * D / past - MIDDLE) / WIDTH
    assert speed == pytest.approx(U * CV / CD * math.sqrt(1.0 - lag**2), rel=0.05)
    assert motion.work("vortices") == pytest.approx(-motion.work("morison"), rel=2e-3)
    assert motion.work("vortices") > 0.0


@pytest.mark.verify
def test_half_the_step_gives_the_same() -> None:
    coarse, fine = (oscillation(mounted(5.5, steps)[1]) for steps in (60, 120))
    assert coarse == pytest.approx(fine, rel=2e-3)


def test_off_resonance_the_cylinder_hardly_moves() -> None:
    assert oscillation(mounted(2.0)[1])[1] < 0.06 * D


@pytest.mark.parametrize("reduced", [2.6, 2.8, 3.0])
def test_in_line_a_cylinder_locks_in_where_drag_takes_what_vortices_give(reduced: float) -> None:
    """At half the speed of the lock-in across. The force's power over a period is rho D C U^2 v/4 cos(theta), that of
    the drag rho D Cd U v^2/2 by the velocity's amplitude v, which is small beside U: so v = U C cos(theta)/(2 Cd).
    """
    C = 0.2
    U, motion = mounted(reduced, in_line=C)
    f, A = oscillation(motion, axis=0)
    lag = (f * D / U - 2.0 * MIDDLE) / (2.0 * WIDTH)
    assert abs(lag) < 0.5
    assert 2.0 * math.pi * f * A == pytest.approx(0.5 * U * C / CD * math.sqrt(1.0 - lag**2), rel=0.05)
    assert np.abs(motion.x[..., 1]).max() < 1e-6 * A
    assert motion.work("vortices in line") > 0.0


def test_in_line_nothing_locks_in_a_slow_flow() -> None:
    slow, locked = (oscillation(mounted(reduced, in_line=0.2)[1], axis=0)[1] for reduced in (1.5, 2.8))
    assert slow < 0.2 * locked


# A riser under tension in a current that grows with height

RISER, THIN, TOP = 60.0, 0.1, 0.6
# Hz, by the same spectrum; largest A/D: MoorDyn 2.7.2, 160 elements, steps of 0.25 ms (benchmarks.peers.shaken).
BY_MOORDYN = 0.967, 0.700


def shear_of(elements: int = 40, dt: float = 0.02, duration: float = 60.0, **scheme: Any) -> Shaken:
    pipe = {"mass": 15.0, "outer_diameter": THIN, "EA": 2.0e6, "EI": 1.0e3, "GJ": 1.0e3} | FORCES
    top = RISER * 1.01
    scene = riser_scene(
        static(),
        dynamic(duration, dt, **scheme),
        pipe=pipe,
        length=RISER,
        elements=elements,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(0.0, 0.0, top),
        riser={"initial": "straight"},
        water={"density": RHO, "current": {"profile": [[0.0, 0.2, 0.0], [top, TOP, 0.0]]}},
    )
    return shaken(scene)


@cache
def in_shear(elements: int = 40) -> Shaken:
    return shear_of(elements)


def strongest(motion: Shaken) -> tuple[float, float]:
    """Frequency [Hz] with the most energy across the flow, all nodes together; largest amplitude [m]."""
    y = motion.x[motion.later, :, 1]
    y = y - y.mean(axis=0)
    power = (np.abs(np.fft.rfft(y * np.hanning(len(y))[:, None], axis=0)) ** 2).sum(axis=1)
    frequency = np.fft.rfftfreq(len(y), motion.t[1] - motion.t[0])[power.argmax()]
    return float(frequency), math.sqrt(2.0) * float(y.std(axis=0).max())


def test_a_riser_in_shear_is_shaken_at_the_fast_flow_s_frequency() -> None:
    frequency, amplitude = strongest(in_shear())
    assert frequency == pytest.approx(MIDDLE * TOP / THIN, rel=0.15)
    assert frequency == pytest.approx(BY_MOORDYN[0], abs=0.5 / 30.0)  # the spectrum of 30 s tells no more
    assert amplitude / THIN == pytest.approx(BY_MOORDYN[1], rel=0.02)


@pytest.mark.verify
def test_twice_the_elements_shake_alike() -> None:
    coarse, fine = strongest(in_shear(elements=20)), strongest(in_shear())
    assert coarse == pytest.approx(fine, rel=0.02)


def test_places_are_of_the_second_order_in_the_step() -> None:
    """By average acceleration: less, as of generalised-alpha, makes accelerations of the first order, which the phase
    follows.
    """
    coarse, middle, fine = (shear_of(10, 0.01 / n, 1.2, scheme=AVERAGE).x[-1] for n in (1, 2, 4))
    assert np.abs(coarse - middle).max() / np.abs(middle - fine).max() == pytest.approx(4.0, rel=0.1)
