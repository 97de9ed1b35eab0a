"""Results of the riser at accepted states: forces and bending along it, reactions, largest values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import Record
from riser_soil.riser.bending_peaks import largest_between_nodes
from riser_soil.riser.section_forces import SectionForces, at_most
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.wall_stress import WallSections, bending_stress, hoop_and_radial_stress, largest_von_mises
from riser_soil.solve.time_stepper import TimeStepper

if TYPE_CHECKING:
    from riser_soil.code_checks.line_checks import LineChecks


def riser_record(riser: LineAssembly, stepper: TimeStepper) -> Record:
    """The riser at the accepted state, without its touchdown; on the rank that has it."""
    line, accepted = riser.line, stepper.newton.accepted
    inside = SectionForces(line, riser.elements, accepted.section_input(line, stepper.now))
    pressed = [contact.force_per_length(stepper.now) for contact in riser.contacts]
    contact_force = np.sum([np.zeros(riser.line.nodes), *pressed], axis=0)
    return Record(line.arc, riser_values(riser, inside, contact_force, riser.pressure_change(stepper.now.t)))


def riser_values(
    riser: LineAssembly, inside: SectionForces, contact_force: Array, pressure: Array | float
) -> dict[str, Array | None]:
    """Quantities by the section forces, the contact force per length (nn,) and the change of the pressure inside [Pa],
    at one instant or at many; None where something is not known.
    """
    return {
        "position": inside.position,
        "effective_tension": inside.effective_tension,
        "wall_tension": _wall_tension(riser, inside, pressure),
        "bending_moment": inside.bending_moment,
        "curvature": inside.curvature,
        "bend_utilisation": _bend_utilisation(riser, inside.curvature_beside),
        **_along("least_tension", *inside.least_tension),
        **_along("largest_moment", *inside.largest_moment),
        **_along("largest_curvature", *inside.largest_curvature),
        **_tightest_bend(riser, inside),
        "contact_force": contact_force,
        "moment_vector": inside.moment,
        "start_force": inside.end_force[..., 0, :],
        "end_force": inside.end_force[..., 1, :],
        "start_moment": inside.end_moment[..., 0, :],
        "end_moment": inside.end_moment[..., 1, :],
        "start_tangent": inside.tangent[..., 0, 0, :],
        "end_tangent": inside.tangent[..., -1, 1, :],
        "tension_utilisation": _tension_utilisation(riser, inside.effective_tension),
        **_wall(riser, inside, pressure),
    }


def _along(name: str, value: Array, arc: Array) -> dict[str, Array]:
    """A largest or least value along the riser, with its place."""
    return {name: value, f"{name}_arc": arc}


def _bend_utilisation(riser: LineAssembly, curvature: Array) -> Array | None:
    """curvature (..., ne, 2): at the elements' ends."""
    if not riser.elements.limits_bending:
        return None
    return at_most(riser.elements.min_bend_radius[:, None] * curvature)


def _tightest_bend(riser: LineAssembly, inside: SectionForces) -> dict[str, Array]:
    """The largest bend utilisation, and the radius [m] there; nothing where no least radius is given."""
    if not riser.elements.limits_bending:
        return {}
    allowed = riser.elements.min_bend_radius
    rows = (allowed[:, None] * values for values in (inside.curvature_beside, inside.curvature_slope))
    used, arc, e = largest_between_nodes(riser.line.arc, *rows)
    radius = np.divide(allowed[e], used, out=np.full(np.shape(used), np.inf), where=used > 0.0)
    return _along("largest_bend_utilisation", used, arc) | {"tightest_radius": radius}


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


def _wall(riser: LineAssembly, inside: SectionForces, pressure: Array | float) -> Mapping[str, Array | None]:
    return {} if riser.wall_sections is None else wall_values(riser, riser.wall_sections, inside, pressure)


def wall_values(
    riser: LineAssembly, sections: WallSections, forces: SectionForces, pressure: Array | float
) -> dict[str, Array | None]:
    """Loads and stress of the pipe's wall; stresses are nan where there is no wall, and at a joint those of the side
    with the larger von Mises' stress.
    """
    assert riser.pressures is not None  # scenes with a wall are refused without
    wall, nodes = sections.wall, riser.line.nodes
    inside, outside = riser.pressures.at(forces.position[..., 2], pressure)
    torque, moment_y, moment_z = np.moveaxis(forces.about_axes, -1, 0)
    loads = sections.loads(forces.effective_tension, moment_y, moment_z, torque, inside, outside)
    von_mises = largest_von_mises(loads, wall)
    used, most_used = _utilisation(sections, von_mises, nodes)

    def governing(stress: Array) -> Array:
        return sections.at_nodes(stress, von_mises, nodes)

    return {
        "internal_pressure": inside,
        "external_pressure": outside,
        "bending_moment_y": moment_y,
        "bending_moment_z": moment_z,
        "torque": torque,
        "wall_axial_stress": governing(loads.tension / wall.area),
        "wall_bending_stress": governing(bending_stress(loads.moment, wall.outer_diameter, wall)),
        "wall_hoop_stress": governing(hoop_and_radial_stress(loads, wall.inner_diameter, wall)[0]),
        "wall_von_mises_stress": governing(von_mises),
        "stress_utilisation": used,
        "most_used_stress": most_used,
    }


def code_values(
    riser: LineAssembly, checks: LineChecks, forces: SectionForces, contact_force: Array, pressure: Array
) -> dict[str, Array]:
    """Utilisations by codes at many instants; pressure (nt,): change of that inside [Pa]."""
    from riser_soil.code_checks.load_effects import SectionEffects

    _, moment_y, moment_z = np.moveaxis(forces.about_axes, -1, 0)
    effects = SectionEffects(forces.effective_tension, moment_y, moment_z)
    return checks.at(effects, _pressures(riser, forces, pressure), forces.curvature_beside, contact_force)


def _pressures(riser: LineAssembly, forces: SectionForces, pressure: Array) -> tuple[Array, Array, Array]:
    """Pressures [Pa]: inside and outside at the nodes, and inside at the level of the contents' given pressure."""
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
    share, stress = (sections.at_nodes(values, used, nodes) for values in (used, von_mises))
    there = np.isfinite(share)
    return np.where(there, share, np.nan), np.where(there, stress, np.nan)
