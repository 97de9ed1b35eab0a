"""Draft of a scene from wishes to its text: YAML with comments."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import replace

from riser_soil.drafts.layout import Cut, LineLayout, Place, layout_of
from riser_soil.drafts.pipes import NU_STEEL, WATER, CrossSection
from riser_soil.drafts.wishes import CLAY, SeaState, Wishes, doubts_of, kind_of, pipe_of, refuse, sea_of
from riser_soil.errors import SceneError

RESPONSE = 0.25  # amplitude of the floater over Hs, where its RAOs are not known
WAVES, STEPS = 10, 60  # periods that the dynamic stage lasts, steps in one
COMMENT = 40  # column at which comments begin
BEDS = {
    "spring": ("seabed: {kind: spring, stiffness: 1.0e5}", "N/m2: force per length and penetration"),
    "rigid": ("seabed: {kind: rigid}", ""),
}
SU, GRADIENT = 2.0e3, 1.5e3  # Pa, Pa/m: soft clay
ALL = 12  # figures of a number: as many as anybody gives
Coded = tuple[str, str]  # a line of the file, its comment


def text(title: str, call: str, layout: LineLayout, sea: SeaState, wishes: Wishes) -> str:
    """The scene file; call: the command that wrote it."""
    head = (
        f"# {title}: a first draft by `{call}`. Units are SI; z = 0 is the seabed.",
        "# Its numbers are typical ones, not yours: check each of them.",
        f"title: {title}",
    )
    line = _line_types(layout), _riser(layout, wishes), _seabed(layout, wishes)
    parts = _water(sea), *line, _stages(layout, sea, wishes.rao)
    lines = (f"{code:<{COMMENT - 2}}  # {comment}" if comment else code for part in parts for code, comment in part)
    return "\n".join([*head, *lines]) + "\n"


def number(value: float, figures: int = ALL) -> str:
    """A float in so many figures that every reader of YAML takes for one: it has a point, and its exponent a sign."""
    digits = f"{value:.{figures}g}"
    if "e" not in digits and abs(value) >= 1e5:
        digits = f"{value:.{figures - 1}e}"
    mantissa, _, exponent = digits.partition("e")
    if exponent:
        mantissa = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    whole = mantissa if "." in mantissa else f"{mantissa}.0"
    return f"{whole}e{int(exponent):+d}" if exponent else whole


def _metres(value: float) -> str:
    """A length to the centimetre, below 10 m to six figures."""
    return number(round(value, 2)) if value > 10.0 else number(value, 6)


def _place(place: Place) -> str:
    """x and y as lengths; z, which the pipe's radius or the depth gives, with all its digits."""
    x, y, z = place
    return f"[{_metres(x)}, {_metres(y)}, {number(z)}]"


def _water(sea: SeaState) -> Iterator[Coded]:
    yield "water:", ""
    yield f"  density: {number(WATER)}", "kg/m3"
    yield f"  surface_level: {number(sea.depth)}", "m"
    if sea.current:
        profile = f"[[0.0, 0.0, 0.0], [{number(sea.depth)}, {number(sea.current)}, 0.0]]"
        yield f"  current: {{profile: {profile}}}", "z, u_x, u_y"
    if sea.Hs:
        yield "  waves:", "in dynamic load steps"
        height, period = number(sea.Hs), number(sea.Tp)
        yield f"    jonswap: {{Hs: {height}, Tp: {period}, seed: 1, direction_deg: 180.0}}", "m, s; towards -x"


def _line_types(layout: LineLayout) -> Iterator[Coded]:
    yield "line_types:", ""
    for name, pipe in layout.pipes.items():
        yield from _line_type(name, pipe)


def _line_type(name: str, pipe: CrossSection) -> Iterator[Coded]:
    across, along = pipe.drag
    yield f"  {name}:", pipe.source
    yield f"    outer_diameter: {number(pipe.outer)}", "m"
    if pipe.inner:
        yield f"    inner_diameter: {number(pipe.inner)}", ""
    yield f"    mass: {number(pipe.mass)}", "kg/m, empty, in air"
    yield f"    EA: {number(pipe.EA)}", "N"
    yield f"    EI: {number(pipe.EI)}", "N.m2"
    if pipe.EI:
        yield f"    GJ: {number(pipe.EI / (1.0 + NU_STEEL), 6)}", "N.m2; counts where the line leaves its plane"
    yield f"    drag: {{normal: {number(across)}, tangential: {number(along)}}}", ""
    yield f"    added_mass: {{normal: {number(pipe.added_mass)}}}", ""
    if pipe.min_bend_radius:
        yield f"    min_bend_radius: {number(pipe.min_bend_radius)}", "m"
    if pipe.max_tension:
        yield f"    max_tension: {number(pipe.max_tension)}", "N"
    if pipe.yield_stress:
        wall = f"{{yield_stress: {number(pipe.yield_stress)}, design_factor: 0.67}}"
        yield f"    wall: {wall}", "Pa; for stress results"


