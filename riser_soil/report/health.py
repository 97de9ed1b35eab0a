"""Tables on how a run was solved: soil, energy, solver, indicators of the numerical error, seconds, versions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from riser_soil.core import outputs
from riser_soil.report.tables import NOTHING, ReportTable, number

_ENERGY = (
    ("kinetic", "kinetic energy, added mass included"),
    ("strain", "elastic energy"),
    ("potential", "energy of weight, buoyancy and contact; its zero is anywhere"),
    ("dissipated", "dissipated since the stage began"),
    ("numerical", "taken out by the time scheme; negative where it put energy in"),
    ("work", "put in since the stage began; negative where it was taken out"),
    ("residual", "residual of the balance; positive where energy appears from nowhere"),
    ("turned_over", "turned over: the largest of kinetic, elastic, dissipated energy and work"),
)


def soil_table(stage: Mapping[str, Any]) -> ReportTable:
    """Largest values in the soil among its recorded frames, with place and time."""
    rows = []
    for figure in (figure for output in outputs.OF_SOIL for figure in output.figures):
        largest = stage.get("soil", {}).get(figure.name)
        if largest is None or figure.row is None:
            continue
        place = ", ".join(number(round(x, 3) + 0.0, 4) for x in largest["position"])
        value = number(largest["value"] * figure.row.scale)
        rows.append([figure.row.words, figure.row.unit or "-", value, place, number(largest["time"], 4)])
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
    for kind, title in (("dissipated_by", "dissipated by"), ("work_by", "put in by")):
        for name, value in energy[kind].items():
            if value:
                words = f"{title} {name.replace('_', ' ')}"
                rows.append([words, number(value * 1e-3), percent(value)])
    worst = energy["worst_residual"]
    note = "Energy is not balanced in statics." if stage["kind"] != "dynamic" else ""
    if worst["value"] is not None and worst["time"] is not None:
        share = percent(worst["value"])
        size, at = number(worst["value"], 3), number(worst["time"], 4)
        note = f"Largest residual on the way: {size} J, {share} % of what was turned over, at {at} s."
    return ReportTable(("energy", "kJ", "% of turned over"), rows, note)


def solver_table(summary: Mapping[str, Any]) -> ReportTable:
    """Steps and iterations, stage by stage."""
    counts = ("steps", "failed attempts", "Newton iterations a step", "most")
    head = ("stage", "kind", "simulated [s]", *counts, "found by")
    rows = []
    for stage in summary["stages"]:
        mean = stage["newton_iterations"] / max(1, stage["steps"])
        numbers = (str(stage["steps"]), str(stage["step_cuts"]), number(mean, 3), str(stage["most_newton_iterations"]))
        found_by = stage["method"] or "time steps"
        rows.append([stage["name"], stage["kind"], number(stage["time"]), *numbers, found_by])
    return ReportTable(head, rows)


def indicators_table(stage: Mapping[str, Any]) -> ReportTable:
    """Estimates of the numerical error that cost no other run."""
    return ReportTable(("indicator", "value"), list(_indicators(stage.get("indicators", {}), ())))


def seconds_table(summary: Mapping[str, Any]) -> ReportTable:
    """Where the time went."""
    return ReportTable(("part", "seconds"), [[part, number(took, 3)] for part, took in summary["seconds"].items()])


def versions_table(summary: Mapping[str, Any]) -> ReportTable:
    """What the run was computed with; a run of an earlier version tells its own alone."""
    versions = {"riser_soil": summary["version"]} | summary.get("versions", {})
    return ReportTable(("software", "version"), [[name, version] for name, version in versions.items()])


def warnings_of(summary: Mapping[str, Any]) -> list[str]:
    """All warnings: those told before the first step, and stage by stage those that only results can tell."""
    before = [*summary.get("warnings", [])]
    return before + [f"{stage['name']}: {words}" for stage in summary["stages"] for words in stage["warnings"]]


def parts_words(summary: Mapping[str, Any]) -> tuple[str, list[str]]:
    """The parts that were built, and each that was left out with its reason."""
    parts = summary["parts"]
    return ", ".join(parts["built"]), [f"{name}: {reason}" for name, reason in parts["left_out"].items()]


def _indicators(nested: Mapping[str, Any], path: tuple[str, ...]) -> Iterator[list[str]]:
    for name, value in nested.items():
        if isinstance(value, Mapping):
            yield from _indicators(value, (*path, name))
        else:
            yield [", ".join((*path, name)).replace("_", " "), number(value, 3) if value is not None else NOTHING]

