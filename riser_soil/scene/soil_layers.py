"""Scene language: layers of the soil, by depth or by the named volumes of a mesh file."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Self

from pydantic import BaseModel, Field, model_validator
from pydantic_core import PydanticCustomError

from riser_soil.core.quantities import FROZEN, Length, OneOf, Text, UnitWeight, wrong
from riser_soil.soil.law import SoilLaw
from riser_soil.soil.laws import LAWS

LAW = OneOf(LAWS)


class Layer(BaseModel):
    """A layer of soil with a law of its own."""

    model_config = FROZEN

    to: Length | None = Field(
        default=None, description="depth of the layer's bottom below the seabed [m]; the last one needs none"
    )
    volume: Text | None = Field(
        default=None, description="instead of to: the layer is this volume (physical group) of the mesh file"
    )
    law: Annotated[SoilLaw, LAW] = Field(
        description=f"constitutive law: {LAW.words}, with its constants; by to, it counts depth from the layer's top"
    )
    submerged_unit_weight: UnitWeight | None = Field(
        default=None, description="submerged unit weight of the layer [N/m3]; by default the soil's"
    )

    @model_validator(mode="after")
    def _given_one_way(self) -> Self:
        if self.to is not None and self.volume is not None:
            raise wrong("volume", "is given beside to", "give either")
        if self.volume is not None and self.submerged_unit_weight is not None:
            raise wrong(
                "submerged_unit_weight",
                "volumes have the soil's own, as the weight above them may change along the seabed",
                "give soil.submerged_unit_weight, or layers by depth",
            )
        return self


def boundaries(layers: Sequence[Layer]) -> tuple[float, ...]:
    """Depths at which layers meet, increasing [m]; none of layers by volume."""
    return tuple(layer.to for layer in layers[:-1] if layer.to is not None)


def wrong_layers(layers: Sequence[Layer], depth: float | None) -> PydanticCustomError | None:
    """Problem of layers in a block of this depth [m], None of a mesh file."""
    if any(layer.volume is not None for layer in layers):
        return _wrong_volumes(layers, depth)
    return _wrong_depths(layers, depth) or _too_weak(layers, depth)


def _wrong_volumes(layers: Sequence[Layer], depth: float | None) -> PydanticCustomError | None:
    names = [layer.volume for layer in layers]
    if depth is not None:
        return wrong("layers", "volume names a volume of a mesh file, and this soil is a block", "give to, the depth")
    if None in names:
        return wrong("layers", "some are by volume and some by depth", "give each a volume, or none")
    if len({*names}) < len(names):
        return wrong("layers", "two layers have the same volume", "name each volume once")
    return None


def _wrong_depths(layers: Sequence[Layer], depth: float | None) -> PydanticCustomError | None:
    bottoms = [layer.to for layer in layers[:-1]]
    if None in bottoms:
        return wrong("layers", f"layer {bottoms.index(None)} lacks to, its bottom", "only the last may leave it out")
    known = [*boundaries(layers), *([layers[-1].to] if layers[-1].to is not None else [])]
    if any(b <= a for a, b in pairwise(known)):
        depths = ", ".join(f"{to:g}" for to in known)
        return wrong("layers", f"to must grow from layer to layer, and is {depths} m", "order the layers downwards")
    if depth is None:
        return None
    below = [to for to in boundaries(layers) if to >= depth]
    if below:
        return wrong("layers", f"a layer begins at {below[0]:g} m, below the block's {depth:g} m", "leave it out")
    if layers[-1].to is not None and layers[-1].to < depth:
        problem = f"the last layer ends at {layers[-1].to:g} m, above the block's bottom at {depth:g} m"
        return wrong("layers", problem, "leave its to out, or add a layer")
    return None


def _too_weak(layers: Sequence[Layer], depth: float | None) -> PydanticCustomError | None:
    """Laws that would fail within their layer; the last one's thickness is that of a block."""
    edges = [0.0, *boundaries(layers), *([depth] if depth is not None else [])]
    for n, ((top, bottom), layer) in enumerate(zip(pairwise(edges), layers, strict=False)):
        fault = layer.law.wrong_within(bottom - top)
        if fault:
            return wrong("layers", f"layer {n}, {bottom - top:g} m thick: {fault[0]}", fault[1])
    return None
