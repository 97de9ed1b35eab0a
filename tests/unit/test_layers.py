"""Data flow one way: a module imports only from layers before its own, and heavy packages stay where they belong."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

import riser_soil

PACKAGE = Path(riser_soil.__file__).parent

LAYERS: list[tuple[str, ...]] = [  # modules of one layer do not import one another
    ("errors", "arrays", "compiled", "smooth_step", "machine", "standard_output"),
    ("part", "snapshot", "interruption"),
    ("scene", "dolfinx_compat", "time_scheme", "roles"),
    ("riser",),
    ("sea", "soil", "seabed", "motion"),
    ("contact",),
    ("build",),
    ("numbering", "stepping", "auto_steps", "extrapolation"),
    ("matrix",),
    ("system",),
    ("direct_solver",),
    ("stability",),
    ("mass", "newton"),
    ("local_error", "buckling"),
    ("march", "relax"),
    ("folder", "schedule", "progress", "inventory", "estimate", "wave_doubts", "motion_doubts", "bending_doubts"),
    ("growing_file", "simulated_time", "ground_doubts"),
    ("ownership", "doubts", "limits"),
    ("netcdf", "xdmf", "summary", "screen", "balance", "touchdown_zone", "plausibility", "overload"),
    ("record_rows",),
    ("record",),
    ("observe",),
    ("run", "check"),
    ("results",),
    ("derived",),
    ("plots",),
    ("__main__",),
]
RANK = {module: rank for rank, layer in enumerate(LAYERS) for module in layer}

ONLY_IN = {  # what costs time to import, or may be absent, and the layers that need it
    "dolfinx": {"dolfinx_compat", "soil"},
    "ufl": {"dolfinx_compat", "soil"},
    "basix": {"dolfinx_compat", "soil"},
    "gmsh": {"dolfinx_compat", "soil"},
    "matplotlib": {"plots"},
    "pyvista": {"plots"},
    "riser_soil.dolfinx_compat": {"soil"},
    "numba": {"compiled"},
}


def imported_names(source: str, package: str) -> Iterator[str]:
    """Full names of everything that `source`, in `package`, imports at module level or inside functions."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            yield from (f"{base}.{alias.name}" for alias in node.names)


def violations(layer: str, source: str, package: str = "riser_soil") -> list[str]:
    """Imports of a module of `layer` from its own rank or later, or of a package that is kept elsewhere."""
    found = []
    for name in imported_names(source, package):
        target = name.split(".")[1] if name.startswith("riser_soil.") else ""
        if target in RANK and target != layer and RANK[target] >= RANK[layer]:
            found.append(f"{layer} imports {name}, which is not in a layer before it")
        for kept, allowed in ONLY_IN.items():
            if (name + ".").startswith(kept + ".") and layer not in allowed:
                found.append(f"{layer} imports {name}, which is kept to {', '.join(sorted(allowed))}")
    return found


def modules() -> list[Path]:
    return sorted(path for path in PACKAGE.rglob("*.py") if path != PACKAGE / "__init__.py")


def layer_of(path: Path) -> str:
    return path.relative_to(PACKAGE).with_suffix("").parts[0]


@pytest.mark.parametrize("path", modules(), ids=lambda path: str(path.relative_to(PACKAGE)))
def test_module_imports_only_from_layers_before(path: Path) -> None:
    assert layer_of(path) in RANK, f"give {layer_of(path)} its place in LAYERS"
    package = ".".join(("riser_soil", *path.relative_to(PACKAGE).parts[:-1]))
    assert violations(layer_of(path), path.read_text(), package) == []


def test_package_itself_imports_nothing_heavy() -> None:
    names = set(imported_names((PACKAGE / "__init__.py").read_text(), "riser_soil"))
    assert not {name.split(".")[0] for name in names} - {"riser_soil", "importlib", "typing"}


@pytest.mark.parametrize(
    ("layer", "source", "package"),
    [
        ("scene", "from riser_soil.contact import pairing", "riser_soil.scene"),
        ("soil", "from riser_soil.sea.waves import Airy", "riser_soil.soil"),
        ("riser", "def f():\n    from riser_soil import run", "riser_soil.riser"),
        ("riser", "from ..contact import pairing", "riser_soil.riser"),
        ("part", "from .system import System", "riser_soil"),
        ("record", "import riser_soil.results", "riser_soil"),
        ("riser", "import dolfinx.fem", "riser_soil.riser"),
        ("contact", "from riser_soil import dolfinx_compat", "riser_soil.contact"),
    ],
)
def test_wrong_import_is_found(layer: str, source: str, package: str) -> None:
    assert len(violations(layer, source, package)) == 1


@pytest.mark.parametrize(
    ("layer", "source", "package"),
    [
        ("contact", "from riser_soil.riser.hermite import shape", "riser_soil.contact"),
        ("riser", "from .rotations import exp", "riser_soil.riser"),
        ("soil", "import dolfinx\nfrom riser_soil import dolfinx_compat", "riser_soil.soil"),
        ("arrays", "import numpy as np", "riser_soil"),
    ],
)
def test_right_import_passes(layer: str, source: str, package: str) -> None:
    assert violations(layer, source, package) == []
