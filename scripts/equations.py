"""Hook of mkdocs (mkdocs.yml): equations, marked by arithmatex, become MathML, which browsers show without a script."""

from __future__ import annotations

import re
from functools import partial
from html import unescape
from typing import Any

from latex2mathml.converter import convert

MARKED = {
    "block": re.compile(r'<div class="arithmatex">\\\[(.*?)\\\]</div>', re.DOTALL),
    "inline": re.compile(r'<span class="arithmatex">\\\((.*?)\\\)</span>', re.DOTALL),
}


def on_page_content(html: str, **_: Any) -> str:
    """The page with its equations as MathML."""
    for display, marked in MARKED.items():
        html = marked.sub(partial(_mathml, display), html)
    return html


def _mathml(display: str, found: re.Match[str]) -> str:
    return str(convert(unescape(found[1]).strip(), display=display))
