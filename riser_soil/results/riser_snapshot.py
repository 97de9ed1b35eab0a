"""The riser at accepted states, as results tell it: forces and bending along it, reactions, largest values."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import CodeSnapshot, ExtremeAlong, RiserSnapshot, WallSnapshot
from riser_soil.riser.line_part import acting_on
from riser_soil.riser.section_forces import add_at_ends, at_most, viscous_residual
from riser_soil.riser.section_kernels import SectionForces, largest_between_nodes
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.wall_stress import WallSections, bending_stress, hoop_and_radial_stress, largest_von_mises
from riser_soil.solve.time_stepper import TimeStepper

if TYPE_CHECKING:
    from riser_soil.code_checks.line_checks import LineChecks


def look_inside(riser: LineAssembly, stepper: TimeStepper) -> Array:
    """Section forces at the accepted state, see `SectionForces.within`, and what the supports exert on the ends; on the
    rank that holds the riser.
    """
    line, state, accepted = riser.line, stepper.now, stepper.newton.accepted
    inside, nodal = accepted.section_forces(line, riser.elements, state), accepted.nodal_residual(line, state)
    if nodal is not None:
        add_at_ends(line, state, nodal, SectionForces.within(inside, line.nodes))
    return inside


def riser_snapshot(riser: LineAssembly, stepper: TimeStepper) -> RiserSnapshot:
    """The riser at the accepted state; on the rank that holds it."""
    inside = SectionForces.within(look_inside(riser, stepper), riser.line.nodes)
    pressed = [contact.force_per_length(stepper.now) for contact in riser.contacts]
    contact_force = np.sum([np.zeros(riser.line.nodes), *pressed], axis=0)
    return snapshot_of(riser, inside, contact_force, riser.pressure_change(stepper.now.t))


def snapshot_of(
    riser: LineAssembly, inside: SectionForces, contact_force: Array, pressure: Array | float
) -> RiserSnapshot:
    """From its section forces, the contact force per length (nn,) and the change of the pressure inside [Pa], at one
    instant or at many.
    """
    most_used, tightest = _tightest_bend(riser, inside)
    return RiserSnapshot(
        position=inside.position,
        effective_tension=inside.effective_tension,
        wall_tension=_wall_tension(riser, inside, pressure),
        bending_moment=inside.bending_moment,
        curvature=inside.curvature,
        bend_utilisation=_bend_utilisation(riser, inside.curvature_beside),
        least_tension=_extreme(inside, 0),
        largest_moment=_extreme(inside, 1),
        largest_curvature=_extreme(inside, 2),
        largest_bend_utilisation=most_used,
        tightest_radius=tightest,
        contact_force=contact_force,
        moment_vector=inside.moment,
        start_force=inside.end_force[..., 0, :],
        end_force=inside.end_force[..., 1, :],
        start_moment=inside.end_moment[..., 0, :],
        end_moment=inside.end_moment[..., 1, :],
        start_tangent=inside.tangent[..., 0, 0, :],
        end_tangent=inside.tangent[..., -1, 1, :],
        tension_utilisation=_tension_utilisation(riser, inside.effective_tension),
        wall=_wall(riser, inside, pressure),
    )


def elastic_residual(riser: LineAssembly, stepper: TimeStepper) -> Array:
    """Residual of the elements (ne, 2 ndof) [N, N m], less what follows from strain rates."""
    line, state = riser.line, stepper.now
    residual = stepper.newton.accepted.element_residual(line, state)
    viscous = viscous_residual(line, acting_on(line, stepper.system.model.parts), state)
    return residual if viscous is None else residual - viscous


def _extreme(inside: SectionForces, row: int) -> ExtremeAlong:
    return ExtremeAlong(inside.extreme[..., row, 0][()], inside.extreme[..., row, 1][()])


def _bend_utilisation(riser: LineAssembly, curvature: Array) -> Array | None:
    """curvature (..., ne, 2): at the elements' ends."""
    if not riser.elements.limits_bending:
        return None
    return at_most(riser.elements.min_bend_radius[:, None] * curvature)


def _tightest_bend(riser: LineAssembly, inside: SectionForces) -> tuple[ExtremeAlong, Array]:
    """The largest bend utilisation, and the radius [m] there; nan where no least radius is given."""
    shape, allowed = inside.extreme.shape[:-2], riser.elements.min_bend_radius[:, None]
    if not riser.elements.limits_bending:
        unknown = np.full(shape, np.nan)[()]
        return ExtremeAlong(unknown, unknown), unknown
    rows = (allowed * values for values in (inside.curvature_beside, inside.curvature_slope))
    each = zip(*(row.reshape(-1, *allowed.shape[:1], 2) for row in rows), strict=True)
    found = [largest_between_nodes(riser.line.arc, *row) for row in each]
    used, arc, e = (np.reshape(values, shape) for values in zip(*found, strict=True))
    radius = np.divide(allowed[e, 0], used, out=np.full(shape, np.inf), where=used > 0.0)
    return ExtremeAlong(used[()], arc[()]), radius[()]


