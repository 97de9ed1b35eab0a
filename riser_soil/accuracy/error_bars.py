"""Error bars: bounds on the errors of a run's key results, from comparison runs of the same scene.

Comparison runs form a chain: each differs in one setting from the one before it, so that each difference has one
source. The soil's cells and the time steps are coarser, as finer ones would cost more than the run; elements are finer,
and so is the penalty. An error that falls with the power p of the fineness is, by Richardson's extrapolation, the
difference over |f^-p - 1|, f being the ratio of the comparison run's fineness to the run's. For a finer comparison run
this is little more than the difference, whatever the order is, so that it is reliable far from convergence, too. A
large difference from longer steps has not reached its order yet: the divisor falls towards 1 as it grows. A source's
share of the bar is

    safety * (error of sampling + difference / |f^-p - 1|).

Differences are those of the extremes and of their course in time together (`extreme_differences.difference`). The error
of sampling between the run's nodes is the mesh's, between its steps the time step's, and so is an alternation from step
to step around an extreme: short waves that the steps do not resolve (`results.peaks`). Largest moments and curvatures
are evaluated between nodes (`riser.bending_peaks`). Of two comparison runs in one source, one coarser than the other,
the larger share counts. The bar is the root of the sum of the squares of shares. With these factors the calibration
(`benchmarks.error_bars`) finds the true error inside at least 95 % of the bars.

On soil one run is coarser in all its settings, and a slice across the riser has finer cells (`fine_slice`). Its share
is the soil's. On a block a second one has the run's own steps on the coarser cells. Its share is the time step's,
evaluated for the longer steps, as errors on soil that yields fall more slowly than by the order. The soil's share of a
settlement is by the slice, and by a part of the coarser run's difference, as a slice has no variation along the riser.
The share of other quantities is that difference, enlarged where the settlement changes by more on fine cells than on
coarse ones. For soil of a few slices a slice is no cheaper than the run: there cells are coarsened twice.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from riser_soil.variants.extreme_differences import Extremes, difference
from riser_soil.variants.key_results import SETTLEMENT, KeyResult

SOURCES = {"elements": "mesh", "time_step": "time", "soil_mesh": "soil", "penalty": "penalty"}
SMALLEST, SMALLEST_ON_SOIL = 5e-5, 1e-4  # least bar, over the quantity's scale
ORDER = {"mesh": 2.0, "time": 2.0, "soil": 1.0, "penalty": 0.75}
#: Orders of a contact force on a rigid floor, by a penalty. Beside an end that is fixed on the floor the riser sinks in
#: over a length (4 EI/k)^(1/4) (beam on an elastic foundation), or over an element where that is longer; the end bears
#: the weight of that length.
CONTACT_FORCE, OF_CONTACT_FORCE = "largest contact force", {"mesh": 1.0, "penalty": 0.25}
SAFETY = {"mesh": 2.0, "time": 2.8, "soil": 0.9, "penalty": 1.6}
ON_SOIL = {"mesh": 1.5, "time": 1.5}
ON_PATH = {"soil": 1.4}  # for path-dependent soil, whose errors jump more, as cells yield one by one
BY_SLICE = {"soil": 1.2}  # where the settlement's error is known by a slice
# For a settlement: safety of the slice's error; part of the coarser run's difference, at rest and in motion, where
# the trough comes by many loads and a slice is pressed once.
SLICE, AT_REST, IN_MOTION = 1.4, 0.35, 1.8
MOST_ENLARGED = 2.0  # largest factor on a difference by the slice's error; the factor where the slice fails
LARGE = {"time": 0.05}  # difference of a coarser run, over the scale, whose divisor is half way to 1
Values = Mapping[str, float]  # values of key results by their keys, in their units


@dataclass(frozen=True)
class ComparisonRun:
    """Run of the chain. source: of error, in which it differs from the run before. finer: how many times as fine it is.

    extremes: of its key results; None where it failed, for the `reason`.
    """

    source: str
    finer: float
    extremes: Extremes | None
    reason: str = ""


@dataclass(frozen=True)
class RunValues:
    """Values of a run's key results.

    key_results: as in the summary. of_nodes: with peaks between nodes. peaks: between nodes and steps. smooth: without
    alternation from step to step.
    """

    key_results: Mapping[str, KeyResult]
    of_nodes: Values
    peaks: Extremes
    smooth: Values


@dataclass(frozen=True)
class ErrorBar:
    """Bound on the error of a key result, in its unit; None where it is not known, for the `reason`.

    by_source: the shares of mesh, time, soil and penalty, as far as they are known, in the same unit. order: of
    convergence, by source.
    """

    key_result: KeyResult
    bar: float | None
    by_source: Mapping[str, float]
    reason: str = ""
    order: Mapping[str, float] = field(default_factory=lambda: ORDER)


@dataclass(frozen=True)
class SoilOfRun:
    """Soil of a run. path_dependent: whether its law is.

    fine: settlements [m] of a slice with fine cells, by their keys; empty where the slice failed, None where no slice
    is computed. moving: names of stages that are not static.
    """

    path_dependent: bool
    fine: Values | None = None
    moving: frozenset[str] = frozenset()


def error_bars(
    run: RunValues, chain: Sequence[ComparisonRun], rigid: bool, soil: SoilOfRun | None = None
) -> list[ErrorBar]:
    """Error bars of all key results. rigid: whether the ground is a rigid floor."""
    comparison = _Comparison(run, chain, rigid, soil)
    return [comparison.bar(each) for each in run.key_results.values()]


@dataclass(frozen=True, eq=False)
class _Comparison:
    """A run, its comparison runs and its ground."""

    run: RunValues
    chain: Sequence[ComparisonRun]
    rigid: bool
    soil: SoilOfRun | None

    def bar(self, key_result: KeyResult) -> ErrorBar:
        order, soil = orders(key_result.name, self.rigid), self.soil
        errors, unknown = self._errors(key_result)
        sampling, safety = sampling_errors(key_result, self.run), _safety(soil)
        shares = {s: safety[s] * (sampling.get(s, 0.0) + errors.get(s, 0.0)) for s in sampling | errors}
        if soil is not None and soil.fine is not None and "soil" in errors:
            shares["soil"] = self._by_slice(key_result, errors["soil"], soil, soil.fine)
        if unknown:
            return ErrorBar(key_result, None, shares, "; ".join(unknown), order)
        smallest = SMALLEST if soil is None else SMALLEST_ON_SOIL
        return ErrorBar(key_result, math.hypot(*shares.values()) + smallest * key_result.scale, shares, "", order)

    def _by_slice(self, key_result: KeyResult, error: float, soil: SoilOfRun, fine: Values) -> float:
        """The soil's share of a bar, from a slice and the error by a coarser run."""
        settled = self.run.key_results.get(f"{key_result.stage}: {SETTLEMENT}")
        if settled is None or settled.key not in fine:
            return BY_SLICE["soil"] * MOST_ENLARGED * error
        of_slice = abs(fine[settled.key] - settled.value)
        if key_result.name == SETTLEMENT:
            return math.hypot(SLICE * of_slice, (IN_MOTION if key_result.stage in soil.moving else AT_REST) * error)
        coarser = self._errors(settled)[0].get("soil", 0.0)
        enlarged = min(max(of_slice / coarser, 1.0), MOST_ENLARGED) if coarser > 0.0 else MOST_ENLARGED
        return BY_SLICE["soil"] * enlarged * error

    def _errors(self, key_result: KeyResult) -> tuple[dict[str, float], list[str]]:
        """Errors by source, without safety, in the quantity's unit; and reasons why some are not known."""
        key, scale, order = key_result.key, key_result.scale, orders(key_result.name, self.rigid)
        errors, unknown, fineness = dict[str, float](), list[str](), dict[str, float]()
        before: Extremes | None = self.run.peaks
        for other in self.chain:
            source, so_far = other.source, fineness.get(other.source, 1.0)
            if before is not None and key in before and other.extremes is not None and key in other.extremes:
                change = difference(before[key], other.extremes[key])
                error = change / divisor(other, order[source], change / scale if scale > 0.0 else 0.0)
                errors[source] = max(errors.get(source, 0.0), error * so_far ** order[source])
            else:
                unknown.append(f"{source}: {other.reason or 'a coarser run does not have it'}")
            fineness[source] = so_far * other.finer
            before = other.extremes
        return errors, unknown


