"""Clump weights and buoyancy modules against closed forms: tension, force balance, frequencies."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.special import ellipk

from riser_soil.assembly import Assembly
from riser_soil.core.part import State, Weights
from riser_soil.riser import shapes
from riser_soil.riser.attachments import PointAttachment, masses
from riser_soil.riser.beam import Beam
from riser_soil.riser.hermite import consistent_mass
from riser_soil.riser.inertia import Inertia
from riser_soil.riser.line import Line
from riser_soil.riser.line_ends import End, Kinematics
from riser_soil.riser.line_part import acting_on
from riser_soil.riser.section_forces import SectionForces, element_residual
from tests.support.dense_chain import solve, tangent
from tests.support.driven_stage import built, take
from tests.support.pipes import WEIGHTLESS, pipe
from tests.support.sample_line import sample
from tests.support.scenes import AVERAGE, Mapping, dynamic, prescribed, riser_scene, static
from tests.support.sections import section_forces
from tests.support.stage_histories import stage_histories

G, RHO = 9.81, 1025.0
PIPE = {"EA": 1.0e9, "EI": 1.0e3, "GJ": 1.0e3, "mass": 20.0, "submerged_weight": 100.0}
both_dimensions = pytest.mark.parametrize("dimension", [2, 3])


def scene(*stages: Mapping, attachments: list[Mapping], riser: Mapping | None = None, **more: Any) -> Mapping:
    settings: dict[str, Any] = {"gravity": G, "water": {"density": RHO}, "pipe": PIPE, "elements": 10, "length": 20.0}
    return riser_scene(*stages, riser={"attachments": attachments} | (riser or {}), **(settings | more))


def inside(assembly: Assembly) -> SectionForces:
    """Section forces at the end of the scene's only, static stage."""
    (stage,) = assembly.scene.stages
    state = take(assembly, stage)
    parts = acting_on(assembly.riser.line, assembly.begin(stage).parts)
    at = State.at_rest(1.0, state.u.size)
    residual = element_residual(assembly.riser.line, parts, at)
    return section_forces(assembly.riser.line, assembly.riser.elements, at, residual)


@both_dimensions
def test_tension_jumps_by_the_weight_of_what_hangs(dimension: int) -> None:
    """A line hangs from its start with clumps at a node, within an element and at its end."""
    clumps: list[Mapping] = [{"at": [6.0, 20.0], "mass": 50.0}, {"at": 10.7, "mass": 300.0, "volume": 0.1}]
    down = {"unstressed": {"points": [[0.0, 0.0, 20.0], [0.0, 0.0, 0.0]]}}
    assembly = built(
        scene(
            static(),
            attachments=clumps,
            riser=down,
            start=prescribed(0.0, 0.0, 20.0),
            end="free",
            dimension=dimension,
        )
    )
    arc, tension = assembly.riser.line.arc, inside(assembly).effective_tension
    weights = {6.0: 50.0 * G, 10.7: (300.0 - 0.1 * RHO) * G, 20.0: 50.0 * G}
    expected = 100.0 * (20.0 - arc) + sum(w * (arc <= s + 1e-9) for s, w in weights.items())
    assert tension == pytest.approx(expected, rel=1e-9)


@both_dimensions
def test_a_buoy_holds_its_mooring_straight_up(dimension: int) -> None:
    buoy = [{"at": 20.0, "mass": 200.0, "volume": 1.0}]
    up = {"unstressed": {"points": [[0.0, 0.0, 0.0], [0.0, 0.0, 20.0]]}}
    assembly = built(
        scene(static(), attachments=buoy, riser=up, start=prescribed(0.0, 0.0, 0.0), end="free", dimension=dimension)
    )
    lift = (RHO - 200.0) * G
    tension = inside(assembly)
    assert tension.effective_tension == pytest.approx(lift - 100.0 * (20.0 - assembly.riser.line.arc), rel=1e-9)
    assert tension.force[0] == pytest.approx([0.0, 0.0, lift - 2000.0], rel=1e-9, abs=1e-6)
    assert assembly.riser.line.to_global(assembly.riser.line.x)[-1] == pytest.approx([0.0, 0.0, 20.0], abs=1e-3)


