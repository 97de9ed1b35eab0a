"""Facts about a run, known before its first step: what it consists of, how large it is, what can be recorded of it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil import __version__
from riser_soil.assembly import Assembly, LineAssembly
from riser_soil.checks.inventory import inventory, unknowns
from riser_soil.core import outputs
from riser_soil.core.environment import versions
from riser_soil.core.output import Need
from riser_soil.core.snapshot import CodeCheckFacts, RunFacts
from riser_soil.results.settlement_trough import count_of, offsets_of

_CHECKED: tuple[Need, ...] = (  # utilisations of a `Record`
    *("bursting", "hoop buckling", "propagating buckling", "combined loading"),
    *("bend radius", "tension limit", "compression", "crushing", "capacity curve"),
)


def known_fields(assembly: Assembly) -> dict[str, tuple[str, ...]]:
    """Fields of each line that the scene requests, as far as they can be computed."""
    requested = assembly.scene.output.fields
    return {name: outputs.known(requested, _known_of_line(line)) for name, line in assembly.lines.items()}


def _known_of_line(riser: LineAssembly) -> list[Need]:
    has: dict[Need, bool] = {
        "pressures": riser.pressures is not None,
        "min_bend_radius": riser.elements.limits_bending,
        "max_tension": riser.elements.limits_tension,
        "wall": riser.wall_sections is not None,
        "wall in space": riser.wall_sections is not None and riser.line.dimension == 3,
        "yield stress": bool(riser.elements.allowable_stress.any()),
        "ground": bool(riser.contacts),
        "friction": bool(riser.frictions),
        "soil": riser.soil is not None,
    }
    if (checks := riser.code_checks()) is not None:
        has["code check"] = True
        has.update({need: need.replace(" ", "_") in checks.fields for need in _CHECKED})
    return [need for need, there in has.items() if there]


def _code_checks(assembly: Assembly) -> dict[str, tuple[CodeCheckFacts, ...]]:
    """The code checks of lines that have some, by the line's name."""
    checks = {name: line.code_checks() for name, line in assembly.lines.items()}
    return {name: each.facts for name, each in checks.items() if each is not None}


def facts_of(assembly: Assembly, warnings: Sequence[str] = ()) -> RunFacts:
    """Facts about a run before its first step; collective."""
    lying = assembly.line_on_soil if "settlement_across" in assembly.scene.output.fields else None
    known = inventory(assembly)
    return RunFacts(
        title=assembly.scene.title,
        version=__version__,
        ranks=assembly.comm.size,
        built=known.built,
        left_out=known.left_out,
        warnings=tuple(warnings),
        versions=versions(),
        dissipating=known.dissipating,
        working=known.working,
        riser_dofs=sum(unknowns(assembly.comm, field) for field in assembly.moving),
        soil_dofs=unknowns(assembly.comm, assembly.soil.whole.field) if assembly.soil is not None else 0,
        diameter=assembly.scales.diameter,
        weight=max(own.scales.weight * float(np.ptp(own.line.arc)) for own in assembly.lines.values()),
        contact_period=assembly.contact_period,
        on_soil=assembly.name_on_soil,
        sections=count_of(lying) if lying is not None else 0,
        offsets=offsets_of(lying) if lying is not None else (),
        code_checks=_code_checks(assembly),
    )
