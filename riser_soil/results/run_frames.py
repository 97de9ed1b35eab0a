"""Frames of riser and soil for ParaView, which share one time axis."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from riser_soil.core import outputs
from riser_soil.core.arrays import Array
from riser_soil.core.saved_state import Stateful
from riser_soil.core.snapshot import SoilMesh, SoilSnapshot
from riser_soil.results import folder as run_folder
from riser_soil.results.netcdf import group
from riser_soil.results.xdmf import Frame, XdmfFile, polyline


def soil_frame(stamp: float, soil: SoilSnapshot, fields: Collection[str]) -> Frame:
    wanted = [output for output in outputs.OF_SOIL if output.name in fields]
    return Frame(
        stamp,
        {output.name: output.value(soil) for output in wanted if output.where == "soil points"},
        {output.name: output.value(soil) for output in wanted if output.where == "soil cells"} | {**soil.requested},
    )


class RunFrames:
    """The files of a run. nodes: how many each line has, by its name, "" of the only one. fields: names of the outputs
    that are wanted, by line; goes_on: from frames that are there.
    """

    def __init__(
        self,
        folder: Path,
        nodes: Mapping[str, int],
        soil_mesh: SoilMesh | None,
        fields: Mapping[str, tuple[str, ...]],
        goes_on: bool,
    ) -> None:
        self._fields = fields
        paths = {line: folder / (run_folder.OF_LINE.format(line) if line else run_folder.RISER_XDMF) for line in nodes}
        self._lines = {
            line: XdmfFile(path, path.stem, polyline(nodes[line]), polyline=True, goes_on=goes_on)
            for line, path in paths.items()
        }
        self._files, self._soil = [*self._lines.values()], None
        if soil_mesh is not None:
            soil = folder / run_folder.SOIL_XDMF
            self._soil = XdmfFile(soil, "soil", soil_mesh.cells, soil_mesh.points, goes_on=goes_on)
            self._files.append(self._soil)

    def drawable(self, soil: SoilSnapshot | None) -> bool:
        """Whether a frame can be made with this snapshot of the soil."""
        return self._soil is None or soil is not None

    def add(self, stamp: float, rows: Mapping[str, Array], row: int, soil: SoilSnapshot | None) -> int:
        """Add a frame; how many bytes wait for their turn on disk."""
        waiting = 0
        for line, file in self._lines.items():
            fields = self._fields[line]
            wanted = [output.name for output in outputs.ALONG_RISER if output.chosen and output.name in fields]
            on_points = {name: rows[f"{group(line)}{name}"][row] for name in (*wanted, "position")}
            file.add(Frame(stamp, on_points, geometry="position"))
            waiting += _size(on_points)
        if self._soil is None:
            return waiting
        if soil is None:
            raise ValueError("pictures are due, so the soil's snapshot is needed too: both files share one time axis")
        self._soil.add(soil_frame(stamp, soil, {name for fields in self._fields.values() for name in fields}))
        return waiting + _size(vars(soil)) + _size(soil.requested)

    def flush(self) -> None:
        """Write all frames so far to disk."""
        for each in self._files:
            each.flush()

    def outlast_power(self) -> None:
        """Write through to the disk from now on, so that the files outlast a power cut."""
        for each in self._files:
            each.outlast_power()

    def close(self) -> None:
        for each in self._files:
            each.close()

    @property
    def owners(self) -> dict[str, Stateful]:
        """Files with a state from step to step, by the names under which it is saved."""
        lines: dict[str, Stateful] = {f"{line or 'riser'}_frames": file for line, file in self._lines.items()}
        return lines if self._soil is None else lines | {"soil_frames": self._soil}


def _size(values: Mapping[str, Any]) -> int:
    """Bytes of the arrays among the values."""
    return sum(value.nbytes for value in values.values() if isinstance(value, np.ndarray))
