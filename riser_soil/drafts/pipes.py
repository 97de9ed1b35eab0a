"""Cross-sections of drafts: a steel pipe by its wall, a flexible pipe and a buoyant stretch by rule of thumb, chain.

Flexible pipes come from their makers with mass and stiffnesses: those here grow with the diameter from a pipe of 0.3 m
with 120 kg/m, 3e8 N and 5e4 N.m2. Studless chain of the bar diameter d has 19.9e3 d^2 kg/m, EA = 8.54e10 d^2 N, the
buoyancy of a rod of 1.8 d, and the drag coefficients 2.4 across and 1.15 along on d (DNV-OS-E301).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from riser_soil.errors import SceneError

STEEL, E_STEEL, NU_STEEL = 7850.0, 2.07e11, 0.3  # kg/m3, Pa
YIELD = 448.0e6  # Pa: X65
WATER, OIL = 1025.0, 800.0  # kg/m3
GRAVITY = 9.81
BORE = 2.0 / 3.0  # of a flexible pipe, over its outer diameter
MASS, AXIAL, BENDING = 120.0 / 0.3**2, 3.0e8 / 0.3**2, 5.0e4 / 0.3**4  # of a flexible pipe, by its diameter
FLOAT_DENSITY = 500.0  # kg/m3, of buoyancy modules
LIFT = 1.0  # of a buoyant stretch, over the pipe's submerged weight
BAR = 1.8  # diameter of the rod with a chain's volume, over that of its bar


@dataclass(frozen=True)
class CrossSection:
    """A line type as a scene has it: given numbers with all their digits, others in six figures.

    Diameters [m], mass [kg/m], stiffnesses [N, N.m2], coefficients (across, along).

    source: where its numbers come from. contents: density of what fills the bore [kg/m3]; 0: empty. yield_stress: of a
    metal wall [Pa]; None: no metal wall. min_bend_radius [m], max_tension [N]: allowed; None: any.
    """

    outer: float
    inner: float
    mass: float
    EA: float
    EI: float
    drag: tuple[float, float]
    added_mass: float
    source: str
    contents: float = OIL
    yield_stress: float | None = None
    min_bend_radius: float | None = None
    max_tension: float | None = None

    @property
    def weight(self) -> float:
        """Weight in water, with the contents [N/m]."""
        return GRAVITY * (self.mass + 0.25 * math.pi * (self.contents * self.inner**2 - WATER * self.outer**2))


def rounded(value: float) -> float:
    """The number with six figures."""
    return float(f"{value:.6g}")


def steel(diameter: float, wall: float | None, mass: float | None) -> CrossSection:
    """A steel pipe by its wall [m] or by its mass [kg/m]; the wall is 1/12 of the diameter by default."""
    inner = rounded(diameter * 5.0 / 6.0) if wall is None else diameter - 2.0 * wall
    if mass is not None:
        inner = rounded(_bore(diameter, wall, mass))
    area, second = 0.25 * math.pi * (diameter**2 - inner**2), math.pi / 64.0 * (diameter**4 - inner**4)
    stiffness = rounded(E_STEEL * area), rounded(E_STEEL * second)
    mass = rounded(STEEL * area) if mass is None else mass
    source = f"steel pipe, wall {500.0 * (diameter - inner):.4g} mm"
    return CrossSection(diameter, inner, mass, *stiffness, (1.0, 0.0), 1.0, source, yield_stress=YIELD)


def _bore(diameter: float, wall: float | None, mass: float) -> float:
    """Inner diameter [m] of a steel pipe of a mass [kg/m]."""
    if wall is not None:
        raise SceneError("--wall and --mass: of a steel pipe one follows from the other; leave one out")
    square = diameter**2 - 4.0 * mass / (math.pi * STEEL)
    if square <= 0.0:
        most = 0.25 * math.pi * STEEL * diameter**2
        raise SceneError(f"--mass {mass:g}: a bar of steel of {diameter:g} m has {most:.4g} kg/m; take less")
    return math.sqrt(square)


def flexible(diameter: float, wall: float | None, mass: float | None) -> CrossSection:
    """A flexible pipe by its diameter [m], and its mass [kg/m] where that is known."""
    inner = rounded(BORE * diameter) if wall is None else diameter - 2.0 * wall
    mass = rounded(MASS * diameter**2) if mass is None else mass
    stiffness = rounded(AXIAL * diameter**2), rounded(BENDING * diameter**4)
    source = "flexible pipe, stiffness by rule of thumb: take its maker's numbers"
    return CrossSection(diameter, inner, mass, *stiffness, (1.1, 0.05), 1.0, source)


def buoyant(pipe: CrossSection) -> CrossSection:
    """A pipe inside buoyancy modules spread evenly, which lift it by its own submerged weight."""
    volume = (1.0 + LIFT) * pipe.weight / (GRAVITY * (WATER - FLOAT_DENSITY))
    outer = rounded(math.sqrt(pipe.outer**2 + 4.0 * volume / math.pi))
    source = "the same pipe inside buoyancy modules, spread evenly"
    mass = rounded(pipe.mass + FLOAT_DENSITY * volume)
    return replace(pipe, outer=outer, mass=mass, drag=(1.0, 0.1), source=source)


def chain(diameter: float, wall: float | None, mass: float | None) -> CrossSection:
    """Studless chain by the diameter of its bar [m]."""
    if wall is not None:
        raise SceneError(f"--wall {wall:g}: chain has none; leave it out")
    mass = rounded(19.9e3 * diameter**2) if mass is None else mass
    drag = round(2.4 / BAR, 3), round(1.15 / (math.pi * BAR), 3)
    source = f"studless chain, bar of {1e3 * diameter:.4g} mm; outer_diameter is that of a rod of its volume"
    return CrossSection(BAR * diameter, 0.0, mass, rounded(8.54e10 * diameter**2), 0.0, drag, 1.0, source)
