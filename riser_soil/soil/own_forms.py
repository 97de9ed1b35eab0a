"""Terms of one's own: what a user's file adds in UFL to the soil's residual; the part "soil forms".

The file has a function `residual(soil)` that returns a form, linear in `soil.v`: internal minus external force, as the
soil's own. Its tangent is UFL's derivative by displacement and velocity. Quasi-static soil has the mean velocity of a
step, soil with inertia that of the time scheme. Integrals of different kind, boundary or quadrature degree are compiled
apart: FFCx would be silently wrong where rules meet in one form. The work that the terms do counts as put in.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import ufl
from ufl.algorithms.check_arities import ArityMismatch, check_form_arity
from ufl.algorithms.remove_complex_nodes import remove_complex_nodes

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.part import Energy, Forces, MatrixBlock, State, Traits, Weights, Work
from riser_soil.core.roles import Stateful
from riser_soil.core.saved_state import Saved
from riser_soil.errors import SceneError
from riser_soil.soil.ffcx_compat import cell_kernel, constant, facet_kernel, lagrange
from riser_soil.soil.field import components
from riser_soil.soil.inertia import outer_facets
from riser_soil.soil.law_source import failure_in_words, run_file
from riser_soil.soil.soil import Soil

BOUNDARIES = ("bottom", "sides")
U, VELOCITY, T = 0, 1, 2  # numbers of what terms are given


class Terms:
    """What `residual(soil)` builds its form of: UFL's symbols on a cell of the soil.

    u [m]: displacement since the soil's start; velocity [m/s]; v: their variation, along the cells' axes, in sections
    across and up. x [m]: place. t: seconds since the stage began, in static stages the share of its load. dx: over the
    soil; ds("bottom"), ds("sides"): over its boundaries.
    """

    def __init__(self, soil: Soil) -> None:
        family = soil.grid.family
        cell, d = family.cell.name, len(family.axes)
        vector = lagrange(cell, family.degree, d)
        self._mesh = mesh = ufl.Mesh(vector)
        space, numbers = ufl.FunctionSpace(mesh, vector), ufl.FunctionSpace(mesh, constant(cell))
        self.u, self.velocity = ufl.Coefficient(space, count=U), ufl.Coefficient(space, count=VELOCITY)
        self.t = ufl.Coefficient(numbers, count=T)
        self.v, self.change = ufl.TestFunction(space), ufl.TrialFunction(space)
        self.x = ufl.SpatialCoordinate(mesh)
        self.degree = max(family.quadrature_degree, 2 * family.degree)
        self.dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": self.degree})

    def ds(self, boundary: str) -> Any:
        """Measure over a boundary."""
        if boundary not in BOUNDARIES:
            raise ValueError(f'ds has {" and ".join(BOUNDARIES)}, not "{boundary}"')
        metadata = {"quadrature_degree": self.degree}
        return ufl.Measure("ds", self._mesh, subdomain_id=BOUNDARIES.index(boundary), metadata=metadata)


@dataclass(frozen=True, eq=False)
class Integral:
    """Kernels of one integral's values, and of its derivatives by u and velocity where they are not zero; each with the
    numbers of the coefficients that it takes. boundary: which, None over the soil.
    """

    boundary: str | None
    force: tuple[Any, tuple[int, ...]]
    slopes: dict[int, tuple[Any, tuple[int, ...]]]


class SoilForms:
    """Part "soil forms": the terms of a file, in the soil's group; SceneError where they won't do."""

    name = "soil forms"
    active = True

    def __init__(self, soil: Soil, file: Path) -> None:
        self._soil, self._inert = soil, soil.traits.groups == "F"
        self.traits = Traits(soil.traits.groups, symmetric=False, roles=(Stateful,))
        self._dofs = components(soil.cells.nodes, soil.grid.family.axes)
        self._integrals = list(integrals_of(soil, file))
        self._facets = {b: outer_facets(soil.grid, soil.cells.nodes, b) for b in BOUNDARIES}
        self._rate = np.zeros(soil.field.size)

    def blocks(self) -> dict[str, MatrixBlock]:
        own = {f"{self.name}, {b}": self._rows(b) for b in BOUNDARIES if any(i.boundary == b for i in self._integrals)}
        return self._soil.blocks() | {key: MatrixBlock(rows, rows) for key, rows in own.items()}

    def _rows(self, boundary: str) -> IntArray:
        return self._soil.field.offset + self._dofs[self._facets[boundary][:, 0]]

    def residual(self, state: State, forces: Forces) -> None:
        own = self._soil.field.own
        own(forces.force if self._inert else forces.end)[:] += self._force(state)

    def tangent(self, state: State, weights: Weights, values: dict[str, Array]) -> None:
        force, rate = (weights.force, weights.shift_v) if self._inert else (1.0, _inverse(state.dt))
        coefficients = self._coefficients(state)
        for each in self._integrals:
            key = "soil" if each.boundary is None else f"{self.name}, {each.boundary}"
            for number, (kernel, columns) in each.slopes.items():
                share = force * (1.0 if number == U else rate)
                values[key] += share * self._values(kernel, each.boundary, columns, coefficients, 2)

    def _force(self, state: State) -> Array:
        """Nodal forces (size,)."""
        coefficients, out = self._coefficients(state), np.zeros(self._soil.field.size)
        for each in self._integrals:
            kernel, columns = each.force
            dofs = self._dofs if each.boundary is None else self._dofs[self._facets[each.boundary][:, 0]]
            values = self._values(kernel, each.boundary, columns, coefficients, 1)
            out += np.bincount(dofs.ravel(), values.ravel(), minlength=out.size)
        return out

    def _coefficients(self, state: State) -> tuple[Array, Array, Array]:
        """Displacement, velocity and time of each cell (nc, n)."""
        field, dofs = self._soil.field, self._dofs
        u = field.total + field.own(state.u)
        return u[dofs], self._velocity(state)[dofs], np.full((len(dofs), 1), state.t)

    def _velocity(self, state: State) -> Array:
        own = self._soil.field.own
        if self._inert:
            return own(state.v)
        return self._rate if state.dt == 0.0 else own(state.u) * _inverse(state.dt)

    def _values(
        self,
        kernel: Any,
        boundary: str | None,
        columns: tuple[int, ...],
        coefficients: tuple[Array, Array, Array],
        rank: int,
    ) -> Array:
        """Vectors (m, n), rank 1, or matrices (m, n, n) of the cells or a boundary's facets."""
        facets = None if boundary is None else self._facets[boundary]
        rows = [coefficients[number] if facets is None else coefficients[number][facets[:, 0]] for number in columns]
        return self._soil.cells.integrals(kernel, rows, rank, facets)

    def energy(self, state: State) -> Energy:
        return Energy()

    def work(self, before: State, after: State) -> Work:
        """Work of the terms over a step [J]: by their force at its end, of terms with inertia by the mean of both ends.
        """
        force = self._force(after)
        if self._inert:
            force = 0.5 * (force + self._force(before))
        return Work(external=-float(force @ self._soil.field.own(after.u)))

    def commit(self, state: State) -> None:
        self._rate = self._velocity(state).copy()

    def state(self) -> Saved:
        return {"rate": self._rate.copy()}

    def restore(self, saved: Saved) -> None:
        self._rate = saved["rate"].copy()


