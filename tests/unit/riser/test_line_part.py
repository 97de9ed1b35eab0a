"""Residuals and tangents of the riser's parts, in the plane and in space, with rates and accelerations."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Energy, Forces, Part, State, Traits, Weights
from riser_soil.riser.bound_parts import has_work
from riser_soil.riser.line_part import LineParts, acting_on
from riser_soil.riser.section_forces import element_residual, nodal_residual
from riser_soil.riser.spatial_directors import SpatialOrientation
from tests.support import sample_water
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error, moved, slope
from tests.support.sample_line import Sample, sample

MAKERS: dict[str, Callable[[Sample], Part]] = {
    "beam": Sample.beam,
    "inertia": Sample.inertia,
    "rotary": Sample.rotary,
    "damping": Sample.damping,
    "morison": Sample.morison,
    "spring": Sample.spring,
    "attachments": Sample.attachments,
    "turned spring": Sample.turned_spring,
    "forces": Sample.forces,
    "contents": Sample.contents,
    "moments": Sample.moments,
    "current": sample_water.current,
    "waves": sample_water.waves,
    "half out of still water": sample_water.half_out,
    "half out of waves": sample_water.half_out_in_waves,
    "modules": sample_water.modules,
    "modules half out of waves": sample_water.modules_half_out_in_waves,
    "modules' buoyancy": sample_water.modules_floating,
    "buoyancy": sample_water.floating,
    "buoyancy in waves": sample_water.floating_in_waves,
}
WITHIN_ELEMENTS = [
    *("beam", "inertia", "rotary", "damping", "morison", "forces", "attachments", "contents"),
    *("half out of waves", "buoyancy", "modules", "modules half out of waves", "modules' buoyancy"),
]
every_part = pytest.mark.parametrize("name", list(MAKERS))
both_dimensions = pytest.mark.parametrize("dimension", [2, 3])


@both_dimensions
@every_part
def test_tangent_is_the_derivative_of_the_residual(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(1)
    K = tangent([part], state, WEIGHTS)
    expected = difference_tangent(part, state, WEIGHTS)
    if name == "moments" and dimension == 2:
        assert not np.any(K)
    else:
        assert error(K, expected) < 1e-7


@both_dimensions
@every_part
def test_symmetric_parts_say_so(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(1)
    K = tangent([part], state, WEIGHTS)
    symmetric = bool(np.abs(K - K.T).max() <= 1e-11 * np.abs(K).max())
    assert symmetric == part.traits.symmetric


@both_dimensions
@every_part
def test_forces_are_in_the_groups_that_a_part_declares(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(1)
    forces = Forces.zeros(state.u.size)
    part.residual(state, forces)
    acts = {group: bool(f.any()) for group, f in zip("IFE", (forces.inertia, forces.force, forces.end), strict=True)}
    assert acts == {group: group in part.traits.groups for group in "IFE"}


@pytest.mark.parametrize("groups", ["", "X", "IFX"])
def test_a_part_is_in_a_group_that_there_is(groups: str) -> None:
    with pytest.raises(ValueError, match="groups of a part"):
        Traits(groups, symmetric=True)


@both_dimensions
@pytest.mark.parametrize("name", ["beam", "spring", "attachments", "buoyancy", "modules' buoyancy"])
def test_conservative_forces_are_the_gradient_of_the_energy(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(2)
    static = Weights(0.0, 1.0, 0.0, 0.0)

    def energy(s: float, direction: Array) -> Array:
        return np.array(part.energy(moved(state, s * direction, static)).total)

    gradient = [slope(partial(energy, direction=d), 3e-4) for d in np.eye(state.u.size)]
    assert error(residual([part], state, static), np.array(gradient)) < 1e-8


@both_dimensions
@pytest.mark.parametrize("name", ["inertia", "rotary"])
def test_inertia_takes_up_the_rate_of_kinetic_energy(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, start = MAKERS[name](at), at.state(3)
    start = State(0.0, 0.0 * start.u, start.v, start.a)

    def kinetic(h: float) -> Array:
        later = State(h, h * start.v + 0.5 * h * h * start.a, start.v + h * start.a, start.a)
        return np.array(part.energy(later).kinetic)

    power = residual([part], start, Weights(1.0, 0.0, 0.0, 0.0)) @ start.v
    # the increments hold to second order only, so the difference must be small itself
    assert (kinetic(1e-5) - kinetic(-1e-5)) / 2e-5 == pytest.approx(power, rel=1e-7)


@every_part
def test_plane_and_space_agree_in_a_plane(name: str) -> None:
    plane, space = sample(2, shaken=False), sample(3, shaken=False)
    flat = plane.state(4)
    state = State(flat.t, *(in_space(plane, values) for values in (flat.u, flat.v, flat.a)))
    parts = [MAKERS[name](s) for s in (plane, space)]
    r2, r3 = residual(parts[:1], flat, WEIGHTS), residual(parts[1:], state, WEIGHTS)
    lift = lifting(plane)
    assert np.abs(lift.T @ r3 - r2).max() <= 1e-12 * np.abs(r2).max()
    K2, K3 = tangent(parts[:1], flat, WEIGHTS), tangent(parts[1:], state, WEIGHTS)
    assert np.abs(lift.T @ K3 @ lift - K2).max() <= 1e-12 * max(np.abs(K2).max(), 1.0)


def lifting(plane: Sample) -> Array:
    """Matrix from planar to spatial dofs: the angle turns about d x z, minus the second body axis."""
    node = np.zeros((6, 3))
    node[:3, :2] = plane.line.basis
    node[4, 2] = -1.0
    return np.kron(np.eye(plane.line.nodes), node)


def in_space(plane: Sample, values: Array) -> Array:
    return np.asarray(lifting(plane) @ values)


@both_dimensions
@every_part
def test_residual_survives_a_commit(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(5)
    rates = Weights(0.0, 1.0, 0.0, 0.0) if name not in ("inertia", "rotary") else Weights(1.0, 0.0, 0.0, 0.0)
    still = State(state.t, state.u, 0.0 * state.v, 0.0 * state.a)
    before = forces_in_global_axes(at, still, part, rates)
    at.line.commit(still)
    after = forces_in_global_axes(
        at, State(state.t, 0.0 * state.u, 0.0 * state.v, 0.0 * state.a), part, rates
    )
    assert np.abs(after - before).max() <= 1e-11 * max(np.abs(before).max(), 1.0)


@both_dimensions
@every_part
def test_forces_of_an_accepted_step_are_those_that_the_next_one_starts_from(name: str, dimension: int) -> None:
    """In the axes of the configuration just accepted; in space those of the step would not do."""
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(5)
    accepted = residual([part], state, WEIGHTS)
    at.line.commit(state)
    anew = residual([part], State(state.t, 0.0 * state.u, state.v, state.a), WEIGHTS)
    assert error(at.line.in_new_axes(accepted, state.u), anew) < 1e-12
    assert (error(accepted, anew) > 1e-3) == (dimension == 3)


def forces_in_global_axes(at: Sample, state: State, part: Part, weights: Weights) -> Array:
    """Residual with spatial moments instead of those conjugate to the rotation increment."""
    out = at.line.nodal(residual([part], state, weights)).copy()
    turn = at.line.trial(state).turn
    if isinstance(turn, SpatialOrientation):
        out[:, 3:] = np.linalg.solve(np.swapaxes(turn.H, 1, 2), out[:, 3:, None])[..., 0]
    return out


@both_dimensions
@pytest.mark.parametrize("name", WITHIN_ELEMENTS)
def test_element_forces_add_up_to_the_residual(name: str, dimension: int) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(6)
    total = np.zeros(at.line.size)
    acting = acting_on(at.line, [part])
    at.line.scatter(element_residual(at.line, acting, state), total)
    nodal = nodal_residual(at.line, acting, state)
    assert total.any()
    assert total + (0.0 if nodal is None else nodal.ravel()) == pytest.approx(
        residual([part], state, Weights(1.0, 1.0, 0.0, 0.0)), rel=1e-13, abs=1e-12
    )
    assert acting_on(sample(dimension).line, [part]) == []


@both_dimensions
@every_part
def test_parts_keep_to_their_slice(name: str, dimension: int) -> None:
    near, far = sample(dimension), sample(dimension, offset=7)
    state = near.state(1)
    shifted = State(
        state.t, *(np.concatenate([np.full(7, np.nan), x, [np.nan] * 2]) for x in (state.u, state.v, state.a))
    )
    forces = Forces.zeros(state.u.size + 9)
    part = MAKERS[name](far)
    part.residual(shifted, forces)
    total = WEIGHTS.inertia * forces.inertia + WEIGHTS.force * forces.force
    assert not np.any(total[:7])
    assert not np.any(total[-2:])
    assert total[7:-2] == pytest.approx(residual([MAKERS[name](near)], state, WEIGHTS), rel=1e-14)
    assert all(block.rows.min() >= 7 for block in part.blocks().values())


@both_dimensions
def test_parts_together_are_their_sum(dimension: int) -> None:
    at, state = sample(dimension), sample(dimension).state(1)
    parts: list[Any] = [make(at) for name, make in MAKERS.items() if "waves" not in name]
    together, forces, expected = LineParts(at.line, parts), Forces.zeros(at.line.size), Forces.zeros(at.line.size)
    K, of_each = np.zeros((2, at.line.length.size, 2 * at.line.ndof, 2 * at.line.ndof))
    for _ in range(2):  # what one has found does not change what the other finds
        forces, expected = Forces.zeros(at.line.size), Forces.zeros(at.line.size)
        K[...], of_each[...] = 0.0, 0.0
        together.residual(state, forces)
        for part in parts:
            part.residual(state, expected)
            part.tangent(state, WEIGHTS, {at.line.name: of_each})
        together.tangent(state, WEIGHTS, {at.line.name: K})
        for group in ("inertia", "force"):
            assert error(getattr(forces, group), getattr(expected, group)) < 1e-12
        assert error(K, of_each) < 1e-12
    stored: Energy = sum((part.energy(state) for part in parts), Energy())
    assert [*vars(together.energy(state)).values()] == pytest.approx([*vars(stored).values()], rel=1e-12)
    within = sum(part.element_forces(state) for part in parts)
    assert error(together.element_forces(state), within) < 1e-12
    before = at.state(3, size=0.0, t=0.4)
    turned = [[*vars(part.work(before, state)).values()] for part in parts if has_work(part.kernel_data())]
    assert len(turned) > 3
    assert error(np.array(together.work_rows(before, state)), np.array(turned)) < 1e-9


@both_dimensions
def test_parts_are_active_where_their_line_is(dimension: int) -> None:
    at = sample(dimension)
    parts = [make(at) for make in MAKERS.values()]
    assert all(part.active for part in parts)
    at.line.active = False
    assert not any(part.active for part in parts)
