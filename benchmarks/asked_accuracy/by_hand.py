"""Best settings by hand: of each scene the cheapest, with its settings varied or not, that truly reaches the accuracy.

`by_hand.json` has the factors of fineness by scene, and their largest true error; null where none of them reaches it,
or where too few quantities have a certain reference to tell. Settings are tried in the order of what they are expected
to cost, up to the first that does.
"""

from __future__ import annotations

import itertools
import json
import math
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from benchmarks.asked_accuracy.true_errors import run_errors
from benchmarks.error_bars.references import Reference
from benchmarks.error_bars.scenes import SCENES, Mapping
from riser_soil.scene.reader import scene_from_mapping
from riser_soil.scene.scene import Scene
from riser_soil.variants.settings import refined, settings_of

FILE = Path(__file__).with_name("by_hand.json")
ASKED = {name: scene for name, scene in SCENES.items() if "soil" not in scene}
TURNS = {
    "elements": (0.25, 0.5, 1.0, 2.0, 4.0),
    "time_step": (0.25, 0.5, 1.0, 2.0, 4.0),
    "penalty": (1.0, 4.0, 16.0),
}
COST = {"elements": 0.5, "time_step": 1.0, "penalty": 0.01}  # expected, as powers of fineness

Factors = dict[str, float]  # of fineness, by setting


@dataclass(frozen=True)
class HandSetting:
    """factors: of a scene's settings. error: the largest relative one, true, with them."""

    factors: Factors
    error: float


def best(mapping: Mapping, reference: Reference) -> HandSetting | None:
    """The first setting, by expected cost, that reaches the accuracy."""
    with tempfile.TemporaryDirectory() as folder:
        for factors in settings(scene_from_mapping(mapping)):
            errors, _ = run_errors(refined(scene_from_mapping(mapping), factors), Path(folder) / "run", reference)
            if errors is not None and not errors.telling:
                return None
            if errors is not None and errors.within:
                return HandSetting(factors, errors.largest[0])
    return None


def settings(scene: Scene) -> Iterator[Factors]:
    """All combinations of the scene's settings, the cheapest first."""
    names = [setting.name for setting in settings_of(scene)]
    grid = itertools.product(*(TURNS[name] for name in names))
    yield from sorted((dict(zip(names, factors, strict=True)) for factors in grid), key=_cost)


def _cost(factors: Factors) -> float:
    return math.prod(factor ** COST[name] for name, factor in factors.items())


def write(names: Iterable[str], references: dict[str, Reference]) -> None:
    """Look for the best settings of scenes anew; those of the others stay."""
    known = read() if FILE.exists() else {}
    for name in names:
        known[name] = best(ASKED[name], references[name])
        print(f"by hand, {name}: {known[name]}", flush=True)
        texts = {each: _reported(known[each]) for each in ASKED if each in known}
        FILE.write_text(json.dumps(texts, indent=1) + "\n", encoding="utf-8")


def read() -> dict[str, HandSetting | None]:
    data = json.loads(FILE.read_text(encoding="utf-8"))
    return {name: HandSetting(**of_scene) if of_scene else None for name, of_scene in data.items()}


def _reported(setting: HandSetting | None) -> Mapping | None:
    return None if setting is None else {"factors": setting.factors, "error": setting.error}