def _wall_tension(riser: LineAssembly, inside: SectionForces, pressure: Array | float) -> Array | None:
    if riser.pressures is None:
        return None
    return riser.pressures.wall_tension(inside.effective_tension, inside.position[..., 2], pressure)


def _tension_utilisation(riser: LineAssembly, tension: Array) -> Array | None:
    """Tension over the allowed one at the nodes (..., nn), the smaller one beside a node; nan where there is no limit.
    None where there is none anywhere.
    """
    if not riser.elements.limits_tension:
        return None
    allowed = riser.elements.max_tension
    share = larger_beside(np.divide(1.0, allowed, out=np.zeros_like(allowed), where=allowed > 0.0))
    return np.where(share > 0.0, tension * share, np.nan)


def _wall(riser: LineAssembly, inside: SectionForces, pressure: Array | float) -> WallSnapshot | None:
    sections = riser.wall_sections
    if sections is None:
        return None

    return wall_snapshot(riser, sections, inside, pressure)


def wall_snapshot(
    riser: LineAssembly, sections: WallSections, forces: SectionForces, pressure: Array | float
) -> WallSnapshot:
    assert riser.pressures is not None  # scenes with a wall are refused without
    wall, nodes = sections.wall, riser.line.nodes
    inside, outside = riser.pressures.at(forces.position[..., 2], pressure)
    about_axes = forces.about_axes * riser.elements.bends_beside[:, None]
    torque, moment_y, moment_z = np.moveaxis(about_axes, -1, 0)
    loads = sections.loads(forces.effective_tension, moment_y, moment_z, torque, inside, outside)
    von_mises = largest_von_mises(loads, wall)
    used, most_used = _utilisation(sections, von_mises, nodes)

    def governing(stress: Array) -> Array:
        return sections.at_nodes(stress, von_mises, nodes)

    return WallSnapshot(
        internal_pressure=inside,
        external_pressure=outside,
        moment_y=moment_y,
        moment_z=moment_z,
        torque=torque,
        axial_stress=governing(loads.tension / wall.area),
        bending_stress=governing(bending_stress(loads.moment, wall.outer_diameter, wall)),
        hoop_stress=governing(hoop_and_radial_stress(loads, wall.inner_diameter, wall)[0]),
        von_mises_stress=governing(von_mises),
        stress_utilisation=used,
        most_used_stress=most_used,
    )


def code_snapshot(
    riser: LineAssembly, checks: LineChecks, forces: SectionForces, contact_force: Array, pressure: Array
) -> CodeSnapshot:
    """Utilisations by codes at many instants; pressure (nt,): change of that inside [Pa]."""
    from riser_soil.code_checks.load_effects import SectionEffects

    _, moment_y, moment_z = np.moveaxis(forces.about_axes * riser.elements.bends_beside[:, None], -1, 0)
    effects = SectionEffects(forces.effective_tension, moment_y, moment_z)
    return checks.at(effects, _pressures(riser, forces, pressure), forces.curvature_beside, contact_force)


def _pressures(riser: LineAssembly, forces: SectionForces, pressure: Array) -> tuple[Array, Array, Array]:
    """Inside and outside at the nodes, and inside at the level to which the contents' pressure refers [Pa]."""
    none, pressures = np.zeros_like(forces.effective_tension), riser.pressures
    if pressures is None:
        return none, none, none[..., :1]
    at_level = 0.0 if pressures.inside is None else pressures.inside.pressure
    return *pressures.at(forces.position[..., 2], pressure), at_level + pressure[:, None]


def _utilisation(sections: WallSections, von_mises: Array, nodes: int) -> tuple[Array, Array] | tuple[None, None]:
    """Stress over the allowed one at the nodes (..., nn), and that stress [Pa]; nan where no limit is given, None if
    nowhere.
    """
    limited = sections.allowable > 0.0
    if not limited.any():
        return None, None
    used = np.divide(von_mises, sections.allowable, out=np.full(von_mises.shape, -np.inf), where=limited)
    found, stress = (sections.at_nodes(values, used, nodes) for values in (used, von_mises))
    there = np.isfinite(found)
    return np.where(there, found, np.nan), np.where(there, stress, np.nan)
