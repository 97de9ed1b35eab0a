"""Tables on how a run was solved: soil, energy, solver, versions, warnings."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from riser_soil.core import outputs
from riser_soil.report.tables import NOTHING, ReportTable, number

_ENERGY = (
    ("kinetic", "kinetic energy, added mass included"),
    ("strain", "elastic energy"),
    ("potential", "potential energy of weight, buoyancy and contact, from an arbitrary zero"),
    ("dissipated", "dissipated since the load step began"),
    ("numerical", "numerical damping of the time integration"),
    ("work", "work of external forces on line and ground since the load step began"),
    ("residual", "residual of the balance"),
    ("turned_over", "largest of kinetic, elastic, dissipated energy and work, by which the shares count"),
)
_SOIL = {
    "max_settlement": "maximum settlement",
    "max_von_mises_stress": "maximum von Mises stress",
    "max_strength_used": "maximum share of the strength used",
    "max_equivalent_plastic_strain": "maximum plastic strain",
}
_SOURCES = {  # sources of energy, by the names of parts
    "morison": "drag and inertia forces of the water",
    "supports": "motions of the ends",
    "seabed": "the seabed",
    "seabed_time_scheme": "time integration in the contact with the seabed",
    "buoyancy": "buoyancy",
    "gravity": "gravity",
    "loads": "loads",
    "soil": "plastic work in the soil",
    "friction": "friction",
    "structural damping": "structural damping",
}


def soil_table(stage: Mapping[str, Any]) -> ReportTable:
    """Largest values in the soil among its recorded frames, with place and time."""
    rows = []
    for figure in (figure for output in outputs.OF_SOIL for figure in output.figures):
        largest = stage.get("soil", {}).get(figure.name)
        if largest is None or figure.row is None:
            continue
        place = ", ".join(number(round(x, 3) + 0.0, 4) for x in largest["position"])
        value = number(largest["value"] * figure.row.scale)
        words = _SOIL.get(figure.name, figure.row.words)
        rows.append([words, figure.row.unit or "-", value, place, number(largest["time"], 4)])
    time = "at load factor" if stage["kind"] == "static" else "at t [s]"
    return ReportTable(("quantity", "unit", "value", "at x, y, z [m]", time), rows)


def energy_table(stage: Mapping[str, Any]) -> ReportTable:
    """The energy balance at the stage's end [kJ], and its share of what was turned over."""
    energy = stage["energy"]
    whole = energy["turned_over"] or float("nan")

    def percent(value: float) -> str:
        return number(100.0 * value / whole, 3)

    rows = [
        [words, number(energy[name] * 1e-3), NOTHING if name == "potential" else percent(energy[name])]
        for name, words in _ENERGY
        if energy[name] is not None
    ]
    for kind, title in (("dissipated_by", "dissipated by"), ("work_by", "work of")):
        for name, value in energy[kind].items():
            if value:
                words = f"{title} {_SOURCES.get(name, name.replace('_', ' '))}"
                rows.append([words, number(value * 1e-3), percent(value)])
    worst = energy["worst_residual"]
    note = "Energy is not balanced in statics." if stage["kind"] != "dynamic" else ""
    if worst["value"] is not None and worst["time"] is not None:
        share = percent(worst["value"])
        size, at = number(worst["value"], 3), number(worst["time"], 4)
        note = f"Largest residual on the way: {size} J, {share} % of the largest energy, at {at} s."
    return ReportTable(("energy", "kJ", "% of the largest"), rows, note)


def solver_table(summary: Mapping[str, Any]) -> ReportTable:
    """Steps and iterations, stage by stage."""
    counts = ("steps", "failed attempts", "Newton iterations a step", "most")
    head = ("load step", "kind", "simulated [s]", *counts, "found by")
    rows = []
    for stage in summary["stages"]:
        mean = stage["newton_iterations"] / max(1, stage["steps"])
        numbers = (str(stage["steps"]), str(stage["step_cuts"]), number(mean, 3), str(stage["most_newton_iterations"]))
        found_by = stage["method"] or "time steps"
        rows.append([stage["name"], stage["kind"], number(stage["time"]), *numbers, found_by])
    return ReportTable(head, rows)


def versions_table(summary: Mapping[str, Any]) -> ReportTable:
    """What the run was computed with; a run of an earlier version tells its own alone."""
    versions = {"riser_soil": summary["version"]} | summary.get("versions", {})
    return ReportTable(("software", "version"), [[name, version] for name, version in versions.items()])


def warnings_of(summary: Mapping[str, Any]) -> list[str]:
    """All warnings: those told before the first step, and stage by stage those that only results can tell."""
    before = [*summary.get("warnings", [])]
    return before + [f"{stage['name']}: {words}" for stage in summary["stages"] for words in stage["warnings"]]
