"""Names of numba that its documentation does not have, and LLVM itself, are not used, but for LLVM in one file.

A release of numba may change them without a word, so the project asks for the releases alone that it is tested with.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
import tomllib
from collections.abc import Iterator
from importlib.metadata import version
from typing import Any

import numba
import pytest
from numba.core import caching, ccallback, codegen, compiler, cpu, dispatcher, funcdesc, lowering
from numba.core.datamodel.manager import DataModelManager
from numba.core.datamodel.models import DataModel
from numba.core.options import TargetOptions
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys
from packaging.requirements import Requirement

from tests.support.on_ranks import ROOT

PUBLIC = {"numba", "numba.types", "numba.typed", "numba.experimental", "numba.extending", "numba.core.event"}  # modules
DOCUMENTED = {"address", "ctypes", "py_func", "signature"}  # the last of the wrapper address protocol
OTHERS = {  # words that objects of others have, too
    "load", "args", "name", "register", "globals", "flush", "_replace", "enable", "disable",
}  # fmt: skip
OPTIONS = {  # the last: by numba's page on types, where it tells of functions as arguments
    "nopython", "boundscheck", "error_model", "fastmath", "forceinline", "inline", "no_cfunc_wrapper",
}  # fmt: skip
IN_TREE = getattr(caching, "InTreeCacheLocator", None) or caching._InTreeCacheLocator  # by the release
INSIDE: tuple[Any, ...] = (
    CPUDispatcher, dispatcher._DispatcherBase, caching.FunctionCache, caching.CompileResultCacheImpl,
    caching.IndexDataCacheFile, IN_TREE, ccallback.CFunc, codegen.JITCodeLibrary,
    codegen.JITCPUCodegen, compiler.CompileResult, funcdesc.PythonFunctionDescriptor, cpu.CPUContext, DataModel,
    DataModelManager, lowering.Environment, type(rtsys),
)  # fmt: skip

def members(kind: Any) -> set[str]:
    """Attributes of a class and of its objects."""
    names = {*dir(kind), *getattr(kind, "_fields", ())}
    for base in inspect.getmro(kind):
        try:
            tree = ast.parse(textwrap.dedent(inspect.getsource(base)))
        except (OSError, TypeError):  # of C's
            continue
        names |= {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute) and is_own(node.value)}
    return names


def is_own(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id == "self"


@pytest.fixture(scope="module")
def private() -> set[str]:
    """Names of attributes and methods within numba, but for those of Python's own objects."""
    usual = {name for kind in (object, list, dict, str, tuple, type(ast)) for name in dir(kind)}
    of_types = {name for name in dir(numba.types.float64) if name.startswith("_")}
    options = {name for name in dir(cpu.CPUTargetOptions) if name not in dir(TargetOptions)}
    names = set().union(*map(members, INSIDE), of_types, options) - usual - DOCUMENTED - OTHERS - OPTIONS
    return {name for name in names if not name.startswith("__")}


def imports(tree: ast.AST) -> Iterator[tuple[str, str]]:
    """Modules of numba, and what is taken from them."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((each.name, "") for each in node.names if each.name.partition(".")[0] == "numba")
        elif isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == "numba":
            yield from ((node.module or "", each.name) for each in node.names)


def words(tree: ast.AST) -> Iterator[str]:
    """Attributes, arguments by name, names that classes give to what they have of their bases, and strings."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            yield node.attr
        elif isinstance(node, ast.keyword) and node.arg is not None:
            yield node.arg
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
        elif isinstance(node, ast.ClassDef) and node.bases:
            yield from (each.name for each in node.body if isinstance(each, ast.FunctionDef))
            targets = [target for each in node.body if isinstance(each, ast.Assign) for target in each.targets]
            yield from (each.id for target in targets for each in ast.walk(target) if isinstance(each, ast.Name))


def used(text: str, private: set[str]) -> set[str]:
    """Private names in a source."""
    tree = ast.parse(text)
    names = list(imports(tree))
    if not names:
        return set()
    named = {name or module for module, name in names if not {module, f"{module}.{name}"} & PUBLIC}
    return named | set(words(tree)) & private


def sources() -> dict[str, str]:
    """Text of the package's modules by their places there."""
    package = ROOT / "riser_soil"
    return {str(path.relative_to(package)): path.read_text(encoding="utf-8") for path in package.rglob("*.py")}


def test_no_private_name_is_used(private: set[str]) -> None:
    assert {place: names for place, text in sources().items() if (names := used(text, private))} == {}


def test_one_file_writes_for_llvm() -> None:
    assert [place for place, text in sources().items() if "llvmlite" in text] == ["core/rows.py"]


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("import numba\nnumba.njit(f)", set()),
        ("from numba.core import event, types", {"types"}),
        ("from numba.np.linalg import _LAPACK", {"_LAPACK"}),
        ("import numba.core.codegen", {"numba.core.codegen"}),
        ("import numba\nf.targetctx", {"targetctx"}),
        ("import numba\nkind._code", {"_code"}),
        ("import numba\nclass A(B):\n    _impl_class, x = C, 1", {"_impl_class"}),
        ("import numba\nclass A(B):\n    def load_overload(self): 1", {"load_overload"}),
        ("import numba\ncall(**{'no_cpython_wrapper': True})", {"no_cpython_wrapper"}),
        ("import numba\ncall(no_cpython_wrapper=True)", {"no_cpython_wrapper"}),
        ("import os\nf.targetctx", set()),
    ],
)  # fmt: skip
def test_what_counts(text: str, names: set[str], private: set[str]) -> None:
    assert used(text, private) == names


def test_numba_is_one_that_is_asked_for() -> None:
    """Up to the release that is tested, in the extras as well."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    texts = [*project["dependencies"], *(text for extra in project["optional-dependencies"].values() for text in extra)]
    asked = [each for each in map(Requirement, texts) if each.name == "numba"]
    major, minor, *_ = map(int, version("numba").split("."))
    assert asked[0].specifier.contains(version("numba"))
    for each in asked:
        assert any(bound.operator == "<" for bound in each.specifier), f"{each} has no ceiling"
        assert not each.specifier.contains(f"{major}.{minor + 1}"), f"{each} allows releases that are not tested"
