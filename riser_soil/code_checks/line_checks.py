"""Code checks of one line: its nodes by line type, and all utilisations at instants of a run.

A node between two line types has the larger utilisation of both.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from riser_soil.code_checks.criteria import Criteria, NodeLoads, criteria_of
from riser_soil.code_checks.load_effects import LoadEffects, SectionEffects
from riser_soil.code_checks.reference import Reference
from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.saved_state import Saved, Stateful, gathered, restore_all
from riser_soil.core.snapshot import CodeCheckFacts
from riser_soil.riser.section_forces import at_most
from riser_soil.riser.sections import larger_beside
from riser_soil.scene.code_check import DnvCheck, checks_of
from riser_soil.scene.scene import Scene

VARIABLE = "{}_utilisation"
_NOT_FUNCTIONAL = -1  # number of the reference without stages of its own


@dataclass(frozen=True, eq=False)
class CheckedPart:
    """The nodes (n,) of one line type, and its check. elements (ne,): 1 where they are of it. borne (n, 2): the pipe's
    share of the moments about y and z. reference: number of the check whose stages tell load effects apart.
    """

    line_type: str
    criteria: Criteria
    nodes: IntArray
    elements: Array
    borne: Array
    reference: int


class LineChecks:
    """All checks of a line, at instants in turn.

    line_types: of each element, by name. borne (ne, 2): share of the moments that the pipe bears. arc (nn,): m.
    """

    def __init__(self, scene: Scene, line_types: Sequence[str], borne: Array, arc: Array) -> None:
        self._arc, self._checks = arc, scene.code_check
        self._parts = [*_parts(scene, np.array(line_types), borne)]
        stages = [(stage.name, stage.kind) for stage in scene.stages]
        self._references = {
            part.reference: Reference(*_reference_stages(scene, part.reference), stages) for part in self._parts
        }
        self._kinds, self._moving = dict(stages), False

    @property
    def facts(self) -> tuple[CodeCheckFacts, ...]:
        """The checks made, in the order of `code_largest`."""
        return tuple(
            CodeCheckFacts(
                line_type=part.line_type,
                code=part.criteria.code,
                check=criterion.words,
                clause=criterion.clause,
                variable=VARIABLE.format(criterion.field),
                limit_state=part.criteria.limit_state,
                safety_class=part.criteria.safety_class,
            )
            for part in self._parts
            for criterion in part.criteria.criteria
        )

    @property
    def fields(self) -> frozenset[str]:
        """Utilisations that there are, by their criteria."""
        return frozenset(criterion.field for part in self._parts for criterion in part.criteria.criteria)

    @property
    def functional_runs(self) -> dict[int, Path]:
        """Folders of runs that give functional load effects, by the number of the check."""
        checks = {n: self._checks[n] for n in self._references if n != _NOT_FUNCTIONAL}
        return {n: check.functional_run for n, check in checks.items() if check.functional_run is not None}

    def begin_from(self, number: int, functional: SectionEffects) -> None:
        """Begin with a check's functional load effects (nn,) from another run."""
        self._references[number].begin_from(functional)

    def begin_stage(self, name: str) -> None:
        self._moving = self._kinds[name] == "dynamic"
        for reference in self._references.values():
            reference.begin_stage(name)

    def at(
        self,
        effects: SectionEffects,
        pressures: tuple[Array, Array, Array],
        curvature_beside: Array,
        contact_force: Array,
    ) -> dict[str, Array]:
        """Utilisations at instants of the present stage, in turn: the largest of all, of each criterion, and of each
        check with its place, see `Record`; nan where not checked.

        effects (nt, nn). pressures: inside and outside (nt, nn), and inside at the level that the contents' pressure
        refers to (nt, 1) [Pa]. curvature_beside (nt, ne, 2): at the elements' ends [1/m]. contact_force (nt, nn): N/m.
        """
        split = {number: reference.split(effects) for number, reference in self._references.items()}
        inside, outside, at_reference = pressures
        at_nodes = {field: np.full(inside.shape, -np.inf) for field in self.fields}
        largest, places = list[Array](), list[Array]()
        for part in self._parts:
            curvature = at_most(np.where(part.elements[:, None] > 0.0, curvature_beside, -np.inf))
            along = (inside, outside, curvature, contact_force)
            p_i, p_o, curved, pressed = (values[..., part.nodes] for values in along)
            own = _of_part(split[part.reference], part)
            loads = NodeLoads(own, p_i, p_o, at_reference, curved, pressed, self._moving)
            utilisations = part.criteria.utilisations(loads)
            for criterion in part.criteria.criteria:
                used = np.broadcast_to(utilisations[criterion.field], p_i.shape)
                values = at_nodes[criterion.field]
                values[..., part.nodes] = np.maximum(values[..., part.nodes], used)
                largest.append(used.max(axis=-1))
                places.append(self._arc[part.nodes[used.argmax(axis=-1)]])
        return _values(at_nodes, largest, places)

    def state(self) -> Saved:
        return gathered(self._owners)

    def restore(self, saved: Saved) -> None:
        restore_all(self._owners, saved)

    @property
    def _owners(self) -> dict[str, Stateful]:
        return {str(number): reference for number, reference in self._references.items()}


def _parts(scene: Scene, line_types: Array, borne: Array) -> list[CheckedPart]:
    parts = list[CheckedPart]()
    for name, line_type in scene.used_line_types.items():
        for n in checks_of(scene.code_check, name):
            check, elements = scene.code_check[n], (line_types == name).astype(float)
            nodes = np.flatnonzero(larger_beside(elements) > 0.0)
            share = np.column_stack([larger_beside(elements * each) for each in borne.T])[nodes]
            criteria = criteria_of(check, line_type)
            reference = n if isinstance(check, DnvCheck) else _NOT_FUNCTIONAL
            parts.append(CheckedPart(name, criteria, nodes, elements, share, reference))
    return parts


def _reference_stages(scene: Scene, number: int) -> tuple[str | None, str | None]:
    if number == _NOT_FUNCTIONAL:
        return None, None
    check = scene.code_check[number]
    return check.functional_stage, check.accidental_stage


def _of_part(effects: LoadEffects, part: CheckedPart) -> LoadEffects:
    """Effects at a part's nodes, with moments as the pipe bears them."""
    borne_y, borne_z = part.borne.T
    return LoadEffects(
        *(
            SectionEffects(
                each.tension[..., part.nodes],
                borne_y * each.moment_y[..., part.nodes],
                borne_z * each.moment_z[..., part.nodes],
            )
            for each in effects
        )
    )


def _values(at_nodes: Mapping[str, Array], largest: Sequence[Array], places: Sequence[Array]) -> dict[str, Array]:
    """at_nodes (nt, nn): -inf where not checked; largest and places (nt,): of each check."""
    most = np.max([*at_nodes.values()], axis=0)
    of_each = {f"{field}_utilisation": values for field, values in at_nodes.items()}
    known = {name: np.where(np.isfinite(v), v, np.nan) for name, v in ({"code_utilisation": most} | of_each).items()}
    return known | {"code_largest": np.stack(largest, axis=-1), "code_place": np.stack(places, axis=-1)}
