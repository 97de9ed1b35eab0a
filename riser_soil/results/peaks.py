"""Peaks between samples: the extremes of a stage's figures without what falls between nodes and between steps.

An extreme at the end of a step, or a least tension at a node, misses the peak beside it by up to an eighth of the
second difference there. The vertex of the parabola through the sample and its two neighbours misses it by higher
orders. Largest moments and curvatures are evaluated between nodes already (`riser.bending_peaks`).

Of a dynamic stage there are extremes in even windows of its time, too. Two runs of a scene may agree in an extreme by
chance; they hardly do so in several windows.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from riser_soil.core.arrays import Array, as_list
from riser_soil.core.saved_state import Saved, Stateful, gathered, packed, restore_all, unpacked
from riser_soil.core.snapshot import Record, Records, SoilMesh, SoilSnapshot
from riser_soil.results.bodies_and_joints_figures import BodiesAndJointsExtremes
from riser_soil.results.figures import FIGURE_NAMES, Extremes, final_state, pack, places_of
from riser_soil.results.soil_extremes import SoilExtremes, places

_ALTERNATING = np.array([1.0, -4.0, 6.0, -4.0, 1.0]) / 16.0  # what alternates of five steps, in the middle one
# The middle one, and those after it, without what alternates, if that lasts; cubics stay as they are.
RINGLESS = np.eye(5)[2:] - np.outer([1.0, -1.0, 1.0], _ALTERNATING)
WINDOWS = 16  # of a dynamic stage
UNEVEN = 1e-6  # of five steps' time, by which they may differ
_TENSION = "min_effective_tension"


def parabola(t: Array, values: Array) -> tuple[Array, Array]:
    """Slope at the middle one, and half the second derivative, of the parabola through samples (3, ...) at growing t,
    (3,) or (3, ...).
    """
    before, after = t[1] - t[0], t[2] - t[1]
    first, second = (values[1] - values[0]) / before, (values[2] - values[1]) / after
    return (first * after + second * before) / (before + after), (second - first) / (before + after)


def vertex(t: Array, values: Array) -> Array:
    """Vertex of the parabola through samples (3, ...) at t (3,); the middle one where it is no extreme of the three."""
    slope, bend = parabola(t, values)
    turns = (values[1] - values[0]) * (values[2] - values[1]) < 0.0
    return np.asarray(np.where(turns, values[1] - slope**2 / np.where(turns, 4.0 * bend, 1.0), values[1]))


def least_between_nodes(arc: Array, along: Array) -> float:
    """Least value along the riser, between nodes too. arc, along: (nn,)."""
    at = int(along.argmin())
    if not 0 < at < len(along) - 1:
        return float(along[at])
    return float(vertex(arc[at - 1 : at + 2], along[at - 1 : at + 2]))


def with_least_between_nodes(record: Record, rows: Array) -> Array:
    """Figures of many instants in rows, the least tension at nodes replaced by that between nodes; a copy."""
    rows = rows.copy()
    rows[:, places_of(_TENSION)] = [[least_between_nodes(record.arc, along)] for along in record.effective_tension]
    return rows


class StagePeaks:
    """Extremes of one stage three ways: as recorded, with the tension's between nodes, and between steps as well.

    duration: of a dynamic stage [s].
    """

    def __init__(self, name: str, kind: str, duration: float) -> None:
        self.name, self.kind, self.duration = name, kind, duration
        self._windows: Array = np.empty((2, WINDOWS, 0))  # least and largest figures in windows of time
        self.sampled, self.of_nodes, self.peaks, self.smooth = Extremes(), Extremes(), Extremes(), Extremes()
        self.soil = SoilExtremes()
        self._t: list[float] = []
        self._last: list[Array] = []

    def update(self, times: Sequence[float], record: Record) -> None:
        """Follow the state that a dynamic stage begins with, and accepted steps in turn; times: s or load factors."""
        rows = pack(record)
        self._follow(times, rows, with_least_between_nodes(record, rows))

    def begin(self, before: StagePeaks) -> None:
        """Begin with the last instant of the stage before."""
        self._follow([0.0], before.sampled.latest[None], before._last[-1][None])

    def _follow(self, times: Sequence[float], sampled: Array, peaked: Array) -> None:
        """Rows (nt, figures) of instants in turn, as recorded and with the tension's between nodes."""
        between, smooth = list[tuple[float, Array]](), list[tuple[float, Array]]()
        for t, row in zip(times, peaked, strict=True):
            self._t, self._last = [*self._t[-4:], t], [*self._last[-4:], row]
            between.append((t, row))
            if self.kind == "dynamic":
                between.extend(self._between_steps(t, row))
            if self.kind != "static":
                smooth.append(self._smoothed())
        at = np.array(times)
        for extremes, rows in ((self.sampled, sampled), (self.of_nodes, peaked)):
            extremes.update(at, rows)
        for extremes, instants in ((self.peaks, between), (self.smooth, smooth)):
            if instants:
                extremes.update(np.array([t for t, _ in instants]), np.array([row for _, row in instants]))

    def _between_steps(self, t: float, peaked: Array) -> Iterator[tuple[float, Array]]:
        """Follow the stage's windows; the peak at the step before, if there is one, with its time."""
        if not self._windows.size:
            self._windows = np.full((2, WINDOWS, peaked.size), np.nan)
        self._at_edges()
        self._in_window(self._window(t), peaked)
        if len(self._t) >= 3 and self._t[-3] < self._t[-2] < t:
            top = vertex(np.array(self._t[-3:]), np.array(self._last[-3:]))
            self._in_window(self._window(self._t[-2]), top)
            yield self._t[-2], top

    def _at_edges(self) -> None:
        """Take in figures where one window ends and the next begins, linear between two steps: long steps miss no
        more of a window than short ones.
        """
        for n in range(self._window(self._t[-2]), self._window(self._t[-1])) if len(self._t) > 1 else ():
            share = ((n + 1) * self.duration / WINDOWS - self._t[-2]) / (self._t[-1] - self._t[-2])
            edge = (1.0 - share) * self._last[-2] + share * self._last[-1]
            self._in_window(n, edge)
            self._in_window(n + 1, edge)

    def _window(self, t: float) -> int:
        return min(int(WINDOWS * t / self.duration), WINDOWS - 1)

    def _in_window(self, n: int, peaked: Array) -> None:
        least, largest = self._windows[:, n]
        np.fmin(least, peaked, out=least)
        np.fmax(largest, peaked, out=largest)

    @property
    def final(self) -> dict[str, Any] | None:
        """Figures of the last state that was followed, as the summary has them; None before there is one."""
        return final_state(self.sampled.latest) if self._t else None

    def _smoothed(self) -> tuple[float, Array]:
        """The middle one of five steps without ringing; where there are none yet, or uneven ones, the last as it is."""
        return (self._t[2], RINGLESS[0] @ np.array(self._last)) if self._even else (self._t[-1], self._last[-1])

    @property
    def _even(self) -> bool:
        """Whether five steps of one motion are as long; from one equilibrium to the next there may be corners."""
        if self.kind != "dynamic" or len(self._t) < 5:
            return False
        return bool(np.ptp(np.diff(self._t)) <= UNEVEN * (self._t[-1] - self._t[0]))

    def _smooth_to_the_end(self) -> Extremes:
        """Extremes without ringing up to the last step: the last two steps ring as the five do."""
        ended = Extremes()
        ended.restore(self.smooth.state())
        for n in (1, 2) if self._even else ():
            ended.update(self._t[2 + n], RINGLESS[n] @ np.array(self._last))
        return ended

    def in_windows(self, figure: str, which: str) -> Array:
        """A figure's extremes, min or max, in windows of time (WINDOWS,), nan where it is unknown; none (0,) of a
        static stage, or of what is no figure.
        """
        if not self._windows.size or figure not in FIGURE_NAMES:
            return np.empty(0)
        return np.asarray(self._windows[("min", "max").index(which), :, places_of(figure).start])

    def as_summary(self, which: str) -> dict[str, Any]:
        """The stage as the summary has it; which: sampled, of_nodes, peaks or smooth."""
        final = self.final
        if final is None:
            return {"name": self.name, "kind": self.kind, "final": None}
        if which != "sampled":
            final[_TENSION] = {**final[_TENSION], "value": self._last[-1][places_of(_TENSION)].item()}
        extremes = self._smooth_to_the_end() if which == "smooth" else vars(self)[which]
        return {
            "name": self.name, "kind": self.kind, "final": final, "soil": self.soil.nested(),
            "extremes": extremes.nested(),
        }  # fmt: skip

    def state(self) -> Saved:
        values = {"t": np.array(self._t), "last": np.array(self._last), "windows": self._windows.copy()}
        return gathered(self._owners) | values

    def restore(self, saved: Saved) -> None:
        self._t, self._last, self._windows = as_list(saved["t"]), list(saved["last"]), saved["windows"].copy()
        restore_all(self._owners, saved)

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {name: vars(self)[name] for name in ("sampled", "of_nodes", "peaks", "smooth", "soil")}


