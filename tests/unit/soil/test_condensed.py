"""Linear elastic soil condensed to what the riser touches of its top: the answer of the whole soil, nothing missed."""

from __future__ import annotations

import re
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.assembly.condensation import why_whole
from riser_soil.checks.check import describe
from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State
from riser_soil.core.roles import owners
from riser_soil.core.saved_state import gathered, restore_all
from riser_soil.core.system import System, Timer
from riser_soil.errors import SceneError
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep
from riser_soil.stages import run_stage
from tests.support.driven_stage import FirstStep, Watcher, before_commit, built, soil_under
from tests.support.said import line_with, telling
from tests.support.scenes import LAY, Mapping, heave, touchdown

ELASTIC: Mapping = {"kind": "linear-elastic", "E": 4.0e5, "nu": 0.45}
FRICTION = {"axial": 0.4, "lateral": 0.7}
CONTACTS: dict[str, Mapping] = {
    "node": {"method": "node"},
    "surface": {"method": "surface", "smoothing": 1e-3},
    "surface with friction": {"method": "surface", "smoothing": 1e-3, "friction": FRICTION},
    "surface with suction": {"method": "surface", "suction": {"cap": 300.0, "reach": 0.02}},
}
CASES = [
    ("node", "hex", 2),
    pytest.param("surface", "tet", 2, marks=pytest.mark.verify),
    pytest.param("surface with friction", "hex", 3, marks=pytest.mark.verify),
    ("surface with suction", "hex", 2),
]
SAME = 1e-8


def scene(contact: str, kind: str, dimension: int, soil: str) -> Mapping:
    mapping = touchdown(LAY, heave(0.8), kind=kind, dimension=dimension, tolerance=1e-11)
    mapping["soil"]["law"] = ELASTIC
    mapping["contact"] = CONTACTS[contact]
    mapping["solver"]["soil"] = soil
    return mapping


class Recording:
    """Both stages, with what each accepted step tells."""

    def __init__(self, mapping: Mapping) -> None:
        self.assembly = built(mapping)
        self.records = list[dict[str, Array]]()
        self.touched = list[int]()
        before = State.at_rest(0.0, self.assembly.size)
        with before_commit(self._tell):
            for stage in self.assembly.scene.stages:
                before = run_stage(self.assembly, stage, before, Watcher(), Timer.new())
        soil = soil_under(self.assembly).recovered()
        assert soil is not None
        fields = soil.output_fields()
        self.records.append({"displacement": fields.displacement, "von Mises": fields.von_mises})

    def _tell(self, system: System, step: AcceptedStep) -> None:
        state, contact, line = step.solution.state, soil_under(self.assembly).contact, self.assembly.riser.line
        assert contact is not None
        self.records.append(
            {
                "positions": line.positions3(state),
                "force on the riser": contact.force_on_riser(state),
                "contact force": contact.force_per_length(state),
                "settlement": np.nan_to_num(contact.settlement(line.positions3(state)[:, :2], state)),
                "strain energy": np.array(step.energy.strain),
                "kinetic energy": np.array(step.energy.kinetic),
                "braking": np.array(step.braking),
                "soil's work": np.array([step.turned["soil"].dissipated, step.turned["soil"].by_scheme]),
                "all work": np.array([step.dissipated, step.work]),
            }
        )
        if (condensed := soil_under(self.assembly).condensed) is not None:
            self.touched.append(len(condensed.top.reached.nodes))


SIZED: tuple[str, ...] = ("positions", "force on the riser", "contact force", "settlement", "displacement")
SIZED += ("von Mises", "strain energy", "kinetic energy")
# Works are differences of energies, and are held against the largest of them.
SIZED_AS = dict.fromkeys(("soil's work", "all work", "braking"), "strain energy")


@cache
def steps_of(contact: str, kind: str, dimension: int, soil: str) -> Recording:
    return Recording(scene(contact, kind, dimension, soil))


@pytest.mark.parametrize(("contact", "kind", "dimension"), CASES)
def test_the_answer_is_that_of_the_whole_soil(contact: str, kind: str, dimension: int) -> None:
    whole, condensed = (steps_of(contact, kind, dimension, soil) for soil in ("whole", "condensed"))
    assert soil_under(whole.assembly).condensed is None
    assert soil_under(condensed.assembly).condensed is not None
    assert len(whole.records) == len(condensed.records)
    sizes = {
        key: max(float(np.abs(record[key]).max()) for record in whole.records if key in record) for key in SIZED
    }
    for wanted, got in zip(whole.records, condensed.records, strict=True):
        for key, value in wanted.items():
            size = sizes[SIZED_AS.get(key, key)]
            assert np.abs(got[key] - value).max() < SAME * size, key
            assert size > 0.0


def test_few_dofs_are_solved_for() -> None:
    case = steps_of("surface", "tet", 2, "condensed")
    soil = soil_under(case.assembly)
    assert soil.condensed is not None
    top = soil.condensed.top
    assert 0 < max(case.touched) < len(top.points)
    assert 0 < np.count_nonzero(~top.prescribed) <= 3 * max(case.touched) < 0.15 * soil.whole.field.size


def test_its_energy_is_that_of_the_soil_recovered() -> None:
    case = steps_of("surface", "tet", 2, "condensed")
    soil, condensed = soil_under(case.assembly).recovered(), soil_under(case.assembly).condensed
    assert soil is not None
    assert condensed is not None
    rest = State.at_rest(0.0, case.assembly.size)
    stored = soil.energy(State.at_rest(0.0, soil.field.size))
    assert condensed.energy(rest).strain == pytest.approx(stored.strain, rel=1e-9)
    assert stored.strain > 0.0


