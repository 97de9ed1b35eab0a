"""A case by Exudyn: planar ANCF cable elements, its generalised-alpha with modified Newton.

It knows no water: an object over all nodes adds drag, added mass (both across the line, in vectorised Python) and the
floor, each lumped at the nodes. It records coordinates and reactions; moments follow from these after the run.
"""

from __future__ import annotations

import functools
import tempfile
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    CoordinateConstraint,
    LoadMassProportional,
    MarkerBodyMass,
    MarkerNodeCoordinate,
    NodePoint2DSlope1,
    NodePointGround,
    ObjectANCFCable2D,
    ObjectGenericODE2,
)
from exudyn.utilities import LoadSolutionFile

from benchmarks.peers.case import GRAVITY, WATER, Case, Record, catenary

NO_DAMPING_BELOW = 0.8  # spectral radius, as riser_soil's default
BARLOW = (0.5 - 0.5 / 3.0**0.5, 0.5 + 0.5 / 3.0**0.5)  # where a cubic's curvature is most accurate


class Water:
    """Drag, added mass and floor at the nodes: what the object over all of them is asked for."""

    def __init__(self, case: Case, reference: np.ndarray) -> None:
        nodes = len(reference)
        share = np.full(nodes, case.length / (nodes - 1))
        share[[0, -1]] *= 0.5
        self._case, self._reference = case, reference
        self._drag = 0.5 * WATER * case.drag * case.diameter * share
        self._mass = case.added_mass * case.displaced * share
        self._floor = (case.floor or 0.0) * share
        self._moving = False
        at = 4 * np.arange(nodes)
        rows = np.stack([at, at, at + 1, at + 1])
        columns = np.stack([at, at + 1, at, at + 1])
        self._triplets = np.stack([rows.ravel(), columns.ravel(), np.zeros(rows.size)], axis=1)
        self._container = exu.MatrixContainer()
        self._size = 4 * nodes

    def force(self, mbs: Any, t: float, item: int, q: object, v: object) -> np.ndarray:
        forces = np.zeros((self._size // 4, 4))
        across, speed, _ = self._across(q, v)
        forces[:, :2] = -(self._drag * speed)[:, None] * across
        if self._case.floor is not None:
            height = self._reference[:, 1] + np.asarray(q)[1::4]
            forces[:, 1] += self._floor * np.maximum(-height, 0.0)
        return forces.ravel()

    def mass(self, mbs: Any, t: float, item: int, q: object, v: object) -> object:
        _, _, normal = self._across(q, v)
        return self._matrix(self._mass * _outer(normal, normal))

    def jacobian(self, mbs: Any, t: float, item: int, q: object, v: object, by_q: float, by_v: float) -> object:
        """Derivative of the forces; what the line's turning changes is left out."""
        _, speed, normal = self._across(q, v)
        matrix = by_v * 2.0 * self._drag * speed * _outer(normal, normal)
        if self._case.floor is not None:
            matrix[3] += by_q * self._floor * (self._reference[:, 1] + np.asarray(q)[1::4] < 0.0)
        return self._matrix(matrix)

    def _across(self, q: object, v: object) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Velocity across the line (nn, 2), its magnitude, and the unit normal (nn, 2)."""
        slope = self._reference[:, 2:] + np.asarray(q).reshape(-1, 4)[:, 2:]
        normal = np.stack([-slope[:, 1], slope[:, 0]], axis=1) / np.hypot(slope[:, 0], slope[:, 1])[:, None]
        rate = np.asarray(v).reshape(-1, 4)
        along = rate[:, 0] * normal[:, 0] + rate[:, 1] * normal[:, 1]
        return along[:, None] * normal, np.abs(along), normal

    def _matrix(self, blocks: np.ndarray) -> object:
        """Blocks (4, nn) of the two displacements at each node; its triplets must not be zero."""
        self._triplets[:, 2] = np.where(blocks == 0.0, 1e-300, blocks).ravel()
        self._container.SetWithSparseMatrix(self._triplets, self._size, self._size)
        return self._container


def _outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.stack([a[:, 0] * b[:, 0], a[:, 0] * b[:, 1], a[:, 1] * b[:, 0], a[:, 1] * b[:, 1]])


def run(case: Case, elements: int, time_step: float) -> Record:
    """One run; the seconds of its time loop are those of `SolveDynamic`."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    reference = _reference(case, elements)
    cables = _assemble(mbs, case, reference)
    settings = exu.SimulationSettings()
    _static(mbs, settings, case, cables)
    with tempfile.TemporaryDirectory() as folder:
        file = str(Path(folder) / "coordinates.bin")
        _dynamic(settings, case, time_step, file)
        began = time.process_time()
        mbs.SolveDynamic(settings)
        seconds = time.process_time() - began
        solution = LoadSolutionFile(file, verbose=False)
    return _read(case, reference, solution, seconds)


def _reference(case: Case, elements: int) -> np.ndarray:
    """Nodes (nn, 4): positions of a catenary and its slopes."""
    fine = catenary(case, 50 * elements + 1)
    slope = np.gradient(fine, case.length / (50 * elements), axis=0)[::50]
    return np.concatenate([fine[::50], slope / np.linalg.norm(slope, axis=1)[:, None]], axis=1)


def _assemble(mbs: Any, case: Case, reference: np.ndarray) -> list[Any]:
    """Line, water, ends; returns the elements."""
    sunk = 0.0 if case.floor is None else case.weight / case.floor
    first = [[0.0, -sunk if 0 < n < len(reference) - 1 else 0.0, 0.0, 0.0] for n in range(len(reference))]
    rows = zip(reference, first, strict=True)
    nodes = [mbs.AddNode(NodePoint2DSlope1(referenceCoordinates=list(r), initialCoordinates=i)) for r, i in rows]
    cables = []
    gravity = [0.0, -GRAVITY * (case.mass - case.displaced) / case.mass, 0.0]
    for pair in pairwise(nodes):
        cable = ObjectANCFCable2D(
            length=case.length / (len(nodes) - 1),
            massPerLength=case.mass,
            bendingStiffness=case.EI,
            axialStiffness=case.EA,
            nodeNumbers=list(pair),
            useReducedOrderIntegration=1,  # cheaper, and no less accurate, by trial
        )
        cables.append(mbs.AddObject(cable))
        marker = mbs.AddMarker(MarkerBodyMass(bodyNumber=cables[-1]))
        mbs.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=gravity))
    water = Water(case, reference)
    empty = exu.MatrixContainer()
    empty.SetWithSparseMatrix(np.array([[0, 0, 1e-300]]), 4 * len(nodes), 4 * len(nodes))
    mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=nodes,
            massMatrix=empty,
            stiffnessMatrix=empty,
            forceUserFunction=water.force,
            massMatrixUserFunction=water.mass,
            jacobianUserFunction=water.jacobian,
        )
    )
    ground = mbs.AddNode(NodePointGround())
    fixed = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for node, target in ((nodes[0], None), (nodes[-1], case)):
        for axis in (0, 1):
            marker = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=axis))
            way = {} if target is None else {"offsetUserFunction": _offset(case, axis)}
            mbs.AddObject(CoordinateConstraint(markerNumbers=[fixed, marker], **way))
    mbs.Assemble()
    return cables


