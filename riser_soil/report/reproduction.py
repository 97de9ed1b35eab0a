"""Chapter on how to reproduce the results, and the appendix with the scene: without what is absent, without paths."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from riser_soil.errors import RiserSoilError
from riser_soil.report import health
from riser_soil.report.document import Block, Code, Paragraph, ReportSection, TableBlock
from riser_soil.report.parameters import reference_of
from riser_soil.report.sources import LoadCase, Sources
from riser_soil.report.tables import BREAK, ReportTable, given_value
from riser_soil.scene.dump import yaml_text
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene

_MOST_ROWS, _COLUMNS = 120, 6


def chapter(sources: Sources) -> ReportSection:
    return ReportSection("How to reproduce the results", [*_blocks(sources)])


def appendix(sources: Sources) -> ReportSection:
    """The scene of the reference case, and in what the others differ from it."""
    return ReportSection("Input file", [*_scene(sources)], appendix=True)


def _blocks(sources: Sources) -> Iterator[Block]:
    first = reference_of(sources)
    yield Paragraph(
        f"The input file in the appendix holds all input of the load case {first.name}; the files that it names lie "
        "beside it. The same version of the program gives the same run:"
    )
    yield Code("riser-soil run scene.yaml -o again")
    if len(sources.cases) > 1:
        yield Paragraph("The other load cases differ from it in the values of the appendix's table.")
    yield TableBlock("Versions of the software", health.versions_table(first.run.summary), words=2)


def _scene(sources: Sources) -> Iterator[Block]:
    first = reference_of(sources)
    if not first.data:
        yield Paragraph("The input file cannot be read.", "warning")
        return
    yield Code(scene_text(first))
    yield from _differences(sources.cases, first)


def _differences(cases: Sequence[LoadCase], first: LoadCase) -> Iterator[TableBlock]:
    """The values in which cases differ, a row a case and a column a value, so many columns a table as a page has."""
    paths = [
        path
        for path in dict.fromkeys(path for case in cases for path in case.given)
        if len({given_value(case.value(path)) for case in (first, *cases)}) > 1
    ]
    more = "" if len(cases) <= _MOST_ROWS else "More are in the tables of the cases' folder."
    for shown in (paths[n : n + _COLUMNS] for n in range(0, len(paths), _COLUMNS)):
        rows = [[case.name, *(given_value(case.value(path)) for path in shown)] for case in cases[:_MOST_ROWS]]
        head = ("load case", *(path.replace(".", f".{BREAK}") for path in shown))
        yield TableBlock("Values in which the load cases differ", ReportTable(head, rows, more), key="differences")


def scene_text(case: LoadCase) -> str:
    """The case's scene as YAML without keys that are absent, and with the names alone of files; without defaults, where
    what is left reads back as the same scene.
    """
    scene, plain = case.scene, case.data
    if scene is not None:
        brief = scene.model_dump(mode="json", by_alias=True, exclude_defaults=True)
        if _reads_back(brief, scene):
            plain = brief
    return yaml_text(pruned(plain))


def _reads_back(data: dict[str, Any], scene: Scene) -> bool:
    try:
        return scene_from_mapping(without_nothing(data)) == scene
    except RiserSoilError:
        return False


def without_nothing(value: Any) -> Any:
    """Plain data without nulls and empty lists or mappings in mappings."""
    if isinstance(value, dict):
        kept = {key: without_nothing(inner) for key, inner in value.items()}
        return {key: inner for key, inner in kept.items() if inner is not None and inner != {} and inner != []}
    return [without_nothing(item) for item in value] if isinstance(value, list) else value


def pruned(value: Any) -> Any:
    """Plain data without nulls and empty parts, and of absolute paths the last name alone."""
    return _named(without_nothing(value))


def _named(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _named(inner) for key, inner in value.items()}
    if isinstance(value, list):
        return [_named(item) for item in value]
    return Path(value).name if isinstance(value, str) and value.startswith("/") else value


