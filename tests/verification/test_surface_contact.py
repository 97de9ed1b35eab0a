"""The pipe's cylinder on soil: Hertz's contact, no hold on the mesh, balances and tangents in coupled scenes."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from riser_soil.assembly import Assembly, soil_contact
from riser_soil.checks.ground_plausibility import ground_warnings
from riser_soil.checks.settlement import LIKE_CONTACT
from riser_soil.contact.surface_contact import SurfaceContact
from riser_soil.core.system import System
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.solve.time_stepper import AcceptedStep
from riser_soil.whole_run import run
from tests.support.driven_stage import FirstStep, built, soil_under, take
from tests.support.pushed_pipe import INDENTATION, NU, D, E, Pushed, slice_of_soil
from tests.support.said import line_with
from tests.support.scenes import LAY, Mapping, heave, touchdown


@cache
def pushed(cells: int, method: str = "surface") -> Pushed:
    return Pushed(cells, method)


def test_the_indentation_is_that_of_hertz() -> None:
    """Relative to a point half a metre below, where the block is nearly a half space; less the penalty's give."""
    case = pushed(64)
    assert case.indentation > 0.95 * INDENTATION
    assert case.indentation - case.settled(0.5) == pytest.approx(case.approach(0.5), rel=0.025)


def test_the_pressure_is_that_of_hertz() -> None:
    """But for its peak, which the penalty's give flattens by some 5 %."""
    case = pushed(64)
    contact = soil_under(case.assembly).contact
    assert isinstance(contact, SurfaceContact)
    points = contact.evaluate(case.state).pressed
    peak = 2.0 * case.q / (np.pi * case.half_width)
    assert (points.force / points.points.area).max() == pytest.approx(peak, rel=0.08)
    assert points.points.area.sum() / case.thickness == pytest.approx(2.0 * case.half_width, rel=0.05)


def test_the_force_converges_as_the_cells_resolve_the_contact() -> None:
    """To what 128 cells across the diameter say."""
    reference = pushed(128).q
    errors = [pushed(cells).q / reference - 1.0 for cells in (2, 8, 16, 32)]
    assert errors[:2] == pytest.approx([0.65, 0.10], abs=0.02), errors
    assert np.abs(errors[2:]).max() < 0.01, errors