def _safety(soil: SoilOfRun | None) -> Mapping[str, float]:
    if soil is None:
        return SAFETY
    return SAFETY | ON_SOIL | (BY_SLICE if soil.fine is not None else ON_PATH if soil.path_dependent else {})


def divisor(comparison_run: ComparisonRun, order: float, change: float) -> float:
    """Ratio of the difference of two runs to the error of the first. change: the difference over its scale."""
    asymptotic = abs(comparison_run.finer**-order - 1.0)
    if comparison_run.source not in LARGE:
        return asymptotic
    return 1.0 + (asymptotic - 1.0) / (1.0 + change / LARGE[comparison_run.source])


def orders(name: str, rigid: bool) -> Mapping[str, float]:
    """Orders of convergence of a quantity by source. rigid: whether the ground is a rigid floor."""
    return ORDER | OF_CONTACT_FORCE if name == CONTACT_FORCE and rigid else ORDER


def sampling_errors(key_result: KeyResult, run: RunValues) -> dict[str, float]:
    """Errors of sampling at the run's nodes and steps, and by alternation from step to step, in the quantity's unit."""
    key, value = key_result.key, key_result.value
    nodes = run.of_nodes.get(key, value)
    peak = run.peaks[key].value if key in run.peaks else nodes
    steps = abs(peak - nodes) + abs(run.smooth.get(key, nodes) - nodes)
    return {"mesh": abs(nodes - value)} | ({"time": steps} if steps else {})
