"""Scene language: prescribed motions of the ends in quasi-static and dynamic stages."""

import math
from functools import cached_property
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, Discriminator, Field, Tag, model_validator

from riser_soil.core.quantities import (
    FLATTEST,
    FROZEN,
    Angle,
    Angles,
    Axis,
    Position,
    Time,
    TimeOrNone,
    Vector,
    wrong,
)
from riser_soil.scene.columns import ANGLE, LENGTH, CsvColumns, read_history
from riser_soil.scene.files import GivenByName, NamedFile, wrong_file
from riser_soil.scene.netcdf_variables import is_netcdf
from riser_soil.scene.rao import MODES, ROTATIONS, TRANSLATIONS, Rao, read_capytaine, read_rao, vessel_axis

PLANES: dict[str, Vector] = {"xz": (0.0, -1.0, 0.0), "yz": (1.0, 0.0, 0.0), "xy": (0.0, 0.0, 1.0)}
"""Axes about which an end turns from a plane's first axis towards its second."""

# A vessel's angles beyond this [rad] are no motion about its heading.
_WIDEST_ANGLE = 0.5 * math.pi

_RAMP = "time over which the motion grows smoothly to its full size [s]"
_PHASE = "phase at the stage's beginning [deg]"


def _number_or_vector(value: Any) -> str:
    return "<vector>" if isinstance(value, list | tuple) else "<number>"


PhaseDeg = Annotated[
    Annotated[Angle, Tag("<number>")] | Annotated[Angles, Tag("<vector>")], Discriminator(_number_or_vector)
]


class Harmonic(BaseModel):
    """Displacement amplitude · sin(2π t/period + phase) from the position at the stage's beginning."""

    model_config = FROZEN

    amplitude: Position = Field(description="amplitude, [x, y, z] [m]")
    period: Time = Field(description="period [s]")
    ramp: TimeOrNone = Field(default=0.0, description=_RAMP)
    phase_deg: PhaseDeg = Field(default=0.0, description=f"{_PHASE}, one for all components or [px, py, pz]")

    @property
    def phases(self) -> Vector:
        """Phase of each component [rad]."""
        given = self.phase_deg if isinstance(self.phase_deg, tuple) else (self.phase_deg,) * 3
        return math.radians(given[0]), math.radians(given[1]), math.radians(given[2])


class ArcMotion(BaseModel):
    """The end turns about its hub by amplitude · sin(2π t/period + phase), from where it is at the stage's beginning.

    The axis runs through the hub, across the plane; positive angles turn the plane's first axis towards its second, so
    that an end that hangs below its hub moves along the first.
    """

    model_config = FROZEN

    hub: Position = Field(description="the hub, [x, y, z] [m]")
    amplitude_deg: Angle = Field(description="amplitude of the angle about the hub [deg]")
    period: Time = Field(description="period [s]")
    ramp: TimeOrNone = Field(default=0.0, description=_RAMP)
    plane: Literal["xz", "yz", "xy"] = Field(default="xz", description="plane of the arc: xz, yz or xy")
    phase_deg: Angle = Field(default=0.0, description=_PHASE)

    @property
    def axis(self) -> Vector:
        return PLANES[self.plane]


class Rotation(BaseModel):
    """The support turns about an axis by amplitude · sin(2π t/period + phase), and with it an end that isn't free."""

    model_config = FROZEN

    axis: Axis = Field(description="axis of the rotation, right-handed, [x, y, z] [-]")
    amplitude_deg: Angle = Field(description="amplitude of the rotation [deg]")
    period: Time = Field(description="period [s]")
    ramp: TimeOrNone = Field(default=0.0, description=_RAMP)
    phase_deg: Angle = Field(default=0.0, description=_PHASE)

    @model_validator(mode="after")
    def _has_an_axis(self) -> Self:
        if math.hypot(*self.axis) < FLATTEST:
            raise wrong("axis", "must not be zero", "give the direction of the axis, such as [0, 1, 0]")
        return self


