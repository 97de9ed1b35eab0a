"""Seabed of a data file: springs, or Randolph & Quiggin's law, which OrcaFlex calls its nonlinear soil model."""

from __future__ import annotations

import re
from typing import Any

from riser_soil.imported_scene import friction
from riser_soil.orcaflex.data_file import FORCE, MASS, Item
from riser_soil.orcaflex.environment import surface_level, water_depth
from riser_soil.orcaflex.line_types import PipeOfType, friction_of
from riser_soil.seabed.randolph_quiggin import RandolphQuiggin

_SPRINGS = ("elastic", "linear")
_BY_LAW = re.compile(r"non-?linear( soil model)?")
# Keys of the law, and names of their data in OrcaFlex, in lower case and without Soil, Seabed and marks between words.
_LAW = {
    "a": r"(powerlaw|penetration(resistance)?)?(parameter)?a",
    "b": r"(powerlaw|penetration(resistance)?)?(parameter)?b",
    "K_max": r"kmax|(normali[sz]ed)?max(imum)?stiffness",
    "f_suc": r"fsuc|suction(resistance)?(ratio|factor)",
    "lambda_suc": r"(lambda)?suc|(normali[sz]ed)?suctiondecay(distance)?",
    "lambda_rep": r"(lambda)?rep|(normali[sz]ed)?repenetration(offset)?(afteruplift)?",
    "f_b": r"fb|buoyancyfactor",
}
_STRENGTH = r"(undrained)?shearstrengthatmudline|mudline(undrained)?shearstrength|(undrained)?shearstrength|su0?"
_GRADIENT = r"(undrained)?shearstrengthgradient|(strength)?gradient|sugradient"
_DENSITY = r"(saturated)?density"


def ground_of(environment: Item, pipes: list[PipeOfType], g: float) -> dict[str, Any]:
    """Seabed and friction, by the lowest pipe, the first of them, where they differ. g: gravity [m/s2]."""
    first = pipes[0]
    contact, remark = friction(*friction_of(first.item))
    if remark:
        first.item.remark("SeabedAxialFrictionCoefficient", remark)
    as_first = (first.contact_diameter, friction_of(first.item))
    for each in pipes:
        if (each.contact_diameter, friction_of(each.item)) != as_first and each.item.name != first.item.name:
            text = f"on the seabed it counts as {first.item.name}: one contact diameter and friction for all"
            each.item.remark("OD", text)
    return {"seabed": _seabed(environment, first.contact_diameter, g)} | contact


def _seabed(environment: Item, diameter: float, g: float) -> dict[str, Any]:
    """Springs whose stiffness [kN/m per m2 of contact] counts for pipe as wide as its contact diameter [m], or clay."""
    place = {"level": surface_level(environment) - water_depth(environment), "contact_at": "outer"}
    kind = environment.choice("SeabedModel", "Elastic")
    if environment.word("SeabedShearStiffness"):
        environment.remark("SeabedShearStiffness", "SeabedShearStiffness: friction takes effect over D/30 here")
    other = [key for key in environment.values if "soil" in key] if kind in _SPRINGS else ["SeabedNormalStiffness"]
    for key in other:
        environment.get(key)  # belongs to the other model: without effect
    if _BY_LAW.fullmatch(kind):
        return {"kind": "hysteretic", "law": _law(environment, g)} | place
    if kind not in _SPRINGS:
        given = environment.word("SeabedModel")
        environment.refuse("SeabedModel", f"is {given}; give Elastic, Linear or Nonlinear soil model")
        return {}
    return {"kind": "spring", "stiffness": environment.number("SeabedNormalStiffness") * FORCE * diameter} | place


def _law(environment: Item, g: float) -> dict[str, Any]:
    """Randolph & Quiggin's law; what the file does not give has the law's default value."""
    parts = [environment, *(environment.part(key) for key in environment.values if "soil" in key)]
    given = {_bare(key): (part, key) for part in parts for key in part.values if key != "density"}

    def number(names: str, size: float) -> float | None:
        value = next((given[name] for name in given if re.fullmatch(names, name)), None)
        return None if value is None or not value[0].has(value[1]) else value[0].number(value[1]) * size

    strength, density = number(_STRENGTH, FORCE), number(_DENSITY, MASS)
    if strength is None:
        strength = environment.refuse("SoilShearStrengthAtMudline", "is missing; give the clay's strength [kPa]")
    law = {"kind": "randolph-quiggin", "su": strength, "su_gradient": number(_GRADIENT, FORCE) or 0.0}
    if density is not None:
        law["unit_weight"] = max(0.0, density - environment.number("Density") * MASS) * g
    values = {key: value for key, names in _LAW.items() if (value := number(names, 1.0)) is not None}
    defaults = {key: RandolphQuiggin.model_fields[key].default for key in _LAW if key not in values}
    if defaults:
        shown = ", ".join(f"{key} {value:g}" for key, value in defaults.items())
        environment.remark("SeabedModel", f"nonlinear soil model: what is not given is the law's default here: {shown}")
    return law | values


def _bare(key: str) -> str:
    """A name of data of the soil without what all of them have."""
    return re.sub(r"[^a-z]|seabed|nonlinear|soil|model", "", key)
