"""Settings of a scene that determine its accuracy, and variants of the scene that are finer in them.

A setting is varied by a factor of fineness: 2 gives twice the elements, half the time step (of automatic steps: an
eighth of the tolerance, which halves them), cells of the soil of half the size, twice the penalty. A scene has only
some settings: soil of a mesh file has no mesh to vary, a bed of springs or of hysteretic clay no penalty.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

from riser_soil.assembly import sized
from riser_soil.assembly.assembly import AUTO_TOLERANCE
from riser_soil.assembly.contact_laws import NARROWEST_CORNER, stiffnesses
from riser_soil.assembly.riser import elements_of
from riser_soil.assembly.scales import Scales, of_several, scales_of
from riser_soil.core.quantities import MOST_ELEMENTS
from riser_soil.errors import SceneError
from riser_soil.scene.lines import by_line, risers, with_segments
from riser_soil.scene.riser import Segment
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import RigidSeabed
from riser_soil.scene.soil import CellSizes, GeneratedMesh, MeshFile
from riser_soil.scene.stages import DynamicStage, Stage

HELPING = ("elements", "time_step")  # names of settings that are refined where a scene fails
LOCAL_ORDER = 3  # order of the local error of automatic steps in their size
FIRM = 50.0  # firm penalty over the automatic one on soil: penetration is 2e-4 of a settlement, not 1e-2


@dataclass(frozen=True, eq=False)
class Setting:
    """A setting of a scene.

    exists: whether a scene has it. finer: the scene with it finer by a factor. fineness: of a scene in it (elements,
    1/s, 1/m, N/m2); the ratio of two scenes' fineness differs from the factor where counts are rounded. in_words: the
    scene's setting in words.
    """

    name: str
    words: str
    exists: Callable[[Scene], bool]
    finer: Callable[[Scene, float], Scene]
    fineness: Callable[[Scene], float]
    in_words: Callable[[Scene], str]


def settings_of(scene: Scene) -> tuple[Setting, ...]:
    """Settings that the scene has."""
    return tuple(setting for setting in SETTINGS if setting.exists(scene))


def varied(scene: Scene, setting: Setting, factor: float) -> Scene:
    """The scene with the setting finer by a factor, the scene itself for 1; SceneError where that can't be.

    All else stays. A setting that is `auto` is varied from the number that it means.
    """
    if factor == 1.0:
        return scene
    finer = setting.finer(resolved(scene), factor)
    if _elements(finer) > MOST_ELEMENTS:
        raise SceneError(f"{setting.words}, {factor:g} times as fine: more than {MOST_ELEMENTS} elements")
    return finer


def refined(scene: Scene, factors: Mapping[str, float]) -> Scene:
    """The scene finer by factors, by names of settings; those that it does not have are ignored.

    SceneError where one can't be.
    """
    for setting in settings_of(scene):
        scene = varied(scene, setting, factors.get(setting.name, 1.0))
    return scene


def settings_in_words(scene: Scene, settings: Iterable[Setting] | None = None) -> str:
    """The scene's settings in words. settings: to be named, by default all."""
    return ", ".join(setting.in_words(scene) for setting in (settings_of(scene) if settings is None else settings))


def resolved(scene: Scene) -> Scene:
    """The scene with numbers where settings are `auto`, which gives the same results.

    With soil beside a rigid seabed, and with several lines, all have the largest of their penalties.
    """
    return _with_stiffness(_with_tolerance(sized(scene)))


def _with_tolerance(scene: Scene) -> Scene:
    if not any(isinstance(stage, DynamicStage) and stage.time_step == "auto" for stage in scene.stages):
        return scene
    tolerance = AUTO_TOLERANCE * _scales(scene).diameter

    def with_number(stage: Stage) -> Stage:
        if not isinstance(stage, DynamicStage) or stage.time_step != "auto" or stage.tolerance is not None:
            return stage
        return stage.model_copy(update={"tolerance": tolerance})

    return scene.model_copy(update={"stages": tuple(with_number(stage) for stage in scene.stages)})


def _with_stiffness(scene: Scene) -> Scene:
    if not _has_penalty(scene) or scene.contact is None or scene.contact.stiffness != "auto":
        return scene
    values: list[float] = []
    for view in by_line(scene).values():
        of_each = stiffnesses(view, scene.contact, _scales(view))
        if not isinstance(scene.seabed, RigidSeabed):
            of_each.pop("seabed", None)  # a bed of springs has its own
        values += of_each.values()
    contact = scene.contact.model_copy(update={"stiffness": max(values)})
    return scene.model_copy(update={"contact": contact})


def _scales(scene: Scene) -> Scales:
    """Typical sizes of all lines together."""
    return of_several(scales_of(elements_of(view)) for view in by_line(scene).values())


def _elements(scene: Scene) -> int:
    return sum(line.element_count for line in risers(scene).values())


def _has_steps(scene: Scene) -> bool:
    return any(isinstance(stage, DynamicStage) for stage in scene.stages)


def _has_soil_mesh(scene: Scene) -> bool:
    return scene.soil is not None and not isinstance(scene.soil.mesh, MeshFile)


def _has_penalty(scene: Scene) -> bool:
    return scene.soil is not None or isinstance(scene.seabed, RigidSeabed)


def _finer_elements(scene: Scene, factor: float) -> Scene:
    lines = risers(scene).items()
    return with_segments(scene, {name: tuple(_cut(each, factor) for each in line.segments) for name, line in lines})


def _cut(segment: Segment, factor: float) -> Segment:
    """A segment with finer elements, at least one; graded lengths stay graded."""
    if segment.elements is not None:
        return segment.model_copy(update={"elements": max(1, round(segment.elements * factor))})
    given = segment.element_length
    assert given is not None
    finer = tuple(x / factor for x in given) if isinstance(given, tuple) else given / factor
    return segment.model_copy(update={"element_length": finer})


