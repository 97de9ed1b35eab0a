"""Names in the package: no class name stands twice, and the first line of each module is a sentence of its own."""

import ast
from collections import Counter
from pathlib import Path

import pytest

import riser_soil

PACKAGE = Path(riser_soil.__file__).parent
MODULES = sorted(PACKAGE.rglob("*.py"))


def test_no_class_name_stands_twice() -> None:
    trees = (ast.parse(path.read_text()) for path in MODULES)
    names = Counter(node.name for tree in trees for node in ast.walk(tree) if isinstance(node, ast.ClassDef))
    assert [name for name, count in names.items() if count > 1] == []


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_first_line_of_a_module_is_a_sentence(path: Path) -> None:
    first, *rest = (ast.get_docstring(ast.parse(path.read_text())) or "").split("\n")
    assert first.endswith(".")
    assert not rest or rest[0] == ""