class Table(GivenByName):
    """Displacements (and rotations) from the stage's beginning, read from a CSV file; cubic splines between its rows.

    Columns: t, x, y, z and, if wanted, the components rx, ry, rz of a rotation vector; the header gives their units.
    """

    model_config = FROZEN

    file: NamedFile = Field(
        description="CSV file with a header such as t [s], x [m], y [m], z [m], rx [deg], ry [deg], rz [deg] (or "
        "min, ms; mm, cm, ft; rad); a relative name is sought beside the scene file"
    )
    ramp: TimeOrNone = Field(default=0.0, description=_RAMP)

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        assert self.columns.rows
        return self

    @cached_property
    def columns(self) -> CsvColumns:
        """Contents of the file."""
        known = {**dict.fromkeys("xyz", LENGTH), **dict.fromkeys(("rx", "ry", "rz"), ANGLE)}
        return read_history(self.file, known, required=("x", "y", "z"))

    @property
    def displacements(self) -> list[Vector]:
        """[x, y, z] [m] of each row."""
        return list(zip(*(self.columns.get(name) for name in ("x", "y", "z")), strict=True))

    @property
    def rotations(self) -> list[Vector]:
        """Rotation vector [rad] of each row."""
        return list(zip(*(self.columns.get(name) for name in ("rx", "ry", "rz")), strict=True))


class Vessel(BaseModel):
    """The end is part of a vessel that answers the scene's waves linearly, by its table of RAOs.

    Vessel axes: x forward along the heading, y to port, z up; rotations are right-handed (roll lowers starboard, pitch
    the bow; yaw turns the bow to port). Wave directions count from the heading towards port and give where waves run
    to: 0 from astern, 90 from starboard, 180 from ahead. Phases are lags behind the crest at the reference point.
    """

    model_config = FROZEN

    rao: NamedFile = Field(
        description="CSV file with columns frequency [rad/s or Hz] or period [s], direction [deg or rad], and of each "
        "mode that responds its amplitude and phase: surge [m/m], surge phase [deg], ..., yaw [deg/m or rad/m], yaw "
        "phase [deg]; or netCDF (.nc) with capytaine's RAO; a relative name is sought beside the scene file"
    )
    reference: Position = Field(description="point that the RAOs belong to, the vessel at rest, [x, y, z] [m]")
    heading_deg: Angle = Field(default=0.0, description="direction of the vessel's bow, from x towards y [deg]")
    ramp: Time | None = Field(
        default=None,
        description=f"{_RAMP}; by default that of the waves; at least one (peak) period where the vessel moves the end "
        "again after a stage in which it rested",
    )

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        assert self.table.frequency
        return self

    @cached_property
    def table(self) -> Rao:
        """Contents of the file."""
        return read_capytaine(self.rao) if is_netcdf(self.rao) else read_rao(self.rao)

    def axes(self, mode: str) -> Vector:
        """Global direction of a mode's displacement, or axis of its rotation."""
        return vessel_axis(mode, self.heading_deg)


class VesselHistory(BaseModel):
    """The end is part of a vessel whose six motions at a reference point a CSV file tells; cubic splines in time.

    Vessel axes: x forward along the heading, y to port, z up; rotations are right-handed (roll lowers starboard, pitch
    the bow; yaw turns the bow to port) and may be large: yaw first, then pitch about the axis turned by yaw, then roll.
    """

    model_config = FROZEN

    file: NamedFile = Field(
        description="CSV file with columns t [s] and, of the modes that move, surge, sway, heave [m] and roll, pitch, "
        "yaw [deg] (or min, ms; mm, cm, ft; rad), from the vessel's place at the stage's beginning; a relative name is "
        "sought beside the scene file"
    )
    reference: Position = Field(
        description="point of the vessel that the motions belong to, at the stage's beginning, [x, y, z] [m]"
    )
    heading_deg: Angle = Field(default=0.0, description="direction of the vessel's bow, from x towards y [deg]")
    ramp: TimeOrNone = Field(default=0.0, description=_RAMP)

    @model_validator(mode="after")
    def _can_be_read(self) -> Self:
        for mode in ROTATIONS:
            for line, angle in zip(self.columns.lines, self.columns.get(mode), strict=True):
                if abs(angle) > _WIDEST_ANGLE:
                    how = f"{mode} must be within 90 deg of the heading and the level, but is {math.degrees(angle):g}"
                    raise wrong_file(f"{self.file}:{line}: {how}; correct it, or give the heading as heading_deg")
        if not self.moving:
            place = f"{self.file}:{self.columns.header}"
            raise wrong_file(f"{place}: nothing moves; give surge [m], sway [m], heave [m], roll [deg] and so on")
        return self

    @cached_property
    def columns(self) -> CsvColumns:
        """Contents of the file."""
        known = {**dict.fromkeys(TRANSLATIONS, LENGTH), **dict.fromkeys(ROTATIONS, ANGLE)}
        return read_history(self.file, known, required=())

    @property
    def displacements(self) -> list[Vector]:
        """Surge, sway and heave [m] of each row."""
        return list(zip(*(self.columns.get(name) for name in ("surge", "sway", "heave")), strict=True))

    @property
    def rotations(self) -> list[Vector]:
        """Roll, pitch and yaw [rad] of each row."""
        return list(zip(*(self.columns.get(name) for name in ("roll", "pitch", "yaw")), strict=True))

    @cached_property
    def moving(self) -> tuple[str, ...]:
        """Modes that are not zero throughout."""
        return tuple(mode for mode in MODES if any(self.columns.get(mode)))

    def axes(self, mode: str) -> Vector:
        """Global direction of a mode's displacement, or axis of its rotation."""
        return vessel_axis(mode, self.heading_deg)


