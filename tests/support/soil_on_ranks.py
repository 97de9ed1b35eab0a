"""Figures of one soil on any number of ranks, as JSON from rank 0: run by test_soil.py under mpirun."""

from __future__ import annotations

import json
import sys
import tempfile
from pathlib import Path
from typing import Literal

import numpy as np
import pytest
from mpi4py import MPI

from riser_soil.core.arrays import Array
from riser_soil.core.part import Forces, State, Weights
from riser_soil.errors import MeshError
from riser_soil.soil.block import BlockSpec
from riser_soil.soil.grid import block_grid, file_grid
from riser_soil.soil.iwan import IwanOverlay
from riser_soil.soil.law import Formula
from riser_soil.soil.layered import LayeredWeight, law_by_depth
from riser_soil.soil.rate import Rate
from riser_soil.soil.soil import Soil
from riser_soil.soil.von_mises import VonMises
from tests.support.mesh_drawings import LEFT, RIGHT, Drawing, msh
from tests.support.said import telling
from tests.support.soil_cases import CLAY

COMM = MPI.COMM_WORLD
SOFT = VonMises(kind="von-mises", su=4.0e3, E_over_su=300.0, rate=Rate(mu=0.1, reference=1e-5))
IWAN = IwanOverlay(kind="iwan", su=4.0e3, su_gradient=1.5e3, E_over_su=300.0, elements=3)


def assembled(soil: Soil, local: Array) -> Array:
    """The ranks' contributions summed by global number, on every rank."""
    largest = COMM.allreduce(int(soil.field.global_index.max(initial=-1)), MPI.MAX)
    total = np.zeros(largest + 1)
    np.add.at(total, soil.field.global_index, soil.field.own(local))
    return np.asarray(COMM.allreduce(total))


def pushed(soil: Soil, factor: float) -> State:
    """An increment that is a smooth function of position, well into the plastic range."""
    x, y, z = soil.field.points.T
    u = factor * np.column_stack((np.sin(x + y), np.cos(2.0 * x) * y, np.sin(x) * np.cos(y) * (z + 1.0)))
    u[soil.field.prescribed.reshape(-1, 3)] = 0.0
    return State(1.0, u.ravel(), u.ravel(), u.ravel(), dt=1.0)


def tangent_times(soil: Soil, state: State, u: Array) -> Array:
    block = soil.blocks()["soil"]
    values = {"soil": block.zeros()}
    soil.tangent(state, Weights(0.0, 1.0, 0.0, 0.0), values)
    out = np.zeros_like(u)
    np.add.at(out, block.rows, np.einsum("mij,mj->mi", values["soil"], u[block.cols]))
    return out


def layered_clay(depth: Array, initial: Array) -> Formula:
    return law_by_depth((SOFT, IWAN), (0.4,), depth, initial)


def figures(kind: str, size: float) -> dict[str, float]:
    layers = (0.4,) if kind == "layers" else ()
    element: Literal["hex", "tet"] = "tet" if kind == "tet" else "hex"
    spec = BlockSpec((0.0, 4.0), (-1.0, 1.0), 1.0, size, 1.5 * size, kind=element, boundaries=layers)
    weight = LayeredWeight((0.4,), (4.0e3, 6.0e3)) if layers else 5.0e3
    soil = Soil(block_grid(COMM, spec), layered_clay if layers else CLAY, level=0.0, unit_weight=weight, K0=0.9)
    start = State.at_rest(1.0, soil.field.size)
    first, second = pushed(soil, 4e-3), pushed(soil, -3e-3)
    out: dict[str, float] = {"work": COMM.allreduce(soil.work(start, first).dissipated)}
    soil.commit(first)
    soil.field.commit(first)
    soil.surface.commit(State(1.0, *(np.full(soil.surface.size, 0.5),) * 3))
    forces = Forces.zeros(soil.field.size)
    soil.residual(second, forces)
    residual = assembled(soil, forces.end)
    product = assembled(soil, tangent_times(soil, second, first.u))
    energy = soil.energy(second)
    out |= {"residual": float(np.linalg.norm(residual)), "product": float(np.linalg.norm(product))}
    out |= {"strain": COMM.allreduce(energy.strain), "potential": COMM.allreduce(energy.potential)}
    out |= {"dofs": COMM.allreduce(int(np.count_nonzero(soil.field.owned & ~soil.field.prescribed)))}
    return out | surface_figures(soil, residual) | output_figures(soil)


def surface_figures(soil: Soil, residual: Array) -> dict[str, float]:
    """Sums over the surface, which rank 0 alone holds."""
    surface, on_root = soil.surface, COMM.rank == 0
    assert surface.facets.size == 0 or on_root
    at_top = residual[surface.global_index].reshape(-1, 3)
    moment = (surface.points[:, :1] * at_top).sum() if on_root else 0.0
    return {
        "facets": COMM.allreduce(len(surface.facets)),
        "surface_points": COMM.allreduce(len(surface.points)),
        "surface_moment": COMM.allreduce(float(moment)),
        "surface_held": COMM.allreduce(int(np.count_nonzero(surface.prescribed))),
        "surface_committed": COMM.allreduce(float(surface.committed.sum())),
    }


def output_figures(soil: Soil) -> dict[str, float]:
    """Output fields weighted with positions, so that a wrong order shows."""
    mesh, fields = soil.output_mesh(), soil.output_fields()
    assert mesh.points.size == fields.displacement.size
    assert len(mesh.cells) == len(fields.von_mises) == len(fields.plastic_strain)
    centre = mesh.points[mesh.cells].mean(axis=1)
    return {
        "cells": COMM.allreduce(len(mesh.cells)),
        "displacement": COMM.allreduce(float((fields.displacement * mesh.points[:, ::-1]).sum())),
        "von_mises": COMM.allreduce(float((fields.von_mises * centre[:, 0]).sum())),
        "mean_stress": COMM.allreduce(float((fields.mean_stress * centre[:, 0]).sum())),
        "strength_used": COMM.allreduce(float((fields.strength_used * centre[:, 0]).sum())),
        "plastic_strain": COMM.allreduce(float((fields.plastic_strain * centre[:, 2]).sum())),
    }


def check_mesh_file(file: Path) -> None:
    """Rank 0 alone reads and judges a file: any numbers will do, cells that come apart will not."""
    file.write_text(msh(Drawing(LEFT, RIGHT), lambda n: 900 - 7 * n))
    assert COMM.allreduce(len(file_grid(COMM, file).nodes.cells)) == 2
    file.write_text(msh(Drawing(LEFT, RIGHT).torn(1.0)))
    with pytest.raises(MeshError, match=telling("4 pairs of nodes", "share a place")):
        file_grid(COMM, file)


def check_refusals() -> None:
    """Every rank raises the error that one rank meets: none is left waiting."""
    with pytest.raises(MeshError, match=telling("absent.msh:", "no such file")):
        file_grid(COMM, Path("absent.msh"))
    with tempfile.TemporaryDirectory() as folder:
        check_mesh_file(Path(folder) / "mesh.msh")
    grid = block_grid(COMM, BlockSpec((0.0, 4.0), (0.0, 4.0), 4.0, 1.0, 1.0))
    if COMM.rank == COMM.size - 1:
        grid.nodes.points[grid.nodes.cells[0]] = 0.0
    with pytest.raises(MeshError, match="inverted or flat"):
        Soil(grid, CLAY, level=0.0, unit_weight=0.0)


if __name__ == "__main__":
    check_refusals()
    result = figures(sys.argv[1], float(sys.argv[2]))
    if COMM.rank == 0:
        print(json.dumps(result))
