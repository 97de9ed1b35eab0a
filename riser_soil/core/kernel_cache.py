"""numba's cache on disk, so that reading it imports nothing but what the kernel at hand is called with.

numba keeps one index for a function, with all types that it was ever called with, and imports the modules of the
NamedTuples among them to read it. A kernel that is called with the numbers of any law or part would import all of them;
and fail where one is gone, as one of a test is in the next run. Here each set of NamedTuples has an index of its own.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from llvmlite import ir
from llvmlite.binding import parse_assembly
from numba import config
from numba.core import event
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.runtime import rtsys

PACKAGE = Path(__file__).parents[1]
COMPILING = "numba:compile"  # the event of it


class MachineCode(CompileResultCacheImpl):
    """Keeps the machine code of a function that no compiled code is linked with, without its intermediate code, which
    takes longer to read; and of the environments of functions within, which numba imports their modules for, those
    that are used: by errors with values in their text.
    """

    def reduce(self, cres: Any) -> Any:
        (name, kind, (machine_code, _)), *rest, environments = super().reduce(cres)
        code = cres.library.get_llvm_str()
        used = tuple(each for each in environments if code.count(each.env_name) > 1)  # once where it is declared
        return (name, kind, (machine_code, _names(cres))), *rest, used


class KernelCache(FunctionCache):
    """Cache of one function as Python calls it; in the place of that of numba's dispatcher, `_cache`."""

    _impl_class, _caller = MachineCode, "called"

    def __init__(self, function: Callable[..., object]) -> None:
        """Looks for nothing on disk before the function is called, as most of them are not."""
        self._function, self._folder = function, config.CACHE_DIR

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        self._choose_index(sig)
        return _loaded(self, sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        self._choose_index(sig)
        super().save_overload(sig, data)

    def _choose_index(self, sig: Any) -> None:
        if not hasattr(self, "_impl"):
            with caching_in(self._folder):
                super().__init__(self._function)
        base = "-".join([self._impl.filename_base, self._caller, *_marks(sig)])
        self._cache_file = IndexDataCacheFile(self._cache_path, base, self._impl.locator.get_source_stamp())


class BareCache(KernelCache):
    """Cache of one function as compiled code calls it, which links it."""

    _impl_class, _caller = CompileResultCacheImpl, "bare"


class EntryCache(FunctionCache):
    """Cache of a function that is called by address, and whose name says all of what it depends on, see `mark`."""

    _impl_class = MachineCode

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        found = _loaded(self, sig, target_context)
        if found is None:
            event.start_event(COMPILING)  # until it is saved
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        event.end_event(COMPILING)
        super().save_overload(sig, data)

    def _index_key(self, sig: Any, codegen: Any) -> Any:
        return codegen.magic_tuple()


def _loaded(cache: FunctionCache, sig: Any, target_context: Any) -> Any:
    """What a cache on disk holds for some types. Machine code needs numba's memory of arrays alone; all else that numba
    would import here it imports when it compiles.
    """
    rtsys.initialize(target_context)
    return cache._load_overload(sig, target_context)


def _names(cres: Any) -> bytes:
    """Intermediate code of empty functions of the same names, by which numba knows what the machine code has."""
    reported, empty = cres.fndesc, ir.Module()
    wanted = {reported.llvm_func_name, reported.llvm_cpython_wrapper_name, reported.llvm_cfunc_wrapper_name}
    for found in cres.library._get_module_for_linking().functions:
        if found.name in wanted and not found.is_declaration:
            function = ir.Function(empty, ir.FunctionType(ir.VoidType(), ()), found.name)
            ir.IRBuilder(function.append_basic_block()).ret_void()
    return bytes(parse_assembly(str(empty)).as_bitcode())


@contextmanager
def caching_in(folder: str) -> Iterator[None]:
    """Caches that are made meanwhile are in this folder."""
    before, config.CACHE_DIR = config.CACHE_DIR, folder
    try:
        yield
    finally:
        config.CACHE_DIR = before


def mark(kinds: Iterable[Any]) -> str:
    """A word for types of numba; another one where a source outside the package is edited."""
    return hashlib.sha256(" ".join([*map(str, kinds), *_marks(kinds)]).encode()).hexdigest()[:12]


def _named(types: Iterable[Any]) -> Iterator[type]:
    """NamedTuples among types of numba, and among what they consist of."""
    for given in types:
        if hasattr(given, "instance_class"):
            yield given.instance_class
        yield from _named(getattr(given, "types", ()))
        yield from _named(getattr(given, "field_dict", {}).values())


def _marks(kinds: Iterable[Any]) -> list[str]:
    """A word for the NamedTuples among types, if there are any; another one where their source is edited."""
    reported = sorted(f"{each.__module__}.{each.__qualname__} {_source(each)}" for each in set(_named(kinds)))
    return [hashlib.sha256("\n".join(reported).encode()).hexdigest()[:12]] if reported else []


def _source(named: type) -> str:
    """Of a class outside the package, as those within have cache folders by their sources."""
    path = getattr(sys.modules[named.__module__], "__file__", None)
    if path is None or PACKAGE in Path(path).parents:
        return ""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()
