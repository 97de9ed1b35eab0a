"""Time steps of joined lines and bodies in the line solver, beside those by SNES over their parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from benchmarks.stage import TimedStage
from riser_soil.assembly import build
from riser_soil.core.arrays import Array, BoolArray
from riser_soil.core.bound import in_turn
from riser_soil.core.part import Energy, State
from riser_soil.core.roles import owners
from riser_soil.core.saved_state import Saved, gathered, restore_all
from riser_soil.core.system import System, Timer
from riser_soil.riser.part_kernels import Border
from riser_soil.riser.section_forces import SectionForces
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.solve.bordered_band import band_of
from riser_soil.solve.line_solver import LineSolver
from riser_soil.solve.line_system import LineSystem
from riser_soil.solve.soil_border import SoilBorder
from riser_soil.solve.step_iteration import STATIC
from riser_soil.stages import LayingCounter, lay, run_stage
from tests.support.line_scenes import CHAIN, DEPTH, IN_WATER, RIGID, hung_over_clay, mooring, shaken

WAVES: Mapping[str, Any] = {"airy": {"height": 2.0, "period": 4.0}, "ramp": 1.0}
STEPS = 12


def buoy_in_waves() -> dict[str, Any]:
    """A point, half of it in the water, on lines of which much lies on the ground."""
    scene = mooring(shaken(), elements=16)
    scene["water"] |= {"waves": WAVES, "depth": DEPTH, "current": {"profile": [[-DEPTH, 0.1, 0.0], [0.0, 0.5, 0.2]]}}
    scene["bodies"]["buoy"] |= {"position": [0.0, 0.0, -0.2], "volume": 9.0}
    for line in scene["lines"].values():
        line["segments"][0]["length"] = 150.0
    return scene | {"seabed": {"kind": "spring", "stiffness": 1.0e5, "level": -DEPTH - 0.025}}


def rigid_buoy() -> dict[str, Any]:
    """One that turns, on lines at arms, one of them clamped to it, with a load that varies."""
    load = {"force": [2.0e3, 0.0, 1.0e3], "moment": [0.0, 3.0e3, 1.0e3], "history": [[0.0, 0.0], [0.3, 1.0]]}
    scene = mooring(shaken() | {"bodies": {"buoy": {"loads": [load]}}}, body=RIGID, elements=12)
    scene["joints"]["north_top"]["kind"] = "clamped"
    return scene


def bundle() -> dict[str, Any]:
    """Two lines side by side, tied along their length and at their ends above, where the second has no support."""
    segments = [{"line_type": "chain", "length": 60.0, "elements": 12}]
    points = [{"position": [0.0, 0.0, -30.0]}, {"position": [50.0, 0.0, -10.0]}]
    ties = {
        f"tie_{n}": {"kind": "clamped" if n == 2 else "pinned", "keep_distance": True}
        | {"between": [{"line": name, "at": 15.0 * n} for name in ("first", "second")]}
        for n in range(1, 5)
    }
    beside = {"segments": segments, "start": {"position": [0.0, 0.5, -30.0]}, "end": "free"}
    heave = {"amplitude": [0.0, 0.8, 1.0], "period": 3.0, "ramp": 1.0}
    moved = {"lines": {"first": {"motion": {"end": {"harmonic": heave}}}}}
    return {
        "title": "A bundle",
        "water": {"density": 1025.0, "surface_level": 0.0},
        "line_types": {"chain": CHAIN | IN_WATER},
        "lines": {"first": {"segments": segments, "start": points[0], "end": points[1]}, "second": beside},
        "joints": ties,
        "stages": [{"name": "rest", "kind": "static"}, shaken(time_step=0.02) | moved],
    }


def on_elastic_soil() -> dict[str, Any]:
    """A riser on soil below, whose upper end hangs on a buoy, which another line holds."""
    sway = {"amplitude": [0.3, 0.0, 0.3], "period": 3.0, "ramp": 1.0}
    moved = {"lines": {"upper": {"motion": {"end": {"harmonic": sway}}}}}
    scene = hung_over_clay(shaken() | moved)
    scene["soil"] |= {"law": {"kind": "linear-elastic", "E": 4.0e5, "nu": 0.45}}
    scene["soil"]["mesh"]["size_at_riser"] |= {"across": 0.1, "strip": 0.3}
    return scene | {"contact": {"method": "surface", "smoothing": 1e-3}}


SCENES = {
    "a buoy in waves": buoy_in_waves,
    "a rigid buoy": rigid_buoy,
    "a bundle": bundle,
    "on elastic soil": on_elastic_soil,
}


def scene_of(case: str, newton: str) -> Scene:
    solver = {"newton": newton, "tolerance": 1e-9} | ({"soil": "condensed"} if "soil" in case else {})
    return scene_from_mapping(SCENES[case]() | {"solver": solver})


@cache
def at_rest(case: str) -> tuple[Saved, Saved]:
    """What the assembly and its parts keep at the end of the static stage."""
    scene = scene_of(case, "compiled")
    assembly = build(scene, MPI.COMM_SELF)
    before, _ = lay(assembly, Timer.new())
    run_stage(assembly, scene.stages[0], before, LayingCounter(), Timer.new())
    kept = assembly.state()
    return kept, gathered(owners(assembly.begin(scene.stages[0])))


def last_stage(case: str, newton: str) -> TimedStage:
    """The second stage, as it begins."""
    scene, (of_assembly, of_parts) = scene_of(case, newton), at_rest(case)
    assembly = build(scene, MPI.COMM_SELF)
    restore_all(owners(assembly.begin(scene.stages[0])), of_parts)
    assembly.restore(of_assembly)
    return TimedStage(assembly, scene.stages[1], State.at_rest(0.0, assembly.size), Timer.new())


@pytest.mark.parametrize("case", SCENES)
def test_steps_are_those_of_snes(case: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(loop: LineSolver) -> bool:
        raise AssertionError("a step was left to Newton's method over the parts")

    monkeypatch.setattr(LineSolver, "leave_to_parts", refuse)
    compiled, snes = (last_stage(case, newton) for newton in ("compiled", "snes"))
    assert compiled.newton.lines is not None
    assert snes.newton.lines is None
    for stage in (compiled, snes):
        stage.walk(STEPS)
    # Stiff joints leave round-off near the tolerance: either may take an iteration more in a step.
    assert abs(compiled.iterations - snes.iterations) <= 0.25 * snes.iterations
    computed, expected = compiled.stepper, snes.stepper
    for field in snes.system.model.lines:
        rates, at = expected.before.v, slice(field.offset, field.offset + field.size)
        assert np.abs(rates[at]).max() > 1e-2, field.name
        np.testing.assert_allclose(computed.before.v[at], rates[at], rtol=0.0, atol=1e-6, err_msg=field.name)
    for mine, other in zip(compiled.assembly.lines.values(), snes.assembly.lines.values(), strict=True):
        place, wanted = mine.line.positions3(computed.before), other.line.positions3(expected.before)
        np.testing.assert_allclose(place, wanted, rtol=0.0, atol=1e-8)
        sections, by_snes = (
            SectionForces(own.line, own.elements, stage.newton.accepted.section_input(own.line, stage.stepper.now))
            for stage, own in ((compiled, mine), (snes, other))
        )
        for name in ("force", "moment", "end_force"):
            values, wanted = getattr(sections, name), getattr(by_snes, name)
            np.testing.assert_allclose(values, wanted, rtol=0.0, atol=1e-5 * np.abs(wanted).max())
    assert computed.energy.total == pytest.approx(expected.energy.total, rel=1e-9)
    for name, work in snes._taken.turned.items():
        mine_turned = [*vars(compiled._taken.turned[name]).values()]
        np.testing.assert_allclose(mine_turned, [*vars(work).values()], rtol=1e-5, atol=1e-5)
    for stage in (compiled, snes):
        stage.destroy()


def at_first_step(case: str) -> LineSystem:
    """The loop where it has solved the first step."""
    stage = last_stage(case, "compiled")
    assert stage.newton.lines is not None
    stage.walk(1)
    return stage.newton.lines.packed


def soil_in(packed: LineSystem, of: Callable[[Border], Array]) -> Array:
    """What a border has of soil's reached dofs; none without soil."""
    soil = next((each for each in packed.couplings if isinstance(each, SoilBorder)), None)
    return np.empty(0) if soil is None else of(soil._border.value)[: len(soil._data.value.holding)]


