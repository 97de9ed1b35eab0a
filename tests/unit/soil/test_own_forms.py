"""Terms of one's own in UFL: values, tangents, boundaries; what they do wrong is told in one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Weights
from riser_soil.errors import SceneError
from riser_soil.soil.grid import DistributedMesh
from riser_soil.soil.own_forms import SoilForms
from riser_soil.soil.slices import slice_grid
from riser_soil.soil.soil import Soil
from tests.support.soil_cases import ELASTIC, distorted, slices_spec, small_block

BODY = "def residual(soil):\n    return 700.0 * soil.v[{up}] * soil.dx\n"
SPRINGS = """
import ufl
def residual(soil):
    stiff = 3.0e4 * (1.0 + 50.0 * ufl.dot(soil.u, soil.u))
    held = stiff * ufl.inner(soil.u, soil.v) * soil.ds("bottom")
    damped = 2.0e3 * ufl.inner(soil.velocity, soil.v) * soil.ds("sides")
    pushed = (40.0 * soil.t * soil.x[0] * soil.v[0] + ufl.inner(ufl.grad(soil.u), ufl.grad(soil.v))) * soil.dx
    carried = 300.0 * soil.u[1] * soil.velocity[2] * soil.t * soil.v[0] * soil.dx
    return held + damped + carried + pushed + 900.0 * soil.u[0]**2 * soil.v[0] * soil.dx(degree=1)
"""


def soil_on(grid: DistributedMesh, inertia: bool = False) -> Soil:
    return Soil(grid, ELASTIC, level=0.0, unit_weight=0.0, inertia=inertia)


def forms(soil: Soil, text: str, folder: Path) -> SoilForms:
    file = folder / "my_terms.py"
    file.write_text(text, encoding="utf-8")
    return SoilForms(soil, file)


def force(part: SoilForms, state: State) -> Array:
    out = Forces.zeros(len(state.u))
    part.residual(state, out)
    return out.force + out.end


@pytest.mark.parametrize("kind", ["hex", "tet", "sections"])
def test_a_body_force_weighs_what_it_says(kind: str, tmp_path: Path) -> None:
    sections = kind == "sections"
    grid = slice_grid(MPI.COMM_SELF, slices_spec(0)) if sections else distorted(small_block(kind))
    soil = soil_on(grid)
    part = forms(soil, BODY.format(up=1 if sections else 2), tmp_path)
    forces = force(part, State.at_rest(1.0, soil.field.size)).reshape(-1, 3)
    np.testing.assert_allclose(forces.sum(axis=0), [0.0, 0.0, 700.0 * soil.cells.volumes.sum()], atol=1e-8)
    assert np.abs(forces[:, :2]).max() < 1e-12


@pytest.mark.parametrize(
    ("kind", "inertia"),
    [
        *(("hex", False), ("tet", True)),
        *(pytest.param(*each, marks=pytest.mark.verify) for each in (("hex", True), ("tet", False))),
    ],
)
def test_the_tangent_is_the_slope_of_the_residual(kind: str, inertia: bool, tmp_path: Path) -> None:
    """Tangents by displacement and velocity, on cells and boundaries, of rules of one point and others side by side."""
    soil = soil_on(distorted(small_block(kind)), inertia)
    part, size = forms(soil, SPRINGS, tmp_path), soil.field.size
    rng, dt = np.random.default_rng(2), 0.5
    soil.field.total = 0.1 * rng.normal(size=size)
    u, v, along = 0.1 * rng.normal(size=size), rng.normal(size=size), rng.normal(size=size)
    weights = Weights(1.0, 0.6 if inertia else 1.0, 7.0, 30.0)
    state, h = State(2.0, u, v, v, dt=dt), 1e-5
    ahead, behind = (replace(state, u=u + s * h * along, v=v + s * h * 7.0 * along) for s in (1.0, -1.0))
    numeric = weights.force * (force(part, ahead) - force(part, behind)) / (2.0 * h)
    forces = tangent_times(part, state, weights, along)
    np.testing.assert_allclose(forces, numeric, atol=1e-7 * np.abs(numeric).max())
    stiff = tangent_times(part, replace(state, u=u + 0.5), weights, along)
    assert np.abs(stiff - forces).max() > 1e-2 * np.abs(forces).max()


def tangent_times(part: SoilForms, state: State, weights: Weights, along: Array) -> Array:
    blocks, out = part.blocks(), np.zeros(len(along))
    values = {key: block.zeros() for key, block in blocks.items()}
    part.tangent(state, weights, values)
    for key, block in blocks.items():
        np.add.at(out, block.rows, np.einsum("cij,cj->ci", values[key], along[block.cols]))
    return out


def test_springs_on_the_bottom_hold_it_as_a_whole(tmp_path: Path) -> None:
    soil = soil_on(small_block("hex"))
    text = 'import ufl\ndef residual(soil):\n    return 5.0e3 * ufl.inner(soil.u, soil.v) * soil.ds("bottom")\n'
    part = forms(soil, text, tmp_path)
    moved = State.at_rest(1.0, soil.field.size)
    moved.u[1::3] = 2e-3
    forces = force(part, moved).reshape(-1, 3)
    np.testing.assert_allclose(forces.sum(axis=0), [0.0, 5.0e3 * 2e-3 * 3.0, 0.0], atol=1e-12)
    assert not forces[soil.grid.nodes.points[:, 2] > -0.999].any()
    work = part.work(State.at_rest(1.0, soil.field.size), moved)
    assert work.external == pytest.approx(-5.0e3 * 2e-3 * 3.0 * 2e-3)


def test_velocity_of_quasi_static_soil_is_the_mean_of_the_step(tmp_path: Path) -> None:
    soil = soil_on(small_block("hex"))
    text = "import ufl\ndef residual(soil):\n    return 10.0 * ufl.inner(soil.velocity, soil.v) * soil.dx\n"
    part, size = forms(soil, text, tmp_path), soil.field.size
    u = np.full(size, 0.3)
    quick, slow = (State(1.0, u, u, u, dt=dt) for dt in (0.1, np.inf))
    assert force(part, quick).sum() == pytest.approx(3 * 10.0 * 3.0 * 3.0)
    assert not force(part, slow).any()
    part.commit(quick)
    assert force(part, State.at_rest(1.0, size)).sum() == pytest.approx(3 * 10.0 * 3.0 * 3.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def residual(soil):\n    return 3.0\n", "must return a form, not float"),
        ("def residual(soil):\n    return soil.v[2] * soil.ds('top')\n", "ds has bottom and sides"),
        ("def residual(soil):\n    return soil.v[0] * soil.v[1] * soil.dx\n", "linear in soil.v"),
        ("def residual(soil):\n    return soil.u[0] * soil.dx\n", "linear in soil.v"),
        ("def residual(soil):\n    return soil.v[0] * soil.dx + 3.0 * soil.dx\n", "linear in soil.v"),
        ("import ufl\ndef residual(soil):\n    return soil.v[0] * ufl.Constant(soil.mesh) * soil.dx\n", "mesh"),
        ("def residual(soil):\n    return soil.v[7] * soil.dx\n", "my_terms.py:2"),
        ("def residuals(soil):\n    return 3.0\n", "residual"),
        ("def residual(soil)\n", "my_terms.py:1: SyntaxError"),
    ],
)
def test_wrong_terms_are_told_in_one_line(text: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as error:
        forms(soil_on(small_block("hex", size=1.0)), text, tmp_path)
    message = str(error.value)
    assert words in message
    assert message.startswith("soil.forms: my_terms.py: ")
    assert "\n" not in message
