"""Assembly of the internal and external pressure of the pipe."""

from __future__ import annotations

from typing import TYPE_CHECKING

from riser_soil.riser.line import Line
from riser_soil.riser.sections import Elements
from riser_soil.scene.scene import Scene

if TYPE_CHECKING:
    from riser_soil.riser.wall_tension import HydrostaticPressure, Pressures


def no_wall_tension(scene: Scene) -> str:
    """Why there is no wall tension; empty where there is one."""
    if scene.water is None:
        needed = scene.riser.contents or any(line.wall for line in scene.used_line_types.values())
        return "" if needed else "without water and contents it is the effective tension"
    if scene.water.surface_level is None:
        return "the pressure outside is unknown without water.surface_level"
    if any(line.outer_diameter is None for line in scene.used_line_types.values()):
        return "the pressure outside acts on outer_diameter, which a line type lacks"
    return ""


def pressures_of(scene: Scene, line: Line, elements: Elements) -> Pressures | None:
    """Both pressures; None where the wall tension is not known."""
    if no_wall_tension(scene):
        return None
    from riser_soil.riser.wall_tension import Pressures

    return Pressures(_inside(scene, line), _outside(scene), elements.inner_diameter, elements.pipe_diameter)


def _inside(scene: Scene, line: Line) -> HydrostaticPressure | None:
    given = scene.riser.contents
    if given is None:
        return None
    from riser_soil.riser.wall_tension import HydrostaticPressure

    ends = line.to_global(line.x[[0, -1]])[:, 2]
    level = float(ends.max()) if given.pressure_level is None else given.pressure_level
    return HydrostaticPressure(level, scene.gravity * given.density, given.pressure)


def _outside(scene: Scene) -> HydrostaticPressure | None:
    if scene.water is None or scene.water.surface_level is None:
        return None
    from riser_soil.riser.wall_tension import HydrostaticPressure

    return HydrostaticPressure(scene.water.surface_level, scene.gravity * scene.water.density)