def increments(packed: LineSystem) -> Array:
    return np.concatenate([*(line.step.u.ravel() for line in packed.lines), soil_in(packed, lambda border: border.u)])


def put(packed: LineSystem, x: Array) -> None:
    first = 0
    for line in packed.lines:
        line.step.u.ravel()[:] = x[first : first + line.line.size]
        first += line.line.size
    soil_in(packed, lambda border: border.u)[:] = x[first:]


def residual(packed: LineSystem, x: Array) -> Array:
    put(packed, x)
    packed.evaluate()
    of_lines = (line.dofs.residual.ravel() for line in packed.lines)
    return np.concatenate([*of_lines, soil_in(packed, lambda border: border.residual)])


def matrix(packed: LineSystem) -> Array:
    """The whole tangent (n, n) of lines and soil: bands, and the border with what couples it."""
    packed.write_tangent()
    border = packed.border
    assert border is not None
    first = np.cumsum([0, *(line.line.size for line in packed.lines)])
    ns = len(soil_in(packed, lambda border: border.u))
    n, corner = first[-1] + ns, border.of[packed.lines[0]].value.corner
    own = np.arange(n - ns, n - ns + len(corner))  # number of each unknown of the border
    for start, line in zip(first, packed.lines, strict=False):
        factors = border._factors[line].value
        own[factors.place[factors.moved]] = start + factors.moved
    out, fixed = np.zeros((n, n)), np.zeros(n, dtype=bool)
    out[np.ix_(own, own)] = corner
    for start, line in zip(first, packed.lines, strict=False):
        coupling, at = border.of[line].value, np.arange(start, start + line.line.size)
        inner = np.setdiff1d(at, own) - start
        for i in inner:
            for j in inner[np.abs(inner - i) <= len(line.workspace.band)]:
                out[start + i, start + j] = line.workspace.ab[i, j - i + len(line.workspace.band)]
        out[np.ix_(start + inner, own)] = coupling.right[inner]
        out[np.ix_(own, start + inner)] = coupling.below[inner].T
        fixed[at] = line.dofs.fixed.ravel()
    out[fixed] = out[:, fixed] = 0.0
    out[fixed, fixed] = 1.0
    return out


