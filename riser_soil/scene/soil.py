"""Scene language: the soil continuum, its block or mesh, constitutive law and initial stress."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import (
    FROZEN,
    SHORTEST,
    Density,
    Interval,
    Length,
    Ratio,
    Text,
    UnitWeight,
    word_or,
    wrong,
)
from riser_soil.scene.files import NamedFile
from riser_soil.scene.seabed_features import Groove, SeabedFeature, Trench
from riser_soil.scene.soil_layers import LAW, Layer, wrong_layers
from riser_soil.soil.law import SoilLaw

STRIP = 8.0  # cells across the riser that do not grow yet, where the scene doesn't say how wide they lie


class Block(BaseModel):
    """A box of soil whose top face is level with the seabed."""

    model_config = FROZEN

    x: Interval = Field(description="from and to along x, [x0, x1] [m]")
    y: Interval = Field(description="from and to along y, [y0, y1] [m]")
    depth: Length = Field(description="depth below the seabed [m]")
    trench: Trench | None = Field(default=None, description="a trench in the block's top, under the riser")
    groove: Groove | None = Field(default=None, description="the groove of a pipe that lies embedded in the block")

    @model_validator(mode="after")
    def _has_a_size(self) -> Self:
        for key, (low, high) in {"x": self.x, "y": self.y}.items():
            if high - low < SHORTEST:
                raise wrong(
                    key, "the first bound must be smaller than the second", "write [from, to] in metres"
                )
        return self

    @model_validator(mode="after")
    def _deeper_than_its_feature(self) -> Self:
        if self.trench is not None and self.groove is not None:
            raise wrong("groove", "is given beside trench", "give either")
        if self.trench is not None and self.trench.depth >= self.depth:
            raise wrong("trench", f"is as deep as the block, {self.depth:g} m", "take a deeper block")
        return self

    @property
    def feature(self) -> SeabedFeature | None:
        """The top's feature: what it has beyond being level."""
        return self.trench or self.groove


class CellSizes(BaseModel):
    """Sizes of the hexahedra under a riser that runs along x or y: fine across it, long along it."""

    model_config = FROZEN

    along: Length = Field(description="length of the cells along the riser [m]")
    across: Length = Field(description="size of the cells across the riser and downwards, under it [m]")
    strip: Length | None = Field(
        default=None,
        description="width across the riser, and half of it downwards, within which cells do not grow yet [m]; "
        "eight cells by default",
    )
    touchdown: Interval | None = Field(
        default=None,
        description="range of x or y, along the riser, beyond which a block's cells grow along it, too, at its ends to "
        "size_far, or four times their length where that is more [m]; by default they do so nowhere",
    )

    @model_validator(mode="after")
    def _touchdown_has_a_length(self) -> Self:
        if self.touchdown is not None and self.touchdown[1] - self.touchdown[0] < SHORTEST:
            raise wrong("touchdown", "the first bound must be smaller than the second", "write [from, to] in metres")
        return self


def _number_or_sizes(value: object) -> str:
    return "<CellSizes>" if isinstance(value, dict | CellSizes) else "<number>"


SizeAtRiser = Annotated[
    Annotated[Length, Tag("<number>")] | Annotated[CellSizes, Tag("<CellSizes>")], Discriminator(_number_or_sizes)
]


class GeneratedMesh(BaseModel):
    """A mesh of the block, fine under the riser and coarse away from it."""

    model_config = FROZEN

    kind: Literal["hex", "tet"] = Field(default="hex", description="hex (hexahedra) or tet (tetrahedra)")
    size_at_riser: SizeAtRiser = Field(
        description="size of the cells under the riser [m], or {along, across, strip} of hexahedra under a riser that "
        "runs along x or y"
    )
    size_far: Length = Field(description="size of the cells at the block's far sides and bottom [m]")

    @property
    def across(self) -> float:
        """Size of the cells across the riser [m]."""
        return self.size_at_riser.across if isinstance(self.size_at_riser, CellSizes) else self.size_at_riser

    @property
    def along(self) -> float:
        """Size of the cells along the riser [m]."""
        return self.size_at_riser.along if isinstance(self.size_at_riser, CellSizes) else self.size_at_riser

    @property
    def touchdown(self) -> tuple[float, float] | None:
        """Range along the riser beyond which the cells grow along it, too [m]; None: nowhere."""
        return self.size_at_riser.touchdown if isinstance(self.size_at_riser, CellSizes) else None

    @property
    def strip(self) -> float:
        """Width across the riser within which the cells do not grow yet [m]; 0: one cell."""
        sizes = self.size_at_riser
        if not isinstance(sizes, CellSizes):
            return 0.0
        return STRIP * sizes.across if sizes.strip is None else sizes.strip

    @model_validator(mode="after")
    def _grows_away_from_the_riser(self) -> Self:
        if self.size_far < self.across:
            raise wrong(
                "size_far",
                f"must not be smaller than size_at_riser ({self.across:g} m)",
                "cells grow away from the riser: swap the two sizes",
            )
        return self

    @model_validator(mode="after")
    def _long_as_hexahedra_only(self) -> Self:
        if self.kind == "tet" and isinstance(self.size_at_riser, CellSizes):
            raise wrong(
                "size_at_riser",
                "tetrahedra have one size under the riser",
                "give a number, or choose kind: hex, whose cells are long along the riser",
            )
        return self


