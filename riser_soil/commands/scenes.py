"""A command's scene: read, its errors placed in the file, its result folder."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from riser_soil.commands.endings import rank
from riser_soil.errors import MeshError, SceneError

if TYPE_CHECKING:
    from riser_soil.scene.scene import Scene


def read(scene: str, overrides: list[str] | None) -> "Scene":
    """The scene of a file, or SceneError."""
    from riser_soil.scene.reader import read_scene

    try:
        return read_scene(scene, overrides or ())
    except OSError as err:
        raise SceneError(f"{scene}: cannot be read: {err.strerror}") from err


def guessed(scene: "Scene", file: str, overrides: list[str] | None) -> "Scene":
    """The scene with its hang-off as a cable would have it, where it asks for one."""
    if not scene.riser.hangs_off:
        return scene
    from riser_soil.assembly.hang_off import by_cable, hung_end, settled, told

    with placed(file, overrides):
        wanted = hung_end(scene)
        assert wanted is not None
        value = by_cable(wanted, wanted.asked.asked)
        found = settled(wanted, value)
    if rank() == 0:
        print(f"{told(wanted, value)} by the cable without bending stiffness; a run solves it on the riser itself")
    return found


def read_begun(scene: str, overrides: list[str] | None) -> "Scene":
    """As `read`; one that asks for an accuracy in the setting with which the search for it begins."""
    checked = read(scene, overrides)
    if checked.accuracy is None:
        return checked
    from riser_soil.accuracy.first_setting import first_setting

    if rank() == 0:
        print(f"accuracy {checked.accuracy:.2%}: a run chooses elements and steps; here are those that it begins with")
    with placed(scene, overrides):
        return first_setting(checked)


def read_solved(scene: str, overrides: list[str] | None) -> "Scene":
    """As `read_begun`, with the hang-off solved that the scene asks for."""
    checked = read_begun(scene, overrides)
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
    try:
        yield
    except (SceneError, MeshError) as err:
        from riser_soil.scene.reader import with_place

        raise type(err)(with_place(str(err), file, overrides or ())) from err
