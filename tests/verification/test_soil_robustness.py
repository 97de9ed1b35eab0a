"""Coupled runs on difficult soil get to their end: almost incompressible, without strength at the seabed, in cells that
grow a thousandfold; stiff pipes that are pressed into fine cells; and pipes and risers that leave the soil as a whole
and come down again.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import System, Timer
from riser_soil.results import Run
from riser_soil.scene.reader import read_scene, scene_from_mapping
from riser_soil.scene.stages import Stage
from riser_soil.solve.time_stepper import AcceptedStep, TimeStepper
from riser_soil.stages import LAID_IN, run_stage
from riser_soil.whole_run import run
from tests.support.driven_stage import Watcher, built, soil_under, take
from tests.support.scenes import (
    CLAY,
    ELASTIC,
    LAY,
    MIDDLE,
    ON_BLOCK,
    Mapping,
    block,
    cells,
    falling_on_soil,
    heave,
    level_pipe,
    pushed_to,
    touchdown,
)


def changed(kind: str, law: Mapping) -> Mapping:
    scene = touchdown(LAY, heave(0.3), kind=kind, su=1000.0)
    scene["soil"]["law"] |= law
    scene["contact"] = {"method": "surface"}
    return scene


SCENES = {
    "nearly incompressible, hex": changed("hex", {"nu": 0.4999}),
    "nearly incompressible, tet": changed("tet", {"nu": 0.4999}),
    "no strength at the seabed, hex": changed("hex", {"su": 0.0, "su_gradient": 8.0e3}),
    "no strength at the seabed, tet": changed("tet", {"su": 0.0, "su_gradient": 8.0e3}),
}


@pytest.mark.verify
@pytest.mark.parametrize("name", SCENES)
def test_riser_is_laid_and_heaves_on_difficult_soil(name: str) -> None:
    runs_and_bears(SCENES[name])


def runs_and_bears(scene: Mapping) -> None:
    """Once the cushion is gone, the grounds bear the part of the weight that does not hang from the end."""
    assembly, borne, iterations = built(scene), list[float](), list[int]()

    def watch(system: System, step: AcceptedStep) -> None:
        state = step.solution.state
        borne.append(float(sum(contact.force_on_riser(state)[2] for contact in assembly.contacts)))
        iterations.append(step.solution.iterations)

    before = State.at_rest(0.0, assembly.size)
    for stage in assembly.scene.stages:
        before = take(assembly, stage, before, watch)
    weight = float(assembly.riser.elements.weight @ assembly.riser.line.length)
    print(f"borne {np.array(borne) / weight}, iterations {iterations}")
    after = np.array(borne[LAID_IN - 1 :])
    assert np.all((after > 0.2 * weight) & (after < weight))


CELL = 0.075  # m


class Laying(Watcher):
    """A riser is laid on cells of a quarter of its diameter, which grow to about `times` their size far from it."""

    def __init__(self, times: float, law: Mapping) -> None:
        super().__init__(self._count)
        scene, far = touchdown(LAY, su=2000.0), times * CELL
        side = max(2.0, 2.5 * far)
        scene["soil"]["block"] = {"x": [3.0, 6.0], "y": [-side, side], "depth": side}
        sizes = {"along": 1.5, "across": CELL, "strip": 0.15}
        scene["soil"]["mesh"] = {"kind": "hex", "size_at_riser": sizes, "size_far": far}
        scene["soil"]["law"] |= law
        self.iterations, self.cuts, self.assembly = list[int](), 0, built(scene)
        lay = self.assembly.scene.stages[0]
        state = run_stage(self.assembly, lay, State.at_rest(0.0, self.assembly.size), self, Timer.new())
        contact = soil_under(self.assembly).contact
        assert contact is not None
        self.borne = -float(contact.force_on_soil(state)[2])

    def _count(self, _: TimeStepper, step: AcceptedStep) -> None:
        self.iterations.append(step.solution.iterations)
        self.cuts += step.cuts


def growth(assembly: Assembly) -> tuple[float, float]:
    """The widest over the narrowest cell across the riser, and the deepest over the shallowest."""
    assert assembly.soil is not None
    points = np.round(assembly.soil.whole.output_mesh().points, 6)
    across, down = (np.diff(np.unique(points[:, axis])) for axis in (1, 2))
    return float(across.max() / across.min()), float(down.max() / down.min())


def lays_as_on_even_cells(law: Mapping) -> None:
    """Without cuts or relaxation, settling aside, in as many iterations as where cells grow tenfold, to that load."""
    even, graded = Laying(10.0, law), Laying(1300.0, law)
    print(f"iterations {even.iterations}, graded {graded.iterations}; borne {even.borne:.1f}, {graded.borne:.1f} N")
    assert min(growth(graded.assembly)) > 1000.0
    assert graded.relaxations == graded.cuts == 0
    assert np.mean(graded.iterations) < 1.2 * np.mean(even.iterations)
    assert graded.borne == pytest.approx(even.borne, rel=0.1)


def test_cells_that_grow_a_thousandfold() -> None:
    lays_as_on_even_cells({})


DIFFICULT = {
    "nearly incompressible": {"nu": 0.4999},
    "no strength at the seabed": {"su": 0.0, "su_gradient": 4.0e4},
    "both": {"su": 0.0, "su_gradient": 4.0e4, "nu": 0.4999},
}


@pytest.mark.verify
@pytest.mark.parametrize("name", DIFFICULT)
def test_cells_that_grow_a_thousandfold_on_difficult_soil(name: str) -> None:
    lays_as_on_even_cells(DIFFICULT[name])


PRESSED = 0.24  # m, the diameter of a pipe that is pressed into clay


def pressed(across: float) -> Mapping:
    """By its ends by a tenth of its diameter, into cells of a size."""
    pipe = {"outer_diameter": PRESSED, "mass": 98.3, "EA": 2.0e7, "EI": 1.52e6, "GJ": 1.0e4}
    law = {"kind": "von-mises", "su": 1527.0, "su_gradient": 450.5, "E_over_su": 149.0}
    mesh = cells({"along": PRESSED, "across": across, "strip": 0.5 * PRESSED}, 0.17)
    return level_pipe(
        pushed_to(PRESSED, 0.4 * PRESSED),
        pipe=pipe,
        length=PRESSED,
        elements=12,
        height=0.5 * PRESSED,
        water={"density": 1025.0},
        soil=block(law, (0.4 * PRESSED, 0.6 * PRESSED), 1.1, 1.1, mesh),
        contact={"method": "surface"},
    )


@pytest.mark.verify
def test_a_stiff_pipe_is_pressed_into_fine_cells_in_few_iterations() -> None:
    """Some 200 with those of the steps that fail, where clay flows and its tangent all but vanishes; 410 without a
    share of the elastic one. No settling and no relaxation, which find nothing while supports move.
    """
    assembly, iterations = built(pressed(PRESSED / 40.0)), list[int]()
    watched = Watcher(lambda stepper, _: iterations.append(stepper.newton.iterations))
    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), watched, Timer.new())
    assert (watched.settlings, watched.relaxations) == (0, 0)
    assert iterations[-1] < 300


@pytest.mark.parametrize("law", [ELASTIC, CLAY], ids=["elastic", "clay"])
def test_pipe_that_leaves_the_soil_touches_again(law: Mapping) -> None:
    """Both ends go up and down by 0.06 m every half a second about 0.05 m above the soil."""
    scene = falling_on_soil(1e7, 0.02, law, MIDDLE)
    z = 0.15 + 0.05  # the pipe's radius and its middle above the soil
    motion = {"harmonic": {"amplitude": [0.0, 0.0, 0.06], "period": 0.5, "ramp": 0.25}}
    scene["riser"] |= {
        end: {"position": [x, 0.0, z], "rotation": "fixed"} for end, x in (("start", 0.0), ("end", 1.0))
    }
    scene["riser"]["initial"] = "straight"
    dip = {"name": "dip", "kind": "dynamic", "duration": 1.6, "time_step": 0.02}
    scene["stages"] = [dip | {"motion": {"start": motion, "end": motion}}]
    force = forces(scene)
    touching = force > 0.0
    landings = np.count_nonzero(touching[1:] & ~touching[:-1])
    assert landings == 3, force
    assert force.min() == 0.0
    assert force.max() > 100.0


def lifted_and_set_down() -> Mapping:
    """Both ends are moved until all of the riser hangs, then back; the clay yields when it is laid."""
    scene = touchdown(LAY, moved("lift", [0.0, 0.0, 0.8], [24.0, 0.0, 16.0]), su=600.0)
    scene["stages"].append(moved("set down", [0.0, 0.0, 0.15], [22.5, 0.0, 15.0]))
    return scene | {"output": {"fields": ["soil_settlement", "embedment"]}}


def moved(name: str, start: list[float], end: list[float]) -> Mapping:
    return {"name": name, "kind": "static", "move": {"start": start, "end": end}}


def test_a_riser_lifted_off_the_soil_comes_to_rest_in_its_trough(tmp_path: Path) -> None:
    run(scene_from_mapping(lifted_and_set_down()), tmp_path)
    results = Run(tmp_path)
    for stage in results.summary["stages"]:
        assert (stage["method"], stage["relaxations"], stage["step_cuts"]) == ("newton", 0, 0)
    laid, lifted, again = results["contact_force_sum"]
    assert np.abs(lifted).max() == 0.0
    assert again[2] == pytest.approx(laid[2], rel=2e-3)
    borne = results["start_force"] + results["end_force"] + results["contact_force_sum"]
    assert np.ptp(borne[:, 2]) < 1e-4 * borne[0, 2], "the weight, within what areas change by in a step"
    trough = np.nanmax(results["soil_settlement"], axis=1)
    assert 0.2 * trough[0] < trough[1] < 0.5 * trough[0]
    assert trough[0] < trough[2] < 1.1 * trough[0]


def forces(scene: Mapping) -> Array:
    """What the soil bears [N], step by step of the only stage."""
    assembly, values = built(scene), list[float]()
    contact = soil_under(assembly).contact
    assert contact is not None
    stage: Stage = assembly.scene.stages[0]
    take(assembly, stage, watch=lambda _, step: values.append(-float(contact.force_on_soil(step.solution.state)[2])))
    return np.array(values)


@pytest.mark.verify
@pytest.mark.parametrize("su", [5.0e5, 2.0e6])
def test_clay_as_stiff_as_rock_takes_the_riser_by_newton_alone(su: float, tmp_path: Path) -> None:
    """It opens and closes point after point: 30 and 46 iterations in the first load step, whose residual falls on. The
    largest moment, in the sag bend, is that on softer clay.
    """
    only_laid = "stages=[{name: lay, kind: static}]"
    run(read_scene(ON_BLOCK, [only_laid, f"soil.law.su={su}", "soil.law.su_gradient=0.0"]), tmp_path)
    (lay,) = Run(tmp_path).summary["stages"]
    assert (lay["relaxations"], lay["step_cuts"], lay["steps"]) == (0, 0, LAID_IN)
    assert lay["final"]["max_bending_moment"]["value"] == pytest.approx(2.1404e3, rel=1e-3)
