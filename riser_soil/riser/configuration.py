"""Configuration of a whole line in arrays, for the line solver.

A line's accepted configuration (`PlanarBase`, `SpatialBase`) and the increments and rates of its dofs give a trial
configuration, written into arrays that are allocated once: all that the parts' kernels need to know of the line.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.by_type import bound_by_type
from riser_soil.core.compiled import fixed, njit
from riser_soil.core.part import Weights
from riser_soil.riser import directors, hermite, line_kernels, moving_nodes, spatial_directors
from riser_soil.riser.directors import PlanarFrames
from riser_soil.riser.hermite import Size
from riser_soil.riser.moving_nodes import MovingNodes, write_moved


class PlanarBase(NamedTuple):
    """Accepted configuration of a plane line: places (nn, 2), chords (ne, 2) and angles (nn,); alpha0 (ne, 2);
    loose (ne,): see `line_kernels`.
    """

    x: Array
    chord: Array
    angle: Array
    alpha0: Array
    loose: Array


class SpatialBase(NamedTuple):
    """Accepted configuration in space: places (nn, 3), chords (ne, 3), frames R (nn, 3, 3); T0 (ne, 2, 3, 3);
    loose (ne,): see `line_kernels`.
    """

    x: Array
    chord: Array
    R: Array
    T0: Array
    loose: Array


class PlanarConfiguration(NamedTuple):
    """Trial configuration of a plane line; see `directors` and `hermite`. D and R: see `fixed`.

    angle (nn,), after the increments Theta (nn, 1); end_angle (ne, 2); tangent (ne, 2, 2); P (ne, 2, 2, 1); q, rate and
    acceleration (ne, 4, 2); v and a (nn, 3): rates and accelerations of the dofs.
    """

    x: Array
    chord: Array
    Theta: Array
    angle: Array
    end_angle: Array
    tangent: Array
    P: Array
    q: Array
    rate: Array
    acceleration: Array
    v: Array
    a: Array
    D: Size
    R: Size


class SpatialConfiguration(NamedTuple):
    """Trial configuration of a line in space; see `directors` and `hermite`. D and R: see `fixed`.

    Rn and frames (nn, 3, 3): before and after the rotation increments Theta (nn, 3); H (nn, 3, 3); frame1 and frame2
    (ne, 3, 3) of element ends, T0 (ne, 2, 3, 3) unstressed; tangent (ne, 2, 3); P (ne, 2, 3, 3); q, rate and
    acceleration (ne, 4, 3); v and a (nn, 6): rates and accelerations of the dofs.
    """

    x: Array
    chord: Array
    Rn: Array
    Theta: Array
    frames: Array
    H: Array
    frame1: Array
    frame2: Array
    T0: Array
    tangent: Array
    P: Array
    q: Array
    rate: Array
    acceleration: Array
    v: Array
    a: Array
    D: Size
    R: Size


Base = PlanarBase | SpatialBase
Configuration = PlanarConfiguration | SpatialConfiguration


class Maps(NamedTuple):
    """How the rates and accelerations of element ends' tangents (ne, 2, d, r) follow the rotation dofs; and how places,
    rates and accelerations of an element follow its dofs, rows (ne, d, n) as of `hermite.write_rows`.
    """

    rate: Array
    acceleration: Array
    place_rows: Array
    rate_rows: Array
    acceleration_rows: Array


def base_of(line: MovingNodes) -> Base:
    """The accepted configuration of a line, by the arrays that the line has."""
    if isinstance(line.frames, PlanarFrames):
        return PlanarBase(line.x, line.chord, line.frames.angle, line.frames.alpha0, line.loose)
    return SpatialBase(line.x, line.chord, line.frames.R, line.frames.T0, line.loose)


def workspace_for(line: MovingNodes) -> Configuration:
    """A configuration's arrays, to be written to."""
    nn, ne, d, r = line.nodes, line.length.size, line.dimension, line.frames.dofs
    shapes = {"x": (nn, d), "chord": (ne, d), "tangent": (ne, 2, d), "P": (ne, 2, d, r), "v": (nn, d + r)}
    shapes |= {"q": (ne, 4, d), "rate": (ne, 4, d), "acceleration": (ne, 4, d), "a": (nn, d + r)}
    sizes: dict[str, Any] = {"D": fixed(d), "R": fixed(r)}
    if isinstance(line.frames, PlanarFrames):
        shapes |= {"Theta": (nn, 1), "angle": (nn,), "end_angle": (ne, 2)}
        return PlanarConfiguration(**sizes, **_empty(shapes))
    shapes |= {"Rn": (nn, 3, 3), "Theta": (nn, 3), "frames": (nn, 3, 3), "H": (nn, 3, 3)}
    shapes |= {"frame1": (ne, 3, 3), "frame2": (ne, 3, 3)}
    return SpatialConfiguration(T0=line.frames.T0, **sizes, **_empty(shapes))


