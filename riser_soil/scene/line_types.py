"""Scene language: line types, the properties of the pipe's cross-section."""

import math
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    AxialStiffness,
    BendingStiffness,
    BendingStiffnessOrNone,
    Coefficient,
    Frequency,
    Length,
    LengthOrNone,
    MassPerLength,
    NonNegative,
    Part,
    Ratio,
    RotaryInertiaPerLength,
    Stress,
    Tension,
    WeightPerLength,
    wrong,
)


class Drag(BaseModel):
    """Drag coefficients of Morison's equation, referred to the outer diameter."""

    model_config = FROZEN

    normal: Coefficient | None = Field(
        default=None, description="normal drag coefficient, on the outer diameter [-]; or give by_reynolds"
    )
    tangential: Coefficient = Field(
        default=0.0, description="tangential drag coefficient, on the circumference [-]"
    )
    by_reynolds: Annotated[tuple[tuple[Ratio, Coefficient], ...], Field(min_length=1)] | None = Field(
        default=None,
        description="in place of normal: the coefficient by Reynolds's number of the flow across the pipe, "
        "[[Re, Cd], ...], Re increasing; linear in log Re, constant beyond",
    )

    @model_validator(mode="after")
    def _normal_once(self) -> Self:
        if self.normal is None and self.by_reynolds is None:
            raise wrong("normal", "the normal drag coefficient is missing", "give normal, or by_reynolds")
        if self.normal is not None and self.by_reynolds is not None:
            raise wrong("by_reynolds", "the normal drag coefficient is given twice", "leave out normal or by_reynolds")
        if any(b[0] <= a[0] for a, b in pairwise(self.by_reynolds or ())):
            raise wrong("by_reynolds", "Reynolds's numbers must increase", "sort the points [Re, Cd] by Re")
        return self

    @property
    def acts(self) -> bool:
        return bool(self.normal or self.tangential or self.by_reynolds)


class AddedMass(BaseModel):
    """Added mass coefficients, referred to the mass of the displaced water."""

    model_config = FROZEN

    normal: Coefficient = Field(description="added mass coefficient across the pipe [-]")
    tangential: Coefficient = Field(default=0.0, description="added mass coefficient along the pipe [-]")

    @property
    def acts(self) -> bool:
        return bool(self.normal or self.tangential)


class InLineForce(BaseModel):
    """Force of shed vortices in line with the flow."""

    model_config = FROZEN

    coefficient: Coefficient = Field(description="of the force, on the outer diameter [-]; 0: none")
    frequency: Ratio | None = Field(
        default=None,
        description="middle of the frequencies that it locks to, times diameter over speed [-]; twice that across the "
        "flow by default",
    )
    width: NonNegative | None = Field(
        default=None, description="half the width of their range, below frequency [-]; twice that across by default"
    )


class VortexForce(BaseModel):
    """Force of shed vortices across the flow, and in line with it."""

    model_config = FROZEN

    coefficient: Coefficient = Field(default=1.2, description="of the force, on the outer diameter [-]; 0: none")
    frequency: Ratio = Field(
        default=0.18, description="middle of the frequencies that shedding locks to, times diameter over speed [-]"
    )
    width: NonNegative = Field(default=0.08, description="half the width of their range, below frequency [-]")
    in_line: InLineForce | None = Field(
        default=None, description="force in line with the flow, {coefficient, frequency, width}; none by default"
    )

    @model_validator(mode="after")
    def _frequencies_above_zero(self) -> Self:
        if self.width >= self.frequency:
            raise wrong("width", f"must be below frequency ({self.frequency:g})", "lower it")
        _, frequency, width = self.of_in_line
        if self.in_line is not None and width >= frequency:
            raise wrong("in_line", f"its width ({width:g}) must be below its frequency ({frequency:g})", "lower it")
        return self

    @property
    def of_cross_flow(self) -> tuple[float, float, float]:
        """Coefficient, middle and half width of the frequencies across the flow."""
        return self.coefficient, self.frequency, self.width

    @property
    def of_in_line(self) -> tuple[float, float, float]:
        """Coefficient, middle and half width of the frequencies in line with the flow; coefficient 0 for none."""
        given = self.in_line
        if given is None:
            return 0.0, 2.0 * self.frequency, 2.0 * self.width
        frequency = 2.0 * self.frequency if given.frequency is None else given.frequency
        return given.coefficient, frequency, 2.0 * self.width if given.width is None else given.width


class Strakes(BaseModel):
    """Helical strakes around the pipe, which keep vortices from shaking it."""

    model_config = FROZEN

    drag: Coefficient = Field(description="normal drag coefficient of the straked pipe, on the outer diameter [-]")
    cover: Part = Field(default=1.0, description="share of the length that has strakes [-]")
    suppression: Part = Field(
        default=0.95, description="share of the vortices' force that strakes take away where they are [-]"
    )


