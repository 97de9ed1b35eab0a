"""Error bars: how far a run's headline quantities may be off, from coarser companions of the same scene.

Companions form a chain: each is coarser in one knob than the one before it, so that each difference has one source. A
source's share of the error is, by Richardson's extrapolation,

    safety * (what falls between samples + difference / (ratio^order - 1)).

What falls between the run's nodes is the mesh's, between its steps the time step's, as is what alternates from step to
step around an extreme: short waves that the steps do not resolve (`results.peaks`). Largest moments and curvatures are
told between nodes (`riser.bending_peaks`), by cubics whose error is of the elements' own order, so that the difference
tells it. A large difference has not reached its order yet: the divisor falls towards 1 as it grows. Of two companions
in one source, one coarser than the other, the larger share counts. Shares of different sources add up as squares do.
With these factors the calibration (`benchmarks.error_bars`) finds the true error inside at least 95 % of the bars.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from riser_soil.accuracy.headlines import Headline

SOURCES = {"elements": "mesh", "time_step": "time", "soil_mesh": "soil", "penalty": "penalty"}
SMALLEST = 5e-5  # bar told, over the quantity's scale
FREE, TOUCHING = 4.0, 2.0  # orders of elements that hang, and where contact begins and ends within one
ORDER = {"time": 2.0, "soil": 1.0, "penalty": 0.75}
#: Orders in a contact force on a rigid floor, by a penalty. Beside an end that is held on it the riser sinks in within
#: a length (4 EI/k)^(1/4) (beam on an elastic foundation), or an element where that is longer; what lies there, the end
#: bears.
CONTACT_FORCE, OF_CONTACT_FORCE = "largest contact force", {"mesh": 1.0, "penalty": 0.25}
SAFETY = {"mesh": 1.5, "time": 1.8, "soil": 0.9, "penalty": 1.6}
ON_PATH = {"soil": 1.4}  # where the soil's law depends on its path: its errors jump more, as cells yield one by one
LARGE = {"mesh": 0.03, "time": 0.01}  # differences, over the scale, that are half way to the divisor 1
RINGING = 2.0  # times what rings from step to step
STEP_GAP = 2.0  # times what falls between steps, as later samples fall elsewhere

Values = Mapping[str, float]  # of headline quantities by their keys, in their units


@dataclass(frozen=True)
class Companion:
    """A run of the chain: the source in which it is coarser than the one before, by what ratio, and its values.

    values: peaks of its headline quantities; None where it failed, for the `reason`.
    """

    source: str
    ratio: float
    values: Values | None
    reason: str = ""


@dataclass(frozen=True)
class RunValues:
    """The run's headline quantities: as told, with peaks between nodes, between steps too, and without what rings."""

    told: Mapping[str, Headline]
    of_nodes: Values
    peaks: Values
    smooth: Values


@dataclass(frozen=True)
class ErrorBar:
    """The error of a headline quantity is at most `bar`, in its unit; None where it can't be told, for the `reason`.

    by_source: the shares of mesh, time, soil and penalty, as far as they are known, in the same unit.
    """

    headline: Headline
    bar: float | None
    by_source: Mapping[str, float]
    reason: str = ""


def error_bars(run: RunValues, chain: Sequence[Companion], touches: bool, path_dependent: bool) -> list[ErrorBar]:
    """Of all headline quantities. touches: whether the scene has a ground. path_dependent: whether its soil is."""
    safety = SAFETY | (ON_PATH if path_dependent else {})
    return [_bar(headline, run, chain, touches, safety) for headline in run.told.values()]


def _bar(
    headline: Headline, run: RunValues, chain: Sequence[Companion], touches: bool, safety: Mapping[str, float]
) -> ErrorBar:
    key, scale = headline.key, headline.scale
    order = orders(headline.name, {each.source for each in chain}, TOUCHING if touches else FREE)
    found, unknown, coarser = dict[str, float](), list[str](), dict[str, float]()
    before: Values | None = run.peaks
    for companion in chain:
        source, so_far = companion.source, coarser.get(companion.source, 1.0)
        known = before is not None and key in before and companion.values is not None and key in companion.values
        if known:
            assert before is not None
            assert companion.values is not None
            off = abs(companion.values[key] - before[key])
            told = off / divisor(companion, off / scale if scale > 0.0 else 0.0, order[source])
            found[source] = max(found.get(source, 0.0), told / so_far ** order[source])
        else:
            unknown.append(f"{source}: {companion.reason or 'a companion does not have it'}")
        coarser[source] = so_far * companion.ratio
        before = companion.values
    between = gaps(headline, run)
    shares = {s: safety[s] * (between.get(s, 0.0) + found.get(s, 0.0)) for s in between | found}
    if unknown:
        return ErrorBar(headline, None, shares, "; ".join(unknown))
    return ErrorBar(headline, math.hypot(*shares.values()) + SMALLEST * scale, shares)


def divisor(companion: Companion, off: float, order: float) -> float:
    """Ratio of the difference to the error of the finer one of two runs. off: the difference over its scale."""
    source = companion.source
    asymptotic = companion.ratio**order - 1.0
    return 1.0 + (asymptotic - 1.0) / (1.0 + off / LARGE[source]) if source in LARGE else asymptotic


def orders(name: str, sources: Collection[str], mesh: float) -> Mapping[str, float]:
    """Orders by source in which the error of a quantity falls. sources: of the scene. mesh: order of its elements."""
    usual = ORDER | {"mesh": mesh}
    rigid = "penalty" in sources and "soil" not in sources
    return usual | OF_CONTACT_FORCE if name == CONTACT_FORCE and rigid else usual


def gaps(headline: Headline, run: RunValues) -> dict[str, float]:
    """What falls between nodes and between steps of the run itself."""
    key, value = headline.key, headline.value
    nodes = run.of_nodes.get(key, value)
    steps = STEP_GAP * abs(run.peaks.get(key, nodes) - nodes)
    if key in run.smooth:
        steps += RINGING * abs(run.smooth[key] - nodes)
    return {"mesh": abs(nodes - value)} | ({"time": steps} if steps else {})
