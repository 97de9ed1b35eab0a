"""Inventory of an assembled scene: which parts its stages solve with, and which are left out and why."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from riser_soil.assembly import Assembly
from riser_soil.assembly.riser import no_wall_tension
from riser_soil.assembly.seabed_reach import why_apart
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Field
from riser_soil.scene.scene import Scene

DISSIPATING = (
    *("morison", "structural damping", "contact", "seabed", "friction"),
    *("soil friction", "soil", "soil boundary", "new mesh", "cushion", "body drag", "body contact", "body friction"),
)
#: Accounts of a part that divides its own energy from the time scheme's.
SPLIT = {
    "soil": ("soil_plasticity", "soil_time_scheme"),
    "seabed": ("seabed", "seabed_time_scheme"),
    "contact": ("contact", "contact_time_scheme"),
    "body_contact": ("body_contact", "body_contact_time_scheme"),
}
WORKING = ("soil forms", "loads", "contents", "morison", "vortices", "vortices in line", "buoyancy", "body drag")
#: Parts that the inventory knows by another name.
CALLED = {"start spring": "springs", "end spring": "springs", "body weight": "bodies"}

Reason = str | Callable[[Scene], str]
"""Why a part is left out, of any scene that lacks it or by the scene."""


@dataclass(frozen=True)
class Inventory:
    """Parts that the scene's stages solve with, by name; parts and results that are left out, each with its reason.

    dissipating, working: accounts of the energy ledger, of parts that may dissipate and of those that may put energy
    in, the supports among them.
    """

    built: tuple[str, ...]
    left_out: dict[str, str]
    dissipating: tuple[str, ...]
    working: tuple[str, ...]


def inventory(assembly: Assembly) -> Inventory:
    """Inventory of an assembly that is complete."""
    names, scene = {CALLED.get(name, name) for name in assembly.part_names}, assembly.scene
    any_line = next(iter(assembly.lines.values())).scene
    reasons = LINE_REASONS if not scene.lines else LINE_REASONS | BODY_REASONS
    built = tuple(name for name in reasons if name in names or (name == "contact" and assembly.contacts))
    left_out = {
        name: _in_words(reason, scene if name in BODY_REASONS else any_line)
        for name, reason in reasons.items()
        if name not in built
    }
    dissipating = (account for name in _accounts(DISSIPATING, names) for account in SPLIT.get(name, (name,)))
    return Inventory(
        built,
        left_out | _results_left_out(assembly),
        tuple(dissipating),
        (*_accounts(WORKING, names), "supports"),
    )


def _in_words(reason: Reason, scene: Scene) -> str:
    return reason if isinstance(reason, str) else reason(scene)


def _accounts(given: tuple[str, ...], names: set[str]) -> list[str]:
    return [name.replace(" ", "_") for name in given if name in names]


def _results_left_out(assembly: Assembly) -> dict[str, str]:
    """Results that are not computed, with the reason."""
    left_out = {} if assembly.scene.code_check else {"code check": "the scene has no code_check"}
    if assembly.soil is not None and assembly.soil.whole.grid.mirror is not None:
        left_out["half of the soil"] = "by symmetry"
    if all(own.pressures is None for own in assembly.lines.values()):
        left_out["wall tension"] = no_wall_tension(next(iter(assembly.lines.values())).scene)
    return left_out


def _static_or(reason: str) -> Callable[[Scene], str]:
    """The reason for a part that is absent of a scene whose stages are dynamic."""
    return lambda scene: reason if scene.has_dynamic_stage else "no stage is dynamic"


def _no_contents(scene: Scene) -> str:
    if scene.line.contents is None:
        return "the riser is empty"
    return "even contents at rest count in the riser's mass and weight"


def _no_morison(scene: Scene) -> str:
    if scene.water is None:
        return "the scene has no water"
    if not scene.has_dynamic_stage and scene.water.current is None:
        return "no stage is dynamic, and still water does not load a riser at rest"
    return "no line type has drag or added mass, nor any attachment"


def _no_buoyancy(scene: Scene) -> str:
    return "the scene has no water" if scene.water is None else "the water has no surface: all is submerged"


def _no_friction(ground: str) -> Callable[[Scene], str]:
    def reason(scene: Scene) -> str:
        if scene.contact is None or scene.contact.friction is None:
            return "no friction is asked for"
        return f"the scene has no {ground}" if getattr(scene, ground) is None else "contact at nodes has none on soil"

    return reason


def _no_soil_inertia(scene: Scene) -> str:
    if scene.soil is None:
        return "the scene has no soil"
    return "no stage is dynamic" if scene.soil.inertia else "soil.inertia is not asked for"


def _no_soil_boundary(scene: Scene) -> str:
    if scene.soil is None or not scene.soil.inertia or not scene.has_dynamic_stage:
        return _no_soil_inertia(scene)
    return "soil.absorbing is not asked for"


def _no_new_mesh(scene: Scene) -> str:
    if scene.soil is None:
        return "the scene has no soil"
    return scene.why_small_strain or "contact at nodes makes none anew"


def _no_cushion(scene: Scene) -> str:
    if scene.soil is None:
        return "the scene has no soil"
    laid = scene.stages[0].kind == "static"
    return "the soil's top is not level" if laid else "the riser is not laid in a static stage"


def _no_body_contact(scene: Scene) -> str:
    if not scene.bodies:
        return "the scene has no bodies"
    if scene.seabed is None:
        return "the scene has no seabed"
    return "; ".join(f"{name}: {why_apart(scene, name)}" for name in scene.bodies)


def _no_body_friction(scene: Scene) -> str:
    apart = not scene.bodies or scene.seabed is None or all(why_apart(scene, name) for name in scene.bodies)
    return _no_body_contact(scene) if apart else "no friction is asked for"


def _no_body_drag(scene: Scene) -> str:
    return "no body has drag" if scene.bodies and scene.water is not None else "no body is in water"


#: Reasons why a line lacks parts, by the scene as the line sees it.
LINE_REASONS: dict[str, Reason] = {
    "riser": "",
    "springs": "no end has a rotational spring",
    "attachments": "nothing is attached to the riser",
    "contents": _no_contents,
    "loads": "no stage has loads",
    "inertia": "no stage is dynamic",
    "rotary inertia": _static_or("no line type has rotary inertia"),
    "structural damping": _static_or("no line type has damping"),
    "morison": _no_morison,
    "vortices": _static_or("no line type has a vortex_force"),
    "vortices in line": _static_or("no line type has a vortex_force.in_line"),
    "buoyancy": _no_buoyancy,
    "seabed": "the scene has no seabed",
    "friction": _no_friction("seabed"),
    "soil friction": _no_friction("soil"),
    "soil": "the scene has no soil",
    "soil forms": "soil.forms is not asked for",
    "soil inertia": _no_soil_inertia,
    "soil boundary": _no_soil_boundary,
    "new mesh": _no_new_mesh,
    "cushion": _no_cushion,
    "contact": "the scene has neither seabed nor soil",
}
#: The same of bodies and joints: of the whole scene.
BODY_REASONS: dict[str, Reason] = {
    "bodies": "the scene has no bodies",
    "body drag": _no_body_drag,
    "body contact": _no_body_contact,
    "body friction": _no_body_friction,
    "joints": "the scene has no joints",
}


def unknowns(comm: Communicator, field: Field) -> int:
    """Free dofs of a field over all ranks; collective."""
    return int(comm.allreduce(int(np.count_nonzero(field.owned & ~field.prescribed))))