def _riser(layout: LineLayout, wishes: Wishes) -> Iterator[Coded]:
    pipe = next(iter(layout.pipes.values()))
    yield "riser:", ""
    if pipe.inner and pipe.contents:
        yield f"  contents: {{density: {number(pipe.contents)}}}", "kg/m3"
    yield "  segments:", "from end A (start) to end B (end); element lengths in m, or [first, last]"
    yield from ((f"    - {_segment(cut)}", "") for cut in layout.cuts)
    yield f"  start: {{position: {_place(layout.start)}}}", "end A; pinned"
    if layout.tension is not None:
        yield "  end:", "end B; guided sideways, with a tensioner of constant force"
        yield f"    position: {_place(layout.end)}", ""
        yield f"    tensioner: {{tension: {number(layout.tension, 3)}}}", "N"
    elif wishes.angle is not None:
        yield "  end:", "end B, the hang-off"
        yield f"    position: {_place(layout.end)}", "x is a first guess: the angle decides"
        yield f"    hang_off: {{angle: {number(wishes.angle)}}}", "deg from the vertical, at rest"
    else:
        yield f"  end: {{position: {_place(layout.end)}}}", "end B, the hang-off"


def _segment(cut: Cut) -> str:
    first, last = number(cut.first, 3), number(cut.last, 3)
    elements = first if first == last else f"[{first}, {last}]"
    return f"{{line_type: {cut.line_type}, length: {_metres(cut.length)}, element_length: {elements}}}"


def _seabed(layout: LineLayout, wishes: Wishes) -> Iterator[Coded]:
    if layout.tension is not None:
        return
    if wishes.bed != CLAY:
        yield BEDS[wishes.bed]
        return
    su, gradient = wishes.su or SU, wishes.gradient or GRADIENT
    clay = f"{{kind: randolph-quiggin, su: {number(su)}, su_gradient: {number(gradient)}}}"
    yield f"seabed: {{kind: hysteretic, law: {clay}}}", "clay: Pa, Pa/m"


def _stages(layout: LineLayout, sea: SeaState, rao: str | None) -> Iterator[Coded]:
    yield "stages:", "load steps"
    yield "  - {name: rest, kind: static}", ""
    if not sea.Hs:
        return
    yield "  - name: storm", ""
    yield "    kind: dynamic", ""
    yield f"    duration: {number(WAVES * sea.Tp)}", "s; extremes of a storm take hours, or several seeds"
    yield f"    time_step: {number(sea.Tp / STEPS, 3)}", ""
    if rao is None:
        yield "    motion:", "in place of the floater's; {vessel: {rao: rao.csv, ...}} follows the waves"
        yield f"      end: {{harmonic: {_harmonic(layout, sea)}}}", ""
    else:
        yield "    motion:", "reference: the point of the RAOs, here the hang-off: give the vessel's own"
        yield f"      end: {{vessel: {{rao: {json.dumps(rao)}, reference: {_place(layout.end)}}}}}", ""
    yield f"output: {{interval: {number(sea.Tp / STEPS, 3)}}}", "s"


def _harmonic(layout: LineLayout, sea: SeaState) -> str:
    surge, period = number(RESPONSE * sea.Hs, 3), number(sea.Tp)
    heave = surge if layout.tension is None else "0.0"
    return f"{{amplitude: [{surge}, 0.0, {heave}], period: {period}, phase_deg: [90.0, 0.0, 0.0], ramp: {period}}}"


def draft(name: str, wishes: Wishes, call: str) -> str:
    """The scene file of a kind, as yet unchecked; SceneError where a wish can't be met.

    call: the command, for the file's first line.
    """
    try:
        kind = kind_of(name)
        refuse(wishes, kind)
        if wishes.angle is not None:
            kind = replace(kind, angle=math.radians(wishes.angle))
        sea = sea_of(kind, wishes)
        return text(kind.title, call, layout_of(kind, pipe_of(kind, wishes), sea.depth), sea, wishes)
    except SceneError as err:
        raise SceneError("\n".join([*doubts_of(wishes), str(err)])) from err
