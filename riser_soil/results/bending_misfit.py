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

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.components import across, cross, dot, size
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.line import Line
from riser_soil.riser.section_forces import ElementEnds
from riser_soil.riser.sections import Elements


def bending_misfits(line: Line, elements: Elements, ends: ElementEnds) -> tuple[Array, Array]:
    """Difference [N m] between each element's bending moment by its end rotations and by its end moments.

    Two of them, each (..., ne), at the states of the section forces at the ends: by the formula with shear, and by the
    trapezoidal rule, which is 0 in elements at ends where the moment sets in.
    """
    bending, shear = across(ends.moment, ends.tangent), cross(ends.force, ends.tangent)
    k, slope = (_over_stiffness(vectors, elements, ends.frames) for vectors in (bending, shear))
    L = line.length
    plain = _turns(line, ends) - 0.5 * L * (k[:, 0] + k[:, 1])
    corrected = plain + L * L / 12.0 * (slope[:, 1] - slope[:, 0])
    smooth, steep = (elements.larger_EI / L * size(turn) for turn in (corrected, plain))
    first, second = size(bending)
    steep[..., 0] *= first[..., 0] > second[..., 0]
    steep[..., -1] *= second[..., -1] > first[..., -1]
    return smooth, steep


def _over_stiffness(moment: Array, elements: Elements, frames: Array | None) -> Array:
    """Curvature (r, 2, ..., ne) of a moment, in space about the section axes of two stiffnesses."""
    y, z = elements.flexibility
    if frames is None:
        return np.asarray(moment * y)
    return np.asarray(frames[1] * (dot(frames[1], moment) * y) + frames[2] * (dot(frames[2], moment) * z))


def _turns(line: Line, ends: ElementEnds) -> Array:
    """Rotation vectors (r, ..., ne) by which elements' ends turn against each other from the unstressed state on, less
    the twist.
    """
    if ends.frames is None or isinstance(line.frames, PlanarFrames):
        return np.asarray(ends.turn[..., 1:] - ends.turn[..., :-1])[None]
    first, second = np.moveaxis(ends.frames, 2, 0)
    unstressed = np.swapaxes(line.frames.T0[:, 1], -1, -2) @ line.frames.T0[:, 0]
    # The second end's axes as the first ones of the element, and the rotation Q from the first end's to these.
    carried = [sum(second[i] * unstressed[:, i, j] for i in range(3)) for j in range(3)]
    Q = [[sum(carried[j][i] * first[j][k] for j in range(3)) for k in range(3)] for i in range(3)]
    vector = 0.5 * np.stack([Q[2][1] - Q[1][2], Q[0][2] - Q[2][0], Q[1][0] - Q[0][1]])
    sine, cosine = size(vector), 0.5 * (Q[0][0] + Q[1][1] + Q[2][2] - 1.0)
    angle_over_sine = np.divide(np.arctan2(sine, cosine), sine, out=np.ones(sine.shape), where=sine > 0.0)
    middle = ends.tangent[:, 0] + ends.tangent[:, 1]
    return across(angle_over_sine * vector, np.asarray(middle / size(middle)))