class MeshFile(BaseModel):
    """A mesh of the user's own."""

    model_config = FROZEN

    file: NamedFile = Field(description="gmsh file (.msh); a relative name is sought beside the scene file")


def _pick_mesh(value: object) -> str | None:
    if isinstance(value, str):
        return "<word>"
    if isinstance(value, MeshFile) or (isinstance(value, dict) and "file" in value):
        return "<MeshFile>"
    return "<GeneratedMesh>" if isinstance(value, dict | GeneratedMesh) else None


Mesh = Annotated[
    Annotated[Literal["auto"], Tag("<word>")]
    | Annotated[GeneratedMesh, Tag("<GeneratedMesh>")] | Annotated[MeshFile, Tag("<MeshFile>")],
    Discriminator(
        _pick_mesh,
        custom_error_type="choice",
        custom_error_message="must be auto or a mapping: {kind, size_at_riser, size_far} or {file: mesh.msh}",
    ),
]


AutoOrBlock = Annotated[
    Annotated[Literal["auto"], Tag("<word>")] | Annotated[Block, Tag("<Block>")],
    Discriminator(
        word_or(Block), custom_error_type="choice", custom_error_message="must be auto or a mapping: {x, y, depth}"
    ),
]


class SoilScene(BaseModel):
    """A continuum of soil under the touchdown zone; quasi-static, unless it has inertia."""

    model_config = FROZEN

    block: AutoOrBlock | None = Field(
        default=None, description="the box of soil to mesh, or auto: around the touchdown points; not with mesh.file"
    )
    mesh: Mesh = Field(
        default="auto",
        description="{kind, size_at_riser, size_far} for a block, auto: sizes that resolve what touches, or "
        "{file: mesh.msh}",
    )
    law: Annotated[SoilLaw, LAW] | None = Field(
        default=None, description=f"constitutive law: {LAW.words}, with its constants; layers instead give several"
    )
    layers: tuple[Layer, ...] | None = Field(
        default=None, min_length=1, description="layers from the seabed downwards, each {to, law}, instead of one law"
    )
    submerged_unit_weight: UnitWeight = Field(
        default=0.0, description="submerged unit weight, source of the initial stress [N/m3]"
    )
    K0: Ratio = Field(default=1.0, description="initial horizontal over vertical effective stress [-]")
    model: Literal["block", "sections"] = Field(
        default="block",
        description="block: one continuum; sections: independent slices across the riser in plane strain, as long as "
        "the cells of the block along it",
    )
    symmetry: Literal["auto", "whole"] = Field(
        default="auto",
        description="auto: half of a block of hexahedra is computed, where it and the riser are symmetric about the "
        "riser's plane; whole: all of it is",
    )
    strain: Literal["auto", "small", "large"] = Field(
        default="auto",
        description="whether cells move with the soil (large) or stay where they were (small); auto: large where the "
        "soil yields and the pipe's surface touches it",
    )
    inertia: bool = Field(
        default=False, description="whether the soil has mass in dynamic stages, at small strain; false: quasi-static"
    )
    density: Density | None = Field(
        default=None,
        description="of soil with inertia, pore water included [kg/m3]; by default that of its submerged unit weight "
        "in the water",
    )
    absorbing: bool = Field(
        default=False,
        description="whether bottom and sides of soil with inertia let waves out in dynamic stages, by dashpots, in "
        "place of holding it",
    )
    forms: NamedFile | None = Field(
        default=None,
        description="a Python file whose function residual(soil) returns terms in UFL that are added to the soil's, at "
        "small strain",
    )
    line: Text | None = Field(
        default=None, description="of several lines the one that lies on it, by name; the others meet the seabed alone"
    )

    @model_validator(mode="after")
    def _meshed_once(self) -> Self:
        if isinstance(self.mesh, MeshFile) and self.block is not None:
            raise wrong("block", "a mesh file replaces the block", "leave out either block or mesh.file")
        if not isinstance(self.mesh, MeshFile) and self.block is None:
            raise wrong(
                "block", "the box of soil is missing", "give block: {x, y, depth}, or mesh: {file: ...}"
            )
        return self

    @model_validator(mode="after")
    def _features_of_tetrahedra(self) -> Self:
        feature = self.given_block.feature if self.given_block else None
        if feature is not None and not self._tetrahedral:
            remedy = "give mesh: {kind: tet, size_at_riser, size_far}"
            raise wrong("mesh", "a trench or a groove is meshed in tetrahedra", remedy)
        return self

    @model_validator(mode="after")
    def _sections_of_a_plain_block(self) -> Self:
        feature = self.given_block.feature if self.given_block else None
        if self.model == "sections" and (isinstance(self.mesh, MeshFile) or feature is not None or self._tetrahedral):
            raise wrong(
                "model", "sections are those of a plain block of hexahedra", "write model: block, or mesh: {kind: hex}"
            )
        return self

    @property
    def _tetrahedral(self) -> bool:
        return isinstance(self.mesh, GeneratedMesh) and self.mesh.kind == "tet"

    @model_validator(mode="after")
    def _elastic_at_small_strain(self) -> Self:
        if self.strain == "large" and self.is_linear:
            raise wrong("strain", "linear elastic soil is computed at small strain", "leave strain out")
        return self

    @model_validator(mode="after")
    def _inertia_and_forms(self) -> Self:
        for key in ("density", "absorbing"):
            if getattr(self, key) and not self.inertia:
                raise wrong(key, "belongs to soil with inertia", "write inertia: true, or leave it out")
        if self.inertia and self.strain == "large":
            raise wrong("strain", "soil with inertia is computed at small strain", "leave strain out, or inertia")
        if self.forms is not None and self.strain == "large":
            raise wrong("strain", "terms of one's own are added at small strain", "leave strain out, or forms")
        if self.inertia and self.density is None and self.lightest == 0.0:
            raise wrong("inertia", "the density is missing", "give density, or submerged_unit_weight")
        return self

    @property
    def lightest(self) -> float:
        """Least submerged unit weight of its layers [N/m3]."""
        own = [layer.submerged_unit_weight for layer in self.layers or ()] or [None]
        return min(self.submerged_unit_weight if weight is None else weight for weight in own)

    @model_validator(mode="after")
    def _strong_to_the_bottom(self) -> Self:
        fault = self.law.wrong_within(self.given_block.depth) if self.given_block and self.law else None
        if fault:
            raise wrong("law", *fault)
        return self

    @model_validator(mode="after")
    def _of_one_law_or_layered(self) -> Self:
        if self.law is None and self.layers is None:
            raise wrong("law", "the key is required here", "add law, or layers: [{to, law}, ...]")
        if self.law is not None and self.layers is not None:
            raise wrong("layers", "is given beside law", "give either")
        depth = self.given_block.depth if self.given_block else None
        fault = wrong_layers(self.layers, depth) if self.layers else None
        if fault:
            raise fault
        return self

    @model_validator(mode="after")
    def _laws_lie_somewhere(self) -> Self:
        for n, law in enumerate(self.laws):
            law.lies(f"soil.layers.{n}.law" if self.layers else "soil.law", self._unit_weight_at_top, self.K0)
        return self

    @property
    def _unit_weight_at_top(self) -> float:
        own = self.layers[0].submerged_unit_weight if self.layers else None
        return self.submerged_unit_weight if own is None else own

    @property
    def given_block(self) -> Block | None:
        """The block, where its size is given or has been chosen."""
        return self.block if isinstance(self.block, Block) else None

    @property
    def path_dependent(self) -> bool:
        """Whether any of its laws is."""
        return any(law.path_dependent for law in self.laws)

    @property
    def is_linear(self) -> bool:
        """Whether all of its laws are."""
        return all(law.linear for law in self.laws)

    @property
    def laws(self) -> list[SoilLaw]:
        """The only law, or those of the layers from the top down."""
        return [layer.law for layer in self.layers] if self.layers else [self.top_law]

    @property
    def reference_rate(self) -> float | None:
        """The least of its laws' [1/s]; None where no rate counts."""
        return min((rate for law in self.laws if (rate := law.reference_rate) is not None), default=None)

    @property
    def laws_at_top(self) -> list[SoilLaw]:
        """Laws that the surface may lie in: of a plain block the first layer's."""
        plain = self.block is not None and (self.given_block is None or self.given_block.feature is None)
        return [self.top_law] if plain else self.laws

    @property
    def top_law(self) -> SoilLaw:
        """The law at the seabed: the only one, or the first layer's."""
        law = self.layers[0].law if self.layers else self.law
        assert law is not None
        return law
