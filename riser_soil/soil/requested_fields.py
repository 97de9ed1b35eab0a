"""Fields of the soil that a scene requests by name: stress, strain and plastic strain as tensors, the law's histories.

Stress is what the law gives, beyond the water pressure at rest. Effective stress is the same where the law's stress is
effective, or what remains of it beyond the pore pressure that is one of its histories. Strain is the sum of the
increments since the start, turned with the material; plastic strain is what is not elastic of it. Both are carried as a
history along with the law's.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from riser_soil.core.arrays import Array
from riser_soil.core.outputs import choices
from riser_soil.errors import SceneError
from riser_soil.soil import mandel
from riser_soil.soil.law import PLACES, PLASTIC_STRAIN, PORE_PRESSURE, STRESS, Formula, SoilLaw, StressUpdate

EFFECTIVE, HISTORIES = "effective_stress", "histories"
TENSORS = ("stress", EFFECTIVE, "strain", "plastic_strain")
OF_STRAIN = ("strain", "plastic_strain")
STRAIN = tuple(f"strain_since_start_{place}" for place in PLACES)
Law = Callable[[Array, Array], Formula]


@dataclass(frozen=True)
class RequestedFields:
    """Names that the scene requests, and the laws of its soil."""

    names: tuple[str, ...]
    laws: tuple[SoilLaw, ...] = ()

    def with_histories(self, law: Law) -> Law:
        """The law, with the strain among its histories where a field needs that."""
        if not {*OF_STRAIN} & {*self.names}:
            return law
        return lambda depth, initial: WithStrain(law(depth, initial))

    def of_law(self, columns: Sequence[str]) -> FieldsOfLaw:
        """Places of the fields in a history of such columns. Raises SceneError for what is not there."""
        own = _histories(columns)
        names = [name for each in self.names for name in (own if each == HISTORIES else [each])]
        for name in names:
            if name in own and name in (*TENSORS, HISTORIES, *choices()):
                raise SceneError(f"output.soil_fields: {name}, a history of the law, is a field, too; rename it")
            if name in choices():
                raise SceneError(f"output.soil_fields: {name} is one of output.fields; ask for it there")
            if name not in TENSORS and name not in own:
                choice = f"of this soil there are {', '.join((*TENSORS, HISTORIES, *own))}"
                raise SceneError(f"output.soil_fields: there is no {name}: {choice}; correct or remove it")
        if EFFECTIVE in names:
            self._check_effective(columns)
        return FieldsOfLaw(tuple(dict.fromkeys(names)), own, tuple(columns))

    def _check_effective(self, columns: Sequence[str]) -> None:
        kinds = dict.fromkeys(law.kind for law in self.laws if not law.knows_effective_stress(columns))
        if kinds:
            raise SceneError(
                f"output.soil_fields: effective_stress is not known of {' and '.join(kinds)}: its stress is total, "
                "and nothing says what share the pore water bears; ask for stress, or take a law with a history "
                f"{PORE_PRESSURE}"
            )


NO_FIELDS = RequestedFields(())


def fields_of(names: Sequence[str], laws: Sequence[SoilLaw]) -> RequestedFields:
    """Fields of these names in soil of some laws."""
    return RequestedFields(tuple(names), tuple(laws))


def _histories(columns: Sequence[str]) -> dict[str, slice]:
    """A law's histories beside those of all laws: tensors without _xx, and where they are."""
    own, at, others = dict[str, slice](), 0, (*STRESS, *STRAIN, PLASTIC_STRAIN)
    while at < len(columns):
        name = columns[at]
        stem = name[:-3]
        tensor = tuple(columns[at : at + 6]) == tuple(f"{stem}_{place}" for place in PLACES)
        if name not in others:
            own[stem if tensor else name] = slice(at, at + 6) if tensor else slice(at, at + 1)
        at += 6 if tensor else 1
    return own


@dataclass(frozen=True)
class FieldsOfLaw:
    """Fields by their names; histories: where the law's are; columns: of all of its history."""

    names: tuple[str, ...]
    histories: dict[str, slice]
    columns: tuple[str, ...]

    def at_points(self, in_balance: Array, update: StressUpdate) -> Iterator[tuple[str, Array]]:
        """Each field by name, (n,) or tensors (n, 6); in_balance: stress (n, 6) [Pa]."""
        for name in self.names:
            if name in self.histories:
                values = update.history[:, self.histories[name]]
                yield name, values[:, 0] if values.shape[1] == 1 else values
            else:
                yield name, self._tensor(name, in_balance, update)

    def _tensor(self, name: str, in_balance: Array, update: StressUpdate) -> Array:
        if name == "stress":
            return in_balance
        if name == EFFECTIVE:
            return self._effective(in_balance, update)
        strain = update.history[:, self._columns_of(STRAIN[0], 6)]
        return strain if name == "strain" else strain - update.elastic

    def _effective(self, in_balance: Array, update: StressUpdate) -> Array:
        """Its mean is that of the law's last answer, which pore pressure belongs to: where cells have moved since, that
        is not in balance, in mean total stress and pore pressure alike.
        """
        if PORE_PRESSURE not in self.columns:
            return in_balance
        pore = update.history[:, self._columns_of(PORE_PRESSURE, 1)][:, 0]
        return mandel.plus_mean(mandel.deviator(in_balance), mandel.mean(update.stress) + pore)

    def _columns_of(self, name: str, count: int) -> slice:
        first = self.columns.index(name)
        return slice(first, first + count)


class WithStrain:
    """A formula whose history has the strain since the start behind the law's own."""

    def __init__(self, law: Formula) -> None:
        self._law = law
        self.columns = (*law.columns, *STRAIN)
        self.symmetric, self.by_rate = law.symmetric, law.by_rate

    @property
    def bulk(self) -> Array:
        return self._law.bulk

    @property
    def shear(self) -> Array:
        return self._law.shear

    def start(self) -> Array:
        own = self._law.start()
        return np.column_stack((own, np.zeros((len(own), 6))))

    def update(self, strain_increment: Array, history: Array, dt: float = math.inf) -> StressUpdate:
        update = self._law.update(strain_increment, np.ascontiguousarray(history[:, :-6]), dt)
        return update._replace(history=np.column_stack((update.history, history[:, -6:] + strain_increment)))

    def overstress(self, stress: Array) -> Array:
        return self._law.overstress(stress)