def maps_for(line: MovingNodes) -> Maps:
    """Maps to be written to."""
    ne, d, r = line.length.size, line.dimension, line.frames.dofs
    rows = (np.empty((ne, d, 2 * (d + r))) for _ in range(3))
    return Maps(np.empty((ne, 2, d, r)), np.empty((ne, 2, d, r)), *rows)


def _empty(shapes: dict[str, tuple[int, ...]]) -> dict[str, Any]:
    return {name: np.empty(shape) for name, shape in shapes.items()}


@bound_by_type
def place(at: Configuration, base: Base, u: Array, v: Array, a: Array) -> None:
    """Write the configuration after increments u, with rates v and accelerations a (nn, ndof) of the dofs."""


@bound_by_type
def write_rates(at: Configuration, v: Array, a: Array) -> None:
    """Write other rates v and accelerations a (nn, ndof) of the dofs, in the same place."""


@bound_by_type
def write_magnitudes(at: Configuration, out: Array) -> None:
    """Write the sizes (nn, ndof) of a configuration's coordinates, from which round-off follows."""


@bound_by_type
def write_maps(at: Configuration, maps: Maps, weights: Weights) -> None:
    """Write the maps of a configuration, rates by the shifts of the weights."""


@bound_by_type
def write_turning(at: Configuration, F: Array, G: Array) -> None:
    """Write to G (ne, 2, r, r) the derivative of P^T F by the rotation dofs, F (ne, 2, d) constant."""


@bound_by_type
def write_folded(at: Configuration, base: Base, out: IntArray) -> None:
    """Write what `line_kernels.write_folded` writes, of a step from the accepted configuration."""


@place.of(PlanarConfiguration)
def _place_in_plane(at: PlanarConfiguration, base: PlanarBase, u: Array, v: Array, a: Array) -> None:
    write_moved(base.x, base.chord, u, at.x, at.chord)
    for n in range(u.shape[0]):
        at.Theta[n, 0] = u[n, 2]
        at.angle[n] = base.angle[n] + u[n, 2]
    normal = at.P.reshape((at.P.shape[0], 2, 2))
    directors.write_ends(at.angle, base.alpha0, at.end_angle, at.tangent, normal)
    hermite.write_interleaved(at.x, at.tangent, at.q, at.D)
    write_rates(at, v, a)


@place.of(SpatialConfiguration)
def _place_in_space(at: SpatialConfiguration, base: SpatialBase, u: Array, v: Array, a: Array) -> None:
    write_moved(base.x, base.chord, u, at.x, at.chord)
    for n in range(u.shape[0]):
        for i in range(3):
            at.Theta[n, i] = u[n, 3 + i]
            for j in range(3):
                at.Rn[n, i, j] = base.R[n, i, j]
    spatial_directors.orient(base.R, at.Theta, base.T0, at.frames, at.H, at.frame1, at.frame2, at.tangent, at.P)
    hermite.write_interleaved(at.x, at.tangent, at.q, at.D)
    write_rates(at, v, a)


