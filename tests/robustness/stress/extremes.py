"""Extremes of a scene: the same scene with one of its properties very large, very small or left out."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from pydantic import BaseModel

from riser_soil.scene.lines import acts_on, risers, with_acts, with_risers
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import StaticStage, varying_in
from riser_soil.variants.settings import SETTINGS, varied

BASE = "as it is"
CLOSE, NEAR, SAME = 0.02, 0.1, 1e-4  # what key results may differ by, of their scales
FACTORS = {
    "elements": ((0.25, NEAR), (2.0, NEAR)),
    "time_step": ((0.1, NEAR), (1.0 / 3.0, NEAR)),
    "soil_mesh": ((0.5, None), (1.5, None)),
    "penalty": ((1e-3, None), (1e-1, None), (10.0, NEAR), (1e3, NEAR)),
}


@dataclass(frozen=True, eq=False)
class ExtremeScene:
    """A scene with something of it changed.

    against, apart: the name of the extreme, or of the scene as it is, whose key results those of this one are
    to be, and by what they may differ, relative; None where its bounds alone are known.
    """

    name: str
    scene: Scene
    against: str | None = None
    apart: float | None = None


def extremes(scene: Scene) -> Iterator[ExtremeScene]:
    """The scene as it is, then those that make sense for it."""
    yield ExtremeScene(BASE, scene)
    for setting in SETTINGS:
        for factor, apart in FACTORS[setting.name] if setting.exists(scene) else ():
            against = BASE if apart else None
            yield ExtremeScene(
                f"{setting.words}, {factor:.3g} times as fine", varied(scene, setting, factor), against, apart
            )
    yield from _materials(scene)
    if any(_is_moved(acts_on(stage, line)) for stage in scene.stages for line in risers(scene)):
        yield from _motions(scene)
    straight = {name: _with(line, initial="straight") for name, line in risers(scene).items()}
    yield ExtremeScene("gravity 0", _with(with_risers(scene, straight), gravity=0.0))  # no catenary without weight
    if scene.dimension == "auto" and not scene.lines:
        spatial = _with(scene, dimension=3, line_types=_line_types(scene, GJ=_as_stiff_as_bent))
        yield ExtremeScene("in three dimensions", spatial, BASE, SAME)


def _materials(scene: Scene) -> Iterator[ExtremeScene]:
    """A line without bending stiffness, or without stretch, has a limit: what comes after a refinement series's first
    is near it.
    """
    for key, factors in (("EI", (1e-3, 1e-6)), ("EA", (1e3, 1e6))):
        first = f"{key} times {factors[0]:g}"
        for factor in factors:
            changed = _with(scene, line_types=_line_types(scene, **dict.fromkeys(_KEYS[key], factor)))
            name = f"{key} times {factor:g}"
            yield ExtremeScene(name, changed, None if name == first else first, None if name == first else CLOSE)
    if scene.soil is not None and scene.soil.law is not None:
        law = scene.soil.law
        for key, value in (("nu", 0.4999), ("su", 1e-3 * getattr(law, "su", 0.0))):
            if getattr(law, key, None):
                changed = _with(scene, soil=_with(scene.soil, law=_with(law, **{key: value})))
                yield ExtremeScene(f"soil: {key} = {value:g}", changed)


def _motions(scene: Scene) -> Iterator[ExtremeScene]:
    """Scenes with extreme motions of the ends; without any, a riser in still water stays where statics left it."""
    for factor in (10.0, 0.1):
        yield ExtremeScene(f"harmonic motion times {factor:g}", _moved(scene, amplitude=factor))
    yield ExtremeScene("harmonic motion in a tenth of its period", _moved(scene, period=0.1))
    if (scene.water is None or scene.water.waves is None) and _ends_at_rest(scene):
        yield ExtremeScene("no motion", _with_motions(scene, lambda motion: None), _AT_REST, SAME)


def _ends_at_rest(scene: Scene) -> bool:
    """Whether static stages alone have loads, which stay, and dynamic ones come after them."""
    kinds = [isinstance(stage, StaticStage) for stage in scene.stages]
    stays = all(still and load.keep for still, stage in zip(kinds, scene.stages, strict=True) for load in _loads(stage))
    return kinds[0] and kinds == sorted(kinds, reverse=True) and stays


def _loads(stage: Any) -> list[Any]:
    return [*varying_in(stage), *(load for own in stage.lines.values() for load in own.loads)]


_AT_REST = "at rest"
"""Stands for the static stage before, in place of another scene."""


def is_at_rest(extreme: ExtremeScene) -> bool:
    """Whether its dynamic stages are to be as its last static one."""
    return extreme.against == _AT_REST


_KEYS = {"EI": ("EI", "EI_y", "EI_z"), "EA": ("EA",)}
Change = float | Callable[[Any], float]


def _with(model: Any, **values: Any) -> Any:
    """A copy of a model with other values, not validated: the run reads it anew."""
    assert isinstance(model, BaseModel)
    return model.model_copy(update=values)


def _line_types(scene: Scene, **changes: Change) -> dict[str, Any]:
    """All line types with properties times a factor, or as a function of the line type gives them."""
    return {name: _with(line, **dict(_changed(line, changes))) for name, line in scene.line_types.items()}


def _changed(line: Any, changes: dict[str, Change]) -> Iterator[tuple[str, float]]:
    for key, change in changes.items():
        if callable(change):
            yield key, change(line)
        elif getattr(line, key) is not None:
            yield key, change * getattr(line, key)


def _as_stiff_as_bent(line: Any) -> float:
    return float(line.GJ or line.bending_stiffness[0])


def _moved(scene: Scene, **factors: float) -> Scene:
    """Harmonic motions with amplitude and period times a factor."""

    def moved(motion: Any) -> Any:
        return _with(motion, **{end: _end_moved(given, factors) for end, given in motion.by_end.items()})

    return _with_motions(scene, moved)


def _end_moved(motion: Any, factors: dict[str, float]) -> Any:
    harmonic = motion.harmonic
    if harmonic is None:
        return motion
    size = tuple(factors.get("amplitude", 1.0) * x for x in harmonic.amplitude)
    return _with(motion, harmonic=_with(harmonic, amplitude=size, period=factors.get("period", 1.0) * harmonic.period))


def _is_moved(acts: Any) -> bool:
    """Whether what happens to a line has motions of its ends."""
    return getattr(acts, "motion", None) is not None


def _with_motions(scene: Scene, change: Callable[[Any], Any]) -> Scene:
    """Variants with other motions of ends where there are some."""
    stages = []
    for stage in scene.stages:
        for line in risers(scene):
            if _is_moved(acts := acts_on(stage, line)):
                stage = with_acts(stage, line, motion=change(acts.motion))
        stages.append(stage)
    return _with(scene, stages=tuple(stages))
