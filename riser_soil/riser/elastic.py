"""Elastic forces and tangent of all elements of a line, in the plane and in space."""

from __future__ import annotations

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import beam2d, beam3d, increments
from riser_soil.riser.directors import PlanarFrames, PlanarOrientation, SpatialFrames, SpatialOrientation
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.riser.trial import Trial


class PlanarElements:
    """Elements of a planar line; EI is EI_y, as the second section axis is normal to the plane."""

    def __init__(self, line: Line, frames: PlanarFrames, elements: Elements) -> None:
        first, second = (np.ascontiguousarray(frames.alpha0[:, i]) for i in (0, 1))
        self.reference = beam2d.reference(line.chord0, first, second, line.length)
        self.section = beam2d.PlanarSection(elements.EA, elements.EI_y)

    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, 2) and directions of the tangents at both ends (ne,)."""
        assert isinstance(trial.turn, PlanarOrientation)
        angle = trial.turn.end_angle
        return trial.chord, angle[:, 0], angle[:, 1]

    def energy(self, trial: Trial) -> float:
        return float(np.sum(beam2d.strain_energy(*self.configuration(trial), self.reference, self.section)))

    def forces(self, trial: Trial) -> Array:
        """(ne, 6)."""
        return np.asarray(beam2d.forces(*self.configuration(trial), self.reference, self.section))

    def add_tangent(self, out: Array, weight: float, trial: Trial) -> None:
        """Add weight times the tangents to out (ne, 6, 6)."""
        _add_planar_tangent(out, weight, *self.configuration(trial), self.reference, self.section)


class SpatialElements:
    """Elements of a line in space."""

    def __init__(self, line: Line, frames: SpatialFrames, elements: Elements) -> None:
        first, second = (np.ascontiguousarray(frames.T0[:, i]) for i in (0, 1))
        self.reference = beam3d.reference(line.chord0, first, second, line.length)
        self.section = beam3d.SpatialSection(elements.EA, elements.EI_y, elements.EI_z, elements.GJ)

    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, 3) and section frames at both ends (ne, 3, 3)."""
        turn = _spatial(trial)
        return trial.chord, turn.frame1, turn.frame2

    def energy(self, trial: Trial) -> float:
        return float(np.sum(beam3d.strain_energy(*self.configuration(trial), self.reference, self.section)))

    def forces(self, trial: Trial) -> Array:
        """(ne, 12), conjugate to displacements and rotation increments."""
        at = self.configuration(trial)
        return np.asarray(_spatial_forces(*at, self.reference, self.section, _spatial(trial).H))

    def add_tangent(self, out: Array, weight: float, trial: Trial) -> None:
        """Add weight times the tangents to out (ne, 12, 12)."""
        turn, at = _spatial(trial), self.configuration(trial)
        _add_spatial_tangent(out, weight, *at, self.reference, self.section, turn.H, turn.Rn, turn.Theta)


@njit
def _add_planar_tangent(
    out: Array,
    weight: float,
    chord: Array,
    direction1: Array,
    direction2: Array,
    reference: beam2d.PlanarReference,
    section: beam2d.PlanarSection,
) -> None:
    f, K = np.empty(6), np.empty((6, 6))
    for e in range(len(chord)):
        beam2d.put_element(e, chord, direction1, direction2, reference, section, f, K)
        for i in range(6):
            for j in range(6):
                out[e, i, j] += weight * K[i, j]


@njit
def _spatial_forces(
    chord: Array,
    frame1: Array,
    frame2: Array,
    reference: beam3d.SpatialReference,
    section: beam3d.SpatialSection,
    H: Array,
) -> Array:
    f = beam3d.forces(chord, frame1, frame2, reference, section)
    increments.forces_to_increments(f, H)
    return f


@njit
def _add_spatial_tangent(
    out: Array,
    weight: float,
    chord: Array,
    frame1: Array,
    frame2: Array,
    reference: beam3d.SpatialReference,
    section: beam3d.SpatialSection,
    H: Array,
    Rn: Array,
    Theta: Array,
) -> None:
    f, K = np.empty(12), np.empty((12, 12))
    for e in range(len(chord)):
        beam3d.put_element(e, chord, frame1, frame2, reference, section, f, K)
        increments.tangent_to_increments(e, f, K, H, Rn, Theta)
        for i in range(12):
            for j in range(12):
                out[e, i, j] += weight * K[i, j]


def elastic_elements(line: Line, elements: Elements) -> PlanarElements | SpatialElements:
    """The elements that suit the line's dimension."""
    if isinstance(line.frames, PlanarFrames):
        return PlanarElements(line, line.frames, elements)
    return SpatialElements(line, line.frames, elements)


def _spatial(trial: Trial) -> SpatialOrientation:
    assert isinstance(trial.turn, SpatialOrientation)
    return trial.turn
