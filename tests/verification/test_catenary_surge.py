"""The surging catenary of the demo: orders in time and in element length, and its errors against finer runs."""

from __future__ import annotations

from pathlib import Path

import pytest

from demos.catenary.surge import EXTREMES, GRADED, UNIFORM, Surge, error, orders, surge

pytestmark = pytest.mark.verify


def runs(folder: Path, *asked: tuple[int, float]) -> list[Surge]:
    return [surge(folder / f"{n}_{dt}", UNIFORM.format(n), dt) for n, dt in asked]


def test_second_order_in_time(tmp_path: Path) -> None:
    rates = orders(*runs(tmp_path, (140, 0.05), (140, 0.025), (140, 0.0125)))
    assert rates["position"] == pytest.approx(2.0, abs=0.15)
    assert rates["M"] == pytest.approx(2.0, abs=0.3)
    assert min(rates.values()) > 1.7


def test_fourth_order_in_element_length(tmp_path: Path) -> None:
    rates = orders(*runs(tmp_path, (70, 0.025), (140, 0.025), (280, 0.025)))
    assert [rates["position"], rates["M"]] == pytest.approx([4.0, 4.0], abs=0.3)
    assert min(rates.values()) > 3.0


def test_a_graded_mesh_does_as_well_as_one_twice_as_large(tmp_path: Path) -> None:
    best, fine, coarse = runs(tmp_path, (280, 0.025), (140, 0.05), (70, 0.05))
    graded = surge(tmp_path / "graded", GRADED, 0.05)
    forces, moment = EXTREMES[:-1], EXTREMES[-1:]
    assert error(graded, best, forces) < 2e-4
    assert error(graded, best, moment) < 5e-4 < error(coarse, best, moment)
    assert error(fine, best, EXTREMES) < 2e-4
