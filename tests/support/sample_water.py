"""Water in general motion around the sample riser: uneven, unsteady, with a wavy surface that the riser crosses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.riser.attachments import PointAttachment
from riser_soil.sea.buoyancy import Buoyancy, DryStations
from riser_soil.sea.dry_pipe import DryPipe
from riser_soil.sea.modules import StillWaterOnModules, diameters, pipe_at
from riser_soil.sea.morison import Morison
from riser_soil.sea.morison_law import added_masses, drag_coefficients
from riser_soil.sea.moving_water import AcceleratedWater, FlowAtStations, RelativeDrag
from riser_soil.sea.pipe import Pipe
from riser_soil.sea.still_water import StationLoads, StillWater
from riser_soil.sea.water import WaterMotion
from riser_soil.sea.wetting import PartlyWet, Wetting, flat_surface
from tests.support.sample_line import DIRECTION, RHO, UP, Sample

LEVEL = 5.2
SECTION = np.stack([DIRECTION, UP])


@dataclass(frozen=True, eq=False)
class Uneven:
    """Vectors within the plane of the sample, varying in all directions: rows of amplitude (2,) m/s, m/s2 with wave
    numbers (2, 3) and frequencies (2,).
    """

    amplitude: Array
    wave_number: Array
    frequency: Array

    def __call__(self, t: float, x: Array) -> tuple[Array, Array]:
        """Values (n, 3) and gradients (n, 3, 3)."""
        phase = x @ self.wave_number.T + self.frequency * t
        values = (self.amplitude * np.sin(phase)) @ SECTION
        slopes = self.amplitude * np.cos(phase)
        return values, np.einsum("na,ai,aj->nij", slopes, SECTION, self.wave_number)


VELOCITY = Uneven(np.array([2.0, 1.1]), np.array([[0.3, -0.2, 0.5], [0.1, 0.4, -0.3]]), np.array([0.9, 1.3]))
ACCELERATION = Uneven(np.array([1.7, -2.3]), np.array([[-0.2, 0.3, 0.4], [0.5, 0.1, 0.2]]), np.array([0.7, -0.4]))
SURFACE = np.array([0.35, -0.25])  # wave numbers along x and y


def water(t: float, x: Array) -> WaterMotion:
    """Its fields have nothing to do with each other, so that each counts by itself."""
    (velocity, by_x), (acceleration, a_by_x) = VELOCITY(t, x), ACCELERATION(t, x)
    phase = x[:, :2] @ SURFACE - 0.8 * t
    gradient = np.concatenate([-0.4 * np.sin(phase)[:, None] * SURFACE, -np.ones((len(x), 1))], axis=1)
    return WaterMotion(velocity, acceleration, by_x, a_by_x, LEVEL - x[:, 2] + 0.4 * np.cos(phase), gradient)


def still(at: Sample) -> StillWater:
    D, e = at.elements.outer_diameter, at.elements
    return StillWater(Pipe(at.line), drag_coefficients(RHO, D, *e.drag.T), added_masses(RHO, D, *e.added_mass.T))


def displaced(at: Sample) -> Array:
    return np.asarray(RHO * 0.25 * np.pi * at.elements.outer_diameter**2)


def driven(loads: StillWater, stream: FlowAtStations, at: Sample) -> StationLoads:
    return AcceleratedWater(RelativeDrag(loads, stream), stream, loads.mass, displaced(at))


def current(at: Sample) -> Morison:
    loads = still(at)
    return Morison(loads.pipe, RelativeDrag(loads, FlowAtStations(loads.pipe, water)))


def waves(at: Sample) -> Morison:
    loads = still(at)
    return Morison(loads.pipe, driven(loads, FlowAtStations(loads.pipe, water), at))


def half_out(at: Sample) -> Morison:
    """The riser crosses the level of still water."""
    loads = still(at)
    return Morison(loads.pipe, PartlyWet(loads, Wetting(loads.pipe, flat_surface(loads.pipe, LEVEL))))


def half_out_in_waves(at: Sample) -> Morison:
    loads = still(at)
    stream = FlowAtStations(loads.pipe, water)
    return Morison(loads.pipe, PartlyWet(driven(loads, stream, at), Wetting(loads.pipe, stream.immersion)))


MODULES = [
    PointAttachment(2.7, volume=0.1, drag_area=0.4, added_mass=0.5),
    PointAttachment(4.0, volume=0.3, drag_area=0.2),
    PointAttachment(5.4, volume=0.3, drag_area=0.7, added_mass=0.8),
]


def on_modules(at: Sample) -> tuple[StillWaterOnModules, Array]:
    """Three modules, two of them in one element; what they displace."""
    volume, drag_area, Ca = np.array([[m.volume, m.drag_area, m.added_mass] for m in MODULES]).T
    loads = StillWaterOnModules(pipe_at(at.line, MODULES), 0.5 * RHO * drag_area, Ca * RHO * volume)
    return loads, RHO * volume


def modules(at: Sample) -> Morison:
    loads, _ = on_modules(at)
    return Morison(loads.pipe, loads)


def modules_half_out_in_waves(at: Sample) -> Morison:
    loads, displaced = on_modules(at)
    stream, added = FlowAtStations(loads.pipe, water), np.array([m.added_mass for m in MODULES])
    mass = (added * displaced)[:, None] * np.ones(2)
    driven = AcceleratedWater(RelativeDrag(loads, stream), stream, mass, displaced)
    return Morison(loads.pipe, PartlyWet(driven, Wetting(loads.pipe, stream.immersion, diameters(MODULES)[:, None])))


def modules_floating(at: Sample) -> Buoyancy:
    pipe = pipe_at(at.line, MODULES)
    surface = flat_surface(pipe, at.line.x[2, -1])
    displaced = 9.81 * RHO * np.array([m.volume for m in MODULES])
    wetting = Wetting(pipe, surface, diameters(MODULES)[:, None])
    return Buoyancy(pipe, DryStations(pipe, wetting, displaced), flat=True)


def floating(at: Sample) -> Buoyancy:
    pipe = Pipe(at.line)
    return Buoyancy(pipe, DryPipe(pipe, flat_surface(pipe, LEVEL), 9.81 * displaced(at)), flat=True)


def floating_in_waves(at: Sample) -> Buoyancy:
    pipe = Pipe(at.line)
    return Buoyancy(pipe, DryPipe(pipe, FlowAtStations(pipe, water).immersion, 9.81 * displaced(at)), flat=False)
