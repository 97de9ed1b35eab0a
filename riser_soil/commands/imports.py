"""Command that makes scenes of other programs' files: riser-soil import."""

from pathlib import Path
from typing import Annotated

import typer

from riser_soil.commands.endings import expected_errors, rank
from riser_soil.errors import SceneError


def import_(
    deck: Annotated[Path, typer.Argument(metavar="DECK", help="deck of MoorDyn v2 (.dat, .txt)")],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="SCENE", help="scene file; by default the deck's name with .yaml, here"),
    ] = None,
    line: Annotated[
        str | None,
        typer.Option("--line", metavar="ID", help="line of the deck, with those joined to it; by default the first"),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="overwrite a scene file, which is refused otherwise")] = False,
) -> None:
    """Write the scene of a MoorDyn v2 deck's line, and tell what of the deck it does not have, line by line."""
    with expected_errors():
        from riser_soil.moordyn.deck import read_deck
        from riser_soil.moordyn.scene_of import scene_of
        from riser_soil.results.whole_file import written_whole
        from riser_soil.scene.dump import yaml_text
        from riser_soil.scene.reader import scene_from_mapping

        if rank() > 0:
            return
        file = output or Path(f"{deck.stem}.yaml")
        if file.exists() and not force:
            raise SceneError(f"{file}: is there already; choose another with -o, or overwrite it with --force")
        found = scene_of(read_deck(deck), line)
        try:
            scene_from_mapping(found.data)
        except SceneError as err:
            raise SceneError(f"{deck}: gives no scene: {err}") from err
        lost = [f"{deck.name}:{number}: not carried over: {text}" for number, text in found.remarks]
        with written_whole(file) as part:
            head = [f"From {deck.name}.", *lost]
            part.write_text("".join(f"# {each}\n" for each in head) + yaml_text(found.data), encoding="utf-8")
        typer.echo("\n".join([*lost, f"{file}: written; {len(lost)} entries of the deck are not carried over"]))
