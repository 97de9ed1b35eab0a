"""The pages in docs: their pieces of scenes fit into a scene, and what they point to is there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

from riser_soil.scene.reader import scene_from_mapping
from tests.on_ranks import ROOT

PAGES = sorted((ROOT / "docs").glob("*.md"))


def pieces(page: Path) -> Iterator[dict[str, Any]]:
    """The page's YAML blocks as data."""
    text = page.read_text(encoding="utf-8")
    yield from (YAML(typ="safe").load(block) for block in re.findall(r"^```yaml\n(.*?)^```$", text, re.M | re.S))


def joined(base: Any, piece: Any) -> Any:
    """A mapping with another laid over it, key by key."""
    if not isinstance(base, dict) or not isinstance(piece, dict):
        return piece
    return base | {key: joined(base.get(key), value) for key, value in piece.items()}


BASE = {
    "water": {"density": 1025.0},
    "line_types": {
        "pipe": {
            "outer_diameter": 0.3,
            "inner_diameter": 0.2,
            "mass": 120.0,
            "EA": 3e8,
            "EI": 5e4,
            "GJ": 4e4,
            "drag": {"normal": 1.1},
        }
    },
    "riser": {
        "segments": [{"line_type": "pipe", "length": 140.0, "elements": 70}],
        "start": {"position": [0.0, 0.0, 0.15]},
        "end": {"position": [80.0, 0.0, 100.0]},
    },
    "seabed": {"kind": "rigid"},
    "stages": [{"name": "move", "kind": "dynamic", "duration": 1.0, "time_step": 0.1}],
}


@pytest.mark.parametrize(("page", "n"), [(page, n) for page in PAGES for n, _ in enumerate(pieces(page))])
def test_pieces_of_scenes_are_valid(page: Path, n: int) -> None:
    scene_from_mapping(joined(BASE, list(pieces(page))[n]))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path) -> None:
    links = re.findall(r"\]\((?!http)([^)#]+)", page.read_text(encoding="utf-8"))
    assert [link for link in links if not (page.parent / link).exists()] == []
