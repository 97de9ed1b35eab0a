"""The report of one run or several: one HTML page that needs no other file, no network and no script."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from riser_soil import __version__
from riser_soil.accuracy.key_results import key_results
from riser_soil.errors import ResultsError
from riser_soil.plots import picture
from riser_soil.plots.album import GROUPS, Picture, embedded, embedded_png, pictures
from riser_soil.plots.progress import Tell, silent
from riser_soil.plots.side_by_side import sheets
from riser_soil.report import health, scene_words
from riser_soil.report.extremes import READ_IN, ends_table, extremes_table, hung_table, key_results_table
from riser_soil.report.tables import NOTHING, ReportTable, number
from riser_soil.results import Run
from riser_soil.results import folder as run_folder
from riser_soil.results.stage_records import StageRecords, all_stages, stage_records
from riser_soil.results.whole_file import written_whole

_MISSING = object()


@dataclass(frozen=True)
class Image:
    """A picture of the page: its data URI and what it shows."""

    uri: str
    caption: str


@dataclass(frozen=True)
class StagePart:
    """What the page tells of a stage; pictures by their groups, of stages that are drawn."""

    name: str
    kind: str
    extremes: ReportTable
    ends: ReportTable
    soil: ReportTable
    energy: ReportTable
    indicators: ReportTable
    pictures: Mapping[str, Sequence[Image]]


@dataclass(frozen=True)
class RunPart:
    """What the page tells of a run; the rest of it follows from its summary."""

    label: str
    anchor: str
    folder: str
    summary: Mapping[str, Any]
    warnings: Sequence[str]
    prose: Sequence[str]
    scene_tables: Sequence[tuple[str, ReportTable]]
    shape: Sequence[Image]
    touchdown: Image | None
    no_touchdown: str
    stages: Sequence[StagePart]
    key_results: ReportTable
    solver: ReportTable
    seconds: ReportTable
    versions: ReportTable
    built: str
    left_out: Sequence[str]
    scene_text: str


def write_report(folders: Sequence[Path], file: Path, stage: str | None = None, tell: Tell = silent) -> Path:
    """Writes the page. stage: the one that is drawn; by default all along t, else the last. tell: hears of each
    picture.

    Raises ResultsError where a folder holds no run, or nothing was recorded; the file is then left as it was.
    """
    given = [*zip(_labels(folders), map(Run, folders), strict=True)]
    hung = {label: hung_table(run.summary) for label, run in given}
    runs = {" ".join([label, name]).strip(): line for label, run in given for name, line in run.of_lines.items()}
    with written_whole(file) as part:
        part.write_text(_page(runs, hung, stage, tell), encoding="utf-8")
    return file


def _page(runs: Mapping[str, Run], hung: Mapping[str, ReportTable], stage: str | None, tell: Tell) -> str:
    """hung: of bodies, joints and clearances, by the labels of whole runs."""
    parts = [_run_part(label, f"run{n}", run, stage, tell) for n, (label, run) in enumerate(runs.items())]
    page: str = _template().render(
        title=" | ".join(dict.fromkeys(part.summary["title"] for part in parts)),
        runs=parts,
        hung={label: content for label, content in hung.items() if content},
        compared=_comparison(runs, stage) if len(runs) > 1 else None,
        made=f"riser-soil {__version__}, {date.today().isoformat()}",
    )
    return page


def _template() -> Any:
    loader = PackageLoader("riser_soil.report", "template")
    environment = Environment(
        loader=loader, autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template("report.html")


def _labels(folders: Sequence[Path]) -> list[str]:
    """Names of the folders, or their paths where two have one name."""
    names = [folder.resolve().name for folder in folders]
    return names if len({*names}) == len(names) else [str(folder) for folder in folders]


def _run_part(label: str, anchor: str, run: Run, stage: str | None, tell: Tell) -> RunPart:
    shapes, drawn = _shapes(run), {n: pictures(each) for n, each in _drawn_stages(run, stage).items()}
    summary, scene = run.summary, scene_words.read(run)
    touchdown, why = None, ""
    whole = sum(map(len, drawn.values())) + len(shapes) + 1
    images = _Images(label, whole, tell)
    shape = [images.drawn(each) for each in shapes]
    images.begin("touchdown")
    try:
        uri = embedded_png(lambda png: picture(run.place, png))
        touchdown = Image(uri, f"the touchdown zone and the whole riser at {run.time[-1]:.5g} s")
    except ResultsError as err:
        why = str(err)
    built, left_out = health.parts_words(summary)
    return RunPart(
        label=label,
        anchor=anchor,
        folder=str(run.place),
        summary=summary,
        warnings=health.warnings_of(summary),
        prose=scene_words.prose(scene, run) if scene is not None else ["The scene's file can't be read."],
        scene_tables=[*_scene_tables(scene)] if scene is not None else [],
        shape=shape,
        touchdown=touchdown,
        no_touchdown=why,
        stages=[
            _stage_part(summary, reported, drawn.get(n, ()), images) for n, reported in enumerate(summary["stages"])
        ],
        key_results=key_results_table(summary),
        solver=health.solver_table(summary),
        seconds=health.seconds_table(summary),
        versions=health.versions_table(summary),
        built=built,
        left_out=left_out,
        scene_text=_scene_text(run),
    )


def _scene_text(run: Run) -> str:
    try:
        return (run.folder / run_folder.SCENE).read_text(encoding="utf-8")
    except OSError as err:
        return f"# {run_folder.SCENE} can't be read: {err.strerror}"


def _scene_tables(scene: Any) -> Iterator[tuple[str, ReportTable]]:
    yield "The riser from its start to its end", scene_words.segments_table(scene)
    yield "Line types", scene_words.pipes_table(scene)
    yield "Contents, ends, water, ground, contact, solver", scene_words.parts_table(scene)
    yield "Stages", scene_words.stages_table(scene)


class _Images:
    """The pictures of a run's part of the page, each reported before it is drawn."""

    def __init__(self, label: str, count: int, tell: Tell) -> None:
        self._label, self._count, self._tell = label, count, tell
        self._begun = 0

    def begin(self, name: str) -> None:
        """Report that a picture is drawn."""
        self._tell(f"{self._label}: {name}", self._begun, self._count)
        self._begun += 1

    def drawn(self, each: Picture) -> Image:
        self.begin(each.name)
        return Image(embedded(each.draw()), each.caption)


