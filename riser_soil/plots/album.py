"""The pictures of a run: which there are for a stage, and their files."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from riser_soil.errors import ResultsError
from riser_soil.plots import film, histories, picture
from riser_soil.plots.bodies import pipe_radius
from riser_soil.plots.curves import PAGE, STYLE, save, sheet
from riser_soil.plots.progress import OnProgress, in_turn, silent
from riser_soil.plots.ranges import names, range_sheet
from riser_soil.plots.shape import seabed_under, snapshots
from riser_soil.results import Run
from riser_soil.results.stage_records import StageRecords, stage_records
from riser_soil.results.whole_file import refuse_file, written_whole

FORMATS = ("png", "svg", "pdf")
GROUPS = ("ranges", "histories", "shape", "soil", "energy", "solver", "touchdown", "film")
_ALONE = {"touchdown": "touchdown.png", "film": "film.gif"}  # drawn by a process of their own, in one format
_UNASKED = ("touchdown",)  # of these


@dataclass(frozen=True, eq=False)
class Picture:
    """A sheet of curves of a stage: the name of its file without ending, its group, its caption, how it is drawn."""

    name: str
    group: str
    caption: str
    stage: StageRecords
    sheet: Callable[[StageRecords], Figure]

    def bare(self) -> Figure:
        """The sheet without a title, for where its caption stands below."""
        return self.sheet(self.stage)

    def draw(self) -> Figure:
        """The sheet with the run's title, in the style of a page."""
        with rc_context(STYLE):
            figure = self.sheet(self.stage)
            figure.suptitle(f"{self.stage.run.summary['title']}: {when(self.stage)}")
        return figure


def pictures(stage: StageRecords) -> list[Picture]:
    """All sheets of curves that a stage has something for."""
    return [*_ranges(stage), *_others(stage)]


def album(
    run: Run,
    folder: Path,
    what: Sequence[str] = (),
    ending: str = "png",
    stage: str | None = None,
    with_film: bool = False,
    on_progress: OnProgress = silent,
) -> Iterator[tuple[Path | None, str]]:
    """Draws pictures into a folder: file by file with its caption, or None and the reason why one is not there.

    what: of GROUPS, or names of pictures; none for all that there is but the film. with_film: the film, too.
    on_progress: hears of each picture and frame. Raises ResultsError for unknown names, and where what was asked for by
    name can't be drawn.
    """
    of_stage = stage_records(run, stage)
    there = pictures(of_stage)
    _check(what, there)
    refuse_file(folder)
    folder.mkdir(parents=True, exist_ok=True)
    curves = {each.name: each for each in there if not what or {each.group, each.name} & set(what)}
    asked = {*what, *(("film",) if with_film else ())}
    alone = [name for name in _ALONE if name in asked or (name in _UNASKED and not what)]
    for name in in_turn([*curves, *alone], str, on_progress):
        if name in curves:
            file = folder / f"{name}.{ending}"
            with written_whole(file) as part:
                save(curves[name].draw(), part)
            yield file, curves[name].caption
        else:
            yield _drawn_alone(name, of_stage, folder / _ALONE[name], name in asked, on_progress)


def _check(what: Sequence[str], there: Sequence[Picture]) -> None:
    known = [*GROUPS, *(each.name for each in there if each.name not in GROUPS)]
    for name in what:
        if name not in known:
            raise ResultsError(f'--what: "{name}" is not among the pictures of this run; it has {", ".join(known)}')
    drawn = {each.group for each in there} | _ALONE.keys()
    for name in what:
        if name in GROUPS and name not in drawn:
            raise ResultsError(f"--what {name}: the stage has nothing to draw for it")


def _ranges(stage: StageRecords) -> Iterator[Picture]:
    for name in names(stage):
        caption = f"{name.replace('_', ' ')} along the riser: {when(stage)}"
        yield Picture(f"range_{name}", "ranges", caption, stage, partial(range_sheet, name=name))


def _others(stage: StageRecords) -> Iterator[Picture]:
    there = stage.run.variables
    if stage.moves:
        yield _sheet(stage, "history_ends", "histories", "ends in time", histories.ends)
        if _touches(stage):
            yield _sheet(stage, "history_touchdown", "histories", "TDP and contact force in time", histories.touchdown)
        words = "minimum effective tension and minimum bend radius in time"
        yield _sheet(stage, "history_extremes", "histories", words, histories.least_and_tightest)
    yield _sheet(stage, "shape", "shape", "shape of the riser", snapshots)
    if has_trough(stage):
        yield _sheet(stage, "trough", "soil", "trough across the riser", trough)
    if stage.moves and "kinetic_energy" in there:
        yield _sheet(stage, "energy", "energy", "energy in the load step", histories.energy)
        yield _sheet(stage, "solver", "solver", "iterations and steps", histories.solver)


