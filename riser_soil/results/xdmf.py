"""Time series for ParaView and VTK: a VTKHDF file, which opens by itself, and XDMF that refers to its numbers.

Readable at any moment. The XDMF is one temporal collection of uniform grids. Each of its items is a whole HDF5 dataset
in the item's own shape: readers other than VTK's, as meshio, know no parts of datasets, nor bytes of a file. Numbers
are written before the XML that refers to them, so that the XML never refers to missing data.
"""

from __future__ import annotations

import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import h5py
import numpy as np

from riser_soil.core.arrays import Array, IntArray
from riser_soil.core.saved_state import Saved
from riser_soil.core.snapshot import stacked
from riser_soil.results import vtkhdf
from riser_soil.results.growing_file import GrowingFile, appending, behind, cutting_back
from riser_soil.results.ownership import PROGRAM, XDMF_HEAD, quoted

_CELLS = {4: "Tetrahedron", 8: "Hexahedron", 10: "Tetrahedron_10"}
_KINDS = {3: "Vector", 9: "Tensor"}
_GRID = '<Grid Name="frame_'
_NUMBER = "\0"  # of a frame, in the text that all have alike: XML has no such character
_FOOT = "  </Grid>\n </Domain>\n</Xdmf>\n"


@dataclass(frozen=True, eq=False)
class Frame:
    """One instant: values on points and cells, (n,), (n, 3), or (n, 9) of tensors, row by row.

    geometry: name of the values on points, (np, 3) m, that are the points; None where the mesh stays.
    """

    time: float  # s
    on_points: dict[str, Array] = field(default_factory=dict)
    on_cells: dict[str, Array] = field(default_factory=dict)
    geometry: str | None = None


