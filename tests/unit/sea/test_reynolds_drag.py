"""Drag whose coefficient follows Reynolds's number: against its formula, a constant one, differences, and in scenes."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy

import numpy as np
import pytest
from ruamel.yaml import YAML

from riser_soil.errors import SceneError
from riser_soil.scene.dump import dump_scene
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.sea import reynolds_drag as law
from riser_soil.sea.morison import Morison, in_still_water
from riser_soil.sea.morison_law import drag_coefficients
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.stream_kernels import FlowAtStations
from tests.support import sample_water
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error
from tests.support.sample_line import RHO, Sample, sample
from tests.support.scenes import Mapping, in_waves
from tests.support.stage_histories import stage_histories
from tests.support.through_water import derivatives, resistance

NU, D = 1.19e-6, 0.4
CRISIS = [(1e4, 1.2), (2e5, 1.2), (4e5, 0.3), (4e6, 0.7)]
WIDE = [(1e4, 1.4), (1e7, 0.2)]  # so that all of the sample's stations lie within it
Maker = Callable[[Sample], Morison]
as_python = pytest.mark.usefixtures("uncompiled")  # scenes below are computed by compiled kernels


def tables(at: Sample, *rows: law.Rows) -> law.ReynoldsTables:
    diameter = at.elements.outer_diameter
    return law.tables_of(RHO, NU, diameter, [rows[e % len(rows)] for e in range(diameter.size)])


def still(at: Sample) -> Morison:
    water = FlowAtStations(Pipe(at.line))
    return law.reynolds_drag(water, tables(at, WIDE, CRISIS), dissipative=True)


def flowing(at: Sample) -> Morison:
    return law.reynolds_drag(FlowAtStations(Pipe(at.line), sample_water.water), tables(at, WIDE))


def half_out(at: Sample) -> Morison:
    pipe = Pipe(at.line)
    return law.reynolds_drag(FlowAtStations(pipe, sample_water.water), tables(at, WIDE), pipe.span)


@as_python
@pytest.mark.parametrize(
    ("Re", "Cd"),
    [(1e2, 1.2), (1e5, 1.2), (2e5, 1.2), (np.sqrt(8e10), 0.75), (4e5, 0.3), (np.sqrt(16e11), 0.5), (5e6, 0.7)],
)
def test_the_coefficient_is_linear_in_the_logarithm(Re: float, Cd: float) -> None:
    speed, tau = Re * NU / D, np.array([0.0, 0.0, 1.0])
    tables = law.tables_of(RHO, NU, np.array([D]), [CRISIS])
    v = np.array([0.6, 0.8, 0.0]) * speed + 3.0 * tau
    force = resistance(tables, v, tau)
    expected = 0.5 * RHO * D * Cd * speed**2
    np.testing.assert_allclose(force, expected * np.array([0.6, 0.8, 0.0]), rtol=1e-12, atol=1e-12 * expected)


@as_python
def test_no_flow_no_drag() -> None:
    tables, none = law.tables_of(RHO, NU, np.array([D]), [CRISIS]), np.zeros(3)
    tau = np.array([0.0, 0.0, 1.0])
    assert not resistance(tables, none, tau).any()
    assert not np.any(derivatives(tables, none, tau))


@as_python
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("make", [still, flowing, half_out])
def test_tangent_is_the_derivative_of_the_residual(make: Maker, dimension: int) -> None:
    at = sample(dimension)
    part, state = make(at), at.state(1)
    assert error(tangent([part], state, WEIGHTS), difference_tangent(part, state, WEIGHTS)) < 1e-7


@as_python
def test_the_change_of_the_coefficient_is_in_the_tangent() -> None:
    """Along the flow d(Cd w^2)/dw = 2 Cd w + w dCd/dln Re, across it Cd w."""
    Re, slope = np.sqrt(8e10), (0.3 - 1.2) / np.log(2.0)
    w, half = Re * NU / D, 0.5 * RHO * D
    tables = law.tables_of(RHO, NU, np.array([D]), [CRISIS])
    by_v, _ = derivatives(tables, np.array([w, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    expected = half * w * np.diag([2.0 * 0.75 + slope, 0.75, 0.0])
    np.testing.assert_allclose(by_v, expected, rtol=1e-12, atol=1e-12 * half * w)


@as_python
def test_a_table_of_one_value_is_a_constant_coefficient() -> None:
    at, state = sample(3), sample(3).state(1)
    e = at.elements
    one, pipe = tables(at, [(1e5, 0.9)]), Pipe(at.line)
    part = law.reynolds_drag(FlowAtStations(pipe), one, dissipative=True)
    ones = np.ones(e.length.size)
    drag = drag_coefficients(RHO, e.outer_diameter, 0.9 * ones, 0.0 * ones)
    same = in_still_water(pipe, drag, 0.0 * drag)
    for f in (residual, tangent):
        assert error(f([part], state, WEIGHTS), f([same], state, WEIGHTS)) < 1e-12


def sea(drag: Mapping) -> Mapping:
    scene = deepcopy(in_waves(0.1, 21.0))
    scene["line_types"]["pipe"]["drag"] = {"tangential": 0.05} | drag
    return scene


def test_a_scene_with_one_value_is_that_of_a_constant_coefficient() -> None:
    """Statics and time steps; energy, too. A table with a drop in the range of speeds is another one."""
    one, same, drop = (
        stage_histories(sea(drag))
        for drag in ({"by_reynolds": [[1e5, 1.1]]}, {"normal": 1.1}, {"by_reynolds": [[1e5, 1.1], [3e5, 0.4]]})
    )
    for value, expected in zip(one, same, strict=True):
        np.testing.assert_allclose(np.array(value.position), np.array(expected.position), rtol=0.0, atol=1e-9)
        np.testing.assert_allclose(value.work, expected.work, rtol=1e-6, atol=1e-4)
    assert np.abs(np.array(drop[1].position) - np.array(one[1].position)).max() > 1e-3


def test_a_resolved_scene_is_read_as_the_same() -> None:
    scene = scene_from_mapping(sea({"by_reynolds": [[1e5, 1.1], [3e5, 0.4]]}))
    assert scene_from_mapping(YAML(typ="safe").load(dump_scene(scene))) == scene


def test_segments_without_a_table_have_none() -> None:
    """One of two line types has a table; the other keeps its coefficient."""
    scene = sea({"normal": 1.1})
    scene["line_types"]["rough"] = deepcopy(scene["line_types"]["pipe"]) | {"drag": {"by_reynolds": [[1e5, 1.1]]}}
    scene["line_types"]["pipe"]["drag"] = scene["line_types"]["rough"]["drag"] | {}
    whole = scene["riser"]["segments"][0]
    halves = [whole | {"line_type": name, "length": 13.0, "elements": 4} for name in ("pipe", "rough")]
    scene["riser"]["segments"] = halves
    both = stage_histories(scene)
    scene["line_types"]["pipe"]["drag"] = {"normal": 1.1}
    mixed = stage_histories(scene)
    np.testing.assert_allclose(mixed[1].position[-1], both[1].position[-1], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("drag", "message"),
    [
        ({}, "the normal drag coefficient is missing"),
        ({"normal": 1.1, "by_reynolds": [[1e5, 1.1]]}, "given twice"),
        ({"by_reynolds": [[1e5, 1.1], [1e5, 0.4]]}, "must increase"),
        ({"by_reynolds": [[0.0, 1.1]]}, r"by_reynolds\.0\.0"),
        ({"by_reynolds": []}, "by_reynolds"),
    ],
)
def test_a_table_that_is_none_is_reported(drag: Mapping, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        scene_from_mapping(sea(drag))
