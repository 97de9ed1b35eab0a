"""What comes from PyPI: each package at one version for a Python, with hashes, and whatever these need."""

from __future__ import annotations

import re
import sys
import tomllib
from importlib.metadata import requires, version

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from ruamel.yaml import YAML

import riser_soil
from tests.support.on_ranks import ROOT

DEBIAN = {"numpy", "scipy", "h5py", "cffi"}  # as its PETSc and dolfinx were compiled with them
APART = {"dev", "all"}  # extras that set-up doesn't bring as such
pythons = pytest.mark.parametrize("python", ["3.11", "3.13", "3.14"])


def as_list(name: str) -> set[str]:
    """Names in requirements/NAME.txt."""
    lines = (ROOT / f"requirements/{name}.txt").read_text(encoding="utf-8").splitlines()
    return {canonicalize_name(Requirement(line).name) for line in lines if not line.startswith("#")}


def pins(name: str, python: str) -> dict[str, tuple[str, int]]:
    """Version and number of hashes of each package pinned for a Python."""
    text = (ROOT / f"requirements/{name}-pins.txt").read_text(encoding="utf-8").replace("\\\n", " ")
    versions: dict[str, tuple[str, int]] = {}
    for line in (line for line in text.splitlines() if not line.startswith("#")):
        pin, *hashes = line.split(" --hash=sha256:")
        asked = Requirement(pin)
        if holds(asked, for_python(python)):
            assert asked.name not in versions, f"{asked.name} is pinned twice for Python {python}"
            assert str(asked.specifier).startswith("==")
            count = len([h for h in hashes if re.fullmatch("[0-9a-f]{64} *", h)])
            versions[asked.name] = str(asked.specifier)[2:], count
    return versions


def for_python(python: str) -> dict[str, str]:
    return {"python_version": python, "python_full_version": f"{python}.0"}


def holds(asked: Requirement, environment: dict[str, str]) -> bool:
    return asked.marker is None or asked.marker.evaluate(environment)


@pythons
def test_what_is_listed_is_pinned_with_hashes(python: str) -> None:
    run, dev = pins("run", python), pins("dev", python)
    assert set(run) >= as_list("run")
    assert set(dev) >= as_list("dev")
    assert all(hashes > 0 for _, hashes in (run | dev).values())


@pythons
def test_runs_need_no_test_tools_and_bring_no_numpy(python: str) -> None:
    run, dev = set(pins("run", python)), set(pins("dev", python))
    assert not run & dev
    assert not (run | dev) & DEBIAN
    assert not run & as_list("dev")


@pythons
def test_pins_are_what_the_project_asks_for(python: str) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    for_users = [text for extra, texts in extras.items() if extra not in APART for text in texts]
    asked = {"run": [*project["dependencies"], *for_users], "dev": extras["dev"]}
    for name, texts in asked.items():
        versions, here = pins(name, python), for_python(python)
        needed = [each for each in map(Requirement, texts) if holds(each, here)]
        assert {canonicalize_name(r.name) for r in needed} - DEBIAN == as_list(name)
        for each in needed:
            assert each.name in DEBIAN or each.specifier.contains(versions[canonicalize_name(each.name)][0]), str(each)


def test_all_is_every_extra_for_users() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    (everything,) = map(Requirement, extras["all"])
    assert everything.extras == extras.keys() - APART


def test_what_pinned_packages_need_is_there() -> None:
    python = "{}.{}".format(*sys.version_info)
    versions = pins("run", python) | pins("dev", python)
    for name in versions:
        for needed in map(Requirement, requires(name) or []):
            if holds(needed, {"extra": ""}):
                assert needed.name in DEBIAN or canonicalize_name(needed.name) in versions, f"{name} needs {needed}"
                assert needed.specifier.contains(version(needed.name), prereleases=True), f"{name} needs {needed}"


def test_the_recipe_for_conda_asks_for_what_the_project_does() -> None:
    """In the same versions; matplotlib-base is conda-forge's matplotlib without windows."""
    recipe = YAML(typ="safe").load((ROOT / "conda/recipe.yaml").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    asked = [Requirement(text) for text in recipe["requirements"]["run"]]
    given = {canonicalize_name(each.name.removesuffix("-base")): each.specifier for each in asked}
    extras = project["optional-dependencies"]
    for text in [*project["dependencies"], *extras["tables"], *extras["plots"], "jinja2>=3.1"]:
        wanted = Requirement(text)
        if wanted.marker is None:
            assert given[canonicalize_name(wanted.name)] == wanted.specifier, wanted.name
    by_python = [each.specifier for each in map(Requirement, project["dependencies"]) if each.marker is not None]
    assert set(given[canonicalize_name("numba")]) <= {bound for each in by_python for bound in each}
    assert recipe["context"]["version"] == riser_soil.__version__
    (command,) = recipe["build"]["python"]["entry_points"]
    assert command == f"riser-soil = {project['scripts']['riser-soil']}"