def _shorter_steps(scene: Scene, factor: float) -> Scene:
    return scene.model_copy(update={"stages": tuple(_stepped(stage, factor) for stage in scene.stages)})


def _stepped(stage: Stage, factor: float) -> Stage:
    """A stage with shorter steps; given ones are at most its duration."""
    if not isinstance(stage, DynamicStage):
        return stage
    if stage.time_step != "auto":
        return stage.model_copy(update={"time_step": min(stage.time_step / factor, stage.duration)})
    assert stage.tolerance is not None  # resolved
    return stage.model_copy(update={"tolerance": stage.tolerance / factor**LOCAL_ORDER})


def _finer_soil(scene: Scene, factor: float) -> Scene:
    """The scene with smaller cells of the soil; the strip of cells of one size keeps its width."""
    soil = scene.soil
    assert soil is not None
    assert isinstance(soil.mesh, GeneratedMesh)  # resolved
    at = soil.mesh.size_at_riser
    if isinstance(at, CellSizes):
        divided = {"along": at.along / factor, "across": at.across / factor, "strip": soil.mesh.strip}
        finer: CellSizes | float = at.model_copy(update=divided)
    else:
        finer = at / factor
    mesh = soil.mesh.model_copy(update={"size_at_riser": finer, "size_far": soil.mesh.size_far / factor})
    return scene.model_copy(update={"soil": soil.model_copy(update={"mesh": mesh})})


def _stiffer_penalty(scene: Scene, factor: float) -> Scene:
    """The scene with a stiffer penalty; on soil alone it becomes at most firm, as a stiffer one is no more accurate."""
    contact, before = scene.contact, _penalty(scene)
    assert contact is not None
    stiffness = max(before, min(before * factor, _firm(scene))) if factor > 1.0 else before * factor
    made = {"stiffness": stiffness} | _corner(scene, stiffness)
    return scene.model_copy(update={"contact": contact.model_copy(update=made)})


def _corner(scene: Scene, stiffness: float) -> dict[str, float]:
    """Smoothing of the penalty for a stiffer rigid seabed, as changed keys of `contact`.

    If the automatic smoothing would be wider than the penetration by the riser's weight, it becomes that penetration,
    also if it was that before. Beside an end that is fixed on the seabed a wider one presses the riser by a force that
    grows with the penalty without limit.
    """
    contact = scene.contact
    if contact is None or scene.soil is not None:
        return {}
    scales = _scales(scene)
    width, at_rest = contact.smoothing, scales.weight / stiffness
    if width == "auto":
        return {"smoothing": at_rest} if at_rest < NARROWEST_CORNER * scales.diameter else {}
    follows = math.isclose(float(width) * _penalty(scene), scales.weight, rel_tol=1e-6)
    return {"smoothing": at_rest} if follows else {}


def _penalty(scene: Scene) -> float:
    """Force per length and penetration [N/m2]."""
    contact = _with_stiffness(scene).contact
    assert contact is not None
    return float(contact.stiffness)


def is_firm(scene: Scene) -> bool:
    """Whether the penalty of contact with soil is so stiff that a stiffer one has no effect."""
    return _has_penalty(scene) and _penalty(scene) > 0.5 * _firm(scene)


def _firm(scene: Scene) -> float:
    """Firm penalty on soil [N/m2]; inf with a rigid seabed, where its error beside a fixed end falls slowly."""
    if scene.soil is None or isinstance(scene.seabed, RigidSeabed):
        return math.inf
    assert scene.contact is not None
    contact = scene.contact.model_copy(update={"stiffness": "auto"})
    return FIRM * _penalty(scene.model_copy(update={"contact": contact}))


def _across(scene: Scene) -> float:
    """Size of the cells across the riser [m]."""
    soil = sized(scene).soil
    assert soil is not None
    assert isinstance(soil.mesh, GeneratedMesh)
    return soil.mesh.across


def _first_steps(scene: Scene) -> DynamicStage:
    return next(stage for stage in _with_tolerance(scene).stages if isinstance(stage, DynamicStage))


def _steps_per_time(scene: Scene) -> float:
    """Steps per time of the first dynamic stage [1/s]; for automatic steps up to a constant factor."""
    stage = _first_steps(scene)
    if stage.time_step != "auto":
        return 1.0 / float(stage.time_step)
    assert stage.tolerance is not None
    return float(stage.tolerance ** (-1.0 / LOCAL_ORDER))


def _steps_in_words(scene: Scene) -> str:
    stage = _first_steps(scene)
    automatic = stage.time_step == "auto"
    return f"time_step auto, tolerance {stage.tolerance:.4g} m" if automatic else f"time_step {stage.time_step:.4g} s"


SETTINGS = (
    Setting(
        "elements", "elements of the riser", lambda scene: True, _finer_elements,
        lambda scene: float(_elements(scene)), lambda scene: f"{_elements(scene)} elements",
    ),
    Setting("time_step", "time step", _has_steps, _shorter_steps, _steps_per_time, _steps_in_words),
    Setting(
        "soil_mesh", "mesh of the soil", _has_soil_mesh, _finer_soil,
        lambda scene: 1.0 / _across(scene), lambda scene: f"soil cells of {_across(scene):.4g} m across the riser",
    ),
    Setting(
        "penalty", "penalty of contact", _has_penalty, _stiffer_penalty, _penalty,
        lambda scene: f"contact.stiffness {_penalty(scene):.4g} N/m2",
    ),
)  # fmt: skip