def test_a_force_beside_counts_as_long_as_it_is_there() -> None:
    """One that was met on a way that the line search has not taken does not."""
    condensed = soil_under(first_step("surface").assembly).condensed
    assert condensed is not None
    size = first_step("surface").assembly.size
    pressed, rest = Forces.zeros(size), State.at_rest(0.0, size)
    condensed.top.own(pressed.end)[condensed.top.unreached[5]] = 1.0
    condensed.residual(rest, pressed)
    assert condensed.outgrown
    condensed.residual(rest, Forces.zeros(size))
    assert not condensed.outgrown


@cache
def first_step(contact: str) -> FirstStep:
    return FirstStep(built(scene(contact, "hex", 2, "condensed")))


@pytest.mark.parametrize("contact", ["node", "surface", "surface with friction"])
def test_the_tangent_is_the_slope_of_the_residual(contact: str) -> None:
    step = first_step(contact)
    condensed = soil_under(step.assembly).condensed
    assert condensed is not None
    random = np.random.default_rng(3)
    x = 1e-5 * random.normal(size=step.free)
    soil = step.rows(condensed.top.offset + condensed.top.reached.dofs)
    assert len(soil) == len(condensed.top.reached.dofs) > 0
    matrix = step.matrix(x)
    for _ in range(3):
        direction = random.normal(size=step.free)
        wanted, got = step.slope(x, direction, 1e-7), matrix @ direction
        for rows in (soil, np.setdiff1d(np.arange(step.free), soil)):
            assert np.linalg.norm((got - wanted)[rows]) < 1e-8 * np.linalg.norm(wanted[rows])
    stiffness = condensed.top.reached.stiffness
    assert np.linalg.norm(matrix[soil][:, soil].toarray()) >= 0.99 * np.linalg.norm(stiffness)


def test_a_force_where_none_was_expected_is_noticed_and_solved_for() -> None:
    """The dofs that bear the riser are taken away between two stages."""
    case = built(scene("surface", "hex", 2, "condensed"))
    condensed = soil_under(case).condensed
    assert condensed is not None
    lay, move = case.scene.stages
    before = run_stage(case, lay, State.at_rest(0.0, case.size), Watcher(), Timer.new())
    bearing = condensed.top.reached.nodes
    settled = condensed.top.committed.copy()
    condensed.top.reach(bearing[:2])
    condensed._wanted[:] = False
    system = System(case.comm, case.begin(move), Timer.new())
    system.forces(State.at_rest(0.0, case.size))
    noticed = condensed.outgrown
    system.destroy()
    assert noticed
    condensed.rebuild(State.at_rest(0.0, case.size))
    assert set(bearing) >= set(condensed.top.reached.nodes)
    assert len(condensed.top.reached.nodes) > 2
    np.testing.assert_array_equal(condensed.top.committed, settled)
    after = run_stage(case, move, before, Watcher(), Timer.new())
    assert after.t > 0.0
    assert not condensed.outgrown
    undisturbed = steps_of("surface", "hex", 2, "whole")
    np.testing.assert_allclose(case.riser.line.x, undisturbed.assembly.riser.line.x, rtol=0.0, atol=1e-8)


def test_a_saved_state_is_taken_over() -> None:
    case, anew = steps_of("surface", "tet", 2, "condensed"), built(scene("surface", "tet", 2, "condensed"))
    stage = case.assembly.scene.stages[0]
    models = [assembly.begin(stage) for assembly in (case.assembly, anew)]
    restore_all(owners(models[1]), gathered(owners(models[0])))
    fields = [_fields(assembly) for assembly in (case.assembly, anew)]
    for got, wanted in zip(fields[1], fields[0], strict=True):
        np.testing.assert_allclose(got, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())


def _fields(assembly: Assembly) -> tuple[Array, Array]:
    soil = soil_under(assembly).recovered()
    assert soil is not None
    fields = soil.output_fields()
    return fields.displacement, fields.von_mises


def reason(mapping: Mapping, ranks: int = 1) -> str:
    assembly = built(mapping)
    assert assembly.soil is not None
    soil: Any = SimpleNamespace(
        grid=SimpleNamespace(nodes=SimpleNamespace(comm=SimpleNamespace(size=ranks))),
        surface=assembly.soil.whole.surface,
        field=assembly.soil.whole.field,
    )
    return why_whole(assembly.scene, soil, assembly.riser.line, assembly.scales.diameter)


def test_what_is_condensed_and_what_is_not() -> None:
    elastic = scene("node", "hex", 2, "auto")
    assert reason(elastic) == ""
    line_with(reason(elastic, ranks=2), "2 ranks")
    assert reason(scene("node", "hex", 2, "whole")) == "solver.soil is whole"
    line_with(reason(touchdown(LAY)), "not linear", "von-mises")


def test_check_tells_how_the_soil_is_solved_for() -> None:
    condensed, whole, clay = (
        describe(scene_from_mapping(mapping))
        for mapping in (scene("node", "hex", 2, "auto"), scene("node", "hex", 2, "whole"), touchdown(LAY))
    )
    line_with(condensed, "soil:", "condensed to", "surface")
    line_with(whole, "soil:", "not condensed:", "solver.soil is whole")
    assert "condensed" not in clay


def test_it_is_not_condensed_where_that_costs_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("riser_soil.assembly.condensation.MOST_REACHED", 0.05)
    assert re.search(r"\d unknowns .*under the riser", reason(scene("node", "hex", 2, "auto")))
    assert reason(scene("node", "hex", 2, "condensed")) == ""


def test_clay_is_refused_where_condensed_soil_is_asked_for() -> None:
    mapping = touchdown(LAY)
    mapping["solver"]["soil"] = "condensed"
    with pytest.raises(SceneError, match=telling("solver.soil:", "can't be condensed:", "not linear")):
        built(mapping)
