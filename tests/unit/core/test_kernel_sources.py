"""What compiled code depends on: an edit compiles the edited module anew and those that import it, and no others."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from riser_soil.core.kernel_sources import PACKAGE, SOURCES, PackageSources
from tests.support.on_ranks import HANGS, environment

SPEED = """
from riser_soil.core.compiled import njit

@njit
def speed(x):
    return 2.0 * x
"""
DRAG = """
from riser_soil.core.compiled import njit
from riser_soil.sea import speed as kernels

@njit
def drag(x):
    return kernels.speed(x) ** 2
"""
BUOYANCY = """
from riser_soil.core.compiled import njit

@njit
def buoyancy(x):
    return 3.0 * x
"""
LAW = """
from typing import NamedTuple
from riser_soil.core.by_type import by_type
from riser_soil.core.compiled import njit

@by_type
def stress(law, x):
    "Stress."

class Soft(NamedTuple):
    k: float

@njit
def pressed(law, x):
    return stress(law, x)
"""
SOFT = """
from riser_soil.soil.law import Soft, stress

@stress.of(Soft)
def _soft(law, x):
    return law.k * x
"""
FLOW = """
from riser_soil.core.by_type import by_type
from riser_soil.soil.law import Soft

@by_type
def flow(law, x):
    "Plastic flow, for which no other module asks."

@flow.of(Soft)
def _soft(law, x):
    return 0.0
"""
CALL = """
from numba.core import event
from riser_soil.sea.buoyancy import buoyancy
from riser_soil.sea.drag import drag
from riser_soil.soil import soft
from riser_soil.soil.law import Soft, pressed

class Compiled(event.Listener):
    names = set()

    def on_start(self, event):
        self.names.add(event.data["dispatcher"].py_func.__name__)

    def on_end(self, event):
        pass

event.register("numba:compile", Compiled())
print(drag(3.0), buoyancy(3.0), pressed(Soft(5.0), 3.0), *sorted(Compiled.names))
"""
FILES = {
    **dict.fromkeys(("__init__.py", "core/__init__.py", "sea/__init__.py", "soil/__init__.py"), ""),
    **{"sea/speed.py": SPEED, "sea/drag.py": DRAG, "sea/buoyancy.py": BUOYANCY},
    **{"soil/law.py": LAW, "soil/soft.py": SOFT, "soil/flow.py": FLOW},
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A package of the same name, with the compiler's layer and some kernels."""
    folder = tmp_path / "riser_soil"
    for file in SOURCES.needed(["riser_soil.core.by_type", "riser_soil.core.bound"]):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(PACKAGE / file, folder / file)
    for name, text in FILES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def called(package: Path, first: str = "") -> tuple[list[float], set[str]]:
    """Results of the kernels, and what was compiled for them. first: a statement before all others."""
    path = os.pathsep.join([str(package.parent), *sys.path])
    given = environment() | {"NUMBA_CACHE_DIR": str(package.parent / "cache"), "PYTHONPATH": path}
    call = [sys.executable, "-c", f"{first}\n{CALL}"]
    done = subprocess.run(
        call, env=given, cwd=package.parent, capture_output=True, text=True, timeout=HANGS, check=False
    )
    assert done.returncode == 0, done.stderr
    drag, buoyancy, pressed, *names = done.stdout.split()
    return [float(drag), float(buoyancy), float(pressed)], set(names)


def edit(file: Path, old: str, new: str) -> None:
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new), encoding="utf-8")


def test_an_edit_compiles_what_depends_on_it_and_nothing_else(package: Path) -> None:
    """Edits of a module that another one inlines, of one that none does, and of a kernel that is chosen by a type."""
    assert called(package)[0] == [36.0, 9.0, 15.0]
    assert called(package) == ([36.0, 9.0, 15.0], set())
    edit(package / "sea" / "speed.py", "2.0", "4.0")
    assert called(package) == ([144.0, 9.0, 15.0], {"drag", "speed"})
    edit(package / "sea" / "buoyancy.py", "3.0", "5.0")
    assert called(package) == ([144.0, 15.0, 15.0], {"buoyancy"})
    edit(package / "soil" / "soft.py", "law.k * x", "law.k * x + 1.0")
    values, names = called(package)
    assert values == [144.0, 15.0, 16.0]
    assert "pressed" in names
    assert not {"drag", "speed", "buoyancy"} & names


def test_kernels_that_are_chosen_by_a_type_count_where_they_are_called(package: Path) -> None:
    """What has been imported by then compiles nothing anew, though it has kernels for the same type."""
    called(package)
    assert called(package, first="import riser_soil.soil.flow") == ([36.0, 9.0, 15.0], set())


@pytest.mark.parametrize(
    ("name", "matters"),
    [("riser/kernel.py", True), ("riser/law.py", True), ("riser/numbers.py", True), ("plots.py", False)],
)
def test_sources_are_those_of_a_module_and_of_all_it_imports(tmp_path: Path, name: str, matters: bool) -> None:
    texts = {
        "riser/__init__.py": "",
        "riser/kernel.py": "from riser_soil.core.compiled import njit\nfrom riser_soil.riser.law import f\n",
        "riser/law.py": "from riser_soil.riser import (\n    numbers,\n)\n",
        "riser/numbers.py": "TWO = 2.0\n",
        "plots.py": "from riser_soil.riser import kernel\n",
    }
    folder = tmp_path / "riser_soil"
    (folder / "riser").mkdir(parents=True)
    for each, text in texts.items():
        (folder / each).write_text(text, encoding="utf-8")
    before = PackageSources(folder).word(["riser_soil.riser.kernel"])
    with (folder / name).open("a", encoding="utf-8") as file:
        file.write("# edited\n")
    assert (PackageSources(folder).word(["riser_soil.riser.kernel"]) != before) == matters


def test_kernels_of_a_line_do_not_depend_on_those_who_call_them() -> None:
    needed = SOURCES.needed(["riser_soil.riser.beam3d"])
    assert {"riser/beam3d.py", "riser/strain3d.py", "core/compiled.py"} <= needed
    assert not {"whole_run.py", "results/observer.py", "riser/inertia.py", "sea/morison.py"} & needed
