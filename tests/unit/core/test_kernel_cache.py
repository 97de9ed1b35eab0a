"""The cache of compiled kernels, by the types of their arguments."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from tests.support.on_ranks import HANGS, Job, environment

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

SLOW = """
import sys
from loop import Counter, event, twice
from hard import Hard

class Slow(event.Listener):
    def on_start(self, event):
        print("compiling", flush=True)
        sys.stdin.readline()

    def on_end(self, event):
        pass

event.register("numba:compile", Slow())
print("begun", flush=True)
print(twice((Hard(1.5),)), flush=True)
sys.stdin.readline()
"""
ONCE = """
import sys
from pathlib import Path
from riser_soil.core.kernel_cache import first_alone

print("begun", flush=True)
with first_alone(Path.cwd(), "once"):
    print("made" if Path("made").exists() else "first", flush=True)
    sys.stdin.readline()
    Path("made").touch()
sys.stdin.readline()
"""
AT_ONCE = 0.5  # s, in which a process that does not wait would go on
SOON = 60.0  # s: less than a process is waited for that does not end


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("hard", "soft"):
        (tmp_path / f"{name}.py").write_text(NUMBERS.format(name=name.title()), encoding="utf-8")
    (tmp_path / "loop.py").write_text(LOOP, encoding="utf-8")
    return tmp_path


def around(folder: Path) -> dict[str, str]:
    """The environment of a process that finds a folder's modules, with a cache of its own."""
    path = os.pathsep.join([str(folder), *sys.path])
    return environment() | {"NUMBA_CACHE_DIR": str(folder / "cache"), "PYTHONPATH": path}


def called(folder: Path, *names: str) -> list[str]:
    """Results of calls with the numbers of some modules; how many were compiled, whether `soft` was imported."""
    return printed(folder, "-c", CALL, *names)


def printed(folder: Path, *words: str) -> list[str]:
    """What Python prints, with a cache of its own."""
    call, given = [sys.executable, *words], around(folder)
    done = subprocess.run(call, env=given, cwd=folder, capture_output=True, text=True, timeout=HANGS, check=False)
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


@contextmanager
def started(folder: Path, script: str) -> Iterator[subprocess.Popen[str]]:
    """A process that has said that it has begun, and waits for a line where the script does."""
    streams: dict[str, Any] = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with Job([sys.executable, "-c", script], folder, around(folder), **streams) as job:
        assert said(job.process) == "begun"
        yield job.process


def said(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    began, line = time.monotonic(), process.stdout.readline().strip()
    assert time.monotonic() - began < SOON
    return line


def answer(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    process.stdin.write("\n")
    process.stdin.flush()


def test_what_one_process_compiles_others_wait_for(folder: Path) -> None:
    with started(folder, SLOW) as first:
        assert said(first) == "compiling"
        with started(folder, SLOW) as second:
            time.sleep(AT_ONCE)
            answer(first)
            assert said(first) == "3.0"
            assert said(second) == "3.0"


def test_a_process_that_ends_while_it_compiles_holds_up_nobody(folder: Path) -> None:
    with started(folder, SLOW) as first:
        assert said(first) == "compiling"
        with started(folder, SLOW) as second:
            time.sleep(AT_ONCE)
            first.kill()
            assert said(second) == "compiling"
            answer(second)
            assert said(second) == "3.0"


def test_what_is_done_alone_at_first_is_done_at_once_later(tmp_path: Path) -> None:
    with started(tmp_path, ONCE) as first:
        assert said(first) == "first"
        with started(tmp_path, ONCE) as second:
            time.sleep(AT_ONCE)
            answer(first)
            assert said(second) == "made"
            with started(tmp_path, ONCE) as third:
                assert said(third) == "made"
