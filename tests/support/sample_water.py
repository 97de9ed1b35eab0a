"""Water in general motion around the sample riser: uneven, unsteady, with a wavy surface that the riser crosses."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.compiled import njit
from riser_soil.riser.attachments import PointAttachment
from riser_soil.sea.buoyancy import Buoyancy, dry_pipe, dry_stations
from riser_soil.sea.flows import Sea, WaterMotion, add_flow
from riser_soil.sea.morison import Morison, in_sea, pushed_masses
from riser_soil.sea.morison_law import added_masses, drag_coefficients
from riser_soil.sea.pipe import Pipe, alike, diameters, pipe_at
from riser_soil.sea.stream_kernels import FlowAtStations
from tests.support.sample_line import DIRECTION, RHO, UP, Sample

LEVEL = 5.2
SECTION = np.stack([DIRECTION, UP])


class Uneven(NamedTuple):
    """Vectors within the plane of the sample, varying in all directions: rows of amplitude (2,) m/s, m/s2 with wave
    numbers (2, 3) and frequencies (2,).
    """

    amplitude: Array
    wave_number: Array
    frequency: Array


VELOCITY = Uneven(np.array([2.0, 1.1]), np.array([[0.3, -0.2, 0.5], [0.1, 0.4, -0.3]]), np.array([0.9, 1.3]))
ACCELERATION = Uneven(np.array([1.7, -2.3]), np.array([[-0.2, 0.3, 0.4], [0.5, 0.1, 0.2]]), np.array([0.7, -0.4]))
SURFACE = np.array([0.35, -0.25])  # wave numbers along x and y


class General(NamedTuple):
    """A flow whose fields have nothing to do with each other, so that each counts by itself; as it is seen
    from a ship under way (3,) [m/s].
    """

    velocity: Uneven
    acceleration: Uneven
    ship: Array


def general(ship: Array | None = None) -> General:
    return General(VELOCITY, ACCELERATION, np.zeros(3) if ship is None else ship)


@njit
def add_to(motion: WaterMotion, flow: General, t: float, x: Array) -> None:
    at = np.empty(3)
    for p in range(x.shape[0]):
        for i in range(3):
            at[i] = x[p, i] + flow.ship[i] * t
            motion.velocity[p, i] -= flow.ship[i]
        _add_uneven(flow.velocity, t, at, motion.velocity[p], motion.velocity_gradient[p])
        _add_uneven(flow.acceleration, t, at, motion.acceleration[p], motion.acceleration_gradient[p])
        phase = at[0] * SURFACE[0] + at[1] * SURFACE[1] - 0.8 * t
        motion.immersion[p] += 0.4 * math.cos(phase)
        for i in range(2):
            motion.immersion_gradient[p, i] -= 0.4 * math.sin(phase) * SURFACE[i]


@njit
def _add_uneven(field: Uneven, t: float, x: Array, value: Array, gradient: Array) -> None:
    for n in range(2):
        phase = field.frequency[n] * t
        for j in range(3):
            phase += field.wave_number[n, j] * x[j]
        for i in range(3):
            value[i] += field.amplitude[n] * math.sin(phase) * SECTION[n, i]
            for j in range(3):
                gradient[i, j] += field.amplitude[n] * math.cos(phase) * SECTION[n, i] * field.wave_number[n, j]


@add_flow.of(General)
def _add_general(flow: General, motion: WaterMotion, t: Array, x: Array) -> None:
    add_to(motion, flow, t[0], x)


water = Sea(LEVEL, [general()])


class Resistance(NamedTuple):
    """Coefficients of drag and added mass (ne, 2) at stations, and the mass of the water in the pipe's place (ne,)."""

    pipe: Pipe
    drag: Array
    mass: Array
    displaced: Array


def resistance(at: Sample) -> Resistance:
    D, e = at.elements.outer_diameter, at.elements
    drag, mass = drag_coefficients(RHO, D, *e.drag.T), added_masses(RHO, D, *e.added_mass.T)
    return Resistance(Pipe(at.line), drag, mass, displaced(at))


def displaced(at: Sample) -> Array:
    return np.asarray(RHO * 0.25 * np.pi * at.elements.outer_diameter**2)


def driven(of: Resistance, sea: Sea = water, span: Array | None = None) -> Morison:
    """In a sea that moves and accelerates."""
    return in_sea(FlowAtStations(of.pipe, sea), of.drag, of.mass, pushed_masses(of.mass, of.displaced), span)


def current(at: Sample) -> Morison:
    of = resistance(at)
    return in_sea(FlowAtStations(of.pipe, water), of.drag, of.mass)


def waves(at: Sample) -> Morison:
    return driven(resistance(at))


def calm(pipe: Pipe, level: float = LEVEL) -> FlowAtStations:
    return FlowAtStations(pipe, Sea(level))


def half_out(at: Sample) -> Morison:
    """The riser crosses the level of still water."""
    of = resistance(at)
    return in_sea(calm(of.pipe), of.drag, of.mass, span=of.pipe.span, dissipative=True)


def half_out_in_waves(at: Sample) -> Morison:
    of = resistance(at)
    return driven(of, span=of.pipe.span)


MODULES = [
    PointAttachment(2.7, volume=0.1, drag_area=0.4, added_mass=0.5),
    PointAttachment(4.0, volume=0.3, drag_area=0.2),
    PointAttachment(5.4, volume=0.3, drag_area=0.7, added_mass=0.8),
]


def on_modules(at: Sample) -> Resistance:
    """Three modules, two of them in one element."""
    volume, drag_area, Ca = np.array([[m.volume, m.drag_area, m.added_mass] for m in MODULES]).T
    return Resistance(pipe_at(at.line, MODULES), alike(0.5 * RHO * drag_area), alike(Ca * RHO * volume), RHO * volume)


def modules(at: Sample) -> Morison:
    of = on_modules(at)
    return in_sea(FlowAtStations(of.pipe), of.drag, of.mass, dissipative=True)


def modules_half_out_in_waves(at: Sample) -> Morison:
    return driven(on_modules(at), span=diameters(MODULES)[:, None])


def modules_floating(at: Sample) -> Buoyancy:
    surface = calm(pipe_at(at.line, MODULES), at.line.x[2, -1])
    displaced = 9.81 * RHO * np.array([m.volume for m in MODULES])
    return Buoyancy(surface, dry_stations(diameters(MODULES)[:, None], displaced), flat=True)


def floating(at: Sample) -> Buoyancy:
    return Buoyancy(calm(Pipe(at.line)), dry_pipe(9.81 * displaced(at)), flat=True)


def floating_in_waves(at: Sample) -> Buoyancy:
    return Buoyancy(FlowAtStations(Pipe(at.line), water), dry_pipe(9.81 * displaced(at)), flat=False)