def _inverse(dt: float) -> float:
    return 0.0 if dt == 0.0 else 1.0 / dt


def integrals_of(soil: Soil, file: Path) -> Iterator[Integral]:
    """The terms of a file, compiled."""
    terms = Terms(soil)
    form = _call_user_code(file, lambda: _checked(run_file(file).residual(terms)))
    for integral in form.integrals():
        boundary = None if integral.integral_type() == "cell" else BOUNDARIES[_number(integral)]
        yield _integral(file, terms, _alone(integral, terms.degree), boundary)


def _integral(file: Path, terms: Terms, form: Any, boundary: str | None) -> Integral:
    slopes = _call_user_code(file, lambda: [_slope(form, terms, number) for number in (U, VELOCITY)])
    kernels = {number: _compiled(file, slope) for number, slope in enumerate(slopes) if slope is not None}
    return Integral(boundary, _compiled(file, form), kernels)


def _checked(form: Any) -> Any:
    if not isinstance(form, ufl.Form):
        raise TypeError(f"residual(soil) must return a form, not {type(form).__name__}: write ... * soil.dx")
    form = remove_complex_nodes(ufl.algorithms.expand_derivatives(form))
    if not _is_linear(form):
        raise ValueError("residual(soil) must be linear in soil.v, each term")
    own = {U: "soil.u", VELOCITY: "soil.velocity", T: "soil.t"}
    if form.constants() or any(each.count() not in own for each in form.coefficients()):
        raise ValueError(f"its values are numbers, {', '.join(own.values())} and soil.x")
    kinds = {integral.integral_type() for integral in form.integrals()} - {"cell", "exterior_facet"}
    if kinds:
        raise ValueError(f"integrals are over soil.dx and soil.ds, not {', '.join(sorted(kinds))}")
    if any(i.integral_type() == "exterior_facet" and _number(i) is None for i in form.integrals()):
        raise ValueError('name the boundary: soil.ds("bottom") or soil.ds("sides")')
    return form


def _is_linear(form: Any) -> bool:
    """Whether a form is linear in one test function, in each term."""
    try:
        check_form_arity(form, form.arguments())
    except (Exception, ArityMismatch):  # UFL has several, by release; this one is no Exception in all of them
        return False
    return len(form.arguments()) == 1


def _number(integral: Any) -> Any:
    """Number of an integral's boundary; None where it has none."""
    number = integral.subdomain_id()
    number = number[0] if isinstance(number, tuple) else number
    return None if isinstance(number, str) else int(number)


def _alone(integral: Any, degree: int) -> Any:
    """A form of one integral, over all that its kernel is called for."""
    metadata = {"quadrature_degree": integral.metadata().get("quadrature_degree", degree)}
    return ufl.Form([integral.reconstruct(subdomain_id="everywhere", metadata=metadata)])


def _slope(form: Any, terms: Terms, number: int) -> Any:
    """Derivative of a form by u or velocity; None where that is zero."""
    by = terms.u if number == U else terms.velocity
    if by not in form.coefficients():
        return None
    slope = ufl.algorithms.expand_derivatives(ufl.derivative(form, by, terms.change))
    return None if slope.empty() else slope


def _compiled(file: Path, form: Any) -> tuple[Any, tuple[int, ...]]:
    kernel = cell_kernel if form.integrals()[0].integral_type() == "cell" else facet_kernel
    return _call_user_code(file, lambda: kernel(form)), tuple(each.count() for each in form.coefficients())


def _call_user_code(file: Path, call: Callable[[], Any]) -> Any:
    """Return value of user code; SceneError, with its file, where it fails."""
    try:
        return call()
    except SceneError:
        raise
    except (Exception, ArityMismatch, SystemExit) as err:
        raise SceneError(f"soil.forms: {file.name}: {failure_in_words(err)}; correct the terms") from err
