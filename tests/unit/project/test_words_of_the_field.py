"""What a user or a client reads is in words of the field: texts of the package have none of this project's own."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from tests.support.on_ranks import ROOT

IDIOMS = re.compile(
    r"\b(told|foretold|looks?|looked|left out|stands?|stood|taken|figures|turned over|put in)\b", re.IGNORECASE
)
LITERALLY = re.compile(r"stands upright")  # of a riser


def idioms(code: str) -> Iterator[str]:
    """Texts of several words with an idiom, docstrings apart: their lines and what they say."""
    tree = ast.parse(code)
    documentation = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in documentation:
            words = LITERALLY.sub("", node.value).strip()
            if " " in words and IDIOMS.search(words):
                yield f"{node.lineno}: {node.value}"


def test_texts_of_the_package_have_words_of_the_field() -> None:
    files = sorted((ROOT / "riser_soil").rglob("*.py"))
    lines = [f"{file.relative_to(ROOT)}:{text}" for file in files for text in idioms(file.read_text(encoding="utf-8"))]
    assert lines == []


def test_idioms_are_found_in_texts_and_not_in_docstrings() -> None:
    code = (
        'def f(n):\n    """What is told."""\n    print(f"{n} m (told above 2 m)")\n    return "stands upright here"\n'
    )
    assert [*idioms(code)] == ["3:  m (told above 2 m)"]


def templates() -> list[Path]:
    return sorted((ROOT / "riser_soil/report/template").iterdir())


def test_templates_of_reports_have_words_of_the_field() -> None:
    assert templates()
    assert [file.name for file in templates() if IDIOMS.search(file.read_text(encoding="utf-8"))] == []