@write_rates.of(PlanarConfiguration)
def _write_planar_rates(at: PlanarConfiguration, v: Array, a: Array) -> None:
    _keep(at, v, a)
    normal = at.P.reshape((at.P.shape[0], 2, 2))
    directors.write_motion(at.tangent, normal, v, a, at.rate, at.acceleration)


@write_rates.of(SpatialConfiguration)
def _write_spatial_rates(at: SpatialConfiguration, v: Array, a: Array) -> None:
    _keep(at, v, a)
    spatial_directors.write_motion(at.frames, at.T0, v, a, at.rate, at.acceleration)


@njit
def _keep(at: Configuration, v: Array, a: Array) -> None:
    for n in range(v.shape[0]):
        for i in range(v.shape[1]):
            at.v[n, i], at.a[n, i] = v[n, i], a[n, i]


@write_magnitudes.of(PlanarConfiguration)
def _write_magnitudes_in_plane(at: PlanarConfiguration, out: Array) -> None:
    moving_nodes.write_magnitudes(at.x, at.angle.reshape((at.angle.size, 1)), out)


@write_magnitudes.of(SpatialConfiguration)
def _write_magnitudes_in_space(at: SpatialConfiguration, out: Array) -> None:
    moving_nodes.write_magnitudes(at.x, at.Theta, out)


@write_maps.of(PlanarConfiguration)
def _write_maps_in_plane(at: PlanarConfiguration, maps: Maps, weights: Weights) -> None:
    normal = at.P.reshape((at.P.shape[0], 2, 2))
    directors.write_maps(
        at.tangent, normal, at.v[:, 2:], at.a[:, 2:], weights.shift_v, weights.shift_a, maps.rate, maps.acceleration
    )
    _write_rows(at, maps, weights)


@write_maps.of(SpatialConfiguration)
def _write_maps_in_space(at: SpatialConfiguration, maps: Maps, weights: Weights) -> None:
    spatial_directors.write_maps(
        at.frames, at.H, at.T0, at.v[:, 3:], at.a[:, 3:], weights.shift_v, weights.shift_a, maps.rate, maps.acceleration
    )
    _write_rows(at, maps, weights)


@njit
def _write_rows(at: Configuration, maps: Maps, weights: Weights) -> None:
    hermite.write_all_rows(at.P, 1.0, maps.place_rows, at.D, at.R)
    hermite.write_all_rows(maps.rate, weights.shift_v, maps.rate_rows, at.D, at.R)
    hermite.write_all_rows(maps.acceleration, weights.shift_a, maps.acceleration_rows, at.D, at.R)


@write_turning.of(PlanarConfiguration)
def _write_turning_in_plane(at: PlanarConfiguration, F: Array, G: Array) -> None:
    directors.write_geometric(at.tangent, F, G)


@write_turning.of(SpatialConfiguration)
def _write_turning_in_space(at: SpatialConfiguration, F: Array, G: Array) -> None:
    spatial_directors.write_geometric(at.Rn, at.H, at.Theta, at.tangent, F, G)


@write_folded.of(PlanarConfiguration)
def _write_folded_in_plane(at: PlanarConfiguration, base: PlanarBase, out: IntArray) -> None:
    tangent, normal = np.empty(at.tangent.shape), np.empty(at.tangent.shape)
    directors.write_ends(base.angle, base.alpha0, np.empty(base.alpha0.shape), tangent, normal)
    line_kernels.write_folded(
        base.chord, tangent, at.chord, at.tangent, directors.first_wound(at.end_angle), base.loose, out
    )


@write_folded.of(SpatialConfiguration)
def _write_folded_in_space(at: SpatialConfiguration, base: SpatialBase, out: IntArray) -> None:
    tangent, first, second = np.empty(at.tangent.shape), np.empty(at.frame1.shape), np.empty(at.frame2.shape)
    spatial_directors.write_end_frames(base.R, base.T0, first, second, tangent)
    line_kernels.write_folded(
        base.chord, tangent, at.chord, at.tangent, spatial_directors.first_wound(at.Theta), base.loose, out
    )
