"""What is said of ground that bears less than the riser puts on it, after a failed solve and after a stage."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.checks.overload import over_a_length, overload, surface_bearing
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.seabed.bearing import Strength, strip_capacity
from riser_soil.seabed.law import NormalLaw
from riser_soil.stages import run_stage
from riser_soil.whole_run import run
from tests.support.driven_stage import Watcher, built
from tests.support.scenes import Mapping, prescribed, riser_scene, static, touchdown
from tests.support.soil_loops import aubeny_biscontin, randolph_quiggin

W, D = 700.0, 0.3


def test_capacity_of_a_strip() -> None:
    """Prandtl's on even clay, and Davis & Booker's on clay whose strength begins with nothing: gradient B^2/4."""
    assert strip_capacity(Strength(1000.0), 0.5) == pytest.approx(5.1416 * 500.0, rel=1e-5)
    assert strip_capacity(Strength(0.0, 2000.0), 0.5) == pytest.approx(125.0)


@pytest.mark.parametrize(("law", "a"), [(randolph_quiggin, 6.0), (aubeny_biscontin, 6.73)])
def test_capacity_of_hysteretic_clay(law: Callable[..., NormalLaw], a: float) -> None:
    """The capacity is the bearing resistance a su D one diameter deep, where it has been reached."""
    clay = law(D, su=500.0, su_gradient=1000.0)
    assert clay.capacity == pytest.approx(a * (500.0 + 1000.0 * D) * D)


def lying(seabed: dict[str, object]) -> Assembly:
    """A pipe on a seabed, its end prescribed 8 m above."""
    pipe = {"EA": 3e8, "EI": 5e4, "outer_diameter": D, "submerged_weight": W}
    ends = {"start": prescribed(0.0, 0.0, 0.5 * D), "end": prescribed(30.0, 0.0, 8.0)}
    assembly = built(riser_scene(static(), pipe=pipe, length=32.0, elements=64, gravity=9.81, seabed=seabed, **ends))
    run_stage(assembly, assembly.scene.stages[0], State.at_rest(0.0, assembly.size), Watcher(), Timer.new())
    return assembly


def clay(su: float) -> dict[str, object]:
    return {"kind": "hysteretic", "law": {"kind": "aubeny-biscontin", "su": su, "su_gradient": 0.0}}


def test_place_load_and_capacity() -> None:
    """The deepest place, some diameters deep, of a law that goes on beyond its range."""
    assembly = lying(clay(300.0))
    said = overload(assembly)
    match = re.search(
        r"at arc (\S+) m, at \(\S+, \S+, (\S+)\) m, the riser puts (\S+) N/m .* bears about (\S+) N/m", said
    )
    assert match, said
    arc, z, load, capacity = (float(each) for each in match.groups())
    at_rest = State.at_rest(0.0, assembly.size)
    depth = _depth(assembly, at_rest)
    assert arc == pytest.approx(assembly.riser.line.arc[depth.argmax()], rel=1e-3)
    assert z == pytest.approx(0.5 * D - depth.max(), abs=1e-3)
    assert load >= W
    assert capacity == pytest.approx(6.73 * 300.0 * D, rel=1e-3)


def _depth(assembly: Assembly, state: State) -> Array:
    assert assembly.riser.seabed is not None
    return assembly.riser.seabed.depth(state)


@pytest.mark.parametrize("seabed", [clay(1500.0), {"kind": "spring", "stiffness": 1.0e3}, {"kind": "rigid"}])
def test_nothing_where_the_ground_bears_it(seabed: dict[str, object]) -> None:
    """Or has no limit: springs that the pipe sinks into by its diameter and more do."""
    assembly = lying(seabed)
    assert np.any(_depth(assembly, State.at_rest(0.0, assembly.size)) > 0.0)
    assert overload(assembly) == ""


def on_clay(su: float, **soil: object) -> Mapping:
    """717 N/m on cells of 0.5 m, more than the pipe's diameter."""
    scene = touchdown(su=su)
    scene["soil"]["law"]["su_gradient"] = 0.0
    scene["soil"] |= soil
    return scene


def overloaded(scene: Mapping, folder: Path) -> list[str]:
    """Warnings about the soil's load after the only stage."""
    run(scene_from_mapping(scene), folder)
    (stage,) = json.loads((folder / "summary.json").read_text())["stages"]
    return [warning for warning in stage["warnings"] if "the soil bears" in warning]


@pytest.mark.parametrize("method", ["node", "surface"])
def test_coarse_cells_that_bear_more_than_their_clay_are_reported(method: str, tmp_path: Path) -> None:
    (warning,) = overloaded(on_clay(450.0) | {"contact": {"method": method}}, tmp_path)
    match = re.search(r"bears (\S+) N/m at arc (\S+) m and 1 of the load, (\S+) times the (\S+) N/m", warning)
    assert match, warning
    load, arc, times, capacity = (float(each) for each in match.groups())
    assert capacity == pytest.approx((2.0 + np.pi) * 450.0 * D, rel=1e-3)
    assert times == pytest.approx(load / capacity, rel=0.05)
    assert load > 717.0
    assert 2.0 < arc < 9.0
    assert "eighth of the diameter" in warning


def test_what_clay_bears_is_not_reported(tmp_path: Path) -> None:
    assert overloaded(on_clay(1500.0) | {"contact": {"method": "node"}}, tmp_path) == []


SAND: Mapping = {"kind": "drucker-prager", "friction_angle_deg": 35.0, "cohesion": 100.0, "E": 1.0e6}
CLAY: Mapping = {"kind": "von-mises", "su": 500.0, "E_over_su": 300.0}


def bearing(**soil: object) -> float | None:
    scene = on_clay(500.0)
    if "layers" in soil:
        del scene["soil"]["law"]
    values = surface_bearing(built(scene | {"soil": scene["soil"] | soil}).riser)
    return values.capacity if values is not None else None


def test_soil_is_compared_with_what_is_known_to_bear() -> None:
    """Not sand, nor clay above a layer that begins within a diameter."""
    prandtl = pytest.approx((2.0 + np.pi) * 500.0 * D, rel=1e-4)
    assert bearing() == prandtl
    assert bearing(layers=[{"to": 0.4, "law": CLAY}, {"law": SAND}]) == prandtl
    assert bearing(layers=[{"to": 0.2, "law": CLAY}, {"law": SAND}]) is None
    assert bearing(law=SAND) is None
    assert surface_bearing(lying({"kind": "rigid"}).riser) is None


def test_mean_over_a_length() -> None:
    """A force on one node counts with all of it over the length, or its own share of the riser where that is longer."""
    line = lying({"kind": "rigid"}).riser.line
    force = np.where(np.arange(line.nodes) == 30, 900.0, 100.0)
    share = line.tributary_length[30]
    assert share == pytest.approx(0.5)
    assert over_a_length(force, line, D)[29:32] == pytest.approx([100.0, 900.0, 100.0])
    assert over_a_length(force, line, 1.0)[30] == pytest.approx(0.5 * 900.0 + 0.5 * 100.0)
    assert over_a_length(force, line, 1.5)[29] == pytest.approx((1.0 * 100.0 + 0.5 * 900.0) / 1.5)
