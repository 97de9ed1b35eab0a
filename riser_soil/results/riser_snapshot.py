"""The riser at an accepted state, as results tell it: forces and bending along it, reactions, largest values."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.core.snapshot import LargestAlong, RiserSnapshot, WallSnapshot
from riser_soil.riser import bending_peaks
from riser_soil.riser.line import Line
from riser_soil.riser.line_part import acting_on, overrides
from riser_soil.riser.section_forces import (
    SectionForces,
    at_most,
    end_reactions,
    nodal_residual,
    section_forces,
    viscous_residual,
)
from riser_soil.riser.sections import larger_beside
from riser_soil.riser.trial import Trial
from riser_soil.solve.time_stepper import TimeStepper


def riser_snapshot(assembly: Assembly, stepper: TimeStepper) -> RiserSnapshot:
    """The riser at the accepted state; on the rank that holds it."""
    line, state = assembly.line, stepper.now
    parts = acting_on(line, stepper.system.model.parts)
    residual, viscous = _residuals(assembly, stepper)
    inside = section_forces(line, assembly.elements, state, residual, viscous)
    start, end = end_reactions(line, state, residual, nodal_residual(line, parts, state))
    tangent, position = line.trial(state).turn.tangent, line.positions3(state)
    most_used, tightest = _tightest_bend(assembly, inside)
    return RiserSnapshot(
        position=position,
        effective_tension=inside.effective_tension,
        wall_tension=_wall_tension(assembly, inside.effective_tension, position[:, 2]),
        bending_moment=inside.bending_moment,
        curvature=inside.curvature,
        bend_utilisation=_bend_utilisation(assembly, inside.curvature_beside),
        largest_moment=_largest(line, _beside(inside.bending_moment), inside.moment_slope),
        largest_curvature=_largest(line, inside.curvature_beside, inside.curvature_slope),
        largest_bend_utilisation=most_used,
        tightest_radius=tightest,
        contact_force=_contact_force(assembly, state),
        moment_vector=inside.moment,
        start_force=start.force,
        end_force=end.force,
        start_moment=start.moment,
        end_moment=end.moment,
        start_tangent=line.basis @ tangent[0, 0],
        end_tangent=line.basis @ tangent[-1, 1],
        tension_utilisation=_tension_utilisation(assembly, inside.effective_tension),
        wall=_wall(assembly, line.trial(state), inside, position[:, 2]),
    )


def elastic_residual(assembly: Assembly, stepper: TimeStepper) -> Array:
    """Of the elements (ne, 2 ndof), less what follows from strain rates."""
    residual, viscous = _residuals(assembly, stepper)
    return residual if viscous is None else residual - viscous


def _residuals(assembly: Assembly, stepper: TimeStepper) -> tuple[Array, Array | None]:
    """Of the elements (ne, 2 ndof), the whole and the share that follows from strain rates, if any; computed once a
    state.
    """
    line, state = assembly.line, stepper.now
    parts = acting_on(line, stepper.system.model.parts)

    def compute(_: Trial) -> tuple[Array, Array | None]:
        damped = [part for part in parts if overrides(part, "viscous_forces")]
        return stepper.newton.element_residual(line, state), viscous_residual(line, damped, state) if damped else None

    found: tuple[Array, Array | None] = line.trial(state).once("residuals of elements", compute)
    return found


def _bend_utilisation(assembly: Assembly, curvature: Array) -> Array:
    """curvature (ne, 2): at the elements' ends."""
    if not assembly.elements.limits_bending:
        return _unknown(assembly.line.nodes)
    return at_most(assembly.elements.min_bend_radius[:, None] * curvature)


@cache
def _unknown(nodes: int) -> Array:
    """nan at the nodes (nn,), not to be written to."""
    values = np.full(nodes, np.nan)
    values.flags.writeable = False
    return values


def _largest(line: Line, values: Array, slopes: Array) -> LargestAlong:
    """values, slopes (ne, 2): at the elements' ends."""
    value, arc, _ = bending_peaks.largest(line.arc, values, slopes)
    return LargestAlong(value, arc)


def _beside(at_nodes: Array) -> Array:
    """What nodes have (nn,), at the elements' ends (ne, 2)."""
    both = np.empty((at_nodes.size - 1, 2))
    both[:, 0], both[:, 1] = at_nodes[:-1], at_nodes[1:]
    return both


def _tightest_bend(assembly: Assembly, inside: SectionForces) -> tuple[LargestAlong, float]:
    """The largest bend utilisation, and the radius [m] there; nan where no least radius is given."""
    if not assembly.elements.limits_bending:
        return LargestAlong(math.nan, math.nan), math.nan
    allowed = assembly.elements.min_bend_radius[:, None]
    used, arc, e = bending_peaks.largest(
        assembly.line.arc, allowed * inside.curvature_beside, allowed * inside.curvature_slope
    )
    return LargestAlong(used, arc), float(allowed[e, 0] / used) if used > 0.0 else math.inf


def _wall_tension(assembly: Assembly, effective: Array, z: Array) -> Array:
    if assembly.pressures is None:
        return _unknown(assembly.line.nodes)
    return assembly.pressures.wall_tension(effective, z)


def _tension_utilisation(assembly: Assembly, tension: Array) -> Array | None:
    """Of the nodes (nn,), nan where any tension is allowed; None where it is everywhere. A node has the smaller tension
    allowed beside it.
    """
    if not assembly.elements.limits_tension:
        return None
    allowed = assembly.elements.max_tension
    share = larger_beside(np.divide(1.0, allowed, out=np.zeros_like(allowed), where=allowed > 0.0))
    return np.where(share > 0.0, tension * share, np.nan)


def _wall(assembly: Assembly, trial: Trial, inside: SectionForces, z: Array) -> WallSnapshot | None:
    """z: heights of the nodes (nn,) [m]."""
    sections = assembly.wall_sections
    if sections is None:
        return None
    from riser_soil.results.wall_snapshot import wall_snapshot

    return wall_snapshot(assembly, sections, trial, inside, z)


def _contact_force(assembly: Assembly, state: State) -> Array:
    forces = (contact.force_per_length(state) for contact in assembly.contacts)
    return np.asarray(sum(forces, np.zeros(assembly.line.nodes)))
