"""The riser at an accepted state, as results tell it: forces and bending along it, reactions, largest values."""

from __future__ import annotations

import math

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.snapshot import ExtremeAlong, RiserSnapshot, WallSnapshot
from riser_soil.riser import bending_peaks
from riser_soil.riser.line_part import acting_on
from riser_soil.riser.section_forces import at_most, end_reactions, viscous_residual
from riser_soil.riser.section_kernels import SectionForces
from riser_soil.riser.sections import larger_beside
from riser_soil.solve.time_stepper import TimeStepper


def riser_snapshot(assembly: Assembly, stepper: TimeStepper) -> RiserSnapshot:
    """The riser at the accepted state; on the rank that holds it."""
    line, state = assembly.line, stepper.now
    inside = stepper.newton.section_forces(line, assembly.elements, state)
    start, end = end_reactions(line, state, inside, stepper.newton.nodal_residual(line, state))
    least_tension, largest_moment, largest_curvature = (ExtremeAlong(float(x), float(s)) for x, s in inside.extreme)
    most_used, tightest = _tightest_bend(assembly, inside)
    return RiserSnapshot(
        position=inside.position,
        effective_tension=inside.effective_tension,
        wall_tension=_wall_tension(assembly, inside),
        bending_moment=inside.bending_moment,
        curvature=inside.curvature,
        bend_utilisation=_bend_utilisation(assembly, inside.curvature_beside),
        least_tension=least_tension,
        largest_moment=largest_moment,
        largest_curvature=largest_curvature,
        largest_bend_utilisation=most_used,
        tightest_radius=tightest,
        contact_force=_contact_force(assembly, state),
        moment_vector=inside.moment,
        start_force=start.force,
        end_force=end.force,
        start_moment=start.moment,
        end_moment=end.moment,
        start_tangent=inside.end_tangent[0],
        end_tangent=inside.end_tangent[1],
        tension_utilisation=_tension_utilisation(assembly, inside.effective_tension),
        wall=_wall(assembly, state, inside),
    )


def elastic_residual(assembly: Assembly, stepper: TimeStepper) -> Array:
    """Of the elements (ne, 2 ndof), less what follows from strain rates."""
    line, state = assembly.line, stepper.now
    residual = stepper.newton.element_residual(line, state)
    viscous = viscous_residual(line, acting_on(line, stepper.system.model.parts), state)
    return residual if viscous is None else residual - viscous


def _bend_utilisation(assembly: Assembly, curvature: Array) -> Array | None:
    """curvature (ne, 2): at the elements' ends."""
    if not assembly.elements.limits_bending:
        return None
    return at_most(assembly.elements.min_bend_radius[:, None] * curvature)


def _tightest_bend(assembly: Assembly, inside: SectionForces) -> tuple[ExtremeAlong, float]:
    """The largest bend utilisation, and the radius [m] there; nan where no least radius is given."""
    if not assembly.elements.limits_bending:
        return ExtremeAlong(math.nan, math.nan), math.nan
    allowed = assembly.elements.min_bend_radius[:, None]
    used, arc, e = bending_peaks.largest(
        assembly.line.arc, allowed * inside.curvature_beside, allowed * inside.curvature_slope
    )
    return ExtremeAlong(used, arc), float(allowed[e, 0] / used) if used > 0.0 else math.inf


def _wall_tension(assembly: Assembly, inside: SectionForces) -> Array | None:
    if assembly.pressures is None:
        return None
    return assembly.pressures.wall_tension(inside.effective_tension, inside.position[:, 2])


def _tension_utilisation(assembly: Assembly, tension: Array) -> Array | None:
    """Of the nodes (nn,), nan where any tension is allowed; None where it is everywhere. A node has the smaller tension
    allowed beside it.
    """
    if not assembly.elements.limits_tension:
        return None
    allowed = assembly.elements.max_tension
    share = larger_beside(np.divide(1.0, allowed, out=np.zeros_like(allowed), where=allowed > 0.0))
    return np.where(share > 0.0, tension * share, np.nan)


def _wall(assembly: Assembly, state: State, inside: SectionForces) -> WallSnapshot | None:
    sections = assembly.wall_sections
    if sections is None:
        return None
    from riser_soil.results.wall_snapshot import wall_snapshot

    return wall_snapshot(assembly, sections, assembly.line.trial(state), inside)


def _contact_force(assembly: Assembly, state: State) -> Array:
    total = np.zeros(assembly.line.nodes)
    for contact in assembly.contacts:
        total += contact.force_per_length(state)
    return total
