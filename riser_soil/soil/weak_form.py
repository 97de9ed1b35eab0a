"""The mechanics of the soil in UFL: strain, internal force, tangent, weight, spin, mass and dashpots of a cell.

Displacement u, its variation v; stress and strain by their components xx, yy, zz, √2 xy, √2 xz, √2 yz, with which the
laws of the soil work (mandel.py).

Undrained clay is nearly incompressible: cells of eight or four nodes would lock. Their dilatation is a field of its
own, p, constant in a cell, of variation q (mean dilatation, B-bar: Hughes 1980, doi:10.1002/nme.1620150914):

    strain     e(u, p) = dev(sym(grad u)) + p/3 I    with  p = mean of div u in the cell
    force      ∫ σ : e(v, q) dx
    tangent    ∫ (C e(u, p)) : e(v, q) dx

`cell_loops` calls what FFCx compiles of these, and puts the mean divergences of the shape functions in the place of p
and q, cell by cell. Ten-node tetrahedra, with curved sides where nodes have moved, need no p: e(u) = sym(grad u).

A section across the riser is in plane strain: nothing changes along it, its cells have two dimensions, and its
gradients are put at their places in space, so that the laws see six components there, too.

With inertia there is the mass, ∫ ρ a·v dx, of a quadrature of its own, and on a boundary where waves leave dashpots of
the impedances ρ c_p along the normal and ρ c_s along the side.

Forms belong to no mesh: a kernel is coefficient a cell's nodes where they are. Stress σ, moduli C and unit weight γ are
numbers at the points of the quadrature. One form has one quadrature degree: FFCx is silently wrong where a rule of one
point meets another.
"""

from __future__ import annotations

from typing import Any

import ufl

from riser_soil.soil.ffcx_compat import at_points, constant, lagrange, mixed

ROOT2 = 2.0**0.5


class WeakForm:
    """Forms and expressions for cells of a shape ("hexahedron", ...), degree and quadrature degree, whose one, two or
    three dimensions are some axes of space, 0 to 2.
    """

    def __init__(self, cell: str, degree: int, quadrature: int, mean_dilatation: bool, axes: tuple[int, ...]) -> None:
        self.axes, vector = axes, lagrange(cell, degree, len(axes))
        mesh = ufl.Mesh(vector)  # isoparametric

        def coefficient(element: Any, number: int) -> Any:  # FFCx 0.5 can't compile what has a number of two digits
            return ufl.Coefficient(ufl.FunctionSpace(mesh, element), count=number)

        self.mesh, self.mean_dilatation = mesh, mean_dilatation
        self.dx = ufl.Measure("dx", mesh, metadata={"quadrature_degree": quadrature})
        self.stress = coefficient(at_points(cell, quadrature, 6), 0)
        self.moduli = coefficient(at_points(cell, quadrature, 36), 1)
        self.unit_weight = coefficient(at_points(cell, quadrature, 1), 2)
        self.displacement = coefficient(vector, 3)
        self.dilatation = coefficient(constant(cell), 4)
        self.nodal = coefficient(lagrange(cell, degree), 5)
        self.density = coefficient(constant(cell), 6)
        self.impedances = coefficient(constant(cell, 2), 7)
        whole = {"quadrature_degree": max(quadrature, 2 * degree + 2)}  # of two displacements, in distorted cells
        self.dx_of_products = ufl.Measure("dx", mesh, metadata=whole)
        self.ds_of_products = ufl.Measure("ds", mesh, metadata=whole)
        plain = ufl.FunctionSpace(mesh, vector)
        self.plain_u, self.plain_v = ufl.TrialFunction(plain), ufl.TestFunction(plain)
        if mean_dilatation:
            space = ufl.FunctionSpace(mesh, mixed(vector, constant(cell)))
            (self.u, self.p), (self.v, self.q) = ufl.TrialFunctions(space), ufl.TestFunctions(space)
        else:
            space = ufl.FunctionSpace(mesh, vector)
            self.u, self.v, self.p, self.q = ufl.TrialFunction(space), ufl.TestFunction(space), None, None

    def gradient(self, u: Any) -> Any:
        """(3, 3) of a displacement, (3,) of a number: in space."""
        there = ufl.grad(u)
        if len(there.ufl_shape) == 1:
            return ufl.as_vector([self._in_space(there, i) for i in range(3)])
        return ufl.as_matrix([[self._in_space(there, i, j) for j in range(3)] for i in range(3)])

    def _in_space(self, there: Any, *places: int) -> Any:
        if not all(axis in self.axes for axis in places):
            return 0.0
        return there[tuple(self.axes.index(axis) for axis in places)]

    def strain(self, u: Any, p: Any) -> Any:
        """Six components; p: dilatation, if it is a field of its own."""
        e = ufl.sym(self.gradient(u))
        return components(e if p is None else ufl.dev(e) + p / 3.0 * ufl.Identity(3))

    def strain_at_points(self) -> Any:
        return self.strain(self.displacement, self.dilatation if self.mean_dilatation else None)

    def mean_divergence(self) -> Any:
        """For v the integral of its divergence, for q the volume."""
        return (ufl.div(self.v) + self.q) * self.dx

    def force(self) -> Any:
        return ufl.inner(self.stress, self.strain(self.v, self.q)) * self.dx

    def tangent(self) -> Any:
        C = ufl.as_matrix([[self.moduli[6 * i + j] for j in range(6)] for i in range(6)])
        return ufl.inner(ufl.dot(C, self.strain(self.u, self.p)), self.strain(self.v, self.q)) * self.dx

    def weight(self) -> Any:
        """Downwards: the last axis points up."""
        return -self.unit_weight[0] * self.v[len(self.axes) - 1] * self.dx

    def mass(self) -> Any:
        return self.density * ufl.inner(self.plain_u, self.plain_v) * self.dx_of_products

    def dashpots(self) -> Any:
        u, v, n = self.plain_u, self.plain_v, ufl.FacetNormal(self.mesh)
        along_normal = ufl.dot(u, n) * ufl.dot(v, n)
        along_side = ufl.inner(u, v) - along_normal
        return (self.impedances[0] * along_normal + self.impedances[1] * along_side) * self.ds_of_products

    def spin_at_points(self) -> Any:
        """Axial vector of the skew part of the displacement's gradient."""
        w = ufl.skew(self.gradient(self.displacement))
        return ufl.as_vector([w[2, 1], w[0, 2], w[1, 0]])

    def slope_at_points(self) -> Any:
        """Gradient of a number at nodes."""
        return self.gradient(self.nodal)


def components(e: Any) -> Any:
    """Components of a symmetric tensor (3, 3), so that a product of two is that of the tensors."""
    return ufl.as_vector([e[0, 0], e[1, 1], e[2, 2], ROOT2 * e[0, 1], ROOT2 * e[0, 2], ROOT2 * e[1, 2]])
