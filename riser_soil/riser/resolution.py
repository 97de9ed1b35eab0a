"""A posteriori estimate of the bending error: how well the elements resolve the curvature.

The relative rotation of an element's ends is the integral of its curvature k, and the moments and shear forces at its
ends give k and k' there. Where both describe one smooth curve, the Euler-Maclaurin formula relates them:

    turn/L = (k1 + k2)/2 - L/12 (k2' - k1') + O(L^4 k'''')

A tension T bends a line into shapes that a cubic can't follow, and leaves an error in the moments of an element of
about T L^4 k''/384, the fourth-order error of its deflection times T; the difference of the two sides is that error.
Near a clamped end, where k decays within sqrt(EI/T), shear and moment have the same error. There the trapezoidal rule
alone is used: its error is the drop of k within the element. At a pinned end, where k sets in, it is no error of the
moment.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.part import State
from riser_soil.riser.line import Line
from riser_soil.riser.section_forces import end_forces
from riser_soil.riser.sections import Elements
from riser_soil.riser.spatial_directors import SpatialOrientation
from riser_soil.riser.trial import Trial


class BendingMisfit(NamedTuple):
    """The largest difference [N m] between an element's bending moment by its end rotations and by its end moments.

    smooth: by the formula with shear; steep: by the trapezoidal rule, without elements at ends where the moment sets
    in. Each with its element.
    """

    smooth: float
    smooth_at: int
    steep: float
    steep_at: int


def misfit(line: Line, elements: Elements, state: State, residual: Array) -> BendingMisfit:
    """residual (ne, 2 ndof): from `section_forces.element_residual`, less its viscous share."""
    trial, L = line.trial(state), line.length[:, None]
    force, moment = _sections(line, trial, residual)
    tangent = trial.turn.tangent @ line.basis.T
    bending = moment - np.sum(moment * tangent, axis=2, keepdims=True) * tangent
    k, slope = (_over_stiffness(trial, elements, M) for M in (bending, np.cross(force, tangent)))
    trapezoidal = _turns(line, trial, tangent) - 0.5 * L * (k[:, 0] + k[:, 1])
    corrected = trapezoidal + L * L / 12.0 * (slope[:, 1] - slope[:, 0])
    size = np.linalg.norm(bending, axis=2)
    EI = np.maximum(elements.EI_y, elements.EI_z)
    smooth, steep = (EI / line.length * np.linalg.norm(turn, axis=1) for turn in (corrected, trapezoidal))
    for end, other in ((0, 1), (-1, 0)):
        steep[end] *= size[end, 1 - other] > size[end, other]
    i, j = int(smooth.argmax()), int(steep.argmax())
    return BendingMisfit(float(smooth[i]), i, float(steep[j]), j)


def _sections(line: Line, trial: Trial, residual: Array) -> tuple[Array, Array]:
    """Force and moment (ne, 2, 3), global axes, that what follows the elements' ends exerts on what goes before."""
    sign = np.array([-1.0, 1.0])[:, None]
    force, moment = end_forces(line, trial, residual)
    return sign * force, sign * moment


def _over_stiffness(trial: Trial, elements: Elements, moment: Array) -> Array:
    """Curvatures (ne, 2, 3) of moments, global axes; about the section axes where there are two stiffnesses."""
    y, z = elements.flexibility
    if not isinstance(trial.turn, SpatialOrientation):
        return np.asarray(moment * y[:, None, None])
    frames = np.stack([trial.turn.frame1, trial.turn.frame2], axis=1)
    about = np.einsum("enij,eni->enj", frames, moment)
    about[..., 0] = 0.0
    about[..., 1] *= y[:, None]
    about[..., 2] *= z[:, None]
    return np.asarray(np.einsum("enij,enj->eni", frames, about))


def _turns(line: Line, trial: Trial, tangent: Array) -> Array:
    """Rotation vectors (ne, 3) by which elements' ends turn against each other from the unstressed state on, less the
    twist.
    """
    if not isinstance(trial.turn, SpatialOrientation):
        return np.asarray(np.diff(trial.turn.angle)[:, None] * line.normal)
    R = trial.turn.R
    Q = R[1:] @ R[:-1].transpose(0, 2, 1)
    vector = 0.5 * np.stack([Q[:, 2, 1] - Q[:, 1, 2], Q[:, 0, 2] - Q[:, 2, 0], Q[:, 1, 0] - Q[:, 0, 1]], axis=1)
    sine, cosine = np.linalg.norm(vector, axis=1), 0.5 * (np.trace(Q, axis1=1, axis2=2) - 1.0)
    turn = vector * np.where(sine > 0.0, np.arctan2(sine, cosine) / np.where(sine > 0.0, sine, 1.0), 1.0)[:, None]
    middle = tangent.sum(axis=1)
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    return np.asarray(turn - np.sum(turn * middle, axis=1, keepdims=True) * middle)
