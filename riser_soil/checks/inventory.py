"""Inventory of a scene: which parts it is built of, and which are left out and why."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from riser_soil.assembly.riser import no_wall_tension
from riser_soil.assembly.seabed_reach import why_apart
from riser_soil.assembly.soil_block import why_all
from riser_soil.core.communicator import Communicator
from riser_soil.core.part import Field
from riser_soil.scene.lines import by_line, on_soil
from riser_soil.scene.plane import resolved_dimension
from riser_soil.scene.riser import RotationSpring, Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import varying_in


def built(scene: Scene) -> tuple[str, ...]:
    """Names of the parts that the scene's stages solve with."""
    return tuple(name for name, reason in _reasons(scene).items() if not reason)


def left_out(scene: Scene) -> dict[str, str]:
    """Parts and results that the scene leaves out, each with its reason."""
    reasons = [no_wall_tension(view) for view in by_line(scene).values()]
    reasons_by_check = {**_reasons(scene), "half of the soil": _no_half(scene), "wall tension": _why_all(reasons)}
    reasons_by_check["code check"] = "" if scene.code_check else "the scene has no code_check"
    return {name: reason for name, reason in reasons_by_check.items() if reason}


def _reasons(scene: Scene) -> dict[str, str]:
    """Part -> why it is left out, empty where it is built: of several lines where one has it."""
    each = [_reasons_of_line(view) for view in by_line(scene).values()]
    found = {name: _why_all([reasons[name] for reasons in each]) for name in each[0]}
    if not scene.lines:
        return found
    drag = "" if scene.bodies and scene.water is not None else "no body is in water"
    bodies = "" if scene.bodies else "the scene has no bodies"
    joints = "" if scene.joints else "the scene has no joints"
    contact, friction = _on_seabed(scene)
    return found | {
        "bodies": bodies,
        "body drag": drag,
        "body contact": contact,
        "body friction": friction,
        "joints": joints,
    }


def _on_seabed(scene: Scene) -> tuple[str, str]:
    """Why bodies have no contact with the seabed, and no friction on it; empty where they have."""
    if not scene.bodies:
        return ("the scene has no bodies",) * 2
    if scene.seabed is None:
        return ("the scene has no seabed",) * 2
    apart = {name: why_apart(scene, name) for name in scene.bodies}
    if all(apart.values()):
        return ("; ".join(f"{name}: {reason}" for name, reason in apart.items()),) * 2
    asked = scene.contact is not None and scene.contact.friction is not None
    rubs = [body.contact.friction if body.contact is not None else None for body in scene.bodies.values()]
    return "", "" if any(asked if own is None else own > 0.0 for own in rubs) else "no friction is asked for"


def _why_all(reasons: Sequence[str]) -> str:
    """The first of the reasons why each lacks something; empty where one has it."""
    return reasons[0] if all(reasons) else ""


def _reasons_of_line(scene: Scene) -> dict[str, str]:
    ends = (scene.line.start, scene.line.end)
    sprung = any(isinstance(e, Support) and isinstance(e.rotation, RotationSpring) for e in ends)
    tensioned = any(isinstance(e, Support) and e.tensioner is not None for e in ends)
    ground = scene.seabed is not None or scene.soil is not None
    return {
        "riser": "",
        "springs": "" if sprung else "no end has a rotational spring",
        "attachments": "" if scene.line.attachments else "nothing is attached to the riser",
        "contents": _no_contents(scene),
        "loads": "" if any(map(varying_in, scene.stages)) or tensioned else "no stage has loads",
        "inertia": "" if has_dynamics(scene) else "no stage is dynamic",
        "rotary inertia": _no_rotary_inertia(scene),
        "structural damping": _no_structural_damping(scene),
        "morison": _no_morison(scene),
        "vortices": _no_vortices(scene),
        "vortices in line": _no_vortices_in_line(scene),
        "buoyancy": _no_buoyancy(scene),
        "seabed": "" if scene.seabed is not None else "the scene has no seabed",
        "friction": _no_friction(scene, "seabed"),
        "soil friction": _no_friction(scene, "soil"),
        "soil": "" if scene.soil is not None else "the scene has no soil",
        "soil forms": "" if scene.soil is not None and scene.soil.forms is not None else "soil.forms is not asked for",
        "soil inertia": _no_soil_inertia(scene),
        "soil boundary": _no_soil_inertia(scene) or _no_soil_boundary(scene),
        "new mesh": no_new_mesh(scene),
        "cushion": _no_cushion(scene),
        "contact": "" if ground else "the scene has neither seabed nor soil",
    }


DISSIPATING = (
    *("morison", "structural damping", "contact", "seabed", "friction"),
    *("soil friction", "soil", "soil boundary", "new mesh", "cushion", "body drag", "body contact", "body friction"),
)
#: Accounts of a part that tells what is its own and what is the time scheme's.
SPLIT = {
    "soil": ("soil_plasticity", "soil_time_scheme"),
    "seabed": ("seabed", "seabed_time_scheme"),
    "contact": ("contact", "contact_time_scheme"),
    "body_contact": ("body_contact", "body_contact_time_scheme"),
}
WORKING = ("soil forms", "loads", "contents", "morison", "vortices", "vortices in line", "buoyancy", "body drag")


