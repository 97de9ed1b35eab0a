"""Slugs and flow in a riser, through statics and the time loop, against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.modes.modes import modes_of
from riser_soil.scene.reader import scene_from_mapping
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene, static
from tests.support.stage_histories import StageHistory, stage_histories

G, BORE = 9.81, 0.2
AREA = 0.25 * math.pi * BORE**2
OIL, WATER, EMPTY = 400.0, 1000.0, 60.0  # kg/m3, kg/m3, kg/m
PIPE: Mapping = {"EA": 1.0e9, "EI": 1.0e3, "GJ": 1.0e3, "mass": EMPTY, "outer_diameter": 0.25, "inner_diameter": BORE}
LENGTH = 40.0
both_dimensions = pytest.mark.parametrize("dimension", [2, 3])


def tension(history: StageHistory) -> Array:
    return np.asarray(history.end.effective_tension)


def upright(contents: Mapping, *stages: Mapping, **more: Any) -> Mapping:
    """A pipe that hangs from its start, its lower end free."""
    riser = {"unstressed": {"points": [[0.0, 0.0, 0.0], [0.0, 0.0, -LENGTH]]}, "contents": {"density": OIL} | contents}
    given: dict[str, Any] = {"pipe": PIPE, "length": LENGTH, "elements": 16, "gravity": G} | more
    return riser_scene(*stages, riser=riser, start=prescribed(0.0, 0.0, 0.0), end="free", **given)


def below(arc: Array, first: float, last: float) -> Array:
    """How much of a stretch lies beyond each arc length [m]."""
    return np.asarray(np.clip(last - np.maximum(arc, first), 0.0, None))


@both_dimensions
def test_standing_plugs_hang_from_what_is_above_them(dimension: int) -> None:
    """Weight below each node: that of pipe and oil, and of two plugs whose ends lie within elements."""
    plugs = [{"density": WATER, "length": 7.3, "front": 11.1}, {"density": 900.0, "length": 9.0, "front": 38.0}]
    (history,) = stage_histories(upright({"slugs": plugs}, static(), dimension=dimension))
    arc = np.linspace(0.0, LENGTH, 17)
    of_plugs = (WATER - OIL) * below(arc, 3.8, 11.1) + (900.0 - OIL) * below(arc, 29.0, 38.0)
    expected = G * ((EMPTY + OIL * AREA) * (LENGTH - arc) + of_plugs * AREA)
    np.testing.assert_allclose(tension(history), expected, rtol=1e-9, atol=1e-6)


def test_a_plug_that_heaves_adds_its_mass() -> None:
    """A stiff pipe whose support moves with the acceleration a pulls with (g + a) times all mass below."""
    plug, amplitude, period = {"density": WATER, "length": 10.0, "front": 25.0}, 0.5, 8.0
    motion = {"start": {"harmonic": {"amplitude": [0.0, 0.0, amplitude], "period": period, "ramp": 8.0}}}
    heave = dynamic(22.0, 0.05, motion=motion)
    at = {name: stage_histories(upright({"slugs": s}, static(), heave))[1] for name, s in (("no", []), ("one", [plug]))}
    omega = 2.0 * math.pi / period
    a = -amplitude * omega**2 * math.sin(omega * 22.0)
    arc = np.linspace(0.0, LENGTH, 17)
    more = (WATER - OIL) * AREA * below(arc, 15.0, 25.0)
    assert abs(a) > 0.03 * G
    np.testing.assert_allclose(tension(at["one"]) - tension(at["no"]), (G + a) * more, rtol=1e-3, atol=2.0)


@pytest.mark.parametrize("speed", [4.0, -4.0])
def test_the_top_bears_a_slug_as_long_as_it_is_in_the_pipe(speed: float) -> None:
    """It comes in slowly beside the axial vibrations of the pipe, runs through and leaves."""
    slug, m = {"density": WATER, "length": 12.0}, (WATER - OIL) * AREA
    for duration in (1.5, 6.0, 11.5):
        scene = upright({"speed": speed, "slugs": [slug]}, static(), dynamic(duration, 0.05), elements=9)
        _, history = stage_histories(scene)
        moved = abs(speed) * duration
        within = min(moved, LENGTH) - max(moved - 12.0, 0.0)
        expected = G * ((EMPTY + OIL * AREA) * LENGTH + m * within)
        assert tension(history)[0] == pytest.approx(expected, rel=2e-3)
        assert tension(history)[0] - G * (EMPTY + OIL * AREA) * LENGTH == pytest.approx(G * m * within, rel=0.05)


def hanging(contents: Mapping, *stages: Mapping, **more: Any) -> Mapping:
    given: dict[str, Any] = {"pipe": PIPE | {"EA": 1.0e11}, "length": 120.0, "elements": 60, "gravity": G} | more
    given |= {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(70.0, 0.0, 60.0)}
    return riser_scene(*stages, riser={"contents": {"density": OIL} | contents}, **given)


@both_dimensions
def test_a_hanging_pipe_keeps_its_shape_and_is_pulled_by_m_u_squared(dimension: int) -> None:
    """m u^2 x'' = (T x')' + w: as without flow, with T - m u^2 in the place of T."""
    still, flowing = (
        stage_histories(hanging({"speed": u}, static(), dimension=dimension))[0].end for u in (0.0, 30.0)
    )
    more = OIL * AREA * 30.0**2
    assert more > 0.1 * still.effective_tension.min()
    np.testing.assert_allclose(flowing.effective_tension - still.effective_tension, more, rtol=2e-3)
    np.testing.assert_allclose(flowing.position, still.position, atol=1e-4)


def test_energy_balances_while_slugs_run_through() -> None:
    """By average acceleration nothing is lost to the scheme: what is left over is of second order in the step."""
    slugs = [{"density": WATER, "length": 15.0, "spacing": 40.0}]
    errors = []
    for dt in (0.1, 0.05):
        stage = dynamic(8.0, dt, scheme=AVERAGE)
        scene = hanging({"speed": 10.0, "slugs": slugs}, static(), stage, pipe=PIPE, elements=30)
        _, history = stage_histories(scene)
        errors.append(abs(history.energy[-1] - history.energy[0] - sum(history.work[1:])))
        assert abs(sum(history.work[1:])) > 7e3
    assert errors[1] < 0.3 * errors[0]
    assert errors[1] < 1e-3 * 7e3


# A short slug on a straight beam

SPAN, EI, BEAM, SPEED = 20.0, 4.0e6, 100.0, 12.0


def test_a_short_slug_on_a_beam_is_a_moving_load() -> None:
    """A load P that moves at the speed c over a hinged beam of the mass m per length bends its middle by the sum of

        2 P/(m L) sin(j pi/2)/(w_j^2 - (j pi c/L)^2) [sin(j pi c t/L) - (j pi c/L)/w_j sin(w_j t)]

    (Fryba, Vibration of Solids and Structures under Moving Loads, 1972, chapter 1). The slug has a hundredth of the
    beam's mass, so that its own inertia hardly counts.
    """
    length, density = 0.5, 2.0e3
    m, P = BEAM + 1e-3 * AREA, density * AREA * length * G
    beam = {"EA": 1.0e9, "EI": EI, "mass": BEAM, "submerged_weight": 1.0e-9, "inner_diameter": BORE}
    contents = {"density": 1.0e-3, "speed": SPEED, "slugs": [{"density": density, "length": length, "front": 0.25}]}
    scene = riser_scene(
        *(static(), dynamic(1.0, 0.0025, scheme=AVERAGE)),
        pipe=beam,
        length=SPAN,
        elements=20,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(SPAN, 0.0, 0.0),
        gravity=G,
        riser={"contents": contents, "initial": "straight"},
        dimension=2,
    )
    _, history = stage_histories(scene)
    t, z = np.array(history.t), np.array(history.position)[:, 10, 2]
    expected = np.zeros_like(t)
    for j in range(1, 12, 2):
        w, drive = (j * math.pi / SPAN) ** 2 * math.sqrt(EI / m), j * math.pi * SPEED / SPAN
        sign = math.sin(0.5 * j * math.pi)
        shape = np.sin(drive * t) - drive / w * np.sin(w * t)
        expected -= sign * 2.0 * P / (m * SPAN) * shape / (w**2 - drive**2)
    assert np.abs(z - expected).max() < 0.03 * np.abs(expected).max()


def lowest_mode(contents: Mapping) -> float:
    """Frequency [Hz] of the same beam without gravity."""
    scene = riser_scene(
        static(),
        pipe={"EA": 1.0e9, "EI": EI, "mass": BEAM, "inner_diameter": BORE},
        length=SPAN,
        elements=20,
        start=prescribed(0.0, 0.0, 0.0),
        end=prescribed(SPAN, 0.0, 0.0),
        riser={"contents": contents, "initial": "straight"},
        dimension=2,
    )
    return float(modes_of(scene_from_mapping(scene), 1).frequency[0])


def test_modes_know_plugs_and_flow() -> None:
    """By their mass, and by m u^2 as a compression; without Coriolis's force."""
    at_rest = lowest_mode({"density": WATER})
    assert at_rest == pytest.approx(math.pi / 2.0 / SPAN**2 * math.sqrt(EI / (BEAM + WATER * AREA)), rel=1e-4)
    plug = {"density": OIL, "slugs": [{"density": WATER, "length": SPAN, "front": SPAN}]}
    assert lowest_mode(plug) == pytest.approx(at_rest, rel=1e-6)
    critical = math.pi / SPAN * math.sqrt(EI / (WATER * AREA))
    flowing = {"density": WATER, "speed": 0.5 * critical}
    assert lowest_mode(flowing) == pytest.approx(at_rest * math.sqrt(0.75), rel=1e-3)
