"""Table of outputs at an instant: effective tension, bending moment, contact force, touchdown, soil stress and more.

The scene's choices, the variables of results.nc, the fields of the XDMF files, the summary and the screen follow
from it. Each part of the table is in the order of results.nc, and of the list of fields in the scene.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from riser_soil.core.output import (
    Figure,
    OutputQuantity,
    Row,
    angle_deg,
    bend_radius,
    extreme_along,
    greatest,
    greatest_in_soil,
    greatest_known,
    least,
    near_greatest,
    resultant,
)

if TYPE_CHECKING:
    from riser_soil.core.snapshot import Record, SoilSnapshot

_ON_RISER = "exerted by the support on the riser; global axes, z up"
_ON_START = "right-hand rule; exerted by the part towards the end on the part towards the start"
_RIGHT_HAND = "right-hand rule; " + _ON_RISER
_EXCEEDED = "above 1 the code is not met"
_TOP = Row("top tension", "kN", 1e-3)

ALONG_RISER: tuple[OutputQuantity[Record], ...] = (
    OutputQuantity(
        "position", "x", "m", "position of the riser's axis", "nodes",
        "global axes, z up", vector=True, always=True,
        figures=(
            Figure("start.position", lambda x: x[..., 0, :], 3),
            Figure("end.position", lambda x: x[..., -1, :], 3),
        ),
    ),
    OutputQuantity(
        "effective_tension", "T", "N", "effective tension", "nodes",
        "positive in tension",
        figures=(
            Figure("start.effective_tension", lambda T: T[..., 0], row=_TOP),
            Figure("end.effective_tension", lambda T: T[..., -1], row=_TOP),
        ),
    ),
    OutputQuantity(
        "wall_tension", "T_w", "N", "true wall tension, T + p_i A_i - p_o A_o", "nodes",
        "positive in tension", needs="pressures",
        figures=(
            least("min_wall_tension", Row("least true wall tension", "kN", 1e-3)),
            greatest("max_wall_tension", Row("largest true wall tension", "kN", 1e-3)),
        ),
    ),
    OutputQuantity(
        "bending_moment", "M", "N m", "magnitude of the bending moment", "nodes",
    ),
    OutputQuantity(
        "curvature", "κ", "m-1", "magnitude of the curvature", "nodes",
    ),
    OutputQuantity(
        "bend_utilisation", "", "1", "bend utilisation: curvature times the minimum bend radius allowed (MBR)", "nodes",
        "above 1 the pipe is bent too much", needs="min_bend_radius",
    ),
    OutputQuantity(
        "tension_utilisation", "", "1", "tension utilisation: effective tension over max_tension", "nodes",
        "above 1 the riser is pulled too much, below 0 it is compressed",
        needs="max_tension",
        figures=(greatest_known("max_tension_utilisation", Row("tension utilisation")),),
    ),
    OutputQuantity(
        "internal_pressure", "p_i", "Pa", "pressure of the contents", "nodes",
        needs="wall",
    ),
    OutputQuantity(
        "external_pressure", "p_o", "Pa", "pressure of the water around, at rest", "nodes",
        needs="wall",
    ),
    OutputQuantity(
        "bending_moment_y", "M_y", "N m", "bending moment about the section's y axis", "nodes",
        _ON_START, needs="wall",
    ),
    OutputQuantity(
        "bending_moment_z", "M_z", "N m", "bending moment about the section's z axis", "nodes",
        _ON_START, needs="wall in space",
    ),
    OutputQuantity(
        "torque", "M_x", "N m", "torque about the pipe's own axis", "nodes",
        _ON_START, needs="wall in space",
    ),
    OutputQuantity(
        "wall_axial_stress", "", "Pa", "stress of the wall tension along the pipe", "nodes",
        "positive in tension", needs="wall",
    ),
    OutputQuantity(
        "wall_bending_stress", "", "Pa", "largest bending stress around the wall's outer surface", "nodes",
        ">= 0", needs="wall",
    ),
    OutputQuantity(
        "wall_hoop_stress", "", "Pa", "hoop stress at the wall's inner surface", "nodes",
        "positive in tension", needs="wall",
    ),
    OutputQuantity(
        "wall_von_mises_stress", "", "Pa", "largest von Mises stress around the wall, inside and outside", "nodes",
        ">= 0", needs="wall",
        figures=(greatest_known("max_wall_von_mises_stress", Row("von Mises stress of the wall", "MPa", 1e-6)),),
    ),
    OutputQuantity(
        "stress_utilisation", "", "1", "stress utilisation: von Mises stress of the wall over the allowable", "nodes",
        "above 1 the wall is stressed too much",
        needs="yield stress",
        figures=(greatest_known("max_stress_utilisation", Row("stress utilisation")),),
    ),
    OutputQuantity(
        "code_utilisation", "", "1", "largest utilisation by codes, of all checks of code_check", "nodes",
        _EXCEEDED, needs="code check",
        figures=(greatest_known("max_code_utilisation", Row("code checks: largest utilisation")),),
    ),
    OutputQuantity(
        "bursting_utilisation", "", "1", "utilisation in bursting by the code", "nodes",
        _EXCEEDED, needs="bursting",
        figures=(greatest_known("max_bursting_utilisation", Row("code: bursting")),),
    ),
    OutputQuantity(
        "hoop_buckling_utilisation", "", "1", "utilisation in hoop buckling, or collapse, by the code", "nodes",
        _EXCEEDED, needs="hoop buckling",
        figures=(greatest_known("max_hoop_buckling_utilisation", Row("code: hoop buckling")),),
    ),
    OutputQuantity(
        "propagating_buckling_utilisation", "", "1", "utilisation in propagating buckling by the code", "nodes",
        _EXCEEDED, needs="propagating buckling",
        figures=(greatest_known("max_propagating_buckling_utilisation", Row("code: propagating buckling")),),
    ),
    OutputQuantity(
        "combined_loading_utilisation", "", "1", "utilisation under combined loading by the code", "nodes",
        _EXCEEDED, needs="combined loading",
        figures=(greatest_known("max_combined_loading_utilisation", Row("code: combined loading")),),
    ),
    OutputQuantity(
        "bend_radius_utilisation", "", "1", "curvature times the least bend radius allowed in the stage", "nodes",
        _EXCEEDED, needs="bend radius",
        figures=(greatest_known("max_bend_radius_utilisation", Row("code: bend radius")),),
    ),
    OutputQuantity(
        "tension_limit_utilisation", "", "1", "effective tension over the limit of the code check", "nodes",
        _EXCEEDED, needs="tension limit",
        figures=(greatest_known("max_tension_limit_utilisation", Row("code: tension")),),
    ),
    OutputQuantity(
        "compression_utilisation", "", "1", "effective compression over the limit of the code check", "nodes",
        _EXCEEDED, needs="compression",
        figures=(greatest_known("max_compression_utilisation", Row("code: compression")),),
    ),
    OutputQuantity(
        "crushing_utilisation", "", "1", "contact force over the limit of the code check", "nodes",
        _EXCEEDED, needs="crushing",
        figures=(greatest_known("max_crushing_utilisation", Row("code: crushing")),),
    ),
    OutputQuantity(
        "capacity_curve_utilisation", "", "1", "tension and curvature over the capacity curve", "nodes",
        _EXCEEDED, needs="capacity curve",
        figures=(greatest_known("max_capacity_curve_utilisation", Row("code: capacity curve")),),
    ),
    OutputQuantity(
        "contact_force", "f", "N m-1", "contact force per length of riser", "nodes",
        "positive where the ground pushes",
    ),
    OutputQuantity(
        "penetration", "", "m", "penetration of the riser's underside into the ground as it is at the time", "nodes",
        ">= 0", needs="ground",
    ),
    OutputQuantity(
        "embedment", "", "m",
        "greatest depth yet of the riser's underside below the ground as it lay before the riser came", "nodes",
        ">= 0", needs="ground",
        figures=(greatest("max_embedment", Row("deepest embedment", "mm", 1e3)),),
    ),
    OutputQuantity(
        "slip", "", "m", "length of the way that the riser has slid over the seabed so far", "nodes",
        ">= 0", needs="friction",
    ),
    OutputQuantity(
        "soil_settlement", "", "m",
        "settlement of the soil's surface under the riser since before it came; nan beside the soil", "nodes",
        "positive downwards", needs="soil",
    ),
    OutputQuantity(
        "force_on_soil", "", "N m-1", "force per length of riser, from the forces at the soil's nodes", "nodes",
        "exerted by the riser on the soil; global axes, z up", vector=True,
        needs="soil",
    ),
    OutputQuantity(
        "moment_vector", "", "N m", "section moment", "nodes",
        "right-hand rule, global axes; exerted by the part towards the end on the part towards the start", vector=True,
    ),
)  # fmt: skip

ACROSS_RISER: tuple[OutputQuantity[Record], ...] = (
    OutputQuantity(
        "section_arc", "", "m", "arc length of the riser where it lay over the section", "sections",
        needs="soil",
    ),
    OutputQuantity(
        "section_position", "", "m", "place of the section: position of the riser's axis there", "sections",
        "global axes, z up", vector=True, needs="soil",
    ),
    OutputQuantity(
        "section_direction", "", "1", "horizontal unit vector across the riser", "sections",
        "to the left, seen from above along growing arc length", vector=True, needs="soil",
    ),
    OutputQuantity(
        "settlement_across", "", "m",
        "settlement of the soil's surface in sections across the riser; nan beside the soil", "across",
        "positive downwards", needs="soil",
    ),
)  # fmt: skip

OF_MODEL: tuple[OutputQuantity[Record], ...] = (
    OutputQuantity(
        "start_force", "", "N", "force at the start", "model",
        _ON_RISER, vector=True,
        figures=(Figure("start.force", size=3), Figure("start.resultant_force", resultant)),
    ),
    OutputQuantity(
        "end_force", "", "N", "force at the end", "model",
        _ON_RISER, vector=True,
        figures=(Figure("end.force", size=3), Figure("end.resultant_force", resultant)),
    ),
    OutputQuantity(
        "start_moment", "", "N m", "moment at the start", "model",
        _RIGHT_HAND, vector=True, figures=(Figure("start.moment", size=3),),
    ),
    OutputQuantity(
        "end_moment", "", "N m", "moment at the end", "model",
        _RIGHT_HAND, vector=True, figures=(Figure("end.moment", size=3),),
    ),
    OutputQuantity(
        "start_angle", "", "degree", "angle of the start from the horizontal", "summary",
        "positive where the riser rises with its arc", get=lambda r: angle_deg(r.start_tangent),
        figures=(Figure("start.angle_deg"),),
    ),
    OutputQuantity(
        "end_angle", "", "degree", "angle of the end from the horizontal", "summary",
        "positive where the riser rises with its arc", get=lambda r: angle_deg(r.end_tangent),
        figures=(Figure("end.angle_deg"),),
    ),
    OutputQuantity(
        "touchdown_arc", "", "m",
        "arc length of the touchdown point towards the end: where a rigid contact with the resultant and moment of the "
        "contact forces would end; nan when nothing touches", "model",
        figures=(Figure("touchdown_arc", row=Row("TDP, arc length", "m")),),
    ),
    OutputQuantity(
        "touchdown_position", "", "m", "position of the riser's axis at the touchdown point", "model",
        "global axes, z up", vector=True,
        figures=(Figure("touchdown_position", size=3, row=Row("TDP, x, y, z", "m")),),
    ),
    OutputQuantity(
        "touchdown_points", "", "1",
        "places where the riser comes down or leaves the seabed, without its ends", "model",
        dtype="i4",
        figures=(Figure("touchdown_points", row=Row("touchdown points")),),
    ),
    OutputQuantity(
        "min_effective_tension", "", "N", "least effective tension along the riser", "model",
        "negative in compression", get=lambda r: r.least_tension,
    ),
    OutputQuantity(
        "min_effective_tension_arc", "", "m", "arc length of the least effective tension", "model",
        get=lambda r: r.least_tension_arc,
    ),
    OutputQuantity(
        "least_tension", "", "N", "least effective tension along the riser, with its place", "summary",
        "negative in compression", get=lambda r: r.extreme("least_tension"),
        figures=(extreme_along("min_effective_tension", Row("least effective tension", "kN", 1e-3)),),
    ),
    OutputQuantity(
        "largest_bending_moment", "", "N m", "largest bending moment, between nodes too", "summary",
        get=lambda r: r.extreme("largest_moment"),
        figures=(extreme_along("max_bending_moment", Row("largest bending moment", "kN m", 1e-3)),),
    ),
    OutputQuantity(
        "largest_curvature", "", "m-1", "largest curvature, between nodes too", "summary",
        get=lambda r: r.extreme("largest_curvature"),
        figures=(
            extreme_along("max_curvature", Row("largest curvature", "1/m")),
            Figure(
                "min_bend_radius",
                lambda largest: bend_radius(largest.value),
                arc=lambda largest: largest.arc,
                row=Row("minimum bend radius", "m"),
            ),
        ),
    ),
    OutputQuantity(
        "largest_bend_utilisation", "", "1", "largest bend utilisation, between nodes too", "summary",
        get=lambda r: r.extreme("largest_bend_utilisation"), needs="min_bend_radius",
        figures=(extreme_along("max_bend_utilisation", Row("bend utilisation, MBR over bend radius")),),
    ),
    OutputQuantity(
        "min_bend_radius", "", "m", "minimum bend radius, one over the largest curvature, between nodes too", "model",
        get=lambda r: bend_radius(r.largest_curvature),
    ),
    OutputQuantity(
        "min_bend_radius_arc", "", "m", "arc length of the minimum bend radius", "model",
        get=lambda r: r.largest_curvature_arc,
    ),
    OutputQuantity(
        "max_penetration", "", "m", "deepest penetration of the riser into the seabed", "model",
        ">= 0",
        figures=(Figure("max_penetration", row=Row("deepest penetration", "mm", 1e3)),),
    ),
    OutputQuantity(
        "contact_force_sum", "", "N", "sum of the contact forces", "model",
        "exerted by the seabed on the riser; global axes, z up", vector=True,
        figures=(Figure("contact_force", lambda F: F[..., 2], row=Row("contact force", "kN", 1e-3)),),
    ),
)  # fmt: skip

OF_SOIL: tuple[OutputQuantity[SoilSnapshot], ...] = (
    OutputQuantity(
        "displacement", "u", "m", "displacement since the geostatic start", "soil points",
        "global axes, z up", get=lambda soil: soil.displacement, vector=True,
        figures=(
            Figure(
                "max_settlement",
                lambda u: -u[:, 2].min(),
                node=lambda u: near_greatest(-u[:, 2]),
                row=Row("soil: deepest settlement", "mm", 1e3),
            ),
        ),
    ),
    OutputQuantity(
        "mean_stress", "p", "Pa", "mean stress beyond the water pressure at rest", "soil cells",
        "positive in compression", get=lambda soil: soil.mean_stress,
    ),
    OutputQuantity(
        "von_mises_stress", "q", "Pa", "von Mises stress", "soil cells", ">= 0", get=lambda soil: soil.von_mises,
        figures=(greatest_in_soil("max_von_mises_stress", Row("soil: largest von Mises stress", "kPa", 1e-3)),),
    ),
    OutputQuantity(
        "strength_used", "", "1", "equivalent stress over its limit", "soil cells",
        ">= 0; 0 where the soil has no limit", get=lambda soil: soil.strength_used,
        figures=(greatest_in_soil("max_strength_used", Row("soil: most of its strength used")),),
    ),
    OutputQuantity(
        "equivalent_plastic_strain", "", "1", "equivalent plastic strain", "soil cells",
        ">= 0", get=lambda soil: soil.plastic_strain,
        figures=(greatest_in_soil("max_equivalent_plastic_strain", Row("soil: largest plastic strain")),),
    ),
)  # fmt: skip


def of_instant() -> tuple[OutputQuantity[Record], ...]:
    """All that follows from the riser and its contact."""
    return (*ALONG_RISER, *ACROSS_RISER, *OF_MODEL)


def choices() -> tuple[str, ...]:
    """Names of the outputs among which a scene may choose."""
    outputs: tuple[OutputQuantity[Any], ...] = (*of_instant(), *OF_SOIL)
    return tuple(output.name for output in outputs if output.chosen)


def unrecorded(fields: Collection[str]) -> set[str]:
    """Names of the outputs that are not recorded where these are. Figures of whole sections go with the values across
    them.
    """
    unwanted = {name for name in choices() if name not in fields}
    of_sections = {output.name for output in ACROSS_RISER}
    return unwanted | (of_sections if of_sections & unwanted else set())


def known(names: Iterable[str], has: Collection[str]) -> tuple[str, ...]:
    """The names of outputs whose needs a run meets."""
    unknown = {output.name for output in of_instant() if output.needs and output.needs not in has}
    return tuple(name for name in names if name not in unknown)


def figures(order: Sequence[str]) -> list[tuple[OutputQuantity[Record], Figure]]:
    """All figures of the summary with their outputs: those named in their order, then the rest in the table's."""
    pairs = [(output, figure) for output in of_instant() for figure in output.figures]
    rank = {name: place for place, name in enumerate(order)}
    return sorted(pairs, key=lambda item: rank.get(item[1].name, len(rank)))


def upper_end(final: Mapping[str, Any]) -> str:
    """"start" or "end" of a riser, by its figures at an instant; of two ends at one height the last."""
    return "start" if final["start"]["position"][2] > final["end"]["position"][2] else "end"


def row_of(figure: Figure, final: Mapping[str, Any]) -> Row | None:
    """Its row on the screen, None for none: of the tensions at the ends the upper one's alone.

    final: all figures at an instant.
    """
    return figure.row if figure.row is not _TOP or figure.path[0] == upper_end(final) else None