def dissipating(scene: Scene) -> tuple[str, ...]:
    """Parts of the energy ledger that may dissipate."""
    return tuple(account for name in _in_ledger(scene, DISSIPATING) for account in SPLIT.get(name, (name,)))


def working(scene: Scene) -> tuple[str, ...]:
    """Parts of the energy ledger that may put energy in, and the supports."""
    return (*_in_ledger(scene, WORKING), "supports")


def _in_ledger(scene: Scene, names: tuple[str, ...]) -> tuple[str, ...]:
    parts = {*built(scene)} - (set() if scene.soil is not None else {"contact"})
    return tuple(name.replace(" ", "_") for name in names if name in parts)


def has_dynamics(scene: Scene) -> bool:
    return any(s.kind == "dynamic" for s in scene.stages)


def _no_contents(scene: Scene) -> str:
    given = scene.line.contents
    if given is None:
        return "the riser is empty"
    return "" if given.uneven_or_moving else "even contents at rest count in the riser's mass and weight"


def _no_cushion(scene: Scene) -> str:
    if scene.soil is None:
        return "the scene has no soil"
    if scene.soil.given_block is not None and scene.soil.given_block.feature is not None:
        return "the soil's top is not level"
    return "" if scene.stages[0].kind == "static" else "the riser is not laid in a static stage"


def no_new_mesh(scene: Scene) -> str:
    if scene.soil is None:
        return "the scene has no soil"
    if scene.soil.is_linear:
        return "the soil is elastic"
    if scene.soil.inertia:
        return "soil with inertia is computed at small strain"
    if scene.soil.forms is not None:
        return "terms of soil.forms are added at small strain"
    if scene.soil.strain == "small":
        return "soil.strain: small keeps the cells where they are"
    return "" if scene.soil_moves else "at contact.method: node cells stay where they are"


def _no_soil_inertia(scene: Scene) -> str:
    if scene.soil is None:
        return "the scene has no soil"
    if not scene.soil.inertia:
        return "soil.inertia is not asked for"
    return "" if has_dynamics(scene) else "no stage is dynamic"


def _no_soil_boundary(scene: Scene) -> str:
    return "" if scene.soil is not None and scene.soil.absorbing else "soil.absorbing is not asked for"


def _no_half(scene: Scene) -> str:
    """The scene's sizes are chosen."""
    own = on_soil(scene)
    return "by symmetry" if own is not None and own.soil is not None and not why_all(own, own.soil) else ""


def _no_friction(scene: Scene, ground: str) -> str:
    if scene.contact is None or scene.contact.friction is None:
        return "no friction is asked for"
    if getattr(scene, ground) is None:
        return f"the scene has no {ground}"
    return "contact at nodes has none on soil" if ground == "soil" and scene.contact.at_nodes else ""


def _no_rotary_inertia(scene: Scene) -> str:
    if not has_dynamics(scene):
        return "no stage is dynamic"
    given = any(t.rotary_inertia for t in scene.used_line_types.values())
    return "" if given or resolved_dimension(scene) == 3 else "no line type has rotary inertia"


def _no_structural_damping(scene: Scene) -> str:
    if not has_dynamics(scene):
        return "no stage is dynamic"
    damped = any(t.damping and t.damping.ratio for t in scene.used_line_types.values())
    return "" if damped else "no line type has damping"


def _no_morison(scene: Scene) -> str:
    if scene.water is None:
        return "the scene has no water"
    if not has_dynamics(scene) and scene.water.current is None:
        return "no stage is dynamic, and still water does not load a riser at rest"
    types, attachments = scene.used_line_types.values(), scene.line.attachments
    resist = any(t.drag or t.added_mass or t.strakes for t in types)
    resist = resist or any(a.drag_area or a.added_mass for a in attachments)
    changes = scene.water.current is not None and scene.water.current.history is not None
    if resist or ((scene.water.waves or changes) and has_dynamics(scene)):
        return ""
    return "no line type has drag or added mass, nor any attachment"


def _no_vortices(scene: Scene) -> str:
    if not has_dynamics(scene):
        return "no stage is dynamic"
    return "" if any(t.vortices[0] for t in scene.used_line_types.values()) else "no line type has a vortex_force"


def _no_vortices_in_line(scene: Scene) -> str:
    if not has_dynamics(scene):
        return "no stage is dynamic"
    acts = any(t.in_line_vortices[0] for t in scene.used_line_types.values())
    return "" if acts else "no line type has a vortex_force.in_line"


def _no_buoyancy(scene: Scene) -> str:
    if scene.water is None:
        return "the scene has no water"
    return "the water has no surface: all is submerged" if scene.water.surface_level is None else ""


def unknowns(comm: Communicator, field: Field) -> int:
    """Free dofs of a field over all ranks; collective."""
    return int(comm.allreduce(int(np.count_nonzero(field.owned & ~field.prescribed))))