def _offset(case: Case, axis: int) -> object:
    position = functools.cache(lambda t: case.moved_end(t)[0][axis] - case.end[axis])
    return lambda mbs, t, item, offset: position(t)


def _static(mbs: Any, settings: Any, case: Case, cables: list[Any]) -> None:
    """Find the state of rest by way of softer lines, since a catenary that is not stretched yet does not lead there at
    once.
    """
    settings.solution.file.write = False
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.numberOfLoadSteps = 1
    settings.staticSolver.loadStepDuration = 1e-9  # the end has not moved yet
    settings.staticSolver.adaptiveStep = True
    settings.staticSolver.newton.relativeTolerance = 1e-8
    settings.staticSolver.newton.absoluteTolerance = 1e-4
    settings.staticSolver.newton.maxIterations = 200
    for softer in (0.03, 0.3, 1.0):
        for cable in cables:
            mbs.SetObjectParameter(cable, "axialStiffness", softer * case.EA)
        mbs.SolveStatic(settings, updateInitialValues=True)


def _dynamic(settings: Any, case: Case, time_step: float, file: str) -> None:
    integration = settings.timeIntegration
    integration.endTime, integration.numberOfSteps = case.duration, round(case.duration / time_step)
    integration.generalizedAlpha.spectralRadius = NO_DAMPING_BELOW
    integration.generalizedAlpha.computeInitialAccelerations = False
    integration.newton.useModifiedNewton = True
    integration.newton.relativeTolerance = 1e-5  # of its default 1e-8 extremes show nothing
    integration.newton.modifiedNewtonJacUpdatePerStep = case.floor is None  # cheaper each time, by trial
    settings.linearSolver.reuseAnalyzedPattern = True
    integration.verboseMode = 0
    file_settings = settings.solution.file
    file_settings.write, file_settings.binary, file_settings.name = True, True, file
    file_settings.writePeriod = time_step
    settings.solution.precision = 16
    file_settings.export.velocities = file_settings.export.accelerations = False
    file_settings.export.algebraicCoordinates = True


def _read(case: Case, reference: np.ndarray, solution: dict[str, Any], seconds: float) -> Record:
    """columnsExported: numbers of displacements and of Lagrange multipliers; the latter are the ends' reactions."""
    data, nodes = solution["data"], len(reference)
    coordinates = reference + data[:, 1 : 1 + 4 * nodes].reshape(len(data), nodes, 4)
    reactions = data[:, -4:].reshape(len(data), 2, 2)
    slopes = coordinates[:, [0, -1], 2:]
    held, moved = np.abs((reactions * slopes).sum(axis=2) / np.linalg.norm(slopes, axis=2)).T
    length = case.length / (nodes - 1)
    moments = np.stack([case.EI * np.abs(_curvature(coordinates, length, xi)) for xi in BARLOW], axis=2)
    return Record(
        time=data[:, 0],
        held=held,
        moved=moved,
        arc=(length * (np.arange(nodes - 1)[:, None] + BARLOW)).ravel(),
        moment=moments.reshape(len(data), -1),
        position=coordinates[:, :, :2],
        seconds=seconds,
    )


def _curvature(coordinates: np.ndarray, length: float, xi: float) -> np.ndarray:
    """Curvature of the cubic between neighbouring nodes (nt, nn - 1) at a share of its length."""
    r0, r1 = coordinates[:, :-1, :2], coordinates[:, 1:, :2]
    s0, s1 = length * coordinates[:, :-1, 2:], length * coordinates[:, 1:, 2:]
    first = 6.0 * (xi - xi**2) * (r1 - r0) + (1.0 - 4.0 * xi + 3.0 * xi**2) * s0 + (3.0 * xi**2 - 2.0 * xi) * s1
    second = (6.0 - 12.0 * xi) * (r1 - r0) + (6.0 * xi - 4.0) * s0 + (6.0 * xi - 2.0) * s1
    cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    return np.asarray(cross / (first**2).sum(axis=-1) / length)
