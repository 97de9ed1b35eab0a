"""The pipe's wall at accepted states: its loads, and the stress that they make."""

from __future__ import annotations

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.snapshot import WallSnapshot
from riser_soil.riser.section_kernels import SectionForces
from riser_soil.riser.wall_sections import WallSections
from riser_soil.riser.wall_stress import bending_stress, hoop_and_radial_stress, largest_von_mises


def wall_snapshot(assembly: Assembly, sections: WallSections, forces: SectionForces) -> WallSnapshot:
    assert assembly.pressures is not None  # scenes with a wall are refused without
    wall, nodes = sections.wall, assembly.line.nodes
    inside, outside = assembly.pressures.at(forces.position[..., 2])
    about_axes = forces.about_axes * assembly.elements.bends_beside[:, None]
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


def _utilisation(sections: WallSections, von_mises: Array, nodes: int) -> tuple[Array, Array] | tuple[None, None]:
    """Of the nodes (..., nn), and the stress that it is of; nan where no stress is allowed, None if nowhere."""
    limited = sections.allowable > 0.0
    if not limited.any():
        return None, None
    used = np.divide(von_mises, sections.allowable, out=np.full(von_mises.shape, -np.inf), where=limited)
    found, stress = (sections.at_nodes(values, used, nodes) for values in (used, von_mises))
    there = np.isfinite(found)
    return np.where(there, found, np.nan), np.where(there, stress, np.nan)
