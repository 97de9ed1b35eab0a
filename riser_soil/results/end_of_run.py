"""The state at the end of a finished run, as the beginning of another: `initial: {from: RUN}`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from riser_soil import __version__
from riser_soil.assembly import Assembly
from riser_soil.core.part import Model, State
from riser_soil.core.roles import owners
from riser_soil.core.saved_state import Saved, record_of, restore_all, within
from riser_soil.errors import SceneError
from riser_soil.results.checkpoint import mine_of
from riser_soil.results.checkpoint_file import About, read_checkpoint
from riser_soil.results.folder import CHECKPOINT, is_finished
from riser_soil.scene.identity import first_difference, identity_of

KEY = "initial.from"
MAY_DIFFER = (
    *((name,) for name in ("title", "stages", "solver", "output", "accuracy", "error_bars", "initial")),
    ("water", "current"),
    ("water", "waves"),
)


def take_up_end_of_run(assembly: Assembly) -> State:
    """Give an assembly the state that the run named by `initial` ended with; collective. SceneError where it can't."""
    initial = assembly.scene.initial
    assert initial is not None
    saved = mine_of(assembly.comm, lambda: _shares(initial.from_run, assembly))
    assert saved is not None
    before = record_of(State, within(saved, "stepper/before"))
    if before.u.size != assembly.size:
        raise SceneError(
            f"{KEY}: {initial.from_run}: it has {before.u.size} unknowns, and this scene {assembly.size}: write the "
            "same dimension (2 or 3) and solver.linear into both"
        )
    soil = [] if assembly.soil is None else assembly.soil.fields
    lasting = owners(Model(assembly.moving, assembly.lasting_parts, soil))
    restore_all({name: owner for name, owner in lasting.items() if within(saved, name)}, saved)
    return before


def refuse_unfit(assembly: Assembly) -> None:
    """SceneError where the run named by `initial` is no beginning of this one; collective, to be asked early."""
    initial = assembly.scene.initial
    if initial is not None:
        mine_of(assembly.comm, lambda: _shares(initial.from_run, assembly))


def _shares(folder: Path, assembly: Assembly) -> list[Saved]:
    if not is_finished(folder):
        raise SceneError(f"{KEY}: {folder}: holds no finished run; run it to its end first")
    path = folder / CHECKPOINT
    checkpoint = read_checkpoint(path) if path.exists() else None
    if checkpoint is None or checkpoint.about.ended != _last_stage(checkpoint.about)["name"]:
        remedy = "run it again with output: {checkpoint: {keep: true}}"
        raise SceneError(f"{KEY}: {folder}: its run has not kept the state at its end; {remedy}")
    _refuse(checkpoint.about, folder, assembly)
    return checkpoint.shares


def _last_stage(about: About) -> dict[str, Any]:
    last: dict[str, Any] = about.scene["values"]["stages"][-1]
    return last


def _refuse(about: About, folder: Path, assembly: Assembly) -> None:
    """SceneError for the end of a run that is no beginning of this one."""
    last = _last_stage(about)
    if about.version != __version__:
        raise SceneError(f"{KEY}: {folder}: is a run of riser_soil {about.version}, not {__version__}; run it again")
    if about.ranks != assembly.comm.size:
        raise SceneError(f"{KEY}: {folder}: was computed on {about.ranks} rank(s); take as many")
    if last["kind"] != "static":
        raise SceneError(f'{KEY}: {folder}: its last stage, "{last["name"]}", is dynamic; name a run that ends at rest')
    if difference := first_difference(about.scene, identity_of(assembly.scene), MAY_DIFFER):
        raise SceneError(f"{KEY}: {folder}: is a run of another scene: there {difference}; make both the same")