class Damping(BaseModel):
    """Structural damping in proportion to the stiffness."""

    model_config = FROZEN

    ratio: NonNegative = Field(lt=1.0, description="ratio to critical damping at the frequency [-]")
    frequency: Frequency = Field(
        description="frequency at which the ratio holds; it grows in proportion to the frequency [Hz]"
    )

    @property
    def time(self) -> float:
        """Viscous over elastic stiffness [s]: a mode of angular frequency w has the damping ratio w time / 2."""
        return self.ratio / (math.pi * self.frequency)


class MetalWall(BaseModel):
    """The wall of a metal pipe, which bears the stress of tension, bending, torsion and pressure."""

    model_config = FROZEN

    outer_diameter: Length | None = Field(
        default=None,
        description="of the wall that bears the stress [m]; by default the line type's pipe_diameter or outer_diameter",
    )
    inner_diameter: Length | None = Field(
        default=None, description="the same [m]; by default the line type's inner_diameter"
    )
    yield_stress: Stress | None = Field(
        default=None, description="specified minimum yield stress [Pa]; with it there is a stress utilisation"
    )
    design_factor: Ratio | None = Field(
        default=None,
        description="share of the yield stress that von Mises' stress may reach, such as 0.67 [-]; 1 by default",
    )

    @property
    def allowable_stress(self) -> float:
        """Von Mises' stress allowed [Pa]; 0 for any."""
        return (self.yield_stress or 0.0) * (1.0 if self.design_factor is None else self.design_factor)


def _switch_or_number(value: Any) -> str:
    return "<word>" if isinstance(value, bool) else "<number>"


RotaryInertia = Annotated[
    Annotated[Literal[True, False], Tag("<word>")] | Annotated[RotaryInertiaPerLength, Tag("<number>")],
    Discriminator(_switch_or_number),
]


