"""The page's block on soil: error bars of the random scenes on soil, and predicted settlements beside references."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from statistics import median

from mpi4py import MPI

from benchmarks.error_bars.calibration import Judged, JudgedScene, decided, ratios, share_inside
from benchmarks.error_bars.random_soils import SOILS
from benchmarks.error_bars.references import Reference
from benchmarks.error_bars.scenes import Mapping as SceneMapping
from demos.page import table
from riser_soil.assembly import build, sized
from riser_soil.checks.settlement import predicted_settlement
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.variants.key_results import SETTLEMENT

ON_SOIL = "error bars on soil"  # block of the page
OF_ALL_ERRORS = "of all errors"
WITHIN = 1.5  # factor within which a predicted settlement is to be


def soil_block(columns: Mapping[str, list[JudgedScene]], known: dict[str, Reference]) -> str:
    """columns: scenes by their heading; known: references by scene."""
    factors = forecast_factors(known)
    kept = sum(1.0 / WITHIN <= factor <= WITHIN for factor in factors.values())
    spread = f"{min(factors.values()):.2f} to {max(factors.values()):.2f}"
    rows = [*zip(*(_cells(scenes) for scenes in columns.values()), strict=True)]
    figures = table(["on soil", *columns], _named(rows))
    return (
        f"{figures}\n\nPredicted settlement over that of the reference, laid scenes: {spread}; {kept} of "
        f"{len(factors)} within {WITHIN:g}."
    )


NAMES = (
    "scenes, key results judged",
    "true error inside its bar",
    "bar over true error, median",
    OF_ALL_ERRORS,
    "settlements inside",
    "their median",
    "excluded, as the reference does not decide",
    "coarser runs' processor time over the scenes'",
)


def _named(rows: Iterable[tuple[str, ...]]) -> list[list[str]]:
    return [[name, *cells] for name, cells in zip(NAMES, rows, strict=True)]


def _cells(scenes: list[JudgedScene]) -> list[str]:
    judged = [each for scene in scenes for each in scene.judged]
    settled = [each for each in judged if each.bar.key_result.name == SETTLEMENT]
    run_seconds, extra = (sum(scene.seconds[n] for scene in scenes) for n in (0, 1))
    return [
        f"{len(scenes)}, {len(decided(judged))}",
        *_figures(judged),
        f"{median(ratios(judged, math.inf)):.2f}",
        *_figures(settled),
        str(len(judged) - len(decided(judged))),
        f"{extra / run_seconds:.0%}",
    ]


def _figures(judged: list[Judged]) -> tuple[str, str]:
    values, bars = ratios(judged), decided(judged)
    inside = f"{share_inside(judged):.1%}, {sum(each.inside for each in bars)} of {len(bars)}"
    return inside, f"{median(values):.2f}" if values else "none"


def forecast_factors(known: dict[str, Reference]) -> dict[str, float]:
    """Settlement of laid scenes as `check` foretells it over that of their references."""
    factors = {name: forecast_factor(SOILS[name], known[name]) for name in SOILS if name in known}
    return {name: factor for name, factor in factors.items() if factor is not None}


def forecast_factor(mapping: SceneMapping, reference: Reference) -> float | None:
    """Factor of the forecast settlement; None of a pipe that is pressed in, and where the reference has no settlement.
    """
    scene = scene_from_mapping(mapping)
    settled = reference.get(f"{scene.stages[0].name}: {SETTLEMENT}")
    if settled is None or scene.line.initial == "straight":
        return None
    expected = predicted_settlement(build(sized(scene), MPI.COMM_WORLD).riser)
    return None if expected is None else expected.deepest / settled[0]
