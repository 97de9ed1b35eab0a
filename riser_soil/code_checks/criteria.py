"""Utilisations of one line type by one check of a scene: the code's formulas with the scene's keys.

Each check is a class of this module, made of its keys and the pipe's diameters. `criteria` are the utilisations that
it finds, in order; `utilisations` finds them from load effects at nodes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from riser_soil.code_checks import api_rp_2rd, api_std_2rd, capacity_curve, dnv_st_f201, flexible_pipe
from riser_soil.code_checks.collapse import elastic_collapse_pressure
from riser_soil.code_checks.load_effects import LoadEffects, design_effects
from riser_soil.core.arrays import Array
from riser_soil.scene.code_check import (
    ApiCheck,
    ApiStressCheck,
    CapacityCurveCheck,
    Check,
    DnvCheck,
    FlexiblePipeCheck,
    SteelCheck,
)
from riser_soil.scene.line_types import LineType


class Criterion(NamedTuple):
    """A criterion of a code: the name of its utilisation, less that word,, its words, and its clause."""

    field: str
    words: str
    clause: str


class NodeLoads(NamedTuple):
    """Loads at nodes (..., n) at instants.

    effects: moments are the pipe's own share, without a bend stiffener's. inside, outside: pressures [Pa];
    at_reference (..., 1): that inside at the level to which the contents' pressure refers [Pa]. curvature: 1/m.
    contact_force: N/m. moving: whether the stage is dynamic.
    """

    effects: LoadEffects
    inside: Array
    outside: Array
    at_reference: Array
    curvature: Array
    contact_force: Array
    moving: bool


class Criteria(Protocol):
    """A check of one line type."""

    @property
    def code(self) -> str: ...

    @property
    def limit_state(self) -> str: ...

    @property
    def safety_class(self) -> str: ...

    @property
    def criteria(self) -> tuple[Criterion, ...]: ...

    def utilisations(self, loads: NodeLoads) -> Mapping[str, Array]:
        """Utilisations by the fields of the criteria, (..., n)."""
        ...


class Steel(NamedTuple):
    """Outer diameter and nominal thickness of a steel pipe's wall [m], on which the pressures act."""

    diameter: float
    thickness: float


def local_design_pressure(check: SteelCheck, loads: NodeLoads) -> tuple[Array, Array]:
    """Local design pressure (..., n), and design pressure (..., 1) at the contents' level [Pa].

    Those of the run, unless the scene gives the latter.
    """
    if check.design_pressure is None:
        return loads.inside, loads.at_reference
    design = np.full_like(loads.at_reference, check.design_pressure)
    return loads.inside + (design - loads.at_reference), design


def minimum_pressure(check: SteelCheck, loads: NodeLoads) -> Array | float:
    """Least pressure inside [Pa]."""
    return loads.inside if check.minimum_pressure == "contents" else float(check.minimum_pressure)


_DNV = "DNV-OS-F201 (2010) sec. 5 D"