def test_a_lazy_wave_balances_at_every_node() -> None:
    """The horizontal force is the same all along; the vertical one grows by all weight and buoyancy on the way."""
    places = [float(s) for s in np.linspace(35.0, 64.5, 11)]
    modules = [{"at": places, "mass": 60.0, "volume": 0.12}]
    assembly = built(
        scene(
            static(),
            attachments=modules,
            length=120.0,
            elements=60,
            start=prescribed(0.0, 0.0, 0.0),
            end=prescribed(60.0, 0.0, 60.0),
            riser={"initial": "catenary"},
        )
    )
    tension, arc = inside(assembly), assembly.riser.line.arc
    net = (60.0 - 0.12 * RHO) * G
    below = sum(net * (arc > s + 1e-9) for s in places)
    assert tension.force[:, 0] == pytest.approx(np.full(61, tension.force[0, 0]), rel=1e-7)
    assert tension.force[:, 2] - tension.force[0, 2] == pytest.approx(100.0 * arc + below, rel=1e-7, abs=1e-3)
    height = assembly.riser.line.to_global(assembly.riser.line.x)[:, 2]
    turns = [i for i in range(1, 60) if (height[i] - height[i - 1]) * (height[i + 1] - height[i]) < 0.0]
    assert len(turns) == 3  # sag bend, hog bend, sag bend


def test_a_mass_at_a_node_is_the_lumped_mass() -> None:
    at = sample(2)
    along, ends = masses(at.line, [PointAttachment(3.0, 7.0), PointAttachment(8.0, 5.0)])
    expected = np.zeros((5, 4, 4))
    expected[2, 0, 0] = 7.0
    assert along.tolist() == expected.tolist()
    assert ends.tolist() == [0.0, 5.0]


def test_many_masses_are_a_mass_per_length() -> None:
    """Midpoints of many equal parts integrate m N N^T to second order."""
    line = sample(2).line
    errors = []
    for n in (20, 40):
        elements_of_line = list(zip(line.arc[:-1], line.length, strict=True))
        many = [PointAttachment(s + L * (k + 0.5) / n, 3.0 * L / n) for s, L in elements_of_line for k in range(n)]
        M = masses(line, many).along
        errors.append(np.abs(M - consistent_mass(line.length, np.full(5, 3.0))).max())
    assert errors[0] < 5e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)


TAUT, EI, LENGTH, TENSION = 1.0e10, 500.0, 30.0, 4.0e4


def lowest_frequency(place: float, mass: float, count: int) -> float:
    """Angular frequency [rad/s] of a mass on a taut massless line with pinned ends, in the plane."""
    e = pipe(LENGTH, count, WEIGHTLESS, EA=TAUT, EI=EI)
    straight = shapes.straight(e.arc)

    def stretch(t: float) -> Kinematics:
        return np.array([LENGTH * (1.0 + t * TENSION / TAUT), 0.0, 0.0]), np.zeros(3), np.zeros(3)

    line = Line(2, shapes.layout(e.arc, e.outer_diameter, straight, straight), End(True), End(True, motion=stretch))
    beam = Beam(line, e)
    inertia = Inertia(line, e.mass, masses(line, [PointAttachment(place, mass)]))
    solve(line, [beam], tolerance=1e-9)
    state, only_mass = State.at_rest(1.0, line.size), Weights(1.0, 0.0, 0.0, 1.0)
    across = np.zeros((line.nodes, 3), dtype=bool)
    across[:, 1:] = True
    at = np.ix_(*[np.flatnonzero(across.ravel() & ~line.prescribed)] * 2)
    K, M = tangent([beam], state)[at], tangent([inertia], state, only_mass)[at]
    return float(1.0 / np.sqrt(eigh(M, K, eigvals_only=True)[-1]))


def exact_frequency(place: float, mass: float) -> float:
    """Frequency by the deflection F/T [a b/L - sinh(ka) sinh(kb)/(k sinh(kL))], k^2 = T/EI, under a force F of a pinned
    beam with tension T (Timoshenko and Gere, Theory of Elastic Stability, 1961, chapter 1).
    """
    k, a, b = np.sqrt(TENSION / EI), place, LENGTH - place
    layer = np.sinh(k * a) * np.sinh(k * b) / (k * np.sinh(k * LENGTH))
    return float(np.sqrt(TENSION / (mass * (a * b / LENGTH - layer))))


def test_frequency_of_a_mass_on_a_taut_line() -> None:
    assert exact_frequency(12.0, 90.0) == pytest.approx(np.sqrt(TENSION * (1 / 12 + 1 / 18) / 90.0), rel=0.01)
    assert lowest_frequency(12.0, 90.0, 120) == pytest.approx(exact_frequency(12.0, 90.0), rel=1e-4)


def test_a_mass_within_an_element_converges() -> None:
    """A cubic can't take the kink in the shear force under what sits within it: third order."""
    frequencies = np.array([lowest_frequency(15.0, 90.0, n) for n in (151, 303, 607)])
    errors = np.abs(frequencies / exact_frequency(15.0, 90.0) - 1.0)
    assert errors[0] < 2e-4
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(orders > 2.5), f"errors {errors}, orders {orders}"


