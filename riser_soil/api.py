"""The package in Python: scenes from files or plain data, their runs, their results.

    from riser_soil import Scene, run, Run
"""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, redirect_stderr, redirect_stdout
from copy import deepcopy
from pathlib import Path
from typing import Any, Self

from riser_soil.accuracy.chosen_run import run_as_asked
from riser_soil.errors import MeshError, SceneError
from riser_soil.results.read import Run
from riser_soil.scene.document import Document, parse, read_text
from riser_soil.scene.overrides import put
from riser_soil.scene.problem import shown
from riser_soil.scene.reader import checked, with_place_in
from riser_soil.scene.scene import Scene as CheckedScene

__all__ = ["Run", "Scene", "run"]


class WrittenScene:
    """A scene as it was written, and checked: from a file, or from a dict with the keys of a scene file.

    `model` is the checked scene with its defaults, typed and read-only: `scene.model.riser.segments[0].length`. A wrong
    scene raises SceneError, whose message has one line per problem: place, value, what is allowed, what to do.
    """

    def __init__(self, document: Document, folder: Path) -> None:
        self._document, self._folder = document, folder
        self.model: CheckedScene = checked(document, folder)

    @classmethod
    def from_file(cls, file: str | Path) -> Self:
        """The scene in a YAML file; files that it names are sought beside it."""
        path = Path(file)
        return cls(parse(read_text(path), str(file)), path.parent)

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], folder: str | Path = ".") -> Self:
        """The scene in plain data, in which numpy's numbers and arrays may stand for numbers and lists.

        folder: where files that it names are sought.
        """
        return cls(Document("scene", _plain(data)), Path(folder))

    def changed(self, values: Mapping[str, Any]) -> Self:
        """This scene with other values, by their dotted paths as after --set: {"riser.segments.0.elements": 70}.

        List items are counted from 0.
        """
        document = deepcopy(self._document)
        for path, value in values.items():
            plain = _plain(value)
            put(document, path, plain, f"{path} = {shown(plain)}")
        return type(self)(document, self._folder)

    @property
    def name(self) -> str:
        """Name of the folder for results where no other is given: `output.directory`, else the file's name without its
        ending.
        """
        return self.model.output.directory or Path(self._document.name).stem

    @contextmanager
    def placing_errors(self) -> Iterator[None]:
        """Errors of the parts, which know the scene's keys, get the place of the key in the file before them."""
        try:
            yield
        except (SceneError, MeshError) as err:
            raise type(err)(with_place_in(self._document, str(err))) from err


Scene = WrittenScene


def run(
    scene: Scene | Mapping[str, Any] | str | Path,
    folder: str | Path | None = None,
    *,
    force: bool = False,
    quiet: bool = False,
    error_bars: bool = False,
    restart: bool = False,
) -> Run:
    """Compute a scene and leave its results in a folder; they come back as `Run`. Collective under MPI.

    scene: also a file's name, or a dict, see `Scene`. folder: by default the scene's name in the current folder.
    force: overwrite a run that is finished or can go on, which is refused otherwise. quiet: print nothing; warnings
    after the stages stand in `Run.summary`, too. error_bars: estimate by coarser comparison runs how far key results
    may be off. restart: go on from the folder's last checkpoint; begin where there is none.
    Raises SceneError or MeshError before anything is computed; SolveError, MemoryShortageError, WriteError or
    KeyboardInterrupt (Ctrl-C) later: the folder then keeps the results until there, marked unfinished.
    """
    scene = _scene(scene)
    folder = Path(scene.name if folder is None else folder)
    with scene.placing_errors(), ExitStack() as silence:
        if quiet:
            for redirect in (redirect_stdout, redirect_stderr):
                silence.enter_context(redirect(io.StringIO()))
        run_as_asked(scene.model, folder, force, error_bars, restart)
    return Run(folder)


def _scene(given: Scene | Mapping[str, Any] | str | Path) -> Scene:
    if isinstance(given, Scene):
        return given
    return Scene.from_dict(given) if isinstance(given, Mapping) else Scene.from_file(given)


def _plain(data: Any) -> Any:
    """A copy as a file would give it: dicts with words as keys, lists, numbers, words."""
    if isinstance(data, Mapping):
        return {str(key): _plain(value) for key, value in data.items()}
    if isinstance(data, (list, tuple)):
        return [_plain(value) for value in data]
    if hasattr(data, "tolist"):  # an array or number of numpy
        return data.tolist()
    return str(data) if isinstance(data, Path) else data