@dataclass(frozen=True)
class DnvCriteria:
    """DNV-ST-F201: bursting and hoop buckling with t1, propagating buckling and combined loading with t2."""

    check: DnvCheck
    pipe: Steel

    code = "DNV-ST-F201"
    criteria = (
        Criterion("bursting", "bursting", _DNV),
        Criterion("hoop_buckling", "hoop buckling", _DNV),
        Criterion("propagating_buckling", "propagating buckling", _DNV),
        Criterion("combined_loading", "combined loading", _DNV),
    )

    @property
    def limit_state(self) -> str:
        return self.check.limit_state

    @property
    def safety_class(self) -> str:
        return self.check.safety_class

    @cached_property
    def gamma(self) -> float:
        """Material factor times safety class factor."""
        given = self.check.material_factor
        material = dnv_st_f201.MATERIAL_FACTORS[self.check.limit_state] if given is None else given
        return material * dnv_st_f201.SAFETY_CLASS_FACTORS[self.check.safety_class]

    @cached_property
    def t2(self) -> float:
        """m, less the corrosion allowance."""
        return self.pipe.thickness - self.check.corrosion_allowance

    @cached_property
    def t1(self) -> float:
        """m, less the fabrication tolerance too."""
        return self.t2 - self.check.fabrication_tolerance

    @cached_property
    def strengths(self) -> tuple[Array, Array]:
        """fy and fu [Pa]."""
        c = self.check
        return (
            dnv_st_f201.characteristic_strength(c.yield_stress, c.yield_derating, c.material_strength_factor),
            dnv_st_f201.characteristic_strength(c.tensile_strength, c.tensile_derating, c.material_strength_factor),
        )

    def collapse(self, t: float) -> Array:
        """p_c [Pa] of a wall of this thickness [m]."""
        c, D, (fy, _) = self.check, self.pipe.diameter, self.strengths
        p_p = dnv_st_f201.plastic_collapse_pressure(D, t, fy, c.fabrication_factor)
        return dnv_st_f201.collapse_resistance(elastic_collapse_pressure(D, t, c.E, c.nu), p_p, c.ovality, D, t)

    def utilisations(self, loads: NodeLoads) -> dict[str, Array]:
        D, (fy, fu), gamma, p_e = self.pipe.diameter, self.strengths, self.gamma, loads.outside
        p_ld, p_d = local_design_pressure(self.check, loads)
        p_li = p_ld + (self.check.incidental_ratio - 1.0) * p_d
        p_min = minimum_pressure(self.check, loads)
        p_b = dnv_st_f201.bursting_resistance(D, self.t1, fy, fu)
        p_pr = dnv_st_f201.propagating_pressure(D, self.t2, fy, self.check.fabrication_factor)
        return {
            "bursting": dnv_st_f201.bursting(p_li, p_e, p_b, gamma),
            "hoop_buckling": dnv_st_f201.hoop_buckling(p_e, p_min, self.collapse(self.t1), gamma),
            "propagating_buckling": dnv_st_f201.propagating_buckling(p_e, p_min, p_pr, gamma),
            "combined_loading": self._combined(loads.effects, p_ld - p_e, np.maximum(p_e - p_min, 0.0)),
        }

    def _combined(self, effects: LoadEffects, inner: Array, outer: Array) -> Array:
        """The larger of both criteria, where each applies. inner: p_ld - p_e; outer: p_e - p_min, at least 0 [Pa].

        Under the least pressure inside no hoop stress hardens the wall.
        """
        D, t, (fy, fu), gamma = self.pipe.diameter, self.t2, self.strengths, self.gamma
        p_b = dnv_st_f201.bursting_resistance(D, t, fy, fu)
        M_d, T_d = design_effects(effects, dnv_st_f201.LOAD_FACTORS[self.check.limit_state])

        def shares(overpressure: Array | float) -> tuple[Array, Array]:
            alpha_c = dnv_st_f201.flow_stress_parameter(D, t, fy, fu, overpressure, p_b)
            M_k, T_k = (of(D, t, fy, alpha_c) for of in (dnv_st_f201.plastic_moment, dnv_st_f201.plastic_tension))
            return M_d / M_k, T_d / T_k

        internal = dnv_st_f201.combined_internal(*shares(inner), np.maximum(inner, 0.0), p_b, gamma)
        external = dnv_st_f201.combined_external(*shares(0.0), outer, self.collapse(t), gamma)
        return np.maximum(np.where(inner >= 0.0, internal, 0.0), np.where((inner < 0.0) | (outer > 0.0), external, 0.0))


_API = "API STD 2RD (2013) "


@dataclass(frozen=True)
class ApiCriteria:
    """API STD 2RD: bursting and collapse of the corroded wall, combined loads by method 1 or 2 on the nominal one."""

    check: ApiCheck
    pipe: Steel

    code = "API STD 2RD"
    safety_class = ""

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        clause = "5.4.3.2" if self.check.method == 1 else "5.4.3.3"
        return (
            Criterion("bursting", "bursting", _API + "5.3.2, 5.4"),
            Criterion("hoop_buckling", "collapse", _API + "5.3.3, 5.4"),
            Criterion("combined_loading", f"combined loading, method {self.check.method}", _API + clause),
        )

    @property
    def limit_state(self) -> str:
        return self.check.case

    @cached_property
    def strengths(self) -> tuple[float, float]:
        """S and U [Pa], less what temperature takes."""
        c = self.check
        return c.yield_stress - c.yield_derating, c.tensile_strength - c.tensile_derating

    @cached_property
    def resistances(self) -> tuple[Array, Array]:
        """p_b and p_c [Pa]."""
        c, D, (S, U), t = self.check, self.pipe.diameter, self.strengths, self.pipe.thickness
        t -= c.corrosion_allowance
        p_c = api_std_2rd.collapse_pressure(
            api_std_2rd.yield_collapse_pressure(D, t, S), elastic_collapse_pressure(D, t, c.E, c.nu)
        )
        return api_std_2rd.burst_pressure(D, t, S, U, c.wall_variability), p_c

    def utilisations(self, loads: NodeLoads) -> dict[str, Array]:
        c, (p_b, p_c), p_e = self.check, self.resistances, loads.outside
        p_ld, _ = local_design_pressure(c, loads)
        p_min = minimum_pressure(c, loads)
        inner, outer = api_std_2rd.overpressure(p_ld, p_e, p_b), api_std_2rd.overpressure(p_e, p_min, p_c)
        combined = (self._combined(loads.effects, *each) for each in ((inner, 0.0), (0.0, outer)))
        return {
            "bursting": inner / c.burst_factor,
            "hoop_buckling": outer / c.collapse_factor,
            "combined_loading": np.maximum(*combined),
        }

    def _combined(self, effects: LoadEffects, inner: Array | float, outer: Array | float) -> Array:
        """inner, outer: net overpressures over p_b and p_c, one of them 0."""
        D, t, (S, _), c = self.pipe.diameter, self.pipe.thickness, self.strengths, self.check
        all_effects = effects.all
        tension = np.abs(all_effects.tension) / api_std_2rd.yield_tension(D, t, S)
        moment = np.hypot(all_effects.moment_y, all_effects.moment_z)
        factor = api_std_2rd.design_factor(c.case, outer) if c.design_factor is None else c.design_factor
        if c.method == 1:
            return api_std_2rd.method_1(tension, moment / api_std_2rd.yield_moment(D, t, S), inner + outer, factor)
        return api_std_2rd.method_2(tension, moment / api_std_2rd.plastic_moment(D, t, S), inner + outer, factor)


