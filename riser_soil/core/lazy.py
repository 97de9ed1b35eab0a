"""Lazy imports: modules that are loaded at first use, so that a scene is read without numerics."""

from __future__ import annotations

import importlib
from typing import Any


class LazyModule:
    """A module by its full name; its names are looked up at first use."""

    def __init__(self, module: str) -> None:
        self._module = module

    def __getattr__(self, name: str) -> Any:
        attribute = getattr(importlib.import_module(self._module), name)
        setattr(self, name, attribute)
        return attribute
