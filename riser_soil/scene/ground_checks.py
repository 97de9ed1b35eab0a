"""Checks of seabed, soil and contact with them, of ends on the ground, and of a trench or groove."""

from collections.abc import Iterator

from riser_soil.scene.bathymetry import ground_height
from riser_soil.scene.plane import positions, vertical_plane
from riser_soil.scene.problem import Path, Problem
from riser_soil.scene.riser import Support
from riser_soil.scene.scene import Scene
from riser_soil.scene.seabed import HystereticSeabed, RigidSeabed
from riser_soil.scene.seabed_features import Trench
from riser_soil.scene.soil import Block
from riser_soil.seabed.bearing import Strength

# Part of its radius by which a prescribed end may lie in a rigid seabed.
_SUNK = 0.02
# How far an end may lie below the seabed for the round-off of its height [m].
ROUND_OFF = 1e-9
# Component of the riser's direction in plan across an axis that it may have to run along it.
_ASKEW = 1e-6


def ground_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of seabed, soil, contact and the ends on them."""
    for check in (
        _contact_with_something,
        _seabed_has_one_shape,
        _grid_under_the_riser,
        _ground_can_do_so,
        _ground_has_a_strength,
        _surface_of_a_pipe_and_soil,
        _ends_above_seabed,
    ):
        yield from check(scene)


def _contact_with_something(scene: Scene) -> Iterator[Problem]:
    if scene.contact and not scene.seabed and not scene.soil:
        yield Problem(("contact",), "there is nothing to touch", "add seabed or soil, or leave out contact")


def _seabed_has_one_shape(scene: Scene) -> Iterator[Problem]:
    seabed = scene.seabed
    if seabed is None:
        return
    if seabed.profile is not None and (seabed.level or seabed.slope_deg):
        yield Problem(("seabed", "profile"), "is given beside level or slope_deg", "give either")
    if seabed.grid is not None and (seabed.level or seabed.slope_deg or seabed.profile is not None):
        yield Problem(("seabed", "grid"), "is given beside level, slope_deg or profile", "give one of them")
    if scene.soil is not None and (seabed.profile is not None or seabed.grid is not None or seabed.slope_deg):
        key = "slope_deg" if seabed.slope_deg else "profile" if seabed.profile is not None else "grid"
        yield Problem(("seabed", key), "the soil's top is level, and so must be the seabed beside it", "leave it out")


def _grid_under_the_riser(scene: Scene) -> Iterator[Problem]:
    """Between the points that the scene names the riser's way in the plan is nearly straight."""
    if scene.seabed is None or scene.seabed.grid is None:
        return
    heights = scene.seabed.grid.heights
    for path, (x, y, _) in positions(scene):
        if not heights.holds(x, y):
            allowed = f"{'.'.join(map(str, path))}, x = {x:g}, y = {y:g} m, lies beyond the grid: {heights.extent}"
            yield Problem(("seabed", "grid"), allowed, "take a grid that reaches farther")
            return


def _ground_can_do_so(scene: Scene) -> Iterator[Problem]:
    if scene.contact is None:
        return
    on_soil = scene.soil is not None and not scene.contact.at_nodes
    for key in ("friction", "suction"):
        if getattr(scene.contact, key) and scene.seabed is None and not on_soil:
            text = "acts on a seabed or on the soil's surface, and there is neither"
            yield Problem(("contact", key), text, "add seabed, or leave out contact.method: node, or leave it out")
    if scene.contact.suction and isinstance(scene.seabed, HystereticSeabed) and not on_soil:
        yield Problem(("contact", "suction"), "a hysteretic seabed has its own, in seabed.law", "leave it out")


def _ground_has_a_strength(scene: Scene) -> Iterator[Problem]:
    """Adhesion is a share of su: some ground must have it, and all of it where no coefficient is given."""
    friction = scene.contact.friction if scene.contact is not None else None
    if friction is None or friction.adhesion is None:
        return
    without = [name for name, strength in _strengths(scene) if strength is None]
    path = ("contact", "friction", "adhesion")
    if without and len(without) == len([*_strengths(scene)]):
        text = f"is a share of the undrained shear strength su, and {' and '.join(without)} has none"
        yield Problem(path, text, "give axial, the coefficient of friction, instead, or take a ground of clay")
    elif without and friction.axial is None:
        text = f"is a share of the undrained shear strength su, and beside the clay {' and '.join(without)} has none"
        yield Problem(path, text, "give axial, too, the coefficient of friction there")


