"""Error bars: how far a run's headline quantities may be off, from companions of the same scene.

Companions form a chain: each differs in one knob from the one before it, so that each difference has one source. The
soil's cells and the time steps are coarser, as finer ones would cost more than the run; elements are finer, and so is
the penalty. An error that falls with the power p of the fineness is, by Richardson's extrapolation, the difference over
|f^-p - 1|, f being how much finer the companion is: of a finer one it is little more than the difference, whatever the
order is, so that it can be relied on where the run is far from converged, too. A large difference from longer steps
has not reached its order yet: the divisor falls towards 1 as it grows. A source's share of the bar is

    safety * (what falls between samples + difference / |f^-p - 1|).

Differences are those of the extremes and of their course in time together (`extremes.apart`). What falls between the
run's nodes is the mesh's, between its steps the time step's, as is what alternates from step to step around an extreme:
short waves that the steps do not resolve (`results.peaks`). Largest moments and curvatures are told between nodes
(`riser.bending_peaks`). Of two companions in one source, one coarser than the other, the larger share counts. Shares
of different sources add up as squares do. With these factors the calibration (`benchmarks.error_bars`) finds the true
error inside at least 95 % of the bars.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from riser_soil.accuracy.extremes import Extremes, apart
from riser_soil.accuracy.headlines import Headline

SOURCES = {"elements": "mesh", "time_step": "time", "soil_mesh": "soil", "penalty": "penalty"}
SMALLEST = 5e-5  # bar told, over the quantity's scale
ORDER = {"mesh": 2.0, "time": 2.0, "soil": 1.0, "penalty": 0.75}
#: Orders in a contact force on a rigid floor, by a penalty. Beside an end that is held on it the riser sinks in within
#: a length (4 EI/k)^(1/4) (beam on an elastic foundation), or an element where that is longer; what lies there, the end
#: bears.
CONTACT_FORCE, OF_CONTACT_FORCE = "largest contact force", {"mesh": 1.0, "penalty": 0.25}
SAFETY = {"mesh": 2.0, "time": 2.8, "soil": 0.9, "penalty": 1.6}
ON_PATH = {"soil": 1.4}  # where the soil's law depends on its path: its errors jump more, as cells yield one by one
LARGE = {"time": 0.05}  # differences of coarser runs, over the scale, that are half way to the divisor 1

Values = Mapping[str, float]  # of headline quantities by their keys, in their units


@dataclass(frozen=True)
class Companion:
    """A run of the chain: the source in which it differs from the one before, and how many times as fine it is in it.

    extremes: of its headline quantities; None where it failed, for the `reason`.
    """

    source: str
    finer: float
    extremes: Extremes | None
    reason: str = ""


@dataclass(frozen=True)
class RunValues:
    """The run's headline quantities: as told, with peaks between nodes, between steps too, and without what rings."""

    told: Mapping[str, Headline]
    of_nodes: Values
    peaks: Extremes
    smooth: Values


@dataclass(frozen=True)
class ErrorBar:
    """The error of a headline quantity is at most `bar`, in its unit; None where it can't be told, for the `reason`.

    by_source: the shares of mesh, time, soil and penalty, as far as they are known, in the same unit. order: in which
    they fall.
    """

    headline: Headline
    bar: float | None
    by_source: Mapping[str, float]
    reason: str = ""
    order: Mapping[str, float] = field(default_factory=lambda: ORDER)


def error_bars(run: RunValues, chain: Sequence[Companion], rigid: bool, path_dependent: bool) -> list[ErrorBar]:
    """Of all headline quantities. rigid: whether the ground is a rigid floor. path_dependent: whether its soil is."""
    safety = SAFETY | (ON_PATH if path_dependent else {})
    return [_bar(told, run, chain, orders(told.name, rigid), safety) for told in run.told.values()]


def _bar(
    headline: Headline,
    run: RunValues,
    chain: Sequence[Companion],
    order: Mapping[str, float],
    safety: Mapping[str, float],
) -> ErrorBar:
    key, scale = headline.key, headline.scale
    found, unknown, fineness = dict[str, float](), list[str](), dict[str, float]()
    before: Extremes | None = run.peaks
    for companion in chain:
        source, so_far = companion.source, fineness.get(companion.source, 1.0)
        if before is not None and key in before and companion.extremes is not None and key in companion.extremes:
            off = apart(before[key], companion.extremes[key])
            of_before = off / divisor(companion, order[source], off / scale if scale > 0.0 else 0.0)
            found[source] = max(found.get(source, 0.0), of_before * so_far ** order[source])
        else:
            unknown.append(f"{source}: {companion.reason or 'a companion does not have it'}")
        fineness[source] = so_far * companion.finer
        before = companion.extremes
    between = gaps(headline, run)
    shares = {s: safety[s] * (between.get(s, 0.0) + found.get(s, 0.0)) for s in between | found}
    if unknown:
        return ErrorBar(headline, None, shares, "; ".join(unknown), order)
    return ErrorBar(headline, math.hypot(*shares.values()) + SMALLEST * scale, shares, "", order)


def divisor(companion: Companion, order: float, off: float) -> float:
    """Ratio of the difference of two runs to the error of the first. off: the difference over its scale."""
    asymptotic = abs(companion.finer**-order - 1.0)
    if companion.source not in LARGE:
        return asymptotic
    return 1.0 + (asymptotic - 1.0) / (1.0 + off / LARGE[companion.source])


def orders(name: str, rigid: bool) -> Mapping[str, float]:
    """Orders by source in which the error of a quantity falls. rigid: on a rigid floor."""
    return ORDER | OF_CONTACT_FORCE if name == CONTACT_FORCE and rigid else ORDER


def gaps(headline: Headline, run: RunValues) -> dict[str, float]:
    """What falls between nodes and between steps of the run itself, and what rings."""
    key, value = headline.key, headline.value
    nodes = run.of_nodes.get(key, value)
    peak = run.peaks[key].value if key in run.peaks else nodes
    steps = abs(peak - nodes) + abs(run.smooth.get(key, nodes) - nodes)
    return {"mesh": abs(nodes - value)} | ({"time": steps} if steps else {})
