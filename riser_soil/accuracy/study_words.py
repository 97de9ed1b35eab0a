"""What a study says in words: how far the scene is off, which knob limits it, which settings reach an accuracy."""

from __future__ import annotations

import math
from collections.abc import Iterator

from riser_soil.accuracy.assessment import TELLING, AssessedQuantity
from riser_soil.accuracy.findings import TARGETS, Study

Quantities = dict[str, AssessedQuantity]


def words(study: Study) -> list[str]:
    """Sentences, in their order."""
    return [
        *_moved(study),
        *_unknown(study.quantities()),
        *_accuracy(study),
        *_limiting(study),
        *(sentence for target in TARGETS for sentence in _cheapest(study, target)),
        *_failed(study),
    ]


def _moved(study: Study) -> Iterator[str]:
    if study.failure:
        settings = study.ladders.told(study.ladders.base)
        yield f"the scene itself fails: {study.failure}; the study is around finer settings: {settings}"


def percent(part: float) -> str:
    """Three figures; a part of inf or nan is unknown."""
    return f"{100.0 * part:.3g} %" if math.isfinite(part) else "unknown"


def _unknown(quantities: Quantities) -> Iterator[str]:
    unknown = _doubtful(quantities, TELLING)
    if unknown:
        yield (
            f"no error can be told of {unknown}, as the ladders do not close in on a value; they are left out of what "
            "follows"
        )


def _doubtful(quantities: Quantities, doubt: float) -> str:
    """Quantities whose reference is not known to a relative uncertainty."""
    return ", ".join(f"{key} (± {percent(each.doubt)})" for key, each in quantities.items() if not each.doubt <= doubt)


def _off(quantities: Quantities, error: float, key: str) -> str:
    return f"{percent(error)} off at most (± {percent(quantities[key].doubt)}), in {key}"


def _accuracy(study: Study) -> Iterator[str]:
    error, key = study.error(study.scene)
    if key:
        scene = "with these settings the scene" if study.failure else "as it is, the scene"
        yield f"{scene} takes {study.scene.cpu:.3g} s and is {_off(study.judged(), error, key)}"


def _limiting(study: Study) -> Iterator[str]:
    """Which knob has the largest share in an error."""
    quantities = study.judged()
    if not quantities:
        return
    shares = [(*_largest_share(quantities, n), knob.words) for n, knob in enumerate(study.ladders.knobs)]
    largest = "; ".join(f"{knob} {percent(share)} ({key})" for share, key, knob in sorted(shares, reverse=True))
    most, key, knob = max(shares)
    if most <= quantities[key].doubt:
        yield f"no knob limits the accuracy by more than the study can tell; largest shares of error: {largest}"
    else:
        yield f"what limits the accuracy is the {knob}; largest shares of error: {largest}"


def _largest_share(quantities: Quantities, number: int) -> tuple[float, str]:
    return max((each.share(number), key) for key, each in quantities.items())


def _cheapest(study: Study, target: float) -> Iterator[str]:
    quantities, found = study.judged(), study.reaching(target)
    if not quantities:
        return
    best = found if found is not None else study.front()[-1]
    error, key = study.error(best)
    settings, off = study.ladders.told(best.factors), _off(quantities, error, key)
    where = "" if len(quantities) == len(study.quantities()) else f" in {len(quantities)} quantities"
    if found is None:
        yield f"{percent(target)} is reached{where} by no setting that was run; the best, {settings}, is {off}"
        return
    at = f"at the least cost, {best.cpu:.3g} s, with {settings}: {off}"
    if error <= target:
        yield f"{percent(target)} is reached{where} {at}"
    else:
        yield f"{percent(target)} can't be told{where}; the reference is reached as far as it is known {at}"
    beside = _doubtful(quantities, target)
    if beside:
        yield f"the reference is known less well than to {percent(target)} of {beside}"


def _failed(study: Study) -> Iterator[str]:
    failed = [each for each in study.outcomes.values() if not each.done]
    if failed:
        yield f"{len(failed)} of {len(study.outcomes)} points failed; study.csv has their reasons"
