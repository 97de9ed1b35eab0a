"""Tests stand alone: tests/support, which has an index, is what they share; the numbers they judge by are their own."""

from __future__ import annotations

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[2]


def imports(path: Path) -> list[ast.ImportFrom]:
    return [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom)]


@pytest.mark.parametrize("path", sorted(TESTS.rglob("*.py")), ids=lambda path: str(path.relative_to(TESTS)))
def test_no_test_module_imports_from_another(path: Path) -> None:
    assert not [node.module for node in imports(path) if ".test_" in (node.module or "")]


@pytest.mark.parametrize("path", sorted((TESTS / "unit").rglob("*.py")), ids=lambda path: path.name)
def test_no_number_is_imported_from_what_is_judged_by_it(path: Path) -> None:
    """A test would follow it, whatever it changes to."""
    named = [
        (node.module, alias.name)
        for node in imports(path)
        for alias in node.names
        if (node.module or "").startswith("riser_soil") and alias.name.isupper()
    ]
    assert not [name for module, name in named if isinstance(getattr(import_module(str(module)), name), float)]


def test_the_index_of_what_tests_share_has_each_module_once() -> None:
    support = TESTS / "support"
    named = re.findall(r"`(\w+)`", (support / "README.md").read_text(encoding="utf-8"))
    assert sorted(named) == sorted(path.stem for path in support.glob("*.py"))


def test_files_that_take_long_are_there() -> None:
    """Workers begin with them: one that has another name now would be among the last."""
    names = (TESTS / "long_files.txt").read_text(encoding="utf-8").splitlines()
    assert len(set(names)) == len(names)
    assert [name for name in names if not (TESTS / name).is_file()] == []