class XdmfFile:
    """Writer of PATH.xdmf and the VTKHDF file of the same name beside it. The former comes with the first frame: VTK's
    reader, and ParaView with it, dies of a collection without any.

    cells: (nc, k) point numbers in VTK's order: k = 4, 8 or 10; or (1, np) with `polyline`.
    points: (np, 3) m for a mesh that stays; None when each frame brings its own geometry.
    goes_on: with the files of an earlier run, up to what is restored.
    """

    def __init__(
        self,
        path: Path,
        name: str,
        cells: IntArray,
        points: Array | None = None,
        *,
        polyline: bool = False,
        goes_on: bool = False,
    ) -> None:
        heavy = path.with_suffix(".vtkhdf")
        self._heavy_name = heavy.name
        self._frames, self._content = 0, ""
        self._waiting: list[Frame] = []
        content = io.BytesIO()
        with h5py.File(content, "w") as store:
            store.attrs["source"] = PROGRAM
            vtkhdf.lay_out(store, cells, points, polyline)
        self._heavy = GrowingFile(heavy, None if goes_on else content.getvalue())
        kind = _polyline_of(cells) if polyline else f'TopologyType="{_CELLS[cells.shape[1]]}"'
        item = self._item(vtkhdf.CELLS, cells.shape, "Int")
        self._topology = f'<Topology {kind} NumberOfElements="{len(cells)}">{item}</Topology>'
        self._points = None if points is None else self._item(f"{vtkhdf.ROOT}/Points", points.shape)
        self._path, self._head = path, XDMF_HEAD.format(name=quoted(name))
        self._goes_on = goes_on
        self._text = GrowingFile(path, None) if goes_on and path.exists() else None
        self._lasting = False

    def add(self, frame: Frame) -> None:
        """Takes a copy of one frame, later than the ones before; it lives in memory until `flush`."""
        on_points = {name: np.array(values) for name, values in frame.on_points.items()}
        on_cells = {name: np.array(values) for name, values in frame.on_cells.items()}
        self._waiting.append(replace(frame, on_points=on_points, on_cells=on_cells))

    def flush(self) -> None:
        """Writes the waiting frames: first the numbers, then the XML."""
        if not self._waiting:
            return
        frames = self._waiting
        with appending(self._heavy) as store:
            on_points, on_cells = (stacked([getattr(f, of) for f in frames]) for of in ("on_points", "on_cells"))
            times = [float(frame.time) for frame in frames]
            first = vtkhdf.append(store, times, on_points, on_cells, frames[0].geometry)
        self._content = self._content or self._content_of(frames[0])
        grids = [self._grid(first + i, self._frames + i, time) for i, time in enumerate(times)]
        self._frames += len(grids)
        self._waiting.clear()
        self._append("".join(grids))

    def close(self) -> None:
        self._heavy.close()
        if self._text is not None:
            self._text.close()

    def outlast_power(self) -> None:
        """Write through to the disk from now on, so that the files outlast a power cut."""
        self._lasting = True
        for file in (self._heavy, self._text):
            if file is not None:
                file.outlast_power()

    def state(self) -> Saved:
        """The number of frames; frames themselves are the files'."""
        return {"frames": np.array(self._frames + len(self._waiting))}

    def restore(self, saved: Saved) -> None:
        """Files that go on lose the frames that were written after those saved; ResultsError where they have fewer."""
        self._frames = int(saved["frames"])
        if self._goes_on:
            self._cut_back_text()
            with cutting_back(self._heavy) as store:
                if len(vtkhdf.times(store)) < self._frames:
                    raise behind(self._heavy.path)
                vtkhdf.cut_back(store, self._frames)

    def _cut_back_text(self) -> None:
        """The XML first, so that it never refers to missing data."""
        content = b"" if self._text is None else self._path.read_bytes()
        whole = self._text is None or content.endswith(_FOOT.encode())
        if not whole or content.count(_GRID.encode()) < self._frames:
            raise behind(self._path)
        at = content.find(f'   {_GRID}{self._frames:06d}"'.encode())
        if self._text is not None and self._frames == 0:
            self._text.close()
            self._text = None
            self._path.unlink()
        elif self._text is not None and at >= 0:
            self._text.update({at: _FOOT.encode()}, at + len(_FOOT))

    def _grid(self, number: int, in_run: int, time: float) -> str:
        """number: of the frame in the VTKHDF file; in_run: in a run that may have had other files before."""
        head = f'   {_GRID}{in_run:06d}" GridType="Uniform">\n   <Time Value="{time!r}"/>\n'
        return head + self._content.replace(_NUMBER, f"{number:06d}")

    def _content_of(self, frame: Frame) -> str:
        """Text of a grid, the same for all but for its number."""
        on = {"Node": frame.on_points, "Cell": frame.on_cells}
        each = [(name, centre, values) for centre, of in on.items() for name, values in of.items()]
        items = {name: self._item(vtkhdf.instant(name, _NUMBER), values.shape) for name, _, values in each}
        points = self._points if frame.geometry is None else items[frame.geometry]
        lines = [
            self._topology,
            f'<Geometry GeometryType="XYZ">{points}</Geometry>',
            *(_attribute(name, centre, values, items[name]) for name, centre, values in each),
            "</Grid>",
        ]
        return "".join(f"   {line}\n" for line in lines)

    def _item(self, where: str, shape: Sequence[int], number: str = "Float") -> str:
        """A whole array of the VTKHDF file."""
        return (
            f'<DataItem Dimensions="{_words(shape)}" NumberType="{number}" Precision="8" Format="HDF">'
            f"{self._heavy_name}:/{where}</DataItem>"
        )

    def _append(self, grids: str) -> None:
        """Put grids behind the last one; the text itself stays on disk, so that memory doesn't grow with the run."""
        added = (grids + _FOOT).encode()
        if self._text is None:
            self._text = GrowingFile(self._path, self._head.encode() + added)
            if self._lasting:
                self._text.outlast_power()
            return
        end = self._text.size - len(_FOOT)
        self._text.update({end: added}, end + len(added))


def polyline(nodes: int) -> IntArray:
    """Connectivity (1, nodes) of one line through all points in their order."""
    return np.arange(nodes, dtype=np.int64)[None, :]


def _words(numbers: Iterable[int]) -> str:
    return " ".join(map(str, numbers))


def _polyline_of(cells: IntArray) -> str:
    return f'TopologyType="Polyline" NodesPerElement="{cells.shape[1]}"'


def _attribute(name: str, centre: str, values: Array, item: str) -> str:
    kind = "Scalar" if values.ndim == 1 else _KINDS[values.shape[1]]
    return f'<Attribute Name={quoted(name)} AttributeType="{kind}" Center="{centre}">{item}</Attribute>'
