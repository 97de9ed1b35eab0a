"""Kernels are functions of Python: with numba's compiler off they compute what they do compiled."""

from __future__ import annotations

import json
import re
import sys
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.support.on_ranks import ROOT, environment, finished
from tests.support.pages import blocks
from tests.support.scenes import LAY, Mapping, heave

OFF = {"NUMBA_DISABLE_JIT": "1"}
BARS = 200  # of catenaries: as Python alone, ten times as many take most of the time
PIPE = {"outer_diameter": 0.3, "inner_diameter": 0.2, "mass": 120.0, "EA": 3.0e8, "EI": 5.0e4, "GJ": 4.0e4}
IN_WATER = {"drag": {"normal": 1.1}, "added_mass": {"normal": 1.0}}


def scene(water: Mapping, seabed: Mapping, end: tuple[float, float, float], **more: Any) -> Mapping:
    """A short pipe of a few elements that comes down on a seabed while its upper end heaves."""
    segments = [{"line_type": "pipe", "length": length, "elements": n} for length, n in ((12.0, 3), (28.0, 3))]
    return {
        "water": {"density": 1025.0, **water},
        "line_types": {"pipe": PIPE | IN_WATER},
        "riser": {
            "segments": segments,
            "contents": {"density": 850.0},
            "start": {"position": [0.0, 0.0, 0.15]},
            "end": {"position": list(end)},
        },
        "seabed": seabed,
        "stages": [LAY, heave(1.0)],
        **more,
    }


PLANE = scene({}, {"kind": "spring", "stiffness": 1.0e5}, (24.0, 0.0, 25.0))
SPACE = scene(
    {
        "surface_level": 22.0,
        "waves": {"jonswap": {"Hs": 2.0, "Tp": 8.0, "seed": 1, "components": 3, "direction_deg": 40.0}},
        "current": {"profile": [[0.0, 0.1, 0.2], [22.0, 0.2, 0.3]]},
    },
    {"kind": "hysteretic", "law": {"kind": "randolph-quiggin", "su": 2.0e3, "su_gradient": 1.5e3}},
    (24.0, 2.0, 25.0),
    contact={"friction": {"axial": 0.4, "lateral": 0.6, "mobilisation": 0.02}},
)
SCENES = {"plane": PLANE, "space": SPACE}


@pytest.fixture(scope="module")
def computed(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """What `few_steps` finds of a scene, by its name and whether it is compiled."""

    @cache
    def steps(name: str, compiled: bool) -> dict[str, Any]:
        folder = tmp_path_factory.mktemp(name)
        (folder / "scene.yaml").write_text(json.dumps(SCENES[name]), encoding="utf-8")
        given = map(str, (ROOT / "tests/support/few_steps.py", folder / "scene.yaml", folder, BARS))
        done = finished([sys.executable, *given], folder, environment() | ({} if compiled else OFF))
        assert done.returncode == 0, done.stderr
        assert "RuntimeWarning" not in done.stderr
        data: dict[str, Any] = json.loads((folder / "found.json").read_text(encoding="utf-8"))
        return data

    return steps


@pytest.mark.parametrize("name", [pytest.param("plane", marks=pytest.mark.verify), "space"])
def test_a_step_is_the_same_with_the_compiler_off(name: str, computed: Any) -> None:
    compiled, plain = computed(name, True), computed(name, False)
    assert set(compiled["kernels"]) <= set(plain["kernels"])
    assert len(compiled["kernels"]) > 30
    assert plain["iterations"] == compiled["iterations"]
    uncompiled, expected = np.array(plain["last"]), np.array(compiled["last"])
    assert np.abs(expected).max() > 0.01
    np.testing.assert_allclose(uncompiled, expected, rtol=1e-6, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize(
    ("modules", "scenes"),
    [
        (r"riser\.(beam3d|corotation|rotations|spatial_directors|strain3d)\.", {"space"}),
        (r"contact\.(friction|coulomb)\.", {"space"}),
        (r"sea\.(wave|waterline|current|stream|moving_water)", {"space"}),
        (r"seabed\.randolph_quiggin_formula\.", {"space"}),
        (r"sea\.morison\.", {"plane"}),
        (r"contact\.law\.", {"plane"}),
        (r"riser\.tension_only\.(blend|set_spring|_heaped)", set()),
        (r"soil\.|bodies\.|contact\.(surface|node|pressed|soil)|riser\.(springs|contents|damping)", set()),
    ],
)
def test_kernels_of_what_a_scene_lacks_are_not_called(modules: str, scenes: set[str], computed: Any) -> None:
    """A kernel that nothing calls or binds is never compiled."""
    called = {name: computed(name, False)["kernels"] for name in SCENES}
    pattern = re.compile(rf"riser_soil\.({modules})")
    assert {name for name, kernels in called.items() if any(map(pattern.match, kernels))} == scenes


#: Kernels that Python calls or binds, by scene, at most; each brings those that it calls.
MOST = {
    "demos/first_scene.yaml": 70,
    "tests/scenes/steel_catenary.yaml": 70,
    "tests/scenes/storm.yaml": 100,
    "demos/touchdown_clay/scene.yaml": 110,
}
LACKED = {  # modules of parts that are not there
    "demos/first_scene.yaml": r"riser\.(beam3d|strain3d)|sea\.(wave|current|buoyancy)|contact\.(friction|coulomb)|soil",
    "tests/scenes/steel_catenary.yaml": r"riser\.(beam3d|strain3d)|sea\.(wave|current|buoyancy)|contact\.coulomb|soil",
    "tests/scenes/storm.yaml": r"riser\.(beam2d|springs)|sea\.(morison|vortices)|contact\.(surface|node)|soil",
    "demos/touchdown_clay/scene.yaml": r"riser\.(beam3d|strain3d|springs)|sea\.(wave|vortices|buoyancy)|bodies",
}
LONG = dict.fromkeys(("tests/scenes/steel_catenary.yaml", "demos/touchdown_clay/scene.yaml"), pytest.mark.verify)


@pytest.mark.parametrize("path", [pytest.param(path, marks=LONG.get(path, ())) for path in MOST])
def test_no_more_kernels_than_a_scene_needs(path: str, tmp_path: Path) -> None:
    script = ROOT / "tests/support/few_steps.py"
    done = finished([sys.executable, str(script), path, str(tmp_path)], ROOT, environment())
    assert done.returncode == 0, done.stderr
    found = json.loads((tmp_path / "found.json").read_text(encoding="utf-8"))
    kernels = found["kernels"]
    assert 50 < len(kernels) <= MOST[path]
    of_parts = re.compile(r"riser_soil\.(riser|sea|contact)\.\w+\._\w*(forces|tangent|energy|work)_")
    assert not list(filter(of_parts.match, found["late"]))  # a solver compiles them together, before its first step
    assert not [each for each in kernels if re.match(rf"riser_soil\.({LACKED[path]})", each)]


@pytest.mark.parametrize("given", [{}, OFF])
def test_the_examples_of_the_page_on_kernels_run(given: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "page.py").write_text("\n".join(blocks(ROOT / "docs/kernels.md", "python")), encoding="utf-8")
    done = finished([sys.executable, str(tmp_path / "page.py")], ROOT, environment() | given)
    assert done.returncode == 0, done.stderr
