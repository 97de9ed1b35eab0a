"""Captions of pictures, in the words of their axes."""

from __future__ import annotations

from riser_soil.plots.album import Picture
from riser_soil.plots.curves import ALONG_ARC
from riser_soil.plots.side_by_side import Sheet


def in_caption(each: Picture | Sheet) -> str:
    """What a sheet shows, as a caption begins: a quantity along the line in the words of its axis."""
    name = each.name.removeprefix("range_")
    if name in ALONG_ARC:
        words = f"{ALONG_ARC[name][0].partition(' [')[0].removesuffix(', magnitude')} along the line"
    else:
        words = each.caption.partition(":")[0]
    return f"{words[0].upper()}{words[1:]}"
