"""Elastic forces and tangent of all elements of a line under uniform load, in the plane and in space."""

from __future__ import annotations

from abc import ABC, abstractmethod
from types import ModuleType
from typing import Any, ClassVar

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser import beam2d, beam3d, increments, planar_load
from riser_soil.riser.line import Line
from riser_soil.riser.planar_directors import PlanarFrames, PlanarOrientation
from riser_soil.riser.sections import Elements
from riser_soil.riser.spatial_directors import SpatialFrames, SpatialOrientation
from riser_soil.riser.trial import Trial


class ElasticElements(ABC):
    """Base class of the elements in the plane and in space.

    kernels: the module of their formulas; section_type: its section stiffnesses. ends (ne, 2, ...): unstressed
    orientation of element ends, as it takes them.
    """

    kernels: ClassVar[ModuleType]
    section_type: ClassVar[type[Any]]

    def __init__(self, line: Line, ends: Array, *stiffnesses: Array) -> None:
        self._line = line
        first, second = (np.ascontiguousarray(ends[:, i]) for i in (0, 1))
        self.reference: Any = self.kernels.reference(line.chord0, first, second, line.length)
        self.section: Any = self.section_type(*stiffnesses)

    @abstractmethod
    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, d) and orientation of both ends, as the kernels take it."""

    def at(self, trial: Trial) -> tuple:
        """Arguments of the kernels."""
        return *self.configuration(trial), self.reference, self.section

    def energy(self, trial: Trial) -> float:
        return float(np.sum(self.kernels.strain_energy(*self.at(trial))))

    @abstractmethod
    def forces(self, trial: Trial, load: Array) -> Array:
        """(ne, 2 ndof), conjugate to the dofs, less those of a load per length (ne, d) [N/m]."""

    @abstractmethod
    def add_tangent(self, out: Array, weight: float, trial: Trial, load: Array) -> None:
        """Add weight times the derivative of the forces to out (ne, 2 ndof, 2 ndof)."""

    @abstractmethod
    def load_potential(self, trial: Trial, load: Array) -> float:
        """Potential of a load per length (ne, d) [N/m], zero at the origin of the axes [J]."""


class PlanarElements(ElasticElements):
    """Elements of a planar line; EI is EI_y, as the second section axis is normal to the plane.

    Forces and tangent cost less than half of those of `SpatialElements` (`benchmarks.twins`).
    """

    kernels: ClassVar[ModuleType] = beam2d
    section_type: ClassVar[type[Any]] = beam2d.PlanarSection

    def __init__(self, line: Line, frames: PlanarFrames, elements: Elements) -> None:
        super().__init__(line, frames.alpha0, elements.EA, elements.stiffness()[0])

    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, 2) and directions of the tangents at both ends (ne,)."""
        assert isinstance(trial.turn, PlanarOrientation)
        angle = trial.turn.end_angle
        return trial.chord, angle[:, 0], angle[:, 1]

    def forces(self, trial: Trial, load: Array) -> Array:
        by_load = planar_load.forces(*self.configuration(trial), self._line.length, load)
        return np.asarray(beam2d.forces(*self.at(trial)) + by_load)

    def add_tangent(self, out: Array, weight: float, trial: Trial, load: Array) -> None:
        _add_planar_tangent(out, weight, *self.at(trial))
        planar_load.add_tangent(out, weight, *self.configuration(trial), self._line.length, load)

    def load_potential(self, trial: Trial, load: Array) -> float:
        at = self.configuration(trial)
        return float(np.sum(planar_load.potential(*at, _middle(trial), self._line.length, load)))


class SpatialElements(ElasticElements):
    """Elements of a line in space."""

    kernels: ClassVar[ModuleType] = beam3d
    section_type: ClassVar[type[Any]] = beam3d.SpatialSection

    def __init__(self, line: Line, frames: SpatialFrames, elements: Elements) -> None:
        super().__init__(line, frames.T0, elements.EA, *elements.stiffness(), elements.GJ)

    def configuration(self, trial: Trial) -> tuple[Array, Array, Array]:
        """Chords (ne, 3) and section frames at both ends (ne, 3, 3)."""
        turn = spatial(trial)
        return trial.chord, turn.frame1, turn.frame2

    def forces(self, trial: Trial, load: Array) -> Array:
        return np.asarray(_spatial_forces(*self.at(trial), load, spatial(trial).H))

    def add_tangent(self, out: Array, weight: float, trial: Trial, load: Array) -> None:
        turn = spatial(trial)
        _add_spatial_tangent(out, weight, *self.at(trial), load, (turn.H, turn.Rn, turn.Theta))

    def load_potential(self, trial: Trial, load: Array) -> float:
        at = *self.configuration(trial), _middle(trial), self.reference
        return float(np.sum(beam3d.load_potential(*at, load)))


def _middle(trial: Trial) -> Array:
    """(ne, d), of the elements' ends [m]."""
    return np.asarray(0.5 * (trial.x[:-1] + trial.x[1:]))


@njit
def _add(out: Array, weight: float, K: Array) -> None:
    """Add weight K to out (n, n)."""
    for i in range(K.shape[0]):
        for j in range(K.shape[1]):
            out[i, j] += weight * K[i, j]


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
        at = beam2d.corotate(chord[e], direction1[e], direction2[e])
        beam2d.put_element(e, at, reference, section, f, K)
        _add(out[e], weight, K)


@njit
def _spatial_forces(
    chord: Array,
    frame1: Array,
    frame2: Array,
    reference: beam3d.SpatialReference,
    section: beam3d.SpatialSection,
    load: Array,
    H: Array,
) -> Array:
    f = beam3d.forces(chord, frame1, frame2, reference, section, load)
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
    load: Array,
    nodes: tuple[Array, Array, Array],
) -> None:
    """nodes: H, Rn and Theta, see `increments`."""
    f, K, room = np.empty(12), np.empty((12, 12)), beam3d.tangent_room()
    for e in range(len(chord)):
        beam3d.put_element(e, chord, frame1, frame2, reference, section, load, room, f, K)
        increments.tangent_to_increments(e, f, K, nodes[0], nodes[1], nodes[2])
        _add(out[e], weight, K)


def elastic_elements(line: Line, elements: Elements) -> PlanarElements | SpatialElements:
    """The elements that suit the line's dimension."""
    if isinstance(line.frames, PlanarFrames):
        return PlanarElements(line, line.frames, elements)
    return SpatialElements(line, line.frames, elements)


def spatial(trial: Trial) -> SpatialOrientation:
    """The orientation of a line in space."""
    assert isinstance(trial.turn, SpatialOrientation)
    return trial.turn
