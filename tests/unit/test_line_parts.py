"""Residuals and tangents of the riser's parts, in the plane and in space, with rates and accelerations."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, Part, State, Traits, Weights
from riser_soil.riser import hermite, loads, rotary_moments, springs
from riser_soil.riser.beam import Beam
from riser_soil.riser.line_part import acting_on
from riser_soil.riser.planar_directors import PlanarOrientation
from riser_soil.riser.rotary_inertia import RotaryInertia
from riser_soil.riser.section_forces import element_residual, nodal_residual
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.structural_damping import StructuralDamping
from riser_soil.riser.trial import Trial
from riser_soil.sea import morison_law, waterline, wet_section
from riser_soil.sea.moving_water import FlowAtStations
from riser_soil.sea.water import WaterMotion
from tests.support import sample_water
from tests.support.dense_chain import residual, tangent
from tests.support.differences import WEIGHTS, difference_tangent, error, moved, no_operation, slope
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
    *("beam", "inertia", "rotary", "damping", "morison", "forces", "attachments"),
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
    found = {group: bool(f.any()) for group, f in zip("IFE", (forces.inertia, forces.force, forces.end), strict=True)}
    assert found == {group: group in part.traits.groups for group in "IFE"}


@pytest.mark.parametrize("groups", ["", "X", "IFX"])
def test_a_part_is_in_a_group_that_there_is(groups: str) -> None:
    with pytest.raises(ValueError, match="groups of a part are letters"):
        Traits(groups, symmetric=True)


def without_geometric(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    monkeypatch.setattr(hermite, "add_geometric", no_operation)


def without_load_tangent(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    assert isinstance(part, Beam)
    original = part._elastic.add_tangent

    def unloaded(out: Array, weight: float, trial: Trial, load: Array) -> None:
        original(out, weight, trial, 0.0 * load)

    monkeypatch.setattr(part._elastic, "add_tangent", unloaded)


def without_turning_moments(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    for module in (loads, springs):
        monkeypatch.setattr(module, "moment_stiffness", lambda *_: np.zeros((3, 3)))


def without_direction_changes(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    for name in ("resistance_derivatives", "added_derivatives"):
        original = getattr(morison_law, name)

        def straight(*at: Array, original: Callable = original) -> tuple[Array, ...]:
            *others, by_slope = original(*at)
            return *others, 0.0 * by_slope

        monkeypatch.setattr(morison_law, name, straight)


def without_director_rates(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    for turn in (PlanarOrientation, SpatialOrientation):
        original = turn.maps

        def still(self: object, v: Array, a: Array, *shifts: float, original: Callable = original) -> object:
            return original(self, 0.0 * v, 0.0 * a, *shifts)

        monkeypatch.setattr(turn, "maps", still)


def without(name: str, change: Callable[[Array], Array]) -> Callable[[pytest.MonkeyPatch, Part], None]:
    """Leaves a state's increments, rates or accelerations out of the tangent of rotary inertia."""

    def leave_out(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
        original = rotary_moments.add_tangent

        def changed(K: Array, weight: float, J: Array, *rest: Any) -> None:
            values = dict(zip(("Theta", "W", "A", "shift_v", "shift_a"), rest, strict=True))
            values[name] = change(values[name])
            original(K, weight, J, *values.values())

        monkeypatch.setattr(rotary_moments, "add_tangent", changed)

    return leave_out


def without_water(field: str) -> Callable[[pytest.MonkeyPatch, Part], None]:
    """Leave out one of the water's gradients."""

    def leave_out(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
        usual = FlowAtStations.at

        def at(stream: FlowAtStations, trial: Trial) -> WaterMotion:
            motion = usual(stream, trial)
            return motion._replace(**{field: 0.0 * getattr(motion, field)})

        monkeypatch.setattr(FlowAtStations, "at", at)

    return leave_out


def without_rotary_inertia(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    assert isinstance(part, RotaryInertia)
    monkeypatch.setattr(part._sections, "add_tangent", no_operation)


def without_wet_slope(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    usual = wet_section.wet_shares
    monkeypatch.setattr(wet_section, "wet_shares", lambda h, b: (usual(h, b)[0], 0.0 * h))
    monkeypatch.setattr(waterline, "add_tangent", no_operation)


def without_strain_rates(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    """Leaves only that the rates follow the increments."""
    assert isinstance(part, StructuralDamping)
    original = part._damping.tangent
    monkeypatch.setattr(part._damping, "tangent", lambda trial, v, shift_v: original(trial, 0.0 * v, shift_v))


def without_viscosity(monkeypatch: pytest.MonkeyPatch, part: Part) -> None:
    """Leaves only that the forces follow the configuration."""
    assert isinstance(part, StructuralDamping)
    original = part._damping.tangent
    monkeypatch.setattr(part._damping, "tangent", lambda trial, v, shift_v: original(trial, v, 0.0))


@pytest.mark.parametrize(
    ("name", "dimension", "leave_out"),
    [
        ("beam", 2, without_load_tangent),
        ("beam", 3, without_load_tangent),
        ("inertia", 2, without_geometric),
        ("inertia", 3, without_geometric),
        ("inertia", 2, without_director_rates),
        ("inertia", 3, without_director_rates),
        ("rotary", 2, without_rotary_inertia),
        ("rotary", 3, without_rotary_inertia),
        *(("damping", d, leave_out) for d in (2, 3) for leave_out in (without_strain_rates, without_viscosity)),
        *(("rotary", 3, without(name, lambda x: 0.0 * x)) for name in ("Theta", "W", "A", "shift_v", "shift_a")),
        ("morison", 2, without_direction_changes),
        ("morison", 3, without_direction_changes),
        ("morison", 3, without_director_rates),
        ("attachments", 2, without_geometric),
        ("attachments", 3, without_geometric),
        *[
            (name, dimension, leave_out)
            for dimension in (2, 3)
            for name, leave_out in (
                ("current", without_water("velocity_gradient")),
                ("waves", without_water("velocity_gradient")),
                ("waves", without_water("acceleration_gradient")),
                ("waves", without_direction_changes),
                ("half out of still water", without_wet_slope),
                ("half out of waves", without_water("velocity_gradient")),
                ("half out of waves", without_water("acceleration_gradient")),
                ("half out of waves", without_water("immersion_gradient")),
                ("half out of waves", without_wet_slope),
                ("modules", without_geometric),
                ("modules half out of waves", without_water("velocity_gradient")),
                ("modules half out of waves", without_water("acceleration_gradient")),
                ("modules half out of waves", without_water("immersion_gradient")),
                ("modules half out of waves", without_wet_slope),
                ("modules' buoyancy", without_wet_slope),
                ("buoyancy", without_wet_slope),
                ("buoyancy", without_geometric),
                ("buoyancy in waves", without_water("immersion_gradient")),
            )
        ],
        ("forces", 2, without_geometric),
        ("forces", 3, without_geometric),
        ("moments", 3, without_turning_moments),
        ("spring", 3, without_turning_moments),
        ("turned spring", 3, without_turning_moments),
    ],
)
def test_each_term_of_the_tangent_matters(
    name: str, dimension: int, leave_out: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    at = sample(dimension)
    part, state = MAKERS[name](at), at.state(1)
    whole = tangent([part], state, WEIGHTS)
    leave_out(monkeypatch, part)
    at.line.forget()
    assert error(tangent([part], state, WEIGHTS), whole) > 1e-5


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
def test_parts_are_active_where_their_line_is(dimension: int) -> None:
    at = sample(dimension)
    parts = [make(at) for make in MAKERS.values()]
    assert all(part.active for part in parts)
    at.line.active = False
    assert not any(part.active for part in parts)