def test_points_and_penalty_hardly_count(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice the points change the force by 0.2 %; twice the penalty takes half of its give of 3 % away."""
    scene, standard = slice_of_soil(32), pushed(32).q
    scene["contact"]["stiffness"] = 2.0 * 20.0 * E
    assert Pushed(32, scene=scene).q / standard - 1.0 == pytest.approx(0.015, abs=0.01)
    monkeypatch.setattr(soil_contact, "POINTS_ACROSS", 2.0 * soil_contact.POINTS_ACROSS)
    assert Pushed(32).q == pytest.approx(standard, rel=5e-3)


@pytest.mark.parametrize("cells", [2, 4, 8])
def test_coarse_cells_settle_less_as_the_warning_says(cells: int) -> None:
    """Against the finest mesh's indentation under the same force, by Hertz's logarithm; within a quarter of it."""
    case, fine = pushed(cells), pushed(64)
    unit = case.q / (np.pi * case.modulus)
    constant = fine.indentation * np.pi * fine.modulus / fine.q - 2.0 * np.log(1.0 / fine.half_width)
    missing = unit * (2.0 * np.log(1.0 / case.half_width) + constant) - case.indentation
    predicted = 2.0 * unit * np.log(LIKE_CONTACT * D / cells / (2.0 * case.half_width))
    assert predicted == pytest.approx(missing, rel=0.3)


def test_wide_cells_are_reported() -> None:
    scene = touchdown(LAY, su=6000.0)
    at_nodes = scene | {"contact": {"method": "node"}}
    assert not any("size_at_riser" in warning for warning in ground_warnings(built(at_nodes).riser))
    warning = line_with(ground_warnings(built(scene).riser), "soil.mesh.size_at_riser", "fine cells", "take at most")
    assert re.search(r"touches .* \d\S* mm.* \d\S* mm ", warning)


def test_contact_at_nodes_has_no_limit() -> None:
    """What surface contact is for: at nodes the force hangs on the cells, and on whether a node meets one at all."""
    with_nodes = np.array([pushed(cells, "node").q for cells in (4, 8)])
    assert np.ptp(with_nodes) > 0.1 * with_nodes.max()


def test_soil_that_flows_from_under_the_pipe_is_reported(tmp_path: Path) -> None:
    """Pushed in by D/16, plastic clay moves aside: the resistance is no figure any more."""
    scene = slice_of_soil(4)
    scene["soil"] |= {"law": {"kind": "von-mises", "su": 4.0e3, "E_over_su": 300.0, "nu": NU}, "strain": "small"}
    for end in ("start", "end"):
        scene["stages"][0]["move"][end][2] = 0.44 * D
    run(scene_from_mapping(scene), tmp_path)
    (stage,) = json.loads((tmp_path / "summary.json").read_text())["stages"]
    (warning,) = stage["warnings"]
    assert re.search(r"under the riser .*stretched to 1\.", line_with([warning], "small strain"))


def laid(kind: str, dimension: int, *more: Mapping, su: float = 1000.0) -> Assembly:
    scene = touchdown(LAY, *more, kind=kind, dimension=dimension, su=su, tolerance=1e-10)
    scene["contact"] = {"method": "surface", "smoothing": 1e-3}
    return built(scene)


@pytest.mark.parametrize(("kind", "dimension"), [("hex", 2), ("tet", 3)])
def test_supports_and_grounds_bear_the_weight(kind: str, dimension: int) -> None:
    assembly = laid(kind, dimension)
    forces = []

    def keep(system: System, step: AcceptedStep) -> None:
        state = step.solution.state
        forces.append(np.sum([c.force_on_riser(state) for c in assembly.contacts], axis=0))
        contact = soil_under(assembly).contact
        assert contact is not None
        apart = contact.force_on_riser(state) + contact.force_on_soil(state)
        assert np.abs(apart).max() < 1e-12 * np.linalg.norm(contact.force_on_soil(state)) or dimension == 2

    take(assembly, assembly.scene.stages[0], watch=keep)
    weight = float(assembly.riser.elements.weight @ assembly.riser.line.length)
    assert 0.2 * weight < forces[-1][2] < weight


@pytest.mark.parametrize(("kind", "dimension"), [("hex", 2), ("hex", 3), ("tet", 2)])
def test_the_matrix_is_the_slope_of_the_residual(kind: str, dimension: int) -> None:
    step = FirstStep(laid(kind, dimension, heave(1.0, time_step=0.01)))
    random = np.random.default_rng(5)
    x = 1e-4 * random.normal(size=step.free)
    matrix, h = step.matrix(x), 1e-6
    for _ in range(3):
        direction = 1e-3 * random.normal(size=step.free)
        wanted = step.slope(x, direction, h)
        assert np.linalg.norm(matrix @ direction - wanted) < 1e-6 * np.linalg.norm(wanted)


def test_a_riser_that_heaves_only_gives_energy_to_the_soil() -> None:
    """Newton needs few iterations a step, and contact gains nothing in impact."""
    assembly = laid("hex", 2, heave(1.5), su=6000.0)
    before = take(assembly, assembly.scene.stages[0])
    iterations, lost = list[int](), list[float]()

    def watch(system: System, step: AcceptedStep) -> None:
        iterations.append(step.solution.iterations)
        lost.append(step.turned["contact"].dissipated)

    take(assembly, assembly.scene.stages[1], before, watch)
    assert np.mean(iterations) <= 6.0
    assert max(iterations) <= 10
    assert sum(lost) >= 0.0
