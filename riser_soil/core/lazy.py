"""Modules that are imported when they are first used, for files that a scene's reader imports: it needs no numerics."""

from __future__ import annotations

import importlib
from typing import Any


class Lazy:
    """A module by its full name; its names are looked up when they are asked for, each once."""

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> Any:
        found = getattr(importlib.import_module(self._module), name)
        setattr(self, name, found)
        return found