@dataclass(frozen=True)
class ApiStressCriteria:
    """API RP 2RD: von Mises' stress, the hoop stress in the thinnest wall and all else in the nominal one."""

    check: ApiStressCheck
    pipe: Steel

    code = "API RP 2RD"
    safety_class = ""
    criteria = (Criterion("combined_loading", "von Mises stress", "API RP 2RD (1998) sec. 4.4 table 2, sec. 5 eq. 8"),)

    @property
    def limit_state(self) -> str:
        return self.check.case

    def utilisations(self, loads: NodeLoads) -> dict[str, Array]:
        """The stress is a convex function of the pressure inside: it is largest under the largest or the least one."""
        p_ld, _ = local_design_pressure(self.check, loads)
        both = p_ld, minimum_pressure(self.check, loads)
        return {"combined_loading": np.maximum(*(self._used(loads, inside) for inside in both))}

    def _used(self, loads: NodeLoads, inside: Array | float) -> Array:
        c, pipe, effects = self.check, self.pipe, loads.effects.all
        moment = np.hypot(effects.moment_y, effects.moment_z)
        D, t = pipe.diameter, pipe.thickness
        wall_tension = effects.tension + 0.25 * np.pi * (inside * (D - 2.0 * t) ** 2 - loads.outside * D**2)
        stress = api_rp_2rd.largest_stress(D, t, t - c.thinning, wall_tension, moment, inside, loads.outside)
        return api_rp_2rd.utilisation(stress, c.yield_stress - c.yield_derating, c.case)


@dataclass(frozen=True)
class FlexibleCriteria:
    """Limits of a flexible pipe."""

    check: FlexiblePipeCheck

    code = "API 17J"
    limit_state = ""
    safety_class = ""

    @property
    def criteria(self) -> tuple[Criterion, ...]:
        c, stated = self.check, "limit stated by the maker"
        given = {
            Criterion("bend_radius", "bend radius", stated): c.bends,
            Criterion("tension_limit", "tension", stated): c.max_tension,
            Criterion("compression", "compression", stated): c.max_compression,
            Criterion("crushing", "crushing", stated): c.max_contact_force,
        }
        return tuple(criterion for criterion, limit in given.items() if limit)

    def utilisations(self, loads: NodeLoads) -> dict[str, Array]:
        c, T, used = self.check, loads.effects.all.tension, dict[str, Array]()
        if (radius := c.radius(loads.moving)) is not None:
            used["bend_radius"] = flexible_pipe.bend_radius(loads.curvature, radius)
        if c.max_tension is not None:
            used["tension_limit"] = flexible_pipe.tension(T, c.max_tension)
        if c.max_compression is not None:
            used["compression"] = flexible_pipe.compression(T, c.max_compression)
        if c.max_contact_force is not None:
            used["crushing"] = flexible_pipe.crushing(loads.contact_force, c.max_contact_force)
        return used


@dataclass(frozen=True)
class CapacityCriteria:
    """A capacity curve."""

    check: CapacityCurveCheck

    code = "capacity curve"
    limit_state = ""
    safety_class = ""
    criteria = (Criterion("capacity_curve", "tension and curvature", "API 17E (2010), allowable bend radius"),)

    def utilisations(self, loads: NodeLoads) -> dict[str, Array]:
        curve = np.array(self.check.curve)
        return {"capacity_curve": capacity_curve.utilisation(loads.effects.all.tension, loads.curvature, curve)}


def criteria_of(check: Check, line_type: LineType) -> Criteria:
    """The criteria of a check on a line type."""
    outer, inner = line_type.pipe_diameters
    pipe = Steel(outer, 0.5 * (outer - inner))
    match check:
        case DnvCheck():
            return DnvCriteria(check, pipe)
        case ApiCheck():
            return ApiCriteria(check, pipe)
        case ApiStressCheck():
            return ApiStressCriteria(check, pipe)
        case FlexiblePipeCheck():
            return FlexibleCriteria(check)
        case CapacityCurveCheck():
            return CapacityCriteria(check)
    raise TypeError(type(check).__name__)