class RunPeaks:
    """The peaks of a run, stage by stage and line by line, "" the only one; fed on the rank that records. mesh: the
    soil's, under the line `on_soil`; None: not followed. Of bodies, at steps, and of soil a run that has a summary
    knows as much by that.
    """

    def __init__(self, mesh: SoilMesh | None = None, on_soil: str = "") -> None:
        self.stages: list[dict[str, StagePeaks]] = []
        self._bodies_and_joints: list[BodiesAndJointsExtremes] = []
        self._places, self._on_soil = None if mesh is None else places(mesh), on_soil

    def begin_stage(self, name: str, kind: str, duration: float = 1.0, lines: Iterable[str] = ("",)) -> None:
        """Extremes of a stage along t include the state that it begins with, where a stage came before it. duration:
        of a dynamic one [s].
        """
        self.stages.append({line: StagePeaks(name, kind, duration) for line in lines})
        self._bodies_and_joints.append(BodiesAndJointsExtremes())
        if kind != "static" and len(self.stages) > 1:
            for line, own in self.stages[-1].items():
                own.begin(self.stages[-2][line])

    def record(
        self,
        times: Sequence[float],
        records: Records,
        soil: SoilSnapshot | None = None,
        bodies_and_joints: Mapping[str, Array] | None = None,
    ) -> None:
        """Follow accepted steps in turn. soil: at the last of them, where recorded; bodies_and_joints: values of those
        and of clearances by path, a row a step.
        """
        self._bodies_and_joints[-1].update(np.array(times), bodies_and_joints or {})
        for line, record in records.items():
            stage = self.stages[-1][line]
            stage.update(times, record)
            if soil is not None and self._places is not None and line == self._on_soil:
                stage.soil.update(times[-1], soil, self._places)

    def as_summary(self, which: str) -> dict[str, Any]:
        """The share of a summary that key results are read from; which: sampled, of_nodes, peaks or smooth."""
        each = zip(self.stages, self._bodies_and_joints, strict=True)
        return {"stages": [_stage_summary(of_lines, which) | extremes.nested for of_lines, extremes in each]}

    def state(self) -> Saved:
        begun = [
            {line: (own.name, own.kind, own.duration) for line, own in of_lines.items()} for of_lines in self.stages
        ]
        return gathered(self._numbered) | {"begun": packed(begun)}

    def restore(self, saved: Saved) -> None:
        begun = unpacked(saved["begun"])
        self.stages = [{line: StagePeaks(*stage) for line, stage in of_lines.items()} for of_lines in begun]
        self._bodies_and_joints = [BodiesAndJointsExtremes() for _ in self.stages]
        restore_all(self._numbered, saved)

    @property
    def _numbered(self) -> dict[str, Stateful]:
        return {f"{n}/{line}": own for n, of_lines in enumerate(self.stages) for line, own in of_lines.items()}


def _stage_summary(of_lines: Mapping[str, StagePeaks], which: str) -> dict[str, Any]:
    each = {line: own.as_summary(which) for line, own in of_lines.items()}
    if "" in each:
        return each[""]
    first = next(iter(each.values()))
    return {"name": first["name"], "kind": first["kind"], "lines": each}
