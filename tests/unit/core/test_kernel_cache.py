"""The cache of compiled kernels, by the types of their arguments."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.on_ranks import HANGS, environment

NUMBERS = """
from typing import NamedTuple
class {name}(NamedTuple):
    k: float
"""
LOOP = """
from numba.core import event
from riser_soil.core.compiled import njit

@njit
def twice(numbers):
    return 2.0 * numbers[0].k

class Counter(event.Listener):
    compiled = 0

    def on_start(self, event):
        self.compiled += 1

    def on_end(self, event):
        pass

counter = Counter()
event.register("numba:compile", counter)
"""
CALL = """
import sys
from loop import counter, twice
for name in sys.argv[1:]:
    print(twice(((getattr(__import__(name), name.title()))(1.5),)))
print(counter.compiled, "soft" in sys.modules)
"""
KERNELS = """
import sys
import numpy as np
from riser_soil.core.compiled import njit

@njit
def pair(x):
    both = np.empty(2)
    both[0], both[1] = x, 2.0 * x
    return both

@njit
def largest(x):
    return pair(x)[1]

for name in sys.argv[1:]:
    print(globals()[name](1.5))
"""
TWO_TYPES = """
import os
import sys
from unittest.mock import patch
from numba.core.caching import IndexDataCacheFile
from riser_soil.core.compiled import njit

x, role, save = eval(sys.argv[1]), sys.argv[2], IndexDataCacheFile._save_data

def overtaken(self, name, data):  # by a process that has looked into the index when it was empty
    os.spawnv(os.P_WAIT, sys.executable, [sys.executable, "two.py", "3.5", "early"])
    save(self, name, data)

@njit
def doubled(x):
    return x + x

changed = {"late": {"_save_data": overtaken}, "early": {"_load_index": lambda self: {}}}
with patch.multiple(IndexDataCacheFile, **changed.get(role, {"_save_data": save})):
    print(doubled(x))
"""

ERROR = """
from riser_soil.core.compiled import njit

@njit
def checked(x):
    if x > 1.0:
        raise ValueError("too large", x)
    return x

@njit
def twice(x):
    return 2.0 * checked(x)

try:
    twice(1.5)
except ValueError as err:
    print(*err.args)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("hard", "soft"):
        (tmp_path / f"{name}.py").write_text(NUMBERS.format(name=name.title()), encoding="utf-8")
    (tmp_path / "loop.py").write_text(LOOP, encoding="utf-8")
    return tmp_path


def called(folder: Path, *names: str) -> list[str]:
    """Results of calls with the numbers of some modules; how many were compiled, whether `soft` was imported."""
    return printed(folder, "-c", CALL, *names)


def printed(folder: Path, *words: str) -> list[str]:
    """What Python prints, with a cache of its own."""
    around = environment() | {"NUMBA_CACHE_DIR": str(folder / "cache")}
    around["PYTHONPATH"] = os.pathsep.join([str(folder), *sys.path])
    call = [sys.executable, *words]
    done = subprocess.run(call, env=around, cwd=folder, capture_output=True, text=True, timeout=HANGS, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_kernels_for_other_types_are_neither_read_nor_needed(folder: Path) -> None:
    assert called(folder, "hard", "soft") == ["3.0", "3.0", "2", "True"]
    assert called(folder, "hard") == ["3.0", "0", "False"]
    (folder / "soft.py").unlink()
    assert called(folder, "hard") == ["3.0", "0", "False"]


def test_a_source_outside_the_package_that_was_edited_is_compiled_anew(folder: Path) -> None:
    called(folder, "hard", "soft")
    with (folder / "soft.py").open("a", encoding="utf-8") as file:
        file.write("# edited\n")
    assert called(folder, "hard", "soft") == ["3.0", "3.0", "1", "True"]


def test_a_kernel_that_is_read_is_compiled_into_others(folder: Path) -> None:
    (folder / "kernels.py").write_text(KERNELS, encoding="utf-8")
    assert printed(folder, "kernels.py", "pair") == ["[1.5", "3.", "]"]
    assert printed(folder, "kernels.py", "largest", "pair") == ["3.0", "[1.5", "3.", "]"]


def test_a_kernel_that_is_read_tells_errors_with_their_values(folder: Path) -> None:
    (folder / "error.py").write_text(ERROR, encoding="utf-8")
    for _ in range(2):
        assert printed(folder, "error.py") == ["too", "large", "1.5"]


def test_processes_that_compile_for_different_types_at_once_do_not_mix_them_up(folder: Path) -> None:
    """Both look into an empty cache; the second one writes while the first one does."""
    (folder / "two.py").write_text(TWO_TYPES, encoding="utf-8")
    printed(folder, "two.py", "3", "late")
    assert printed(folder, "two.py", "3.5", "alone") == ["7.0"]
    assert printed(folder, "two.py", "3", "alone") == ["6"]
