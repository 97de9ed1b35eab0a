"""The elastic elements of a line, in the plane and in space: trial state in, forces conjugate to its dofs
out.
"""

from __future__ import annotations

import numpy as np

from riser_soil.arrays import Array
from riser_soil.riser import beam2d, beam3d, increments
from riser_soil.riser.directors import PlanarFrames, PlanarTurn, SpatialFrames, SpatialTurn
from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.riser.trial import Trial


class PlanarElements:
    """Elements of a planar line; EI is EI_y, as the second section axis is normal to the plane."""

    def __init__(self, line: Line, frames: PlanarFrames, elements: Elements) -> None:
        first, second = (np.ascontiguousarray(frames.alpha0[:, i]) for i in (0, 1))
        self.reference = beam2d.reference(line.chord0, first, second, line.length)
        self.section = beam2d.Section(elements.EA, elements.EI_y)

    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, 2) and directions of the tangents at both ends (ne,)."""
        assert isinstance(trial.turn, PlanarTurn)
        angle = trial.turn.end_angle
        return trial.chord, np.ascontiguousarray(angle[:, 0]), np.ascontiguousarray(angle[:, 1])

    def energy(self, trial: Trial) -> float:
        return float(np.sum(beam2d.strain_energy(*self.configuration(trial), self.reference, self.section)))

    def forces(self, trial: Trial) -> Array:
        """(ne, 6)."""
        return np.asarray(beam2d.forces(*self.configuration(trial), self.reference, self.section))

    def tangent(self, trial: Trial) -> Array:
        """(ne, 6, 6)."""
        at = self.configuration(trial)
        return np.asarray(beam2d.forces_and_tangent(*at, self.reference, self.section)[1])


class SpatialElements:
    """Elements of a line in space."""

    def __init__(self, line: Line, frames: SpatialFrames, elements: Elements) -> None:
        first, second = (np.ascontiguousarray(frames.T0[:, i]) for i in (0, 1))
        self.reference = beam3d.reference(line.chord0, first, second, line.length)
        self.section = beam3d.Section(elements.EA, elements.EI_y, elements.EI_z, elements.GJ)

    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, 3) and section frames at both ends (ne, 3, 3)."""
        turn = _spatial(trial)
        return trial.chord, turn.frame1, turn.frame2

    def energy(self, trial: Trial) -> float:
        return float(np.sum(beam3d.strain_energy(*self.configuration(trial), self.reference, self.section)))

    def forces(self, trial: Trial) -> Array:
        """(ne, 12), conjugate to displacements and rotation increments."""
        f = beam3d.forces(*self.configuration(trial), self.reference, self.section)
        increments.forces_to_increments(f, _spatial(trial).H)
        return np.asarray(f)

    def tangent(self, trial: Trial) -> Array:
        """(ne, 12, 12)."""
        turn = _spatial(trial)
        f, K = beam3d.forces_and_tangent(*self.configuration(trial), self.reference, self.section)
        increments.to_increments(f, K, turn.H, turn.Rn, turn.Theta)
        return np.asarray(K)


def elastic_elements(line: Line, elements: Elements) -> PlanarElements | SpatialElements:
    """The elements that suit the line's dimension."""
    if isinstance(line.frames, PlanarFrames):
        return PlanarElements(line, line.frames, elements)
    return SpatialElements(line, line.frames, elements)


def _spatial(trial: Trial) -> SpatialTurn:
    assert isinstance(trial.turn, SpatialTurn)
    return trial.turn
