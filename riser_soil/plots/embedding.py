"""Pictures as data URIs, so that a page needs no other file."""

from __future__ import annotations

import base64
import tempfile
from collections.abc import Callable
from pathlib import Path

from matplotlib.figure import Figure

from riser_soil.plots.curves import save

_TYPES = {".svg": "image/svg+xml", ".png": "image/png"}


def embedded(figure: Figure) -> str:
    """A sheet of curves as SVG, whose letters are drawn: no font is needed where it is looked at."""
    return _drawn(".svg", lambda file: save(figure, file))


def embedded_png(draw: Callable[[Path], object]) -> str:
    """What `draw` writes to a PNG file."""
    return _drawn(".png", draw)


def _drawn(ending: str, draw: Callable[[Path], object]) -> str:
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / f"picture{ending}"
        draw(file)
        return f"data:{_TYPES[ending]};base64,{base64.b64encode(file.read_bytes()).decode()}"
