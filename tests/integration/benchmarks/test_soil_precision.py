"""Work and precision of soil: norms, which run is the cheapest, and that the page has what its CSV gives."""

from __future__ import annotations

from math import nan

import pytest

from benchmarks.soil_precision.errors import Row, cheapest, csv_of, largest, relative, rms, rows_of
from benchmarks.soil_precision.ladders import LADDERS
from benchmarks.soil_precision.page import PAGE, ROWS, cheapest_table
from demos.page import block
from riser_soil.scene.reader import scene_from_mapping
from tests.support.pages import text


def row(method: str, n: int, seconds: float, error: float) -> Row:
    return Row("pushed", method, n, seconds, "capacity", "relative", 1.0, error)


def test_norms_are_relative_to_the_reference() -> None:
    assert relative(-1.1, -1.0) == pytest.approx(0.1)
    assert largest([1.0, 2.5, nan], [1.0, 2.0, 9.0]) == pytest.approx(0.5 / 9.0)
    assert rms([0.0, 1.0], [3.0, 4.0]) == pytest.approx((18.0 / 25.0) ** 0.5)


def test_an_accuracy_that_a_finer_run_loses_does_not_count() -> None:
    lucky = [row("nodes", 4, 1.0, 0.01), row("nodes", 8, 2.0, 0.2)]
    kept = [row("whole", 4, 3.0, 0.09), row("whole", 8, 9.0, 0.02)]
    assert cheapest([*lucky, *kept], 0.1) == kept[0]
    assert cheapest([*lucky, *kept], 0.03) == kept[1]
    assert cheapest(lucky, 0.1) is None


def test_rows_are_read_as_they_were_written() -> None:
    rows = [row("whole", 4, 3.0, 0.09), row("nodes", 8, 2.25, 0.5)]
    assert rows_of(csv_of(rows)) == rows


def test_the_page_has_the_table_of_its_rows() -> None:
    assert block(text(PAGE), "cheapest") == cheapest_table(rows_of(text(ROWS)))


@pytest.mark.parametrize(
    ("scene", "method"), [(scene, method) for scene, ladder in LADDERS.items() for method in ladder.methods]
)
def test_each_method_makes_a_scene(scene: str, method: str) -> None:
    keys, sizes = LADDERS[scene].methods[method]
    scene_from_mapping(LADDERS[scene].scene(sizes[0], keys))
