"""Commands that write a scene, or another program's file of one: riser-soil new | import | export."""

import os
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from riser_soil.commands.exit_status import expected_errors
from riser_soil.commands.scenes import guessed, placed_in, refuse_existing
from riser_soil.core.environment import rank
from riser_soil.errors import MeshError, SceneError

if TYPE_CHECKING:
    from riser_soil.drafts.wishes import Wishes
    from riser_soil.imported_scene import ImportedScene


def import_(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="deck of MoorDyn v2 (.dat, .txt), or text data of OrcaFlex (.yml)")
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="SCENE", help="scene file; by default the file's name with .yaml, here"),
    ] = None,
    line: Annotated[
        str | None,
        typer.Option("--line", metavar="ID", help="line with those joined to it, by default the first; all: the deck"),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="overwrite a scene file, which is refused otherwise")] = False,
) -> None:
    """Write the scene of a line of a MoorDyn v2 deck or of OrcaFlex data, and tell line by line what it leaves out.

    The scene is checked, as by `check`: one that a run would refuse is not written.
    """
    with expected_errors():
        if rank() > 0:
            return
        scene = output or Path(f"{file.stem}.yaml")
        imported = _imported(file, line, scene.stem)
        for name in (scene.name, *imported.files):
            refuse_existing(scene.parent / name, force)
        lost = [f"{file.name}:{number}: not carried over: {text}" for number, text in imported.remarks]
        try:
            report = _write(imported, scene, [f"From {file.name}.", *lost], file.name)
        except (SceneError, MeshError) as err:
            refused = f"{file}: gives no scene that runs, and none is written; correct the file:"
            raise type(err)("\n".join([*lost, refused, str(err)])) from err
        written = f"{scene}: written; {len(lost)} entries of the file are not carried over; check says of it:"
        typer.echo("\n".join([*lost, written, report]))


def export(
    scene: Annotated[Path, typer.Argument(metavar="SCENE", help="scene file (.yaml)")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="DECK", help="deck; by default the scene's name with .dat, here"),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="overwrite a deck, which is refused otherwise")] = False,
) -> None:
    """Write the MoorDyn v2 deck of a scene's riser at rest, and tell line by line what it leaves out."""
    with expected_errors():
        from riser_soil.moordyn.deck_of import deck_of, left_out
        from riser_soil.results.whole_file import written_whole
        from riser_soil.scene.reader import checked, read_document

        if rank() > 0:
            return
        deck, document = output or Path(f"{scene.stem}.dat"), read_document(scene)
        refuse_existing(deck, force)
        model = checked(document, scene.parent)
        with placed_in(lambda: document):
            text = deck_of(model)
        lost = [f"{scene.name}:{line}: not in the deck: {what}" for line, what in left_out(document, model)]
        with written_whole(deck) as part:
            part.write_text(text, encoding="utf-8")
        typer.echo("\n".join([*lost, f"{deck}: written; {len(lost)} entries of the scene are not in it"]))


def _imported(file: Path, line: str | None, stem: str) -> "ImportedScene":
    if file.suffix.lower() in (".yml", ".yaml"):
        from riser_soil.orcaflex import data_file, scene_of

        return scene_of.scene_of(data_file.read_data(file), line, stem)
    from riser_soil.moordyn import deck
    from riser_soil.moordyn.scene_of import scene_of as scene_of_deck

    if line == "all":
        from riser_soil.moordyn.whole_deck import whole_scene_of

        return whole_scene_of(deck.read_deck(file))
    return scene_of_deck(deck.read_deck(file), line)


def _write(imported: "ImportedScene", scene: Path, head: list[str], source: str) -> str:
    """The scene and the files that it names, if it is one that runs; what `check` says of it, with the source's lines
    where messages name keys.
    """
    from riser_soil.checks.check import describe
    from riser_soil.results.whole_file import written_together
    from riser_soil.scene.dump import yaml_text
    from riser_soil.scene.reader import checked, with_place_in

    document = imported.document(source)
    with written_together(scene.parent, [scene.name, *imported.files]) as folder:
        for name, text in imported.files.items():
            (folder / name).write_text(text, encoding="utf-8")
        model = checked(document, folder)
        with placed_in(lambda: document):
            report = describe(model, place=partial(with_place_in, document))
        comments = "".join(f"# {each}\n" for each in head)
        (folder / scene.name).write_text(comments + yaml_text(imported.data), encoding="utf-8")
    return report


