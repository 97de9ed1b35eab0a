"""The hose at rest: touchdown point, tension and moment by number of elements, contact stiffness and method, against
boundary value problems of the extensible elastica (at_rest_reference.yaml).

Usage, in the project's folder: python -m demos.tank.statics [--results FOLDER]. Prints the tables; half a minute.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np
from ruamel.yaml import YAML

from demos.compute import compute
from demos.page import publish, table
from riser_soil.core.arrays import Array
from riser_soil.results.stage_records import peak

HERE = Path(__file__).parent
SCENE, REFERENCE = HERE / "at_rest.yaml", HERE / "at_rest_reference.yaml"
WEIGHT, HUB, ARM = 147.09975, (28.0, 17.0), 2.0
ROUNDED = 0.1  # the contact law's corner, in depths at rest
METHODS = ("line", "node")
ELEMENTS, STIFFNESSES = (50, 100, 200, 400, 800), (1e5, 1e6, 1e7, 1e8, 1e9)
ON_THE_PAGE = (1e6, 1e8)  # N/m2


@dataclass(frozen=True)
class Rest:
    """H [N]; top tension [N]; touchdown arc [m]; largest moment [N.m]."""

    H: float
    top_tension: float
    touchdown: float
    moment: float

    def errors(self, exact: Rest) -> Array:
        """Relative ones, that of the touchdown arc in metres."""
        values, expected = np.array(astuple(self)), np.array(astuple(exact))
        return np.asarray((values - expected) / np.array([exact.H, exact.top_tension, 1.0, exact.moment]))


def reference() -> tuple[dict[float, Rest], dict[float, Rest]]:
    """On a rigid floor, by the arm's angle [deg]; on a bed of springs, by its stiffness [N/m2]."""
    read = YAML(typ="safe").load(REFERENCE.read_text(encoding="utf-8"))
    return _rests(read["rigid"]), _rests(read["springs"])


def _rests(rows: Mapping[float, Mapping[str, float]]) -> dict[float, Rest]:
    names = [each.name for each in fields(Rest)]
    return {float(key): Rest(*(row[name] for name in names)) for key, row in rows.items()}


def at_rest(folder: Path, elements: int, stiffness: float, method: str = "line", angle_deg: float = 0.0) -> Rest:
    """The elements' answer, the top on the arm at an angle from the vertical."""
    angle = np.radians(angle_deg)
    top = float(HUB[0] + ARM * np.sin(angle)), float(HUB[1] - ARM * np.cos(angle))
    run = compute(
        SCENE,
        folder / "at_rest",
        f"riser.segments.0.elements={elements}",
        f"riser.end.position=[{top[0]!r}, 0.0, {top[1]!r}]",
        f"contact.stiffness={stiffness!r}",
        f"contact.smoothing={ROUNDED * WEIGHT / stiffness!r}",
        f"contact.method={method}",
    )
    final = run.summary["stages"][0]["final"]
    moment = float(peak(run.arc, run["bending_moment"][-1]))
    return Rest(final["end"]["force"][0], final["end"]["effective_tension"], final["touchdown_arc"], moment)


def mesh_rows(
    folder: Path,
    methods: Iterable[str] = METHODS,
    elements: Sequence[int] = ELEMENTS,
    stiffnesses: Sequence[float] = STIFFNESSES,
) -> list[list[str]]:
    """Errors against the bed of springs of the same stiffness: what the mesh and the method leave. The order is the
    slope of the straight line through the errors' logarithms, as errors change their signs on the way.
    """
    rows = []
    for method in methods:
        for k in stiffnesses:
            errors = mesh_errors(folder, method, elements, k)
            rows += [[method, f"{k:.0e}", str(n), *_signed(each)] for n, each in zip(elements, errors, strict=True)]
            rows.append([method, f"{k:.0e}", "order", *_orders(orders(elements, errors))])
    return rows


def mesh_errors(folder: Path, method: str, elements: Sequence[int], stiffness: float) -> Array:
    """Errors of a Rest's quantities by number of elements (elements, 4)."""
    exact = reference()[1][stiffness]
    return np.array([at_rest(folder, n, stiffness, method).errors(exact) for n in elements])


def orders(x: Sequence[float] | Array, errors: Array) -> Array:
    """Slopes of log error over log x, by least squares, without sign; nan where an error is zero to all digits."""
    with np.errstate(divide="ignore", invalid="ignore"):
        logs = np.log(np.abs(errors))
    return np.apply_along_axis(lambda column: _slope(np.log(x), column), 0, logs)


def _slope(x: Array, y: Array) -> float:
    return float(-np.polyfit(x, y, 1)[0]) if np.isfinite(y).all() else np.nan


def penalty_rows() -> list[list[str]]:
    """Beds of springs against the rigid floor: what the penalty leaves, without any mesh."""
    rigid, springs = reference()
    errors = np.array([rest.errors(rigid[0.0]) for rest in springs.values()])
    rows = [[f"{k:.0e}", *_signed(each)] for k, each in zip(springs, errors, strict=True)]
    return [*rows, ["order", *_orders(orders(list(springs), errors))]]


def rigid_rows(folder: Path, elements: int = 400, stiffness: float = 1e9) -> list[list[str]]:
    """On the rigid floor, by the arm's angle: exact values, and errors of stiff line contact."""
    rows = []
    for angle, exact in reference()[0].items():
        errors = at_rest(folder, elements, stiffness, "line", angle).errors(exact)
        rows.append([f"{angle:g}", "exact", *(f"{value:.7g}" for value in astuple(exact))])
        rows.append(["", f"error, {elements} elements", *_signed(errors)])
    return rows


def _signed(errors: Array) -> list[str]:
    return [f"{value:+.1e}" for value in errors]


def _orders(orders: Array) -> list[str]:
    return [f"{order:.1f}" if np.isfinite(order) else "–" for order in orders]


def at_rest_blocks(results: Path) -> dict[str, str]:
    """The page's tables of the hose at rest."""
    relative = ("H", "top tension", "touchdown m", "largest M")
    absolute = ("H N", "top tension N", "touchdown m", "largest M N.m")
    return {
        "at_rest_rigid": table(["arm deg", "", *absolute], rigid_rows(results)),
        "at_rest_penalty": table(["k N/m²", *relative], penalty_rows()),
        "at_rest_mesh": table(["method", "k N/m²", "elements", *relative], mesh_rows(results, stiffnesses=ON_THE_PAGE)),
    }


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=Path, default=HERE / "results", help="folder for runs and tables")
    folder = parser.parse_args().results
    publish(at_rest_blocks(folder), folder)
