"""Interface of seabed laws: force per length by penetration, history per point, and the model in the scene.

Penetration δ = −gap [m]; force f [N/m] pushes the two sides apart.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from pydantic import BaseModel

from riser_soil.core.quantities import FROZEN
from riser_soil.seabed.bearing import Strength

if TYPE_CHECKING:
    from riser_soil.core.arrays import Array


class SeabedResponse(NamedTuple):
    """Response of a seabed law at the end of a step.

    force [N/m]: positive where it pushes the riser away. slope [N/m2]: its derivative by the penetration. history
    (..., nh). stored [N]: energy per length that the ground gives back; what the force does beyond it is dissipated.
    """

    force: Array
    slope: Array
    history: Array
    stored: Array


class NormalLaw(Protocol):
    """Force per length of riser by its penetration, with a history of nh numbers a point, kept between steps.

    Penetrations, forces and slopes have one shape (...); a history is (..., nh), its `columns` have names. Nothing is
    kept here: `update` gives the history after a step, for the caller to keep when it is accepted.
    """

    @property
    def columns(self) -> tuple[str, ...]: ...

    @property
    def kernel_data(self) -> Any:
        """Its constants as compiled code reads them: a NamedTuple, whose type chooses the law's kernels."""
        ...

    @property
    def start(self) -> float:
        """Gap [m] at which contact begins as the riser comes down."""
        ...

    @property
    def reach(self) -> float:
        """Gap [m] from which on there is no force."""
        ...

    @property
    def capacity(self) -> float:
        """Force per length [N/m] that it bears at a penetration of one diameter; inf without a limit."""
        ...

    @property
    def gradual(self) -> bool:
        """Whether the force grows along a curve from the first touch, as clay's does; a stiff penalty has a corner."""
        ...

    def initial_history(self, shape: tuple[int, ...]) -> Array:
        """History of ground that has never been touched (*shape, nh)."""
        ...

    def update(self, penetration: Array, history: Array) -> SeabedResponse:
        """The response at the end of a step from a history at its beginning to a penetration."""
        ...


class SeabedLaw(BaseModel, ABC):
    """The model of a seabed law in the scene: `kind`, a Literal of one word, and its constants."""

    model_config = FROZEN

    @property
    def undrained_strength(self) -> Strength | None:
        """Undrained shear strength of the clay by depth; None where the law knows of none."""
        return None

    @abstractmethod
    def of_pipe(self, diameter: float) -> NormalLaw:
        """The formula for a pipe of this diameter [m]."""
