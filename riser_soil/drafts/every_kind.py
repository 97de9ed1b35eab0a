"""Scenes of every kind of draft."""

from __future__ import annotations

import tempfile
from pathlib import Path

from riser_soil.drafts.text import draft
from riser_soil.drafts.wishes import KINDS, Wishes
from riser_soil.scene.reader import read_scene
from riser_soil.scene.scene import Scene


def drafted() -> dict[str, Scene]:
    """A scene of each kind that `new` has, as it comes out without wishes."""
    with tempfile.TemporaryDirectory(prefix="riser_soil-") as folder:
        drafts = {}
        for kind in KINDS:
            file = Path(folder, f"{kind}.yaml")
            file.write_text(draft(kind, Wishes(), kind), encoding="utf-8")
            drafts[kind] = read_scene(file)
        return drafts
