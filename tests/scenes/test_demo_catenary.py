"""The catenary's demo: its values against the published ones, and its page against what the code gives."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from demos.catenary import statics
from demos.catenary.convergence import CHEAP
from demos.catenary.statics import COARSE, COLUMNS, FINE, WEIGHTS, Published, hanging, published, table1
from demos.catenary.surge import EXTREMES, UNIFORM, surge
from demos.page import block

PAGE = "".join((statics.HERE / page).read_text(encoding="utf-8") for page in ("README.md", "convergence.md"))
IMPLIED, STATED = "364.2", "346.1"
ROUND_OFF = 1e-9
Found = dict[tuple[str, int], dict[str, float]]


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("catenary")


@pytest.fixture(scope="module")
def forces_of(results: Path) -> Found:
    """Table 1's quantities by weight and number of elements."""
    return {(w, n): table1(hanging(results, n, w)) for w in WEIGHTS for n in (COARSE, FINE)}


@pytest.mark.parametrize("row", published(), ids=lambda row: row.name)
def test_published_values_with_the_implied_weight(forces_of: Found, row: Published) -> None:
    apart = {name: abs(forces_of[IMPLIED, FINE][name] - row.values[name]) for name in COLUMNS}
    assert {name: value for name, value in apart.items() if value > row.tolerance[name]} == {}


@pytest.mark.parametrize("row", published(), ids=lambda row: row.name)
def test_the_stated_weight_misses_the_published_forces(forces_of: Found, row: Published) -> None:
    missed = {name for name in COLUMNS if abs(forces_of[STATED, FINE][name] - row.values[name]) > row.tolerance[name]}
    assert missed >= {"V1", "V2", "H1", "H2"}


def test_forces_scale_with_the_weight_and_angles_do_not_change(forces_of: Found) -> None:
    implied, stated = forces_of[IMPLIED, FINE], forces_of[STATED, FINE]
    scale = {name: 1.0 if name.startswith("theta") else 364.2 / 346.107 for name in COLUMNS}
    assert implied == pytest.approx({name: scale[name] * stated[name] for name in COLUMNS}, rel=2e-4)


def test_horizontal_reactions_balance(forces_of: Found) -> None:
    assert max(abs(values["H2"] / values["H1"] - 1.0) for values in forces_of.values()) < ROUND_OFF


@pytest.mark.parametrize("weight", WEIGHTS)
def test_figures_stand(results: Path, weight: str) -> None:
    assert statics.largest_change(results, weight) < 1e-5


def test_both_paths_end_in_the_same_state(results: Path) -> None:
    differences = statics.path_differences(results)
    assert len(differences) == 3
    assert max(differences.values()) < 1e-6


# The page


def test_page_shows_table_1_as_computed(results: Path) -> None:
    assert_same_table(block(PAGE, "table1"), statics.table1_page(results))


def test_page_shows_the_paths_as_computed(results: Path) -> None:
    assert_same_table(block(PAGE, "paths"), statics.paths_page(results))


def test_page_shows_a_cheap_run_as_computed(results: Path) -> None:
    elements, step = CHEAP[0]
    run = surge(results / "cheap", UNIFORM.format(elements), step)
    row = next(line for line in block(PAGE, "cheap").splitlines() if line.startswith(f"| {elements} | {step:g} |"))
    shown = [float(cell) for cell in row.split("|")[4 : 4 + len(EXTREMES) + 1]]
    assert shown == pytest.approx([*run.extremes.values(), run.arc], rel=2e-5)


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", PAGE))))
def test_link(target: str) -> None:
    assert target.startswith("https://") or (statics.HERE / target).exists()


def assert_same_table(shown: str, computed: str) -> None:
    """Equal words; equal numbers but for the last digit; what is round-off in one is round-off in the other."""
    for a, b in zip(cells(shown), cells(computed), strict=True):
        if re.fullmatch(r"\d+e-\d+", a):
            assert max(float(a), float(b)) < 1e-7
        elif re.fullmatch(r"-?\d+\.\d+", a):
            assert np.isclose(float(a), float(b), rtol=0.0, atol=1.01 * 10.0 ** -len(a.split(".")[1]))
        else:
            assert a == b


def cells(table: str) -> list[str]:
    return [cell.strip() for line in table.splitlines() for cell in line.split("|")]