class LineType(BaseModel):
    """One kind of pipe."""

    model_config = FROZEN

    outer_diameter: Length | None = Field(
        default=None, description="outer diameter [m]; needed for buoyancy, drag, added mass and contact"
    )
    inner_diameter: LengthOrNone = Field(default=0.0, description="inner diameter, filled by the contents [m]")
    pipe_diameter: Length | None = Field(
        default=None,
        description="outer diameter of the pipe inside a coat or buoyancy modules [m]: the pressure outside acts on it "
        "for the wall tension; by default wall.outer_diameter, or outer_diameter",
    )
    mass: MassPerLength | None = Field(
        default=None, description="mass per length in air without contents [kg/m]; needed for dynamics"
    )
    EA: AxialStiffness = Field(description="axial stiffness [N]")
    EI: BendingStiffnessOrNone | None = Field(
        default=None, description="bending stiffness [N.m2], 0 for a chain; or give EI_y and EI_z"
    )
    EI_y: BendingStiffness | None = Field(
        default=None, description="bending stiffness about the section's y axis [N.m2]"
    )
    EI_z: BendingStiffness | None = Field(
        default=None, description="bending stiffness about the section's z axis [N.m2]"
    )
    GJ: BendingStiffness | None = Field(
        default=None, description="torsional stiffness [N.m2]; needed in three dimensions"
    )
    submerged_weight: WeightPerLength | None = Field(
        default=None,
        description="weight less buoyancy, contents included [N/m]; "
        "without it, it follows from mass, contents, diameters and water",
    )
    drag: Drag | None = Field(default=None, description="drag coefficients; none by default")
    added_mass: AddedMass | None = Field(default=None, description="added mass coefficients; none by default")
    vortex_force: VortexForce | None = Field(
        default=None,
        description="force of shed vortices across the flow and in line with it, {coefficient, frequency, width, "
        "in_line}, in dynamic stages in three dimensions; none by default",
    )
    strakes: Strakes | None = Field(
        default=None,
        description="helical strakes, {drag, cover, suppression}, by which there is more drag and less of the "
        "vortex_force; none by default",
    )
    damping: Damping | None = Field(
        default=None, description="structural damping in motion, {ratio, frequency}; none by default"
    )
    rotary_inertia: RotaryInertia = Field(
        default=False,
        description="inertia of the cross-section about an axis across the pipe [kg.m], twice that about the pipe's "
        "axis; true: (m (D^2 + d^2) + m_contents d^2)/16 from masses and diameters; false: none across; that about the "
        "pipe's axis is always there in three dimensions",
    )

    min_bend_radius: Length | None = Field(
        default=None,
        description="minimum bend radius allowed, MBR [m]; a run warns where the pipe is bent more; any by default",
    )
    max_tension: Tension | None = Field(
        default=None,
        description="largest effective tension allowed [N], such as the breaking load over its safety factor; a run "
        "warns where the riser is pulled more; any by default",
    )
    wall: MetalWall | None = Field(
        default=None,
        description="wall of a metal pipe, {outer_diameter, inner_diameter, yield_stress, design_factor}, whose stress "
        "is a result; none by default",
    )

    @model_validator(mode="after")
    def _bore_inside_wall(self) -> Self:
        if self.outer_diameter is not None and self.inner_diameter >= self.outer_diameter:
            raise wrong(
                "inner_diameter",
                f"must be smaller than outer_diameter ({self.outer_diameter:g} m)",
                "correct one of the two diameters",
            )
        return self

    @model_validator(mode="after")
    def _pipe_inside_what_is_around_it(self) -> Self:
        if self.pipe_diameter is None:
            return self
        if self.wall is not None and self.wall.outer_diameter is not None:
            raise wrong("pipe_diameter", "is given twice, as wall.outer_diameter, too", "leave out one of the two")
        if self.outer_diameter is None or not self.inner_diameter < self.pipe_diameter <= self.outer_diameter:
            allowed = f"inner_diameter ({self.inner_diameter:g} m) < pipe_diameter <= outer_diameter"
            around = "not given" if self.outer_diameter is None else f"{self.outer_diameter:g} m"
            raise wrong("pipe_diameter", f"must be {allowed} ({around})", "correct one of the diameters")
        return self

    @model_validator(mode="after")
    def _bending_stiffness_given_once(self) -> Self:
        pair = (self.EI_y, self.EI_z)
        if self.EI is None and None in pair:
            raise wrong("EI", "the bending stiffness is missing", "give EI, or both EI_y and EI_z [N.m2]")
        if self.EI is not None and pair != (None, None):
            raise wrong(
                "EI", "the bending stiffness is given twice", "give either EI or the pair EI_y and EI_z"
            )
        return self

    @model_validator(mode="after")
    def _wall_between_two_diameters(self) -> Self:
        if self.wall is None:
            return self
        outer, inner = self.wall_diameters
        if not inner < outer:
            raise wrong(
                "wall",
                f"must lie between two diameters, but its outer one is {outer:g} m and its inner one {inner:g} m",
                "give outer_diameter and inner_diameter of the line type or of its wall",
            )
        if inner == 0.0:
            raise wrong("wall", "needs an inner diameter", "give inner_diameter of the line type or of its wall [m]")
        if self.wall.yield_stress is None and self.wall.design_factor is not None:
            raise wrong("wall", "has a design_factor without a yield_stress", "give wall.yield_stress [Pa]")
        return self

    @model_validator(mode="after")
    def _one_drag_with_strakes(self) -> Self:
        if self.strakes is not None and self.drag is not None and self.drag.by_reynolds is not None:
            allowed = "strakes have one drag coefficient, and drag.by_reynolds has many"
            raise wrong("strakes", allowed, "give drag.normal, or leave out strakes")
        return self

    @property
    def normal_drag(self) -> float:
        """Normal drag coefficient, strakes counted in; 0 where it goes by Reynolds's number."""
        bare = (self.drag.normal or 0.0) if self.drag is not None else 0.0
        if self.strakes is None:
            return bare
        return self.strakes.cover * self.strakes.drag + (1.0 - self.strakes.cover) * bare

    @property
    def vortices(self) -> tuple[float, float, float]:
        """Coefficient of the force across the flow, strakes counted in, and the frequencies; zeros for none."""
        return (0.0, 0.0, 0.0) if self.vortex_force is None else self._straked(self.vortex_force.of_cross_flow)

    @property
    def in_line_vortices(self) -> tuple[float, float, float]:
        """The force of shed vortices in line with the flow, as `vortices`."""
        return (0.0, 0.0, 0.0) if self.vortex_force is None else self._straked(self.vortex_force.of_in_line)

    def _straked(self, force: tuple[float, float, float]) -> tuple[float, float, float]:
        coefficient, frequency, width = force
        share = 1.0 if self.strakes is None else 1.0 - self.strakes.cover * self.strakes.suppression
        return share * coefficient, frequency, width

    @property
    def sheds(self) -> bool:
        """Whether vortices act on it."""
        return self.vortices[0] > 0.0 or self.in_line_vortices[0] > 0.0

    @property
    def pipe_diameters(self) -> tuple[float, float]:
        """Outer and inner diameter [m] of the pipe itself, inside its coat, modules and around its lining; 0 where not
        given. The pressures act on it for the wall tension, and codes check it.
        """
        outer, inner = (None, None) if self.wall is None else (self.wall.outer_diameter, self.wall.inner_diameter)
        return outer or self.pipe_diameter or self.outer_diameter or 0.0, inner or self.inner_diameter

    @property
    def wall_diameters(self) -> tuple[float, float]:
        """Outer and inner diameter of the wall that bears the stress [m]; 0 where there is none."""
        return (0.0, 0.0) if self.wall is None else self.pipe_diameters

    @property
    def bending_stiffness(self) -> tuple[float, float]:
        """EI about the section's y axis and z axis [N.m2]."""
        if self.EI_y is not None and self.EI_z is not None:
            return self.EI_y, self.EI_z
        assert self.EI is not None  # the validator has seen to it
        return self.EI, self.EI
