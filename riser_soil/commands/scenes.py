"""What commands share: arguments and options, the scene with its errors placed in the file, its result folder."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from riser_soil.commands.exit_status import rank
from riser_soil.errors import MeshError, ResultsError, SceneError

if TYPE_CHECKING:
    from riser_soil.scene.document import Document
    from riser_soil.scene.scene import Scene

SceneFile = Annotated[str, typer.Argument(metavar="SCENE", help="scene file (.yaml)")]
Overrides = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="PATH=VALUE",
        help="override a value of the scene, e.g. riser.segments.0.elements=70; may be repeated; "
        "list items are counted from 0",
    ),
]

RunFolder = Annotated[Path, typer.Argument(metavar="RUN", help="folder of a run's results")]
StageName = Annotated[
    str | None, typer.Option("--stage", metavar="NAME", help="a dynamic stage; by default the last one")
]
Period = Annotated[
    float | None,
    typer.Option("--period", metavar="SECONDS", help="length of a cycle; by default that of the stage's motion"),
]


def read(scene: str, overrides: list[str] | None) -> "Scene":
    """The scene of a file, or SceneError."""
    from riser_soil.scene.reader import read_scene

    try:
        return read_scene(scene, overrides or ())
    except OSError as err:
        raise SceneError(f"{scene}: cannot be read: {err.strerror}") from err


def guessed(scene: "Scene") -> "Scene":
    """The scene with its hang-offs as a cable would have them, and its vessel at its offset, where it asks for them;
    SceneError begins with a key.
    """
    from riser_soil.scene.variants import at_offset, displacement

    placed = _with_hang_offs_by_cable(scene)
    if placed.vessel is not None and rank() == 0:
        print(displacement(placed).in_words)
    return at_offset(placed)


def _with_hang_offs_by_cable(scene: "Scene") -> "Scene":
    from riser_soil.scene.lines import risers

    if not any(line.hangs_off for line in risers(scene).values()):
        return scene
    from riser_soil.assembly.hang_off import first_value, hang_off_ends, in_words, settled

    ends = hang_off_ends(scene)
    values = [first_value(end) for end in ends]
    placed = settled(ends, values)
    for each in zip(ends, values, strict=True) if rank() == 0 else ():
        print(f"{in_words(*each)} by the cable without bending stiffness; a run solves it on the riser itself")
    return placed


def read_start(scene: str, overrides: list[str] | None) -> "Scene":
    """The scene in a file; where it asks for an accuracy, in the setting from which the search for it begins."""
    checked = read(scene, overrides)
    if checked.accuracy is None:
        return checked
    from riser_soil.accuracy.search import first_setting

    if rank() == 0:
        print(f"accuracy {checked.accuracy:.2%}: a run chooses elements and steps; here are those that it begins with")
    from riser_soil.scene.variants import at_offset

    with placed(scene, overrides):
        return first_setting(at_offset(checked))


def read_solved(scene: str, overrides: list[str] | None) -> "Scene":
    """Read a scene, solve its hang-off and displace the vessel by the offset that the scene asks for."""
    checked = read_start(scene, overrides)
    from riser_soil.accuracy.chosen_run import in_numbers

    with placed(scene, overrides):
        return in_numbers(checked)[0]


def result_folder(file: str, scene: "Scene", output: Path | None, force: bool, goes_on: bool) -> Path:
    """The folder for the results; a run in it that is finished, or can go on, is only overwritten by force."""
    from riser_soil.results.ownership import refuse
    from riser_soil.results.whole_file import refuse_file

    folder = output or Path(scene.output.directory or Path(file).stem)
    refuse_file(folder)
    if rank() == 0:
        refuse(folder, force, goes_on)
    return folder


@contextmanager
def placed(file: str, overrides: list[str] | None) -> Iterator[None]:
    """Parts that find a scene impossible know its keys; file and line are added here."""
    from riser_soil.scene.reader import overridden_document

    with placed_in(lambda: overridden_document(file, overrides or ())):
        yield


@contextmanager
def placed_in(document: "Callable[[], Document]") -> Iterator[None]:
    """Put lines of the scene's document before keys in errors; the document is asked for where there is one."""
    try:
        yield
    except (SceneError, MeshError) as err:
        from riser_soil.scene.reader import with_doubts, with_place_in

        value = document()
        raise with_doubts(type(err)(with_place_in(value, str(err))), value) from err
    except ValueError as err:
        from pydantic import ValidationError

        from riser_soil.scene.reader import impossible, with_doubts

        if not isinstance(err, ValidationError):
            raise
        raise with_doubts(impossible(err), document()) from err


def positive(name: str, value: float | None) -> None:
    """ResultsError where an option is given and not greater than 0."""
    if value is not None and not value > 0.0:
        raise ResultsError(f"--{name} {value:g}: must be greater than 0")


def at_least_one(name: str, value: int | None) -> None:
    """ResultsError where an option is given and less than 1."""
    if value is not None and value < 1:
        raise ResultsError(f"--{name} {value}: must be 1 or more")


def refuse_existing(file: Path, force: bool) -> None:
    """SceneError where a command would overwrite a file without being asked to."""
    if file.exists() and not force:
        raise SceneError(f"{file}: is there already; choose another with -o, or overwrite it with --force")
