"""Water, current and seabed of a data file."""

from __future__ import annotations

from typing import Any

from riser_soil.orcaflex.data_file import FORCE, MASS, Item, unit_vector

_DEPTHS = ("WaterDepth", "SeabedOriginDepth")


def water_depth(environment: Item) -> float:
    """From the surface to a level seabed [m]; SceneError of one that is not level."""
    for key in ("SeabedSlope", "SeabedProfileFile"):
        if environment.word(key) not in ("", "0", "0.0"):
            raise environment.error(key, f"is {environment.word(key)}: only a level seabed can be carried over")
    if environment.word("SeabedType", "Flat") != "Flat":
        raise environment.error("SeabedType", "only a level seabed (Flat) can be carried over")
    environment.get("SeabedSlopeDirection")
    key = next((key for key in _DEPTHS if environment.has(key)), _DEPTHS[0])
    if not environment.has(key):
        raise environment.error(key, "is missing; give the water's depth [m]")
    return environment.number(key)


def water(environment: Item) -> dict[str, Any]:
    """The scene's water without waves."""
    current = _current(environment)
    found: dict[str, Any] = {
        "density": environment.number("Density") * MASS,
        "surface_level": surface_level(environment),
        "depth": water_depth(environment),
    }
    return found | ({"current": {"profile": current}} if current else {})


def surface_level(environment: Item) -> float:
    """Height of the surface [m]."""
    return environment.number("WaterSurfaceZ", 0.0)


def seabed(environment: Item, diameter: float) -> dict[str, Any]:
    """Springs whose stiffness [kN/m per m2 of contact] counts for pipe as wide as its contact diameter [m]."""
    if environment.word("SeabedModel", "Elastic") != "Elastic":
        raise environment.error("SeabedModel", "only Elastic can be carried over; choose it, or give the seabed anew")
    if environment.word("SeabedShearStiffness"):
        environment.left("SeabedShearStiffness", "SeabedShearStiffness: friction takes effect over D/30 here")
    stiffness = environment.number("SeabedNormalStiffness") * FORCE * diameter
    level = surface_level(environment) - water_depth(environment)
    return {"kind": "spring", "stiffness": stiffness, "level": level, "contact_at": "outer"}


def _current(environment: Item) -> list[list[float]]:
    """Velocities [z, ux, uy] from below; empty without a current."""
    speed = environment.number("RefCurrentSpeed", 0.0)
    direction, surface = environment.number("RefCurrentDirection", 0.0), surface_level(environment)
    rows = environment.rows("CurrentDepth")
    if speed == 0.0:
        _ = [row.get(key) for row in rows for key in row.values]
        return []
    method = environment.word("VerticalCurrentVariationMethod", "Interpolated")
    if method != "Interpolated" or environment.word("CurrentModel", "Variation scheme") != "Variation scheme":
        environment.left("VerticalCurrentVariationMethod", f"current by {method}: only one by depth, interpolated")
        return []
    turns = {row.number("CurrentRotation", 0.0) for row in rows}
    if len(turns) > 1:
        environment.left("RefCurrentDirection", "CurrentRotation: between depths the velocity's components are linear")
    found = [_velocity(row, speed, direction, surface) for row in rows]
    return sorted(found) or [[surface, *_along(speed, direction)]]


def _velocity(row: Item, speed: float, direction: float, surface: float) -> list[float]:
    size = speed * row.number("CurrentFactor", 1.0)
    return [surface - row.number("CurrentDepth"), *_along(size, direction + row.number("CurrentRotation", 0.0))]


def _along(speed: float, direction: float) -> list[float]:
    return [speed * part for part in unit_vector(direction)]
