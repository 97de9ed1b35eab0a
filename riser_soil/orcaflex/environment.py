"""Water and current of a data file."""

from __future__ import annotations

from typing import Any

from riser_soil.orcaflex.data_file import MASS, Item, unit_vector

_DEPTHS = ("WaterDepth", "SeabedOriginDepth")
_VISCOSITY = 1.35e-6  # m2/s, OrcaFlex's default


def surface_level(environment: Item) -> float:
    """Height of the surface [m]."""
    return environment.number("WaterSurfaceZ", 0.0)


def water_depth(environment: Item) -> float:
    """Depth from the surface to a level seabed [m]; refused where there is none, where two differ, or it is not level.
    """
    for key in ("SeabedSlope", "SeabedProfileFile"):
        if environment.word(key) not in ("", "0", "0.0"):
            environment.refuse(key, f"is {environment.word(key)}: only a level seabed can be carried over")
    if environment.choice("SeabedType", "Flat") != "flat":
        given = environment.word("SeabedType")
        environment.refuse("SeabedType", f"is {given}: only a level seabed (Flat) can be carried over")
    depths = {key: environment.number(key) for key in _DEPTHS if environment.has(key)}
    if environment.has("SeabedOriginZ"):
        depths["SeabedOriginZ"] = surface_level(environment) - environment.number("SeabedOriginZ")
    if not depths:
        return environment.refuse("SeabedOriginDepth", "is missing, as is WaterDepth; give the water's depth [m]")
    (first, depth), *others = depths.items()
    for key, other in others:
        if other != depth:
            environment.refuse(key, f"gives a depth of {other:g} m, and {first} of {depth:g} m; correct one of them")
    return depth


def water(environment: Item, by_reynolds: bool) -> dict[str, Any]:
    """The scene's water without waves. by_reynolds: whether a line type's drag goes by Reynolds's number."""
    current = _current(environment)
    data: dict[str, Any] = {
        "density": environment.number("Density") * MASS,
        "surface_level": surface_level(environment),
        "depth": water_depth(environment),
    }
    if by_reynolds:
        data |= _viscosity(environment)
    return data | ({"current": {"profile": current}} if current else {})


def _viscosity(environment: Item) -> dict[str, float]:
    method = environment.choice("ReynoldsNumberCalculation", "Flow direction")
    if method != "cross flow":
        given = environment.word("ReynoldsNumberCalculation", "~")
        text = "Reynolds's number is that of the velocity across the line here, as by Cross flow"
        environment.remark("ReynoldsNumberCalculation", f"ReynoldsNumberCalculation {given}: {text}")
    return {"kinematic_viscosity": environment.number("KinematicViscosity", _VISCOSITY)}


def _current(environment: Item) -> list[list[float]]:
    """Velocities [z, ux, uy] from below; empty without a current."""
    speed = environment.number("RefCurrentSpeed", 0.0)
    direction, surface = environment.number("RefCurrentDirection", 0.0), surface_level(environment)
    rows = environment.rows("CurrentDepth")
    method = environment.choice("VerticalCurrentVariationMethod", "Interpolated")
    if speed == 0.0:
        _ = [row.get(key) for row in rows for key in row.values]
        return []
    model = environment.choice("CurrentModel", "Variation scheme")
    if method != "interpolated" or model != "variation scheme":
        given = environment.word("VerticalCurrentVariationMethod") if model == "variation scheme" else model
        text = f"current by {given}, of {speed:g} m/s: only one by depth, interpolated; there is none here"
        environment.remark("VerticalCurrentVariationMethod", text)
        return []
    turns = {row.number("CurrentRotation", 0.0) for row in rows}
    if len(turns) > 1:
        text = "CurrentRotation: between depths the velocity's components are linear"
        environment.remark("RefCurrentDirection", text)
    velocities = [_velocity(row, speed, direction, surface) for row in rows]
    return sorted(velocities) or [[surface, *_along(speed, direction)]]


def _velocity(row: Item, speed: float, direction: float, surface: float) -> list[float]:
    size = speed * row.number("CurrentFactor", 1.0)
    return [surface - row.number("CurrentDepth"), *_along(size, direction + row.number("CurrentRotation", 0.0))]


def _along(speed: float, direction: float) -> list[float]:
    return [speed * part for part in unit_vector(direction)]
