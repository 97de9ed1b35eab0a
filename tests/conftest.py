"""What all tests share: a process that Ctrl-C interrupts. What a script starts in the background ignores it, and passes
that on to all that it starts; a handler, though, ends where another program begins. Before anything else is imported,
as gmsh remembers how it found Ctrl-C. What runs keep for others of their compliance is not kept, nor read.

Files that take long stand in long_files.txt, and are the first that workers take, so that none is left with one at the
end. Those that start ranks stand apart, so that few ranks at a time share the cores.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
from functools import partial
from pathlib import Path

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

os.environ["RISER_SOIL_COMPLIANCE"] = "off"
os.environ["RISER_SOIL_COMPILERS"] = "1"  # tests are several processes already

import numba
import pytest
from hypothesis import settings

from tests.support.pages import Tell, compare

gc.set_threshold(100_000, 10, 10)  # in what compiling kernels makes a search for garbage takes a tenth of its time

settings.register_profile("unhurried", deadline=None)  # nothing hangs on how busy the machine is
settings.load_profile("unhurried")


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--page", action="store_true", help="write what tests find to its places in the pages")


@pytest.fixture
def uncompiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels run as Python: formulas alone are tested, in less time than it takes to compile them for all laws and
    grounds. Others see to it that compiled code does the same (`tests/scenes/test_uncompiled.py`).
    """
    monkeypatch.setattr(numba.config, "DISABLE_JIT", True)


@pytest.fixture
def tell(request: pytest.FixtureRequest) -> Tell:
    """Compares what a test has found, by the names of figures, with what the pages tell; writes it there by --page."""
    return partial(compare, write=request.config.getoption("--page"))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    tests = Path(__file__).parent
    long = [tests / name for name in (tests / "long_files.txt").read_text(encoding="utf-8").splitlines()]
    places = {path: n for n, path in enumerate(long)}
    items.sort(key=lambda item: places.get(item.path, len(long)))


def pytest_sessionfinish() -> None:
    """Coverage of a worker is written before it ends, which it may do without notice."""
    if (measured := sys.modules.get("coverage")) and (running := measured.Coverage.current()):
        running.save()
