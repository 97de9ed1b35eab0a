"""Properties of a pipe to arrays by element."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from riser_soil.core.part import State, Weights
from riser_soil.riser.sections import Elements, Surroundings, elements, joined
from tests.support.dense_chain import residual
from tests.support.pipes import IN_AIR, pipe
from tests.support.sample_line import sample

FLEXIBLE = {"EA": 15.38e8, "EI": 20.96e3, "outer_diameter": 0.26, "inner_diameter": 0.20, "mass": 57.5}
FLOODED = Surroundings(gravity=9.81, contents=1025.0, water=1025.0)


def flexible(around: Surroundings = FLOODED, **more: Any) -> Elements:
    """A metre of the flexible riser."""
    return pipe(1.0, 1, around, **FLEXIBLE | more)


def test_submerged_weight_of_the_flexible_riser() -> None:
    assert flexible().weight == pytest.approx(346.1, abs=0.05)


def test_a_given_submerged_weight_wins() -> None:
    assert flexible(submerged_weight=364.2).weight == 364.2


def test_in_air_nothing_floats() -> None:
    assert flexible(IN_AIR).weight == pytest.approx(57.5 * 9.81)


def test_segments_become_elements_in_order() -> None:
    thin = FLEXIBLE | {"EA": 1.0}
    line = joined([pipe(10.0, 2, FLOODED, **FLEXIBLE), pipe(3.0, 3, FLOODED, **thin, drag=(1.1, 0.1))])
    assert line.arc.tolist() == [0.0, 5.0, 10.0, 11.0, 12.0, 13.0]
    assert line.EA.tolist() == [15.38e8, 15.38e8, 1.0, 1.0, 1.0]
    assert line.drag.tolist() == [[0.0, 0.0]] * 2 + [[1.1, 0.1]] * 3
    assert line.mass[0] == pytest.approx(57.5 + 1025.0 * 0.25 * np.pi * 0.2**2)


def test_a_property_that_elements_do_not_have_is_refused() -> None:
    with pytest.raises(TypeError, match="colour"):
        flexible(colour=1.0)


def test_rotary_inertia_of_wall_and_contents() -> None:
    """rho pi (D^4 - d^4)/64 of the wall, rho pi d^4/64 of what fills it."""
    density = 57.5 / (0.25 * np.pi * (0.26**2 - 0.2**2))
    wall, filling = (rho * np.pi / 64.0 for rho in (density, 1025.0))
    exact = wall * (0.26**4 - 0.2**4) + filling * 0.2**4
    inertias = [float(flexible(rotary_inertia=given).rotary_inertia[0]) for given in (None, 3.0, 0.0)]
    assert inertias == pytest.approx([exact, 3.0, 0.0], rel=1e-14)


def test_spin_has_inertia_whatever_is_asked_for() -> None:
    """rho (I_y + I_z) of the section: twice that about an axis across it; E drops out of a homogeneous section's."""
    across = float(flexible(rotary_inertia=None).rotary_inertia[0])
    round_ones = [flexible(rotary_inertia=given) for given in (None, 3.0, 0.0)]
    EI_y, EI_z = 0.3 * 0.1**3 / 12.0 * 2e9, 0.3**3 * 0.1 / 12.0 * 2e9
    strip = pipe(1.0, 1, FLOODED, EA=0.3 * 0.1 * 2e9, EI_y=EI_y, EI_z=EI_z, mass=30.0)
    exact = 30.0 * (0.1**2 + 0.3**2) / 12.0
    inertias = [float(each.polar_inertia[0]) for each in (*round_ones, strip)]
    assert inertias == pytest.approx([2.0 * across, 6.0, 2.0 * across, exact], rel=1e-14)


def test_uneven_elements_keep_their_lengths() -> None:
    kind = {"EA": 15.38e8, "EI_y": 20.96e3, "EI_z": 20.96e3}
    line = joined([elements((1.0, 2.0, 4.0), FLOODED, **kind), elements((1.5, 1.5), FLOODED, **kind)])
    assert line.arc.tolist() == [0.0, 1.0, 3.0, 7.0, 8.5, 10.0]


@pytest.mark.parametrize("dimension", [2, 3])
def test_weight_adds_up_whatever_the_shape(dimension: int) -> None:
    at = sample(dimension)
    beam, state = at.beam(), at.state(1)
    nodal = at.line.nodal(residual([beam], state, Weights(0.0, 1.0, 0.0, 0.0)))
    down = at.elements.weight @ at.line.length
    expected = np.array([12.0, -7.0, 3.0]) * 8.0 - [0.0, 0.0, down]
    total = -nodal[:, :dimension].sum(axis=0)
    assert total == pytest.approx((0.5 + 0.7) * expected @ at.line.basis, rel=1e-10)


@pytest.mark.parametrize("dimension", [2, 3])
def test_mass_adds_up(dimension: int) -> None:
    at = sample(dimension)
    a = np.zeros(at.line.size)
    at.line.nodal(a)[:, :dimension] = np.arange(1.0, 1.0 + dimension)
    state = State(0.0, 0.0 * a, 0.0 * a, a)
    nodal = at.line.nodal(residual([at.inertia()], state, Weights(1.0, 0.0, 0.0, 0.0)))
    total = at.elements.mass @ at.line.length + sum(attachment.mass for attachment in at.attached())
    assert nodal[:, :dimension].sum(axis=0) == pytest.approx(total * np.arange(1.0, 1.0 + dimension))
