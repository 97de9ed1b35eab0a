"""What a study says in words: how far the scene is off, which knob limits it, which settings reach an accuracy."""

from __future__ import annotations

import math
from collections.abc import Iterator

from riser_soil.accuracy.assessment import AssessedQuantity
from riser_soil.accuracy.study import TARGETS, Study

Quantities = dict[str, AssessedQuantity]


def words(study: Study) -> list[str]:
    """Sentences, in their order."""
    quantities = study.quantities()
    return [
        *_unknown(quantities),
        *_accuracy(study, quantities),
        *_limiting(study, quantities),
        *(_cheapest(study, quantities, target) for target in TARGETS),
        *_failed(study),
    ]


def percent(part: float) -> str:
    """Three figures; a part of inf or nan is unknown."""
    return f"{100.0 * part:.3g} %" if math.isfinite(part) else "unknown"


def _unknown(quantities: Quantities) -> Iterator[str]:
    unknown = [f"{key} (± {percent(each.doubt)})" for key, each in quantities.items() if not each.known]
    if unknown:
        yield (
            f"no error can be told of {', '.join(unknown)}: the ladders do not close in on a value; they are left out "
            "of what follows"
        )


def _accuracy(study: Study, quantities: Quantities) -> Iterator[str]:
    error, key = study.error(study.scene)
    if key:
        doubt = percent(quantities[key].doubt)
        yield (
            f"as it is, the scene takes {study.scene.cpu:.3g} s and is {percent(error)} off at most (± {doubt}), in "
            f"{key}"
        )


def _limiting(study: Study, quantities: Quantities) -> Iterator[str]:
    """Which knob has the largest share in an error."""
    shares = [_largest_share(quantities, number) for number in range(len(study.ladders.knobs))]
    if not shares or not any(key for _, key in shares):
        return
    told = [
        f"{knob.words} {percent(share)} ({key})"
        for knob, (share, key) in sorted(zip(study.ladders.knobs, shares, strict=True), key=lambda each: -each[1][0])
    ]
    most, key = max(shares)
    if most <= quantities[key].doubt:
        yield f"no knob limits the accuracy by more than the study can tell: largest shares are {'; '.join(told)}"
    else:
        knob = study.ladders.knobs[shares.index((most, key))]
        yield f"the {knob.words} limits the accuracy; largest shares of error: {'; '.join(told)}"


def _largest_share(quantities: Quantities, number: int) -> tuple[float, str]:
    return max(((each.share(number), key) for key, each in quantities.items() if each.known), default=(0.0, ""))


def _cheapest(study: Study, quantities: Quantities, target: float) -> str:
    found = study.reaching(target)
    if found is not None:
        error, key = study.error(found)
        return (
            f"{percent(target)} is reached at the least cost, {found.cpu:.3g} s, with "
            f"{study.ladders.told(found.factors)}: {percent(error)} off (± {percent(quantities[key].doubt)}), in {key}"
        )
    least = [(*study.error(each), each) for each in study.front()]
    if not least:
        return f"{percent(target)}: no setting could be judged"
    error, key, best = least[-1]
    return (
        f"{percent(target)} is reached by no setting that was run: the best, {study.ladders.told(best.factors)}, is "
        f"{percent(error)} off (± {percent(quantities[key].doubt)}), in {key}"
    )


def _failed(study: Study) -> Iterator[str]:
    failed = [each for each in study.outcomes.values() if not each.done]
    if failed:
        yield f"{len(failed)} of {len(study.outcomes)} points failed; study.csv has their reasons"
