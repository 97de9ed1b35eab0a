"""Plausibility of a line's results: strains, bending and compression beyond what its elements are made for."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from riser_soil.assembly import LineAssembly
from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import Record
from riser_soil.results.largest import LargestAlong, LargestAt
from riser_soil.riser.section_forces import at_most
from riser_soil.riser.sections import larger_beside
from riser_soil.scene.stages import Stage

# Strain from which EA and EI would be no constants, and a section would not keep its shape.
LARGE_STRAIN = 0.1
# Shares of the largest moment by which turn and end moments of an element may differ, see results/bending_misfit.py.
# Of 48 catenaries, hanging, clamped and on the seabed, those whose largest moment is off by less than 2 % stay below.
SMOOTH_MISFIT, STEEP_MISFIT = 0.1, 0.2
# The same as a turn of the element [rad] that is too small to mind: it strains a pipe's outside by 1e-3 D/L.
SMALL_TURN = 2e-3
# The same over the stage's largest tension and the diameter: a moment moves the line in which tension acts by its share
# of the tension, here by so little of the diameter that the stress in a section changes by less than 0.02 % (a full
# round section: 8 M/(T D)). A taut rope has no larger moment; of a pipe of 10 km that hangs in its weight, whose moment
# elements of 125 m miss by ten times its size, it is 1e-4.
SMALL_ARM = 2e-5
# Compression beyond what elements bear that is too small to mind, as a share of the stage's largest tension.
SMALL_PUSH = 1e-3

# Strains; tension and compression beyond what elements bear [N]; moment and misfits of bending [N m].
_FOLLOWED = (
    *("axial strain", "bending strain", "tension", "compression"),
    *("moment", "misfit", "smooth misfit", "steep misfit"),
)


class Plausibility:
    """Plausibility of a stage's results at the recorded instants, by warnings; on the rank that has the line.

    EA [N] and radius [m] (nn,): the smaller and the larger of what the two elements beside a node have. buckling [N]
    (nn,): the larger of their buckling loads, pi^2 EI/L^2 by the smaller EI.
    """

    def __init__(self, riser: LineAssembly) -> None:
        elements = riser.elements
        self._riser = riser
        self.EA = -at_most(np.repeat(-elements.EA[:, None], 2, axis=1))
        self.radius = larger_beside(0.5 * elements.outer_diameter)
        self.buckling = larger_beside(np.square(np.pi / elements.length) * np.minimum(elements.EI_y, elements.EI_z))
        self._middle = 0.5 * (riser.line.arc[1:] + riser.line.arc[:-1])
        self._small_misfit = SMALL_TURN * elements.larger_EI / elements.length
        self._arm = SMALL_ARM * float(elements.pipe_diameter.min())

    def begin_stage(self, stage: Stage) -> None:
        self._unit = "of the load" if stage.kind == "static" else "s"
        self._worst = LargestAlong(_FOLLOWED)

    def follow(self, times: Array, record: Record) -> None:
        """Take in a record's strains and forces. times (nt,): of its instants, s of the run (static stages: load
        factor).
        """
        tension = record.effective_tension
        at_nodes = {
            "axial strain": np.abs(tension) / self.EA,
            "bending strain": self.radius * record.curvature,
            "tension": tension,
            "moment": record.bending_moment,
            "compression": -tension - self.buckling,
        }
        self._worst.update(times, record.arc, at_nodes)

    def follow_bending(self, times: Array, record: Record) -> None:
        """Take in misfits of the elements' bending, which cost more, at some times (nt,) as above."""
        misfits = {"misfit": record.smooth_misfit, "smooth misfit": self._without_small(record.smooth_misfit)}
        self._worst.update(times, self._middle, misfits | {"steep misfit": self._without_small(record.steep_misfit)})

    def _without_small(self, misfit: Array) -> Array:
        """Misfits (nt, ne) [N m]; 0 where the turn of the element is too small to mind."""
        return np.where(misfit < self._small_misfit, 0.0, misfit)

    def bending(self) -> dict[str, float]:
        """The largest misfit of the elements' bending, an estimate of the moment's error [N.m]: its size, share of the
        stage's largest moment, arc [m] and time [s] or load factor. Empty before `follow_bending`.
        """
        misfit = self._worst["misfit"]
        if math.isnan(misfit.t):
            return {}
        share = misfit.value / self._largest_moment(misfit)
        return {"moment_error": misfit.value, "share": share, "arc": misfit.arc, "time": misfit.t}

    def _largest_moment(self, misfit: LargestAt) -> float:
        """The stage's largest moment [N m], as which a larger misfit counts, too."""
        return max(misfit.value, self._worst["moment"].value)

    def warnings(self) -> tuple[str, ...]:
        """Warnings about the line's results, with numbers and a remedy."""
        return (*self._strains(), *self._too_long_for_bending(), *self._compressed())

    def _strains(self) -> Iterator[str]:
        axial, bending = self._worst["axial strain"], self._worst["bending strain"]
        if axial.value > LARGE_STRAIN:
            yield (
                f"the riser is strained along its axis by {self._at(axial)}; beams with a constant EA hold for "
                f"strains of some per cent, at most {LARGE_STRAIN:.0%}: correct EA, the length or what pulls"
            )
        if bending.value > LARGE_STRAIN:
            yield (
                f"the pipe's outside is strained by bending, curvature times D/2, by {self._at(bending)}; beams "
                f"whose sections keep their shape and EI hold for at most {LARGE_STRAIN:.0%}: correct EI or what bends"
            )

    def _too_long_for_bending(self) -> Iterator[str]:
        small = self._arm * self._worst["tension"].value
        for what, allowed in (("smooth misfit", SMOOTH_MISFIT), ("steep misfit", STEEP_MISFIT)):
            misfit = self._worst[what]
            largest = self._largest_moment(misfit)
            share = misfit.value / largest if largest > 0.0 else 0.0
            if share > allowed and misfit.value > small:
                length = float(self._riser.line.length[np.abs(self._middle - misfit.arc).argmin()])
                yield (
                    f"elements of {length:.4g} m are too long for the bending at arc {misfit.arc:.5g} m: at "
                    f"{misfit.t:.5g} {self._unit} their turn and the moments at their ends differ by "
                    f"{misfit.value:.4g} N.m, {share:.0%} of the stage's largest (limit {allowed:.0%}); moments may be "
                    "off as much; take elements half as long there"
                )
                return

    def _compressed(self) -> Iterator[str]:
        push = self._worst["compression"]
        if push.value <= SMALL_PUSH * self._worst["tension"].value:
            return
        arc, length = self._riser.line.arc, self._riser.line.length
        node = int(np.abs(arc - push.arc).argmin())
        borne, long = float(self.buckling[node]), f"elements of {length[min(node, length.size - 1)]:.4g} m"
        where = f"at arc {push.arc:.5g} m and {push.t:.5g} {self._unit}"
        compressed = f"{where} the line is compressed by {push.value + borne:.4g} N"
        if borne > 0.0:
            yield (
                f"{compressed}: {long} bow out between their nodes beyond pi^2 EI/L^2 = {borne:.4g} N, which tensions "
                "don't know; take shorter elements there, or EI: 0 of chain and rope, which go slack"
            )
        else:
            yield (
                f"{compressed}, though it has no bending stiffness and goes slack: that is weight and inertia of "
                f"{long}, and tensions there may be off by as much; take shorter ones at rest, and damping of the line "
                "in motion"
            )

    def _at(self, worst: LargestAt) -> str:
        return f"{worst.value:.3g} at arc {worst.arc:.5g} m and {worst.t:.5g} {self._unit}"

    def state(self) -> Saved:
        return self._worst.state()

    def restore(self, saved: Saved) -> None:
        """Resume in the stage that has begun."""
        self._worst.restore(saved)
