"""What is said of ground that bears less than the riser puts on it."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest

from riser_soil.assembly import Assembly
from riser_soil.checks.overload import overload
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.system import Timer
from riser_soil.seabed.bearing import Strength, strip_capacity
from riser_soil.seabed.law import NormalLaw
from riser_soil.stages import run_stage
from tests.support.driven_stage import Watcher, built
from tests.support.riser_scenes import prescribed, riser_scene, static
from tests.support.soil_loops import aubeny_biscontin, randolph_quiggin

W, D = 700.0, 0.3


def test_capacity_of_a_strip() -> None:
    """Prandtl's on even clay, and Davis & Booker's on clay whose strength begins with nothing: gradient B^2/4."""
    assert strip_capacity(Strength(1000.0), 0.5) == pytest.approx(5.1416 * 500.0, rel=1e-5)
    assert strip_capacity(Strength(0.0, 2000.0), 0.5) == pytest.approx(125.0)


@pytest.mark.parametrize(("law", "a"), [(randolph_quiggin, 6.0), (aubeny_biscontin, 6.73)])
def test_capacity_of_hysteretic_clay(law: Callable[..., NormalLaw], a: float) -> None:
    """Its bearing resistance a su D one diameter deep, where it has been reached."""
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
    found = re.search(
        r"at arc (\S+) m, at \(\S+, \S+, (\S+)\) m, the riser puts (\S+) N/m .* bears about (\S+) N/m", said
    )
    assert found, said
    arc, z, load, capacity = (float(each) for each in found.groups())
    at_rest = State.at_rest(0.0, assembly.size)
    depth = _depth(assembly, at_rest)
    assert arc == pytest.approx(assembly.line.arc[depth.argmax()], rel=1e-3)
    assert z == pytest.approx(0.5 * D - depth.max(), abs=1e-3)
    assert load >= W
    assert capacity == pytest.approx(6.73 * 300.0 * D, rel=1e-3)


def _depth(assembly: Assembly, state: State) -> Array:
    assert assembly.seabed is not None
    return assembly.seabed.depth(state)


@pytest.mark.parametrize("seabed", [clay(1500.0), {"kind": "spring", "stiffness": 1.0e3}, {"kind": "rigid"}])
def test_nothing_where_the_ground_bears_it(seabed: dict[str, object]) -> None:
    """Or has no limit: springs that the pipe sinks into by its diameter and more do."""
    assembly = lying(seabed)
    assert np.any(_depth(assembly, State.at_rest(0.0, assembly.size)) > 0.0)
    assert overload(assembly) == ""
