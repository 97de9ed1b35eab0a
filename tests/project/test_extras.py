"""Packages that a riser alone does without: each is required, or has an extra that brings it."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from collections.abc import Iterator

from riser_soil.commands.exit_status import ELSEWHERE, EXTRAS
from tests.support.on_ranks import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
COMING_WITH = {"llvmlite": "numba", "pydantic_core": "pydantic", "dask": "distributed", "PIL": "matplotlib"}
COMING_WITH |= {"docx": "python-docx", "markupsafe": "jinja2"}


def imported() -> Iterator[str]:
    """Packages of others that a module of the project imports, anywhere."""
    for path in (ROOT / "riser_soil").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                yield from (each.name.partition(".")[0] for each in node.names)
            elif isinstance(node, ast.ImportFrom):
                yield (node.module or "").partition(".")[0]


def names(requirements: list[str]) -> set[str]:
    return {re.split(r"[^\w.-]", each)[0].partition(".")[0] for each in requirements}


def test_every_package_is_required_or_has_an_extra_that_brings_it() -> None:
    required = names(PROJECT["dependencies"])
    extras = {name: names(wanted) for name, wanted in PROJECT["optional-dependencies"].items()}
    for package in sorted(set(imported()) - sys.stdlib_module_names - {"riser_soil", *ELSEWHERE}):
        bringing = COMING_WITH.get(package, package)
        having = [extras[name] for name in EXTRAS[package]] if package in EXTRAS else [required]
        assert all(bringing in each for each in having), package
