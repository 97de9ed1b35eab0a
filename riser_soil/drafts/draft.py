"""Draft of a scene: from wishes to its text."""

from __future__ import annotations

from pathlib import Path

from riser_soil.drafts.kinds import kind_of
from riser_soil.drafts.layout import layout_of
from riser_soil.drafts.text import text
from riser_soil.drafts.wishes import GROUNDS, Wishes, pipe_of, refuse, sea_of
from riser_soil.scene.document import parse
from riser_soil.scene.reader import checked


def checked_draft(name: str, wishes: Wishes, call: str) -> str:
    """The scene file of a kind; SceneError where a wish can't be met, or the scene breaks a rule of its language.

    call: the command, for the file's first line.
    """
    written = _draft(name, wishes, call)
    checked(parse(written, "draft"), Path())
    return written


def _draft(name: str, wishes: Wishes, call: str) -> str:
    kind = kind_of(name)
    refuse(wishes, kind)
    sea = sea_of(kind, wishes)
    layout = layout_of(kind, pipe_of(kind, wishes), sea.depth)
    return text(kind.title, call, layout, sea, (wishes.ground or GROUNDS[0]) if kind.hangs else None)
