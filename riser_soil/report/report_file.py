"""Report file: what a report is made from, and what its cover says."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, Field, ValidationError, model_validator

from riser_soil.core.quantities import FROZEN, Positive, Ratio, Text, wrong
from riser_soil.errors import SceneError
from riser_soil.results.read import Run
from riser_soil.scene.document import parse, read_text, refuse_others
from riser_soil.scene.explain import problems_in
from riser_soil.scene.files import NamedFile, NamedFolder
from riser_soil.scene.reader import error_of

_NEEDS = "the report file is empty; it needs runs or cases, folders of results"
KINDS = {"cases.csv": "cases", "fatigue.json": "fatigue", "modes.nc": "modes"}
"""Files by which the folders of results other than runs are known, with their keys of a report file."""
OPTIONAL = ("fatigue", "modes")  # chapters of which a report says that it has none
LOGOS = (".png", ".jpg", ".jpeg")


def _as_list(given: Any) -> Any:
    return (given,) if isinstance(given, str) else given


def _named_runs(given: Any) -> Any:
    """Runs as a list: each is called by the name of its folder; by its path where two have one name."""
    if isinstance(given, str):
        given = [given]
    if not isinstance(given, list | tuple) or not all(isinstance(folder, str) for folder in given):
        return given
    names = [Path(folder).resolve().name for folder in given]
    return dict(zip(names if len({*names}) == len(names) else given, given, strict=True))


Names = Annotated[tuple[Text, ...], BeforeValidator(_as_list)]
Files = Annotated[tuple[NamedFile, ...], BeforeValidator(_as_list)]
Folders = Annotated[tuple[NamedFolder, ...], BeforeValidator(_as_list)]


class ReportFile(BaseModel):
    """A report file. Relative names of files and folders are sought beside it."""

    model_config = FROZEN

    title: Text = Field(default="", description="title on the cover; by default that of the first run")
    subtitle: Text = Field(default="", description="second line of the cover")
    client: Text = Field(default="", description="for whom the report is written")
    document: Text = Field(default="", description="document number")
    revision: Text = Field(default="", description="revision, such as A or 01")
    date: Text = Field(default="", description="date on the cover; by default today")
    authors: Names = Field(default=(), description="who prepared it: a name, or a list of them")
    checked: Text = Field(default="", description="who checked it")
    approved: Text = Field(default="", description="who approved it")
    logo: NamedFile | None = Field(default=None, description="picture for the cover, .png or .jpg")
    runs: Annotated[dict[Text, Text], BeforeValidator(_named_runs)] = Field(
        default={}, description="folders of runs, {name: folder} or [folder, ...]; of one of several lines, RUN/LINE"
    )
    cases: Folders = Field(default=(), description="folders of riser-soil cases: one, or a list of them")
    fatigue: NamedFolder | None = Field(default=None, description="folder of riser-soil fatigue")
    statistics: Files = Field(default=(), description=".json files of riser-soil statistics: one, or a list of them")
    modes: NamedFolder | None = Field(default=None, description="folder of riser-soil modes")
    not_assessed: dict[Text, Text] = Field(
        default={}, description="why the report has no fatigue or modes, {fatigue: reason}"
    )
    stage: Text | None = Field(default=None, description="load step that is drawn; by default the last in time")
    reference: Text | None = Field(
        default=None, description="case that sensitivities count from; by default the one that has most in common"
    )
    required_life: Positive | None = Field(
        default=None, description="years that the pipe must last [-]; by default the fatigue file's design_life"
    )
    design_fatigue_factor: Ratio | None = Field(
        default=None, description="DFF, factor on the required life [-]; by default the fatigue file's"
    )

    @model_validator(mode="after")
    def _has_results(self) -> ReportFile:
        if not self.runs and not self.cases:
            raise wrong("runs", "neither runs nor cases are given", "name a folder of results")
        if self.logo is not None and self.logo.suffix.lower() not in LOGOS:
            raise wrong("logo", f"must be one of {', '.join(LOGOS)}", "convert the picture")
        for name in self.not_assessed:
            if name not in OPTIONAL:
                raise wrong("not_assessed", f"has {name}, but can have {' and '.join(OPTIONAL)}", "correct the key")
            if getattr(self, name) is not None:
                raise wrong("not_assessed", f"has {name}, but results are given as {name}", "remove one of the two")
        return self


def read_report_file(file: Path, options: Mapping[str, Any] | None = None) -> ReportFile:
    """The report file; SceneError has one line per problem found. options: of the command line, in place of its keys;
    names of files in them count from where the command is called.
    """
    document = refuse_others(parse(read_text(file), str(file), _NEEDS), "report file")
    if isinstance(document.data, dict):
        document.data |= {key: _from_here(key, value) for key, value in (options or {}).items()}
    try:
        given = ReportFile.model_validate(document.data, context={"folder": file.parent})
    except ValidationError as err:
        raise error_of(problems_in(err, document.data, ReportFile), document) from err
    runs = {name: str(file.parent / folder) for name, folder in given.runs.items()}
    for name, folder in runs.items():
        if not Run.is_there(Path(folder)):
            place = document.where(("runs",))[1]
            raise SceneError(f"{place}: runs.{name}: {folder} is not the folder of a run; correct it, or run it first")
    return given.model_copy(update={"runs": runs})


def _from_here(key: str, value: Any) -> Any:
    """A file's name on the command line as an absolute one."""
    if key == "logo":
        return str(Path(value).absolute())
    return [str(Path(each).absolute()) for each in value] if key == "statistics" else value


def of_folders(folders: Sequence[Path], given: Mapping[str, Any]) -> ReportFile:
    """What the command line names: folders of any results, known by their files, and options by the keys of a file."""
    named: dict[str, list[str]] = {}
    for folder in folders:
        kind = next((kind for file, kind in KINDS.items() if (folder / file).is_file()), "runs")
        named.setdefault(kind, []).append(str(folder))
    single = {kind: named.pop(kind) for kind in ("fatigue", "modes") if kind in named}
    for kind, kind_folders in single.items():
        if len(kind_folders) > 1 or given.get(kind):
            raise SceneError(f"{kind_folders[-1]}: is a second folder of riser-soil {kind}; a report takes one")
    data: dict[str, Any] = {**named, **{kind: kind_folders[0] for kind, kind_folders in single.items()}, **given}
    try:
        return ReportFile.model_validate(data)
    except ValidationError as err:
        first = err.errors()[0]
        path = ".".join(str(key) for key in first["loc"])
        raise SceneError(f"report: {path or 'command line'}: {first['msg']}") from err