def _strengths(scene: Scene) -> Iterator[tuple[str, float | Strength | None]]:
    """What friction may act on, and its undrained shear strength, None where it has none."""
    if scene.soil is not None and scene.contact is not None and not scene.contact.at_nodes:
        for law in scene.soil.laws_at_top:
            yield f"soil that is {law.kind}", law.undrained_strength(0.0)
    if scene.seabed is not None:
        yield f"the {scene.seabed.kind} seabed", scene.seabed.undrained_strength


def _surface_of_a_pipe_and_soil(scene: Scene) -> Iterator[Problem]:
    if scene.contact is None:
        return
    if scene.contact.method == "surface" and scene.soil is None:
        remedy = "add soil, or take line or node"
        yield Problem(("contact", "method"), "surface is contact with soil, and the scene has none", remedy)
    if scene.soil is not None and scene.contact_at == "axis" and not scene.contact.at_nodes:
        remedy = "write outer, or contact.method: node"
        yield Problem(("seabed", "contact_at"), "the axis has no surface to touch the soil with", remedy)


def _ends_above_seabed(scene: Scene) -> Iterator[Problem]:
    if not scene.contact:
        return
    types = [scene.line_types[scene.line.segments[n].line_type] for n in (0, -1)]
    ends = {"start": scene.line.start, "end": scene.line.end}
    for (key, end), line in zip(ends.items(), types, strict=True):
        if not isinstance(end, Support) or end.jointed:  # where a joint is, `line_checks` looks
            continue
        ground = ground_height(scene, end.position)
        sunk = ground - end.position[2]
        radius = 0.5 * (line.outer_diameter or 0.0) if scene.contact_at == "outer" else 0.0
        if sunk > ROUND_OFF and not scene.laid_from_below:
            yield below_seabed(("riser", key, "position"), ground)
        elif isinstance(scene.seabed, RigidSeabed) and scene.soil is None and sunk + radius > _SUNK * radius:
            allowed = f"would press the pipe {sunk + radius:.3g} m into the rigid seabed"
            yield Problem(("riser", key, "position"), allowed, f"raise it to z = {ground + radius:g} m")


def below_seabed(path: Path, ground: float) -> Problem:
    """The problem of a position below the seabed, whose height is z = ground [m]."""
    allowed = f"must not lie below the seabed (z = {ground:g} m)"
    return Problem(path, allowed, "raise the position or lower the seabed")


def feature_conflicts(scene: Scene) -> Iterator[Problem]:
    """Conflicts of the block's trench or groove with the riser and the block."""
    block = scene.soil.given_block if scene.soil else None
    if block is None or block.feature is None:
        return
    direction = vertical_plane(scene).direction
    axis = int(abs(direction[1]) > abs(direction[0]))
    path: Path = ("soil", "block", "trench" if block.trench else "groove")
    if abs(direction[1 - axis]) > _ASKEW:
        allowed = "lies along x or y, and the riser, seen from above, runs askew to both"
        yield Problem(path, allowed, "turn the scene so that the riser runs along x, or give a mesh file")
    elif _half_width(scene, block) <= 0.0:
        yield Problem(path, "needs the pipe's diameter", "give groove.diameter, or outer_diameter of the line types")
    else:
        yield from _within_the_block(scene, block, path, axis)


def _half_width(scene: Scene, block: Block) -> float:
    if block.trench is not None:
        return block.trench.half_width
    return 0.5 * ((block.groove.diameter if block.groove else None) or scene.largest_diameter)


def _within_the_block(scene: Scene, block: Block, path: Path, axis: int) -> Iterator[Problem]:
    """axis: x (0) or y (1), along which the riser runs."""
    wide, line = _half_width(scene, block), vertical_plane(scene).origin[1 - axis]
    low, high = (block.x, block.y)[1 - axis]
    if not low < line - wide < line + wide < high:
        name = "yx"[axis]
        allowed = f"is {2.0 * wide:.4g} m wide at the seabed about {name} = {line:g} m and leaves the block's {name}"
        yield Problem(path, allowed, "widen the block, or take less")
    along = block.feature.along if isinstance(block.feature, Trench) else None
    first, last = (block.x, block.y)[axis]
    if along is not None and not (along[0] < last and along[1] > first):
        allowed = f"lies beyond the block's {'xy'[axis]}, {first:g} to {last:g} m"
        yield Problem((*path, "along"), allowed, "move either")