@both_dimensions
def test_a_pendulum_of_a_rod_and_masses_keeps_time_and_energy(dimension: int) -> None:
    """A stiff rod of mass m L with masses m_i at l_i swings by I phi'' = -g S sin(phi)."""
    tilt = np.radians(20.0)
    rod = PIPE | {"EI": 1.0e7, "GJ": 1.0e7, "mass": 2.0, "submerged_weight": 2.0 * G}
    tip = [10.0 * np.sin(tilt), 0.0, -10.0 * np.cos(tilt)]
    leaning = {"unstressed": {"points": [[0.0, 0.0, 0.0], tip]}}
    masses = {4.3: 30.0, 10.0: 15.0}
    I = 2.0 * 10.0**3 / 3.0 + sum(m * s**2 for s, m in masses.items())
    S = 2.0 * 10.0**2 / 2.0 + sum(m * s for s, m in masses.items())
    period = 4.0 * np.sqrt(I / (G * S)) * ellipk(np.sin(0.5 * tilt) ** 2)
    swing = scene(
        dynamic(period, period / 200.0, scheme=AVERAGE),
        attachments=[{"at": s, "mass": m} for s, m in masses.items()],
        riser=leaning,
        pipe=rod,
        length=10.0,
        elements=4,
        start=prescribed(0.0, 0.0, 0.0),
        end="free",
        dimension=dimension,
    )
    (history,) = stage_histories(swing)
    x = np.array([position[-1, 0] for position in history.position])
    crossings = [i for i, (a, b) in enumerate(pairwise(x)) if a > 0.0 >= b or a < 0.0 <= b]
    times = [history.t[i] + history.dt[i] * x[i] / (x[i] - x[i + 1]) for i in crossings]
    assert np.diff(times) == pytest.approx([0.5 * period], rel=2e-4)
    assert np.ptp(history.energy) < 1e-3 * G * S * (1.0 - np.cos(tilt))


@both_dimensions
def test_the_support_moves_what_sits_at_its_end(dimension: int) -> None:
    """A mass at a moving prescribed end adds m (g + a) to the reaction there, and nothing to the line's tension."""
    amplitude, period, t, mass = 0.2, 4.0, 5.3, 70.0
    motion = {"end": {"harmonic": {"amplitude": [0.0, 0.0, amplitude], "period": period, "ramp": 1.0}}}
    ends = {"start": prescribed(0.0, 0.0, 0.0), "end": prescribed(10.0, 0.0, 12.0)}
    soft = PIPE | {"EA": 1.0e6}
    stage = dynamic(t, 0.1, motion=motion)
    bare, laden = (
        stage_histories(scene(stage, attachments=attached, dimension=dimension, pipe=soft, **ends))[0].end
        for attached in ([], [{"at": 20.0, "mass": mass}])
    )
    omega = 2.0 * np.pi / period
    a = -amplitude * omega**2 * np.sin(omega * t)
    assert laden.end_force - bare.end_force == pytest.approx([0.0, 0.0, mass * (G + a)], abs=1e-3)
    assert laden.effective_tension == pytest.approx(bare.effective_tension, rel=1e-6)


def pressed_in(count: int, EI: float, clump: float) -> tuple[float, float]:
    """A pipe of so many elements lies on springs with a clump at its middle: how deep it is there, and the bed's force.
    """
    bed, pipe = 1.0e5, PIPE | {"EI": EI, "outer_diameter": 0.2, "submerged_weight": 500.0, "mass": 90.0}
    height = 0.1 - 500.0 / bed
    assembly = built(
        scene(
            static(),
            attachments=[{"at": 20.0, "mass": clump / G}],
            pipe=pipe,
            length=40.0,
            elements=count,
            start=prescribed(0.0, 0.0, height),
            end=prescribed(40.0, 0.0, height),
            seabed={"kind": "spring", "level": 0.0, "stiffness": bed},
            contact={},
        )
    )
    state = take(assembly, assembly.scene.stages[0])
    at, seabed = State.at_rest(1.0, state.u.size), assembly.riser.seabed
    assert seabed is not None
    return float(seabed.penetration(at)[count // 2]), float(seabed.force_on_riser(at)[2])


def test_a_clump_on_a_lying_pipe_sinks_in_as_a_beam_on_springs_does() -> None:
    """The clump sinks by W lambda/(2 k) beyond the pipe's own w/k, with lambda^4 = k/(4 EI): elements must resolve
    1/lambda = 2.5 m.

    Its weight is all borne by the bed, however long the elements are.
    """
    EI, clump, bed = 1.0e6, 5.0e3, 1.0e5
    wave = (bed / (4.0 * EI)) ** 0.25
    expected = 500.0 / bed + clump * wave / (2.0 * bed)
    errors = []
    for count in (8, 16, 32):
        deepest, borne = pressed_in(count, EI, clump)
        assert borne == pytest.approx(500.0 * 40.0 + clump, rel=0.01)
        errors.append(abs(deepest / expected - 1.0))
    assert errors[-1] < 2e-3
    assert all(finer < 0.5 * coarse for coarse, finer in pairwise(errors))
