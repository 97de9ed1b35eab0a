"""Sources that compiled code depends on: those of the modules it comes from, with all that these import.

numba's own cache notices an edit of the file with a function, not of another file whose functions it has inlined there,
and would run stale code. So what is kept of a function has a place by a word for all these sources: after an edit the
functions of the edited module are compiled anew, and those of modules that import it, and no others.
"""

from __future__ import annotations

import hashlib
import re
import sys
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path


class PackageSources:
    """Sources of a package's modules, as they are when they are asked for first."""

    def __init__(self, package: Path) -> None:
        self._package = package
        self.text, self._imports, self._digest = cache(self._text), cache(self._imports_of), cache(self._digest_of)

    def word(self, modules: Iterable[str]) -> str:
        """A word for some modules, by their dotted names, and all of the package that they import, one through the
        other. Modules outside the package count with their own text; those without a file have none.
        """
        digests = sorted(f"{path} {self._digest(path)}" for path in self.needed(modules))
        return hashlib.sha256("\n".join(digests).encode()).hexdigest()[:16]

    def needed(self, modules: Iterable[str]) -> set[str]:
        """Files with these modules and all of the package that they import: in the package by their names there."""
        files, todo = set[str](), {path for module in modules if (path := self._file(module))}
        while todo:
            files |= todo
            todo = {path for file in todo for path in self._imports(file)} - files
        return files

    def chosen(self, modules: Iterable[str], choices: Iterable[tuple[str, str]]) -> set[str]:
        """The second of each pair of modules the first of which is one of some modules, or what they import."""
        files = self.needed(modules)
        return {kernel for callee, kernel in choices if self._file(callee) in files}

    def _file(self, module: str) -> str:
        """The file of a module; "" where there is none."""
        first, _, rest = module.partition(".")
        if first == self._package.name:
            return next(self._files_of(rest), "")
        return getattr(sys.modules.get(module), "__file__", None) or ""

    def _files_of(self, dotted: str) -> Iterator[str]:
        """Files of the package that a dotted name within it can mean."""
        name = dotted.replace(".", "/")
        for path in (f"{name}.py", f"{name}/__init__.py".lstrip("/")):
            if self.text(path) is not None:
                yield path

    def _text(self, path: str) -> str | None:
        try:
            return (self._package / path).read_text(encoding="utf-8")
        except OSError:
            return None

    def _digest_of(self, path: str) -> str:
        return hashlib.sha256((self.text(path) or "").encode()).hexdigest()

    def _imports_of(self, path: str) -> set[str]:
        """Files of the package that a source names in its import statements, wherever they stand."""
        statement = rf"from {self._package.name}\.?([\w.]*) import (\([^)]*\)|.*)"
        return {
            file
            for module, names in re.findall(statement, self.text(path) or "")
            for dotted in (module, *(f"{module}.{name}".strip(".") for name in re.findall(r"\w+", names)))
            for file in self._files_of(dotted)
        }


PACKAGE = Path(__file__).parents[1]
SOURCES = PackageSources(PACKAGE)
