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
PRIMED = re.compile(r"<msup>(<mi[^>]*>[^<]*</mi>)<m[io]>(&#x0(?:2032|2033|2034|2057);)</m[io]></msup>")


def on_page_content(html: str, **_: Any) -> str:
    """The page with its equations as MathML."""
    for display, marked in MARKED.items():
        html = marked.sub(partial(_mathml, display), html)
    return html


def _mathml(display: str, match: re.Match[str]) -> str:
    return PRIMED.sub(_beside, str(convert(unescape(match[1]).strip(), display=display)))


def _beside(match: re.Match[str]) -> str:
    """Primes as large as the font has them: they are raised already, and as an exponent they would be specks."""
    return f'<mrow>{match[1]}<mo lspace="0em" rspace="0em">{match[2]}</mo></mrow>'