def new(
    kind: Annotated[
        str | None,
        typer.Argument(
            metavar="[KIND]",
            help="steel-catenary, flexible, lazy-wave, top-tensioned or mooring; without it a terminal is asked",
        ),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="SCENE", help="scene file; by default the kind's name with .yaml, here"),
    ] = None,
    depth: Annotated[float | None, typer.Option(metavar="METRES", help="of the water")] = None,
    diameter: Annotated[float | None, typer.Option(metavar="METRES", help="outer; of chain that of its bar")] = None,
    wall: Annotated[float | None, typer.Option(metavar="METRES", help="thickness of the pipe's wall")] = None,
    mass: Annotated[float | None, typer.Option(metavar="KG/M", help="per length, empty, in air")] = None,
    hs: Annotated[float | None, typer.Option(metavar="METRES", help="significant wave height; 0: no waves")] = None,
    tp: Annotated[float | None, typer.Option(metavar="SECONDS", help="peak period; by default 4.3 sqrt(hs)")] = None,
    current: Annotated[
        float, typer.Option(metavar="M/S", help="at the surface, along x; falls to 0 at the seabed")
    ] = 0.0,
    ground: Annotated[
        str | None, typer.Option(metavar="KIND", help="spring (the default), rigid or hysteretic")
    ] = None,
    angle: Annotated[
        float | None, typer.Option(metavar="DEGREES", help="at the top from the vertical, solved for as a hang_off")
    ] = None,
    su: Annotated[float | None, typer.Option(metavar="PA", help="strength of hysteretic clay at the seabed")] = None,
    gradient: Annotated[float | None, typer.Option(metavar="PA/M", help="its growth with depth")] = None,
    contents: Annotated[
        float | None, typer.Option(metavar="KG/M3", help="density of the contents, by default oil's, 800; 0: empty")
    ] = None,
    yield_stress: Annotated[
        float | None, typer.Option(metavar="PA", help="of a steel pipe; by default X65's, 448e6")
    ] = None,
    min_bend_radius: Annotated[float | None, typer.Option(metavar="METRES", help="smallest one allowed")] = None,
    max_tension: Annotated[float | None, typer.Option(metavar="NEWTON", help="largest one allowed")] = None,
    rao: Annotated[
        Path | None, typer.Option(metavar="FILE", help="RAOs of the vessel that moves the top (.csv, .nc)")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="overwrite a scene file, which is refused otherwise")] = False,
) -> None:
    """Write a first scene of a common line, with comments; check it; name the command that runs it."""
    with expected_errors():
        if rank() > 0:
            return
        from riser_soil.drafts.text import draft
        from riser_soil.drafts.wishes import Wishes
        from riser_soil.results.whole_file import written_whole

        wishes = Wishes(depth, diameter, wall, mass, hs, tp, current, ground, angle, su, gradient, contents)
        wishes = replace(wishes, yield_stress=yield_stress, min_bend_radius=min_bend_radius, max_tension=max_tension)
        if kind is None:
            kind, wishes = _asked(wishes)
        file = output or Path(f"{kind}.yaml")
        wishes = replace(wishes, rao=None if rao is None else _beside(rao, file.parent))
        text = draft(kind, wishes, f"riser-soil {' '.join(sys.argv[1:])}")
        refuse_existing(file, force)
        report = _report(text, file)
        with written_whole(file) as part:
            part.write_text(text, encoding="utf-8")
        typer.echo(f"{report}\n{file}: written; next: riser-soil run {file}")


def _report(text: str, file: Path) -> str:
    """What `check` says of a draft before it is written; SceneError where it is no scene."""
    from riser_soil.checks.check import describe
    from riser_soil.scene.document import parse
    from riser_soil.scene.reader import checked

    document = parse(text, f"draft of {file}")
    scene = checked(document, file.parent)
    with placed_in(lambda: document):
        return describe(guessed(scene))


def _beside(named: Path, folder: Path) -> str:
    """The name of a file as a scene in the folder has it."""
    if not named.is_file():
        raise SceneError(f"--rao {named}: there is no such file")
    return str(named) if named.is_absolute() else os.path.relpath(named, folder)


def _asked(given: "Wishes") -> "tuple[str, Wishes]":
    """Kind and wishes as a terminal answers; what was given as an option is not asked for."""
    from riser_soil.drafts.wishes import ask

    if not sys.stdin.isatty():
        from riser_soil.drafts.wishes import KINDS

        raise SceneError(f"new: the kind is missing; give one of {', '.join(KINDS)}")
    return ask(given, typer.prompt)