def _shapes(run: Run) -> list[Picture]:
    """The shape at the end of the first stage: where the riser lies before it is moved."""
    first = all_stages(run)[:1]
    return [each for stage in first if not stage.timed for each in pictures(stage) if each.group == "shape"]


def _drawn_stages(run: Run, stage: str | None) -> dict[int, StageRecords]:
    """The stages that are drawn, by their numbers."""
    chosen = stage_records(run, stage)
    timed = [each for each in all_stages(run) if each.timed] if stage is None else []
    return {each.number: each for each in (timed or [chosen])}


def _stage_part(
    summary: Mapping[str, Any], reported: Mapping[str, Any], drawn: Sequence[Picture], images: _Images
) -> StagePart:
    groups: dict[str, list[Image]] = {group: [] for group in GROUPS}
    for each in drawn:
        groups[each.group].append(images.drawn(each))
    return StagePart(
        name=reported["name"],
        kind=reported["kind"],
        extremes=extremes_table(summary, reported),
        ends=ends_table(reported),
        soil=health.soil_table(reported),
        energy=health.energy_table(reported),
        indicators=health.indicators_table(reported),
        pictures=groups,
    )


@dataclass(frozen=True)
class Comparison:
    """Several runs side by side."""

    differences: ReportTable
    key_results: ReportTable
    pictures: Sequence[Image]


def _comparison(runs: Mapping[str, Run], stage: str | None) -> Comparison:
    return Comparison(
        differences_table(runs),
        compared_key_results_table(runs),
        [Image(embedded(each.figure), each.caption) for each in sheets(runs, stage)],
    )


def differences_table(runs: Mapping[str, Run]) -> ReportTable:
    """Keys of the scenes that are not the same in all runs; runs by their labels."""
    flat = {label: dict(_flattened(run.scene, "")) for label, run in runs.items()}
    keys = dict.fromkeys(key for each in flat.values() for key in each)
    rows = []
    for key in keys:
        values = [each.get(key, _MISSING) for each in flat.values()]
        if any(value != values[0] for value in values):
            rows.append([key, *(NOTHING if value is _MISSING else str(value) for value in values)])
    return ReportTable(("key", *runs), rows)


def compared_key_results_table(runs: Mapping[str, Run]) -> ReportTable:
    """Key results, and by how much they differ from the first run's: relative to their scale."""
    known = [key_results(run.summary) for run in runs.values()]
    first, *others = known
    rows = []
    for key in dict.fromkeys(key for each in known for key in each):
        one = next(each[key] for each in known if key in each)
        unit, scale = READ_IN.get(one.unit, (one.unit, 1.0))
        values = [number(each[key].value * scale) if key in each else NOTHING for each in known]
        row = [key, unit, values[0]]
        for value, each in zip(values[1:], others, strict=True):
            row += [value, _difference(first, each, key)]
        rows.append(row)
    labels = [*runs]
    heads = [head for label in labels[1:] for head in (label, f"differs from {labels[0]} by [%]")]
    note = (
        "Of static stages at their end, of others the extremes. A difference is relative to the first run's "
        "size; of forces to a tenth of the stage's largest at least, of touchdown arcs to the distance of the ends."
    )
    return ReportTable(("quantity", "unit", labels[0], *heads), rows, note)


def _difference(first: Mapping[str, Any], other: Mapping[str, Any], key: str) -> str:
    if key not in first or key not in other:
        return NOTHING
    share = first[key].relative(other[key].value - first[key].value)
    signed = share if other[key].value >= first[key].value else -share
    return f"{100.0 * signed:+.3g}"


def _flattened(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for key, inner in value.items():
            yield from _flattened(inner, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list) and any(isinstance(item, dict) for item in value):
        for n, inner in enumerate(value):
            yield from _flattened(inner, f"{path}.{n}")
    else:
        yield path, value