def shaken_increments(packed: LineSystem) -> tuple[Array, BoolArray]:
    """Increments near those of the step, and which of them are free."""
    x = increments(packed)
    free = np.concatenate([~line.dofs.fixed.ravel() for line in packed.lines])
    free = np.pad(free, (0, len(x) - len(free)), constant_values=True)
    return x + 1e-4 * np.random.default_rng(3).normal(size=x.size) * free, free


@pytest.mark.parametrize("case", SCENES)
def test_the_tangent_is_the_slope_of_the_residual(case: str) -> None:
    packed = at_first_step(case)
    x, free = shaken_increments(packed)
    residual(packed, x)
    tangent, random = matrix(packed), np.random.default_rng(4)
    for _ in range(3):
        direction = random.normal(size=x.size) * free
        h = 1e-6 / np.abs(direction).max()
        slope = (residual(packed, x + h * direction) - residual(packed, x - h * direction)) / (2.0 * h)
        sizes = np.abs(tangent) @ np.abs(direction)
        assert np.abs(slope - tangent @ direction)[free].max() < 1e-7 * sizes.max()
        assert (np.abs(slope - tangent @ direction)[free] < 1e-5 * sizes[free] + 1e-9 * sizes.max()).all()


def test_terms_of_what_soil_and_line_do_to_each_other() -> None:
    """Products of tangent and coordinates: of soil's rows all, of the line's those by what touches it."""
    packed = at_first_step("on elastic soil")
    residual(packed, shaken_increments(packed)[0])
    K = np.abs(matrix(packed))
    soil = next(each for each in packed.couplings if isinstance(each, SoilBorder))
    moved = np.abs(soil._data.value.accepted + soil_in(packed, lambda border: border.u))
    sizes = np.concatenate([*(line.dofs.sizes.ravel() for line in packed.lines), moved])
    touched, n = soil._packed, len(sizes) - len(moved)
    at = slice(touched.line.offset, touched.line.offset + touched.line.size)
    touched.dofs.terms[...] = 0.0
    in_turn(*soil.terms())()
    own, by_itself = touched.workspace, np.zeros(touched.line.size)
    for rows, block in zip(own.rows, np.abs(own.K), strict=True):
        by_itself[rows] += block @ sizes[at][rows]
    assert K[n:, at].any()
    np.testing.assert_allclose(soil._data.value.terms, K[n:] @ sizes, rtol=1e-12)
    np.testing.assert_allclose(touched.dofs.terms.ravel(), by_itself + K[at, n:] @ moved, rtol=1e-12)


