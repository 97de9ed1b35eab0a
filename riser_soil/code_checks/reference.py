"""Which load effects are functional, environmental and accidental: by the stages at whose ends they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.code_checks.load_effects import LoadEffects, SectionEffects
from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved


class Reference:
    """Load effects (nn,) at the ends of the functional and the accidental stage of a run, as it gets there.

    functional: name of the stage at whose end effects are functional, None for the last static one; up to its end all
    are. accidental: of the stage whose additions are accidental, None for none. stages: names and kinds, in turn. A run
    that begins with another stage has the functional effects of its first instant.
    """

    def __init__(self, functional: str | None, accidental: str | None, stages: Sequence[tuple[str, str]]) -> None:
        names = [name for name, _ in stages]
        self._last = None if functional is None else names.index(functional)
        self._accident = None if accidental is None else names.index(accidental)
        self._kinds, self._names = [kind for _, kind in stages], names
        self._stage, self._given = 0, False
        self._split: dict[str, Array] = {}  # (3, nn) functional, accidental

    def begin_from(self, functional: SectionEffects) -> None:
        """Begin with functional effects (nn,) from elsewhere: no stage of this run brings them about."""
        self._split["functional"], self._given = np.stack(functional), True

    def begin_stage(self, name: str) -> None:
        self._stage = self._names.index(name)

    def split(self, now: SectionEffects) -> LoadEffects:
        """Effects (nt, nn) at instants of the present stage, in turn, by their kinds."""
        stacked, zero = np.stack(now), np.zeros_like(now.tension)
        none = SectionEffects(zero, zero, zero)
        if self._is_functional:
            self._split["functional"] = stacked[:, -1].copy()
            return LoadEffects(now, none, none)
        functional = self._split.setdefault("functional", stacked[:, 0].copy())[:, None]
        added = stacked - functional
        if self._stage == self._accident:
            self._split["accidental"] = added[:, -1].copy()
            return LoadEffects(_effects(functional + 0.0 * added), none, _effects(added))
        accidental = self._split.get("accidental", np.zeros_like(functional[:, 0]))[:, None]
        return LoadEffects(*(_effects(each + 0.0 * added) for each in (functional, added - accidental, accidental)))

    @property
    def _is_functional(self) -> bool:
        if self._last is not None:
            return self._stage <= self._last
        return not self._given and self._kinds[self._stage] == "static"

    def state(self) -> Saved:
        return dict(self._split)

    def restore(self, saved: Saved) -> None:
        self._split = {name: values.copy() for name, values in saved.items()}


def _effects(rows: Array) -> SectionEffects:
    return SectionEffects(*rows)
