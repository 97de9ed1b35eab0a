"""The trench's demo: its page beside its runs, and what the trench changes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from demos.compute import compute
from demos.page import block, places
from demos.trench.run import HERE, LEVEL, SCENE, edges, rows

TEXT = (HERE / "README.md").read_text(encoding="utf-8")
TOUCHDOWN = "at rest: touchdown arc length [m]"
STATIC = "stages=[{name: lay, kind: static}]"


def shown() -> dict[str, list[str]]:
    cells = ([cell.strip() for cell in line.split("|")[1:-1]] for line in block(TEXT, "trench").splitlines()[2:])
    return {first: others for first, *others in cells}


@pytest.mark.verify
@pytest.mark.parametrize(("column", "overrides"), [(0, (STATIC,)), (1, (STATIC, LEVEL))])
def test_page_shows_rest_as_computed(column: int, overrides: tuple[str, ...], tmp_path: Path) -> None:
    """The touchdown point within half an element: gmsh's versions make other tetrahedra, which moves it by 0.14 m."""
    computed = rows(compute(SCENE, tmp_path / "run", *overrides).summary["stages"])
    values = {name: float(value) for name, value in computed.items()}
    page = {name: float(shown()[name][column]) for name in values}
    assert page.pop(TOUCHDOWN) == pytest.approx(values.pop(TOUCHDOWN), abs=0.25)
    assert page == pytest.approx(values, rel=0.005)


@pytest.mark.verify
def test_page_tells_what_the_edges_do(tmp_path: Path) -> None:
    """Within what other tetrahedra change."""
    figures = places(TEXT)
    for name, value in edges(compute(SCENE, tmp_path, STATIC)).items():
        assert [float(each) for each in figures[name]] == [pytest.approx(float(value), rel=0.15, abs=0.11)]


def test_the_riser_touches_down_later_in_the_trench() -> None:
    touchdown, pieces = (list(map(float, shown()[name])) for name in list(shown())[:2])
    assert touchdown[0] > touchdown[1] + 1.0
    assert pieces[0] > pieces[1] == 1.0


@pytest.mark.parametrize("target", sorted(set(re.findall(r"\]\(([^)#]+)\)", TEXT))))
def test_link(target: str) -> None:
    assert (HERE / target).exists()
