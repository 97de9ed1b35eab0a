"""What varies among load cases: paths of the scene in words, parameters with their labels, and the reference case."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from riser_soil.report.sources import TABLE, LoadCase, Sources, flattened, is_seed
from riser_soil.report.tables import given_value
from riser_soil.scene.explain import spot

PROPERTIES = (  # path of a line type's key, words, unit, how many of it are one of SI
    ("outer_diameter", "outer diameter", "mm", 1e3),
    ("inner_diameter", "inner diameter", "mm", 1e3),
    ("mass", "mass in air, empty", "kg/m", 1.0),
    ("submerged_weight", "submerged weight, contents included", "N/m", 1.0),
    ("EA", "axial stiffness EA", "MN", 1e-6),
    ("EI", "bending stiffness EI", "kN m²", 1e-3),
    ("EI_y", "bending stiffness EI, y", "kN m²", 1e-3),
    ("EI_z", "bending stiffness EI, z", "kN m²", 1e-3),
    ("GJ", "torsional stiffness GJ", "kN m²", 1e-3),
    ("wall.outer_diameter", "outer diameter of the steel wall", "mm", 1e3),
    ("wall.inner_diameter", "inner diameter of the steel wall", "mm", 1e3),
    ("wall.yield_stress", "specified minimum yield stress", "MPa", 1e-6),
    ("wall.design_factor", "allowable von Mises stress over yield stress", "-", 1.0),
    ("min_bend_radius", "allowable bend radius", "m", 1.0),
    ("max_tension", "allowable effective tension", "kN", 1e-3),
    ("drag.normal", "normal drag coefficient", "-", 1.0),
    ("drag.tangential", "tangential drag coefficient", "-", 1.0),
    ("added_mass.normal", "normal added mass coefficient", "-", 1.0),
    ("added_mass.tangential", "tangential added mass coefficient", "-", 1.0),
    ("damping.ratio", "structural damping, share of critical", "-", 1.0),
    ("damping.frequency", "frequency of that damping", "Hz", 1.0),
)
GROUND_WORDS = {
    "stiffness": ("stiffness per length of pipe", "kN/m²", 1e-3),
    "su": ("undrained shear strength at the mudline", "kPa", 1e-3),
    "su_gradient": ("its gradient with depth", "kPa/m", 1e-3),
    "gradient": ("gradient of the strength with depth", "kPa/m", 1e-3),
    "E": ("Young's modulus", "MPa", 1e-6),
    "submerged_unit_weight": ("submerged unit weight", "kN/m³", 1e-3),
}
_PATHS = {"vessel.offset": "offset of the vessel", "seed": "seed", "Hs": "Hs", "Tp": "Tp", "direction_deg": "direction"}
_NO_PARAMETERS = ("error_bars", "output", "title")  # keys of the scene that don't change what it is of
_MIDDLE = ("mean", "best", "best estimate", "best-estimate", "base")


@dataclass(frozen=True)
class Parameter:
    """What varies among cases: paths of the scene that change together, in the words of an axis or of the language.

    labels: what its values are called, by the values of the scene.
    """

    paths: tuple[str, ...]
    words: str
    labels: Mapping[str, str]

    def of(self, case: LoadCase) -> str:
        """The case's value, as text."""
        return _text(case, self.paths)

    def label(self, value: str) -> str:
        return self.labels.get(value, value)


def parameters(cases: Sequence[LoadCase]) -> list[Parameter]:
    """All that varies among cases but seeds; paths that always change together are one parameter."""
    paths = dict.fromkeys(
        path
        for case in cases
        for path in case.given
        if not is_seed(path) and path.partition(".")[0] not in _NO_PARAMETERS
    )
    together: dict[tuple[int, ...], list[str]] = {}
    for path in paths:
        values = [_text(case, (path,)) for case in cases]
        numbers = tuple(values.index(value) for value in values)
        if len(set(values)) > 1:
            together.setdefault(numbers, []).append(path)
    return [_parameter(tuple(each), cases) for each in together.values()]


def _text(case: LoadCase, paths: Sequence[str]) -> str:
    return "; ".join(given_value(case.value(path)) for path in paths)


def _parameter(paths: tuple[str, ...], cases: Sequence[LoadCase]) -> Parameter:
    """Parameter in the words of the axis of a case file whose labels go with its values one by one, if there is one."""
    axes = dict.fromkeys(axis for case in cases for axis in case.axes)
    for axis in (axis for axis in axes if "." not in axis and axis != TABLE and not is_seed(axis)):
        pairs = {(case.axes[axis], _text(case, paths)) for case in cases if axis in case.axes}
        labels = {value: label for label, value in pairs}
        if 1 < len(pairs) == len(labels) == len({label for label, _ in pairs}):
            return Parameter(paths, axis, labels)
    return Parameter(paths, words_of_path(paths[0]), {})


def reference_of(sources: Sources) -> LoadCase:
    """The case that the report file names; else the first that has most values in common with the others, of equal ones
    that of mean or best values.
    """
    cases, names = sources.cases, parameters(sources.cases)
    if sources.given.reference is not None:
        return next(case for case in cases if case.name == sources.given.reference)
    counts = {name.paths: Counter(name.of(case) for case in cases) for name in names}

    def common(case: LoadCase) -> tuple[int, int]:
        middle = sum(name.label(name.of(case)) in _MIDDLE or not set(name.of(case)) - set("0, ") for name in names)
        return sum(counts[name.paths][name.of(case)] for name in names), middle

    return max(cases, key=common)


def seeds_of(case: LoadCase) -> tuple[str, ...]:
    """The seeds of the case: of its axis, else of the waves of its scene, as text."""
    named = tuple(value for axis, value in case.axes.items() if is_seed(axis))
    if named:
        return named
    waves = case.value("water.waves")
    return tuple(str(value) for path, value in flattened(waves, "waves") if is_seed(path))


def in_words(description: str) -> tuple[str, str]:
    """First clause of a key's description, and its unit."""
    head, _, rest = description.partition(" [")
    unit = rest.partition("]")[0] if rest and " " not in rest.partition("]")[0] else ""
    clause = (head if unit else description).split("; ")[0].split(", {")[0]
    return clause.rstrip(".,"), "" if unit == "-" else unit


def words_of_path(path: str) -> str:
    """Name of a path of the scene: "normal drag coefficient", else by the language's description."""
    key = path.rpartition(".")[2]
    for name, words, _, _ in PROPERTIES:
        if path.startswith("line_types.") and path.split(".", 2)[2] == name:
            return words
    if path in _PATHS or key in _PATHS:
        return _PATHS.get(path) or _PATHS[key]
    if path.startswith("seabed.") and key == "stiffness":
        return "stiffness of the seabed"
    if key in GROUND_WORDS:
        return GROUND_WORDS[key][0]
    parts = tuple(int(part) if part.isdecimal() else part for part in path.split("."))
    try:
        description = spot(parts).description
    except (KeyError, IndexError, ValueError, TypeError):
        description = ""
    return in_words(description)[0] if description else key.replace("_", " ")