def left_over(packed: LineSystem) -> float:
    """What the factors' answer to a residual leaves of it by the whole matrix, relative."""
    x, _ = shaken_increments(packed)
    load = residual(packed, x)
    whole = matrix(packed)
    packed.correct()
    return float(np.linalg.norm(load - whole @ (x - increments(packed))) / np.linalg.norm(load))


@pytest.mark.parametrize("case", SCENES)
def test_the_factors_answer_as_the_whole_matrix_does(case: str) -> None:
    assert left_over(at_first_step(case)) < 1e-9


def test_many_joints_are_left_to_newton(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whose sparse factors cost less than dense ones."""
    monkeypatch.setattr("riser_soil.solve.joint_border.MOST_JOINTS", len(bundle()["joints"]) - 1)
    assert last_stage("a bundle", "compiled").newton.lines is None


@pytest.mark.parametrize(("case", "border"), [("a buoy in waves", 3), ("a rigid buoy", 6), ("a bundle", 21)])
def test_statics_and_steps_eliminate_the_fewest_rows_that_joints_have(case: str, border: int) -> None:
    """A body's own; of lines those of one side: six, and three rotations where the line has a support."""
    scene = scene_from_mapping(SCENES[case]())
    assembly = build(scene, MPI.COMM_SELF)
    lay(assembly, Timer.new())
    system = System(assembly.comm, assembly.begin(scene.stages[0]), Timer.new())
    band = band_of(system)
    assert band is not None
    assert len(band.rows[1]) == border
    stage = last_stage(case, "compiled")
    assert stage.newton.lines is not None
    in_steps = stage.newton.lines.packed.border
    assert in_steps is not None
    assert len(in_steps.of[stage.newton.lines.packed.lines[0]].value.residual) == border
    load = np.random.default_rng(3).normal(size=system.numbering.free)
    system.assemble(State.at_rest(0.0, system.numbering.size), STATIC)
    answer = band.solve(load)
    starts, columns, values = system.matrix.stored.csr()
    terms = np.add.reduceat(np.abs(values * answer[columns]), starts[:-1])  # of each row's product
    assert np.abs(system.matrix.stored.times(answer) - load).max() < 1e-10 * terms.max()


def test_joints_store_what_they_stretch() -> None:
    """The loop's energy of joints is that of the part."""
    stage = last_stage("a bundle", "compiled")
    assert stage.newton.lines is not None
    stage.walk(1)
    bodies_and_joints = stage.assembly.bodies_and_joints
    assert bodies_and_joints is not None
    assert bodies_and_joints.joints is not None
    step = stage.stepper.next_step(stage.control)
    solution = stage.newton.solve(step)
    energy, _ = stage.newton.accepted.energy_exchanged(step.before, solution)
    parts: Energy = sum((part.energy(solution.state) for part in stage.system.model.parts), Energy())
    assert bodies_and_joints.joints.energy(solution.state).strain > 0.0
    assert energy.strain == pytest.approx(parts.strain, rel=1e-12)
    assert energy.potential == pytest.approx(parts.potential, rel=1e-12)
