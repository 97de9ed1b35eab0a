"""Data flow one way: no folder imports from a later one, no modules import each other in a circle, and heavy packages
stay where they belong. Imports inside functions and for type checkers count as all others do.
"""

import ast
from collections.abc import Mapping
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import riser_soil

PACKAGE = Path(riser_soil.__file__).parent

LAYERS: list[tuple[str, ...]] = [  # folders, and modules of the root, of one layer do not import one another
    ("errors", "standard_output"),
    ("interruption",),
    ("core",),
    ("seabed",),
    ("soil",),
    ("scene", "riser"),
    ("sea", "motion", "code_checks"),
    ("contact",),
    ("bodies",),
    ("solve",),
    ("assembly",),
    ("checks",),
    ("results",),
    ("statistics", "imported_scene"),
    ("stages", "plots"),
    ("variants",),
    ("whole_run", "material", "calibration", "modes", "hang_off", "moordyn", "orcaflex", "drafts", "fatigue"),
    ("accuracy",),
    ("cases", "report"),
    ("api",),
    ("commands",),
    ("__main__",),
]
RANK = {name: rank for rank, layer in enumerate(LAYERS) for name in layer}

ONLY_IN: dict[str, str | tuple[str, ...]] = {  # what costs time to import, or may be absent, and where it is needed
    "dolfinx": "riser_soil.soil",
    "ufl": "riser_soil.soil",
    "basix": "riser_soil.soil",
    "gmsh": "riser_soil.soil",
    "riser_soil.soil.dolfinx_compat": "riser_soil.soil",
    "matplotlib": "riser_soil.plots",
    "pyvista": "riser_soil.plots",
    "jinja2": "riser_soil.report",
    "weasyprint": "riser_soil.report",
    "docx": "riser_soil.report",
    "numba": "riser_soil.core",
    "llvmlite": "riser_soil.core.rows",
    "fatpack": "riser_soil.fatigue",
    "scipy.optimize": ("riser_soil.calibration", "riser_soil.assembly.hang_off", "riser_soil.hang_off"),
    "scipy.stats": ("riser_soil.calibration", "riser_soil.statistics"),
    "scipy.signal": "riser_soil.statistics",
    "xarray": ("riser_soil.results", "riser_soil.cases", "riser_soil.modes"),
    "distributed": "riser_soil.variants",
    "dask": "riser_soil.variants",
    "raschii": "riser_soil.sea",
}


@cache
def imported_names(source: str, package: str) -> list[str]:
    """Full names of everything that `source`, in `package`, imports at module level or inside functions."""
    names = list[str]()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            names += (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            names += (f"{base}.{alias.name}" for alias in node.names)
    return names


def within(name: str, place: str) -> bool:
    return (name + ".").startswith(place + ".")


def package_of(module: str, path: Path) -> str:
    return module if path.name == "__init__.py" else module.rpartition(".")[0]


def violations(module: str, source: str, package: str) -> list[str]:
    """Imports of a module from its own layer's other folders or from later ones, or of what is kept elsewhere."""
    wrong, mine = [], module.split(".")[1]
    for name in imported_names(source, package):
        target = name.split(".")[1] if name.startswith("riser_soil.") else ""
        if target in RANK and target != mine and RANK[target] >= RANK[mine]:
            wrong.append(f"{module} imports {name}, which is not in a layer before it")
        for kept, where in ONLY_IN.items():
            places = where if isinstance(where, tuple) else (where,)
            if within(name, kept) and not any(within(module, place) for place in places):
                wrong.append(f"{module} imports {name}, which is kept to {' and '.join(places)}")
    return wrong


@cache
def modules() -> dict[str, Path]:
    """All modules of the package but itself."""
    names = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        names[".".join(("riser_soil", *(parts[:-1] if parts[-1] == "__init__" else parts)))] = path
    del names["riser_soil"]
    return names


@cache
def imports() -> dict[str, set[str]]:
    """Module -> the modules that it imports: the longest name of one in each name imported."""
    known, graph = modules(), {}
    for module, path in known.items():
        names = imported_names(path.read_text(), package_of(module, path))
        candidates = {name if name in known else name.rpartition(".")[0] for name in names}
        graph[module] = (candidates & known.keys()) - {module}
    return graph


def circle(graph: Mapping[str, set[str]]) -> list[str]:
    """Modules that import each other, the first again at the end; empty where there is no circle."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as found:
        return list(found.args[1])
    return []


@pytest.mark.parametrize("module", modules())
def test_module_imports_only_from_layers_before(module: str) -> None:
    path = modules()[module]
    place = module.split(".")[1]
    assert place in RANK, f"give {place} its place in LAYERS"
    assert violations(module, path.read_text(), package_of(module, path)) == []


def test_no_modules_import_each_other_in_a_circle() -> None:
    assert circle(imports()) == []


def test_a_circle_is_found() -> None:
    assert set(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})) == {"a", "b", "c"}
    assert circle({"a": {"b"}, "b": {"c"}, "d": {"a"}}) == []


def test_imports_for_type_checkers_and_inside_functions_count() -> None:
    assert "riser_soil.solve.newton" in imports()["riser_soil.stages"]
    source = "if TYPE_CHECKING:\n    from riser_soil import a\ndef f():\n    from riser_soil.b import c"
    assert imported_names(source, "riser_soil") == ["riser_soil.a", "riser_soil.b.c"]


def test_package_itself_imports_nothing_heavy() -> None:
    names = set(imported_names((PACKAGE / "__init__.py").read_text(), "riser_soil"))
    assert not {name.split(".")[0] for name in names} - {"riser_soil", "importlib", "typing"}


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("scene.reader", "from riser_soil.contact import pairing"),
        ("soil.soil", "from riser_soil.sea.waves import Airy"),
        ("riser.line", "def f():\n    from riser_soil import whole_run"),
        ("riser.line", "from ..contact import pairing"),
        ("core.part", "from ..solve.newton import Newton"),
        ("results.record", "import riser_soil.plots.curves"),
        ("riser.line", "import dolfinx.fem"),
        ("contact.law", "from riser_soil.soil import dolfinx_compat"),
        ("riser.line", "import numba"),
    ],
)
def test_wrong_import_is_found(module: str, source: str) -> None:
    package = f"riser_soil.{module.split('.')[0]}"
    assert violations(f"riser_soil.{module}", source, package) != []


@pytest.mark.parametrize(
    ("module", "source"),
    [
        ("contact.law", "from riser_soil.riser.hermite import shape"),
        ("riser.line", "from .rotations import exp"),
        ("soil.soil", "import dolfinx\nfrom riser_soil.soil import dolfinx_compat"),
        ("core.arrays", "import numpy as np"),
        ("core.compiled", "import numba"),
    ],
)
def test_right_import_passes(module: str, source: str) -> None:
    package = f"riser_soil.{module.split('.')[0]}"
    assert violations(f"riser_soil.{module}", source, package) == []
