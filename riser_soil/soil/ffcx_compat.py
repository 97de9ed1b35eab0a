"""UFL's elements and FFCx' compilation with releases 0.5, 0.9 and 0.11: the only module that knows how they differ.

FFCx writes C code for a form or an expression, which a C compiler (gcc) turns into machine code: one function, the
kernel, for the integral over one cell or facet, or for the values at the points of a cell. Its arguments are addresses:

    result, coefficients, constants, nodes' coordinates (nn, 3), local facet, permutation, nothing (from 0.10 on)

Machine code is for the processor at hand, and so is its folder: see `compiled.fingerprint`. Sums may be taken in an
order that isn't written, but in the same one wherever arrays lie in memory, so that ranks and resumed runs agree to the
last bit. A kernel is compiled by one process, in a folder that gets its place when it is complete: what a killed
process leaves is in nobody's way.
"""

from __future__ import annotations

import importlib
import logging
import os
import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import cffi
import ffcx
import ffcx.naming
import numpy as np
import ufl

from riser_soil.core import compiled
from riser_soil.core.arrays import Array
from riser_soil.core.c_function import CFunction
from riser_soil.core.kernel_cache import first_alone
from riser_soil.errors import RiserSoilError

ARGUMENTS = 7
FLAGS = [
    "-O2", "-ftree-vectorize", "-march=native", "-fno-math-errno", "-fno-trapping-math", "-fno-signed-zeros",
    "-fassociative-math", "-freciprocal-math", "--param", "vect-max-peeling-for-alignment=0", "-g0", "-w",
]  # fmt: skip
OLD = hasattr(ufl, "VectorElement")  # elements were UFL's own before basix had them
_FFI = cffi.FFI()


def lagrange(cell: str, degree: int, components: int = 0) -> Any:
    """Continuous element of values at nodes, 0 components: of one number."""
    if OLD:
        return ufl.VectorElement("Lagrange", cell, degree, dim=components) if components else _scalar(cell, degree)
    shape = (components,) if components else ()
    return _basix_ufl().element("Lagrange", cell, degree, shape=shape)


def constant(cell: str, components: int = 0) -> Any:
    """Element of one value in each cell, 0 components: of one number."""
    if OLD:
        return ufl.VectorElement("DG", cell, 0, dim=components) if components else ufl.FiniteElement("DG", cell, 0)
    return _basix_ufl().element("DG", cell, 0, shape=(components,) if components else ())


def at_points(cell: str, degree: int, components: int) -> Any:
    """Element of numbers at the points of the quadrature of a degree."""
    if OLD:
        return ufl.VectorElement("Quadrature", cell, degree=degree, dim=components, quad_scheme="default")
    return _basix_ufl().quadrature_element(cell, value_shape=(components,), degree=degree)


def mixed(*elements: Any) -> Any:
    """The mixed element of these, one after the other."""
    return ufl.MixedElement(*elements) if OLD else _basix_ufl().mixed_element(list(elements))


def cell_kernel(form: Any) -> CFunction:
    """Kernel of a form with integrals over cells."""
    return _form_kernel(form, 0)


def facet_kernel(form: Any) -> CFunction:
    """Kernel of a form with integrals over outer facets."""
    return _form_kernel(form, 1)


def point_kernel(expression: Any, points: Array) -> CFunction:
    """Kernel for the values (n, ...) of an expression at points (n, d) of the reference cell."""
    made = _compiled("expressions", (expression, points))
    return _function(made[0][0], made)


def _form_kernel(form: Any, kind: int) -> CFunction:
    """kind: of its integrals, in the order of cells and outer facets."""
    require_one_degree(form)
    made = _compiled("forms", form)
    form = made[0][0]
    if OLD:
        return _function(form.integrals(kind)[0], made)
    return _function(form.form_integrals[form.form_integral_offsets[kind]], made)


def require_one_degree(form: Any) -> None:
    """FFCx is silently wrong, on every release so far, where a form has a rule of one point and another one."""
    degrees = {integral.metadata().get("quadrature_degree") for integral in form.integrals()}
    if len(degrees) > 1 or None in degrees:
        raise ValueError(f"one form, one quadrature degree: {degrees}")


def _function(kernel: Any, owner: object) -> CFunction:
    return CFunction(int(_FFI.cast("uintptr_t", kernel.tabulate_tensor_float64)), ARGUMENTS, owner)


def _compiled(kind: str, what: Any) -> Any:
    """FFCx' objects for a form or an expression, and the module that owns them."""
    compile_in = _compiler(kind, what)
    name = ffcx.naming.compute_signature([what], str(FLAGS))
    folder = compiled.FOLDER / "forms" / name
    with first_alone(compiled.FOLDER, f"form {name}"):
        if not folder.exists():
            with compiled.compiling():
                _compile(compile_in, folder)
    return compile_in(folder)


def _compile(compile_in: Callable[[Path], object], folder: Path) -> None:
    folder.parent.mkdir(exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix="new-", ignore_cleanup_errors=True) as work:
        try:
            compile_in(Path(work, "form"))
        except cffi.VerificationError as err:
            raise RiserSoilError(
                f"the soil's forms can't be compiled ({err}); they need a C compiler: install gcc, or set CC to yours"
            ) from err
        with suppress(OSError):  # another process has been faster
            os.replace(Path(work, "form"), folder)


def _compiler(kind: str, what: Any) -> Callable[[Path], Any]:
    jit = importlib.import_module("ffcx.codegeneration.jit")
    quiet_compiler_log()
    options = {"parameters": {"scalar_type": "double"}} if OLD else {"options": {"scalar_type": np.float64}}
    compiles = jit.compile_forms if kind == "forms" else jit.compile_expressions
    return lambda folder: compiles([what], cache_dir=folder, cffi_extra_compile_args=FLAGS, **options)


def quiet_compiler_log() -> None:
    """The compiler of 0.5 logs every command at level INFO through the root logger."""
    for handler in logging.getLogger().handlers:
        handler.setLevel(max(handler.level, logging.WARNING))


def _scalar(cell: str, degree: int) -> Any:
    return ufl.FiniteElement("Lagrange", cell, degree)


def _basix_ufl() -> Any:
    return importlib.import_module("basix.ufl")