def _touches(stage: StageRecords) -> bool:
    return bool((stage["max_penetration"] > 0.0).any())


def _sheet(
    stage: StageRecords, name: str, group: str, words: str, draw: Callable[[StageRecords], Figure]
) -> Picture:
    return Picture(name, group, f"{words}: {when(stage)}", stage, draw)


def when(stage: StageRecords) -> str:
    """The stage, and from when to when it was recorded."""
    if not stage.moves:
        return f"{stage.name}, at its end"
    return f"{stage.name}, {stage.time[0]:.5g} to {stage.time[-1]:.5g} s"


def _drawn_alone(
    name: str, stage: StageRecords, file: Path, asked: bool, on_progress: OnProgress
) -> tuple[Path | None, str]:
    """The picture of the run's end, or the film of a stage; what was asked for must be there."""
    run = stage.run
    try:
        if name == "film":
            return film(run.place, file, stage=stage.name, on_progress=on_progress), f"film: {stage.name}"
        return picture(run.place, file), "the touchdown zone at the run's end"
    except ResultsError as err:
        if asked:
            raise
        return None, f"no {name}: {err}"


@dataclass(frozen=True, eq=False)
class TouchdownView:
    """The picture of the touchdown zone at a run's end, which a process of its own draws as PNG."""

    run: Run
    endings: tuple[str, ...] = (".png",)

    @cached_property
    def png(self) -> bytes:
        """Bytes of the file; ResultsError where it can't be drawn, as on a machine without means to do so."""
        with tempfile.TemporaryDirectory() as place:
            return picture(self.run.place, Path(place) / "touchdown.png").read_bytes()

    def content(self, ending: str) -> bytes:
        """Bytes of the picture in its one format; ResultsError where it can't be drawn."""
        assert ending in self.endings
        return self.png


def trough(stage: StageRecords) -> Figure:
    """Settlement of the soil's surface across the riser, as the stage begins and ends, and the deepest in between, with
    the outline of the pipe where it is at the end.
    """
    settlement, offset = 1e3 * stage["settlement_across"], stage.run["offset"]
    arc = stage["section_arc"][-1]
    figure, panels = sheet(-(-len(arc) // 2), min(len(arc), 2), width=PAGE, height=2.8)
    for axes in panels[len(arc) :]:
        axes.remove()
    for n, axes in enumerate(panels[: len(arc)]):
        if stage.moves:
            axes.plot(offset, settlement[0, n], color="0.5", label="as the load step begins")
        axes.plot(offset, settlement[-1, n], color="C0", label="at its end")
        if stage.moves:
            deepest = settlement[:, n].max(axis=0)
            axes.plot(offset, deepest, color="C3", linestyle=":", label="deepest")
        _draw_pipe(axes, stage, n)
        axes.invert_yaxis()
        axes.set(title=f"section at arc {arc[n]:.4g} m", xlabel="distance to the left of the riser [m]")
        if n % 2 == 0:
            axes.set_ylabel("settlement of the soil's\nsurface [mm], + down")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


def _draw_pipe(axes: Axes, stage: StageRecords, section: int) -> None:
    """The pipe's underside at the stage's end, as far as it is beside the settled surface."""
    place, r = stage["section_position"][-1, section], pipe_radius(stage.run)
    level = seabed_under(stage.run, place[None])
    if level is None or not np.isfinite(place).all():
        return
    low, high = axes.get_ylim()
    x = r * np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 181))
    below = 1e3 * (level[0] - place[2] + np.sqrt(r**2 - x**2))
    axes.plot(x, below, color="k", linewidth=1.6, label="underside of the pipe at the end")
    room = 0.1 * abs(high - low)
    axes.set_ylim(min(low, high) - room, max(low, high, float(below.max())) + room)


def has_trough(stage: StageRecords) -> bool:
    """Whether sections are recorded, and lie on the soil."""
    there = "settlement_across" in stage.run.variables
    return there and bool(np.isfinite(stage["settlement_across"][-1]).any())