MotionKind = Harmonic | ArcMotion | Table | Vessel | VesselHistory | Rotation


class EndMotion(BaseModel):
    """The prescribed motion of one end: one of harmonic, arc, table, vessel and vessel_history; rotation beside the
    first three or alone.
    """

    model_config = FROZEN

    harmonic: Harmonic | None = Field(
        default=None, description="harmonic motion: amplitude, period, ramp, phase_deg"
    )
    arc: ArcMotion | None = Field(
        default=None, description="motion on an arc about a hub: hub, amplitude_deg, period, ramp, plane, phase_deg"
    )
    table: Table | None = Field(
        default=None, description="motion from a CSV file: its name, or {file, ramp}"
    )
    vessel: Vessel | None = Field(
        default=None, description="motion with a vessel in the scene's waves: rao, reference, heading_deg, ramp"
    )
    vessel_history: VesselHistory | None = Field(
        default=None, description="motion with a vessel that a CSV file moves: file, reference, heading_deg, ramp"
    )
    rotation: Rotation | None = Field(
        default=None, description="rotation of the support: axis, amplitude_deg, period, ramp, phase_deg"
    )

    @model_validator(mode="after")
    def _moves_in_one_way(self) -> Self:
        given = [key for key in self.ways if key != "rotation"]
        if len(given) > 1:
            raise wrong(given[1], f"the end moves by {given[0]} already", "leave one of the two out")
        if not given and self.rotation is None:
            remedy = "give harmonic, arc, table, vessel, vessel_history or rotation"
            raise wrong("harmonic", "there is no motion", remedy)
        if self.rotation and self.table and any(map(any, self.table.rotations)):
            raise wrong("rotation", "the table has rotations already", "leave one of the two out")
        if self.rotation and (self.vessel or self.vessel_history):
            raise wrong("rotation", "the vessel turns the end already", "leave one of the two out")
        return self

    @property
    def ways(self) -> dict[str, MotionKind]:
        """The given ways of motion by their keys."""
        return {key: way for key, way in self if way is not None}

    @property
    def turns(self) -> bool:
        """Whether the support turns."""
        by_table = self.table is not None and any(map(any, self.table.rotations))
        by_history = self.vessel_history is not None and any(map(any, self.vessel_history.rotations))
        return by_table or by_history or self.rotation is not None or self.vessel is not None


class Motion(BaseModel):
    """Prescribed motions of the ends."""

    model_config = FROZEN

    start: EndMotion | None = Field(
        default=None, description="motion of the start, {harmonic, arc, table, vessel or vessel_history}"
    )
    end: EndMotion | None = Field(
        default=None, description="motion of the end, {harmonic, arc, table, vessel or vessel_history}"
    )

    @property
    def by_end(self) -> dict[str, EndMotion]:
        """The motions given, by end."""
        ends = {"start": self.start, "end": self.end}
        return {key: motion for key, motion in ends.items() if motion is not None}
