"""The soil against closed forms: settlement under its weight, Prandtl's collapse load; and on more ranks."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from riser_soil.soil.soil import Soil
from tests.support.on_ranks import mpirun
from tests.support.pages import Tell, signed_percent
from tests.support.soil_bench import Bench
from tests.support.soil_cases import ELASTIC, KINDS, small_block
from tests.support.strip import press_graded_strip, press_strip

ROOT = Path(__file__).parents[2]
PRANDTL = 2.0 + np.pi


@pytest.mark.parametrize("kind", KINDS)
def test_block_settles_under_its_weight_as_a_column(kind: str) -> None:
    """w = −γ (H² − z²) / 2M, z from the top, M = E(1−ν)/((1+ν)(1−2ν)); both families are exact at nodes."""
    H, gamma, nu = 1.0, 5.0e3, 0.49
    M = 1.2e6 * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    soil = settled(kind)
    z = soil.field.points[:, 2]
    exact = -gamma * (H**2 - z**2) / (2.0 * M)
    total = soil.field.total.reshape(-1, 3)
    np.testing.assert_allclose(total[:, 2], exact, atol=1e-9 * np.abs(exact).max())
    assert np.abs(total[:, :2]).max() < 1e-9 * np.abs(exact).max()


@pytest.mark.parametrize("kind", KINDS)
def test_settled_block_carries_the_stress_of_a_column(kind: str) -> None:
    """At rest sideways, so σh/σv = ν/(1−ν); the von Mises stress is the difference of the two."""
    soil = settled(kind)
    mesh, fields = soil.output_mesh(), soil.output_fields()
    depth = -mesh.points[mesh.cells].mean(axis=1)[:, 2]
    np.testing.assert_allclose(fields.von_mises, 5.0e3 * depth * (1.0 - 0.49 / 0.51), rtol=1e-6)
    np.testing.assert_allclose(fields.mean_stress, 5.0e3 * depth * (1.0 + 2.0 * 0.49 / 0.51) / 3.0, rtol=1e-6)


def settled(kind: str) -> Soil:
    """An elastic block, 1 m deep, at first without stress, under its weight."""
    soil = Soil(small_block(kind), ELASTIC, level=0.0, unit_weight=5.0e3, start="unstressed")
    Bench(soil, np.zeros(soil.field.size, dtype=bool)).step(np.zeros(soil.field.size))
    return soil


@pytest.mark.parametrize(
    ("kind", "cells", "far", "error"),
    [
        ("hex", 8, 0.5, 0.065),
        pytest.param("hex", 16, 0.25, 0.035, marks=pytest.mark.verify),
        pytest.param("tet", 8, 0.5, 0.05, marks=pytest.mark.verify),
    ],
)
def test_strip_collapses_at_prandtl_load(kind: str, cells: int, far: float, error: float) -> None:
    strip = press_strip(kind, cells, far=far)
    assert 0.0 < strip.load[-1] / PRANDTL - 1.0 < error
    assert strip.load[-1] - strip.load[-2] < 1e-3 * PRANDTL, "the load still rises: the mesh locks"
    assert_quadratic(strip.norms[-1])


def test_strip_error_shrinks_with_the_cells() -> None:
    """The strip's singular edge costs half a cell of width: first order."""
    errors = [press_strip("hex", n, far=4.0 / n).load[-1] / PRANDTL - 1.0 for n in (4, 8)]
    assert np.log2(errors[0] / errors[1]) > 0.8


@pytest.mark.verify
@pytest.mark.parametrize("kind", KINDS)
def test_strip_comes_to_prandtls_load_at_first_order(tell: Tell, kind: str) -> None:
    """Hexahedra halved everywhere, and tetrahedra, small around the strip's edge, too; the last two extrapolated."""
    if kind == "hex":
        loads = [press_strip("hex", n, far=4.0 / n).load[-1] for n in (4, 8, 16)]
    else:
        loads = [press_graded_strip(1.0 / n, growth=4.0 / n).load[-1] for n in (8, 16, 32)]
    errors = np.array(loads) / PRANDTL - 1.0
    rates, extrapolated = np.log2(errors[:-1] / errors[1:]), 2.0 * errors[-1] - errors[-2]
    orders = " and ".join(f"{rate:.2f}" for rate in rates)
    tell({f"strip {kind}": f"{signed_percent(errors)} | order {orders}; {signed_percent([extrapolated])} extrapolated"})
    assert np.all(rates > 0.85)
    assert 0.0 < errors[-1] < {"hex": 0.035, "tet": 0.02}[kind]
    assert abs(extrapolated) < 0.005


@pytest.mark.verify
def test_strip_on_fine_hexahedra_is_within_two_per_cent() -> None:
    assert 0.0 < press_strip("hex", 32, far=0.25).load[-1] / PRANDTL - 1.0 < 0.02


@pytest.mark.verify
def test_strip_on_full_integration_locks() -> None:
    """What the mean dilatation cures: without it the load is far off and still rising."""
    grid_family = small_block("hex").family
    strip = press_strip("hex", 4, replace(grid_family, mean_dilatation=False))
    sound = press_strip("hex", 4)
    assert strip.load[-1] > 1.15 * sound.load[-1]
    assert strip.load[-1] - strip.load[-2] > 1e-2 * PRANDTL


def assert_quadratic(norms: list[float]) -> None:
    """Each drop of the last three residual norms is by at least the power 1.5 of the one before."""
    a, b, c = norms[-3:]
    assert c < max(1e-10, b * (b / a) ** 1.5)


@pytest.mark.verify
@pytest.mark.parametrize(
    ("ranks", "kind", "size"),
    [
        pytest.param(2, "hex", 0.4, id="hex"),
        pytest.param(2, "tet", 0.4, id="tet"),
        pytest.param(2, "layers", 0.4, id="layers"),
        pytest.param(3, "layers", 9.0, id="two cells"),
    ],
)
def test_any_number_of_ranks_agrees(ranks: int, kind: str, size: float) -> None:
    """Also where some ranks have no cell."""
    assert on_ranks(ranks, kind, size) == pytest.approx(on_ranks(1, kind, size), rel=1e-10, abs=1e-12)


def on_ranks(ranks: int, kind: str, size: float) -> dict[str, float]:
    script = ROOT / "tests/support/soil_on_ranks.py"
    done = mpirun(ranks, str(script), kind, str(size))
    assert done.returncode == 0, done.stderr
    result: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return result
