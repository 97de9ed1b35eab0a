"""VTKHDF layout of the pictures' HDF5 files: VTK 9.3, ParaView 5.12 and later ones open them by themselves, with times.

One group is of that layout, VTKHDF: points, cells, values on both, and for each instant where its own begin. Values of
all instants stand one after the other, in chunks of an instant or of several small ones, so that a frame costs the same
however many there are. What they share is stored once: a mesh that stays, a line's cells; offsets that are the same for
several values are links to one array. XDMF refers to `CELLS`, and to datasets of single instants, see `instant`: its
readers, other than VTK's, know no parts of datasets. The dataset of an instant is a view, which stores no number, where
its values are large. Small values are copied: HDF5 makes three copies in the time of one view.
Source: VTK's file formats, "VTKHDF File Format", version 2.0.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import h5py
import numpy as np
from h5py import h5d, h5p, h5s, h5t

from riser_soil.core.arrays import Array, IntArray
from riser_soil.results.growing_file import append_rows

ROOT = "VTKHDF"
CELLS = "cells"  # (nc, k) numbers of each cell's points: a view of VTKHDF's own, which are in one row
_INSTANTS = "instants"
_TYPES = {4: 10, 8: 12, 10: 24}  # tetrahedron, hexahedron, second-order tetrahedron, by their points
_KINDS_OF_LINES = ("Vertices", "Lines", "Polygons", "Strips")
_STEPS_IN_CHUNK = 128
_BYTES_IN_CHUNK = 1 << 14  # of values, or those of one instant, which then are large


def lay_out(store: h5py.File, cells: IntArray, points: Array | None, polyline: bool) -> None:
    """A mesh without any instant. cells: (nc, k), or one line (1, np); points: (np, 3) m, None where they move."""
    store.create_group(_INSTANTS)
    root = store.create_group(ROOT)
    root.attrs["Version"] = np.array([2, 0])
    root.attrs["Type"] = np.bytes_("PolyData" if polyline else "UnstructuredGrid")
    root["NumberOfPoints"] = np.array([cells.max() + 1 if points is None else len(points)])
    if points is not None:
        root["Points"] = points
    kinds = _KINDS_OF_LINES if polyline else ("",)
    for kind in kinds:
        _add_cells(root.create_group(kind) if kind else root, cells if kind in ("", "Lines") else cells[:0])
    _add_view_of_cells(store, root["Lines/Connectivity" if polyline else "Connectivity"], cells.shape)
    if not polyline:
        root["Types"] = np.full(len(cells), _TYPES[cells.shape[1]], dtype=np.uint8)
    steps = root.create_group("Steps")
    steps.attrs["NSteps"] = 0
    _make_growing(steps, "Values", (), "f8", _STEPS_IN_CHUNK)
    for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
        _make_growing(steps, name, (), "i8", _STEPS_IN_CHUNK)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        _make_growing(steps, name, (len(kinds),), "i8", _STEPS_IN_CHUNK)
    for kind in ("Point", "Cell"):
        root.create_group(f"{kind}Data")
        steps.create_group(f"{kind}DataOffsets")


def append(
    store: h5py.File,
    times: Sequence[float],
    on_points: Mapping[str, Array],
    on_cells: Mapping[str, Array],
    geometry: str | None = None,
) -> int:
    """Instants (n,) [s], with the same names as those before; the number of the first of them in this file. Values (n,
    np) or (n, np, 3), on cells alike.

    geometry: name of the values on points that are the points.
    """
    root = store[ROOT]
    steps, n = root["Steps"], len(times)
    numbers = int(steps.attrs["NSteps"]) + np.arange(n)
    for kind, values in {"Point": on_points, "Cell": on_cells}.items():
        _append_values(root[f"{kind}Data"], steps[f"{kind}DataOffsets"], numbers, values)
        for name, array in values.items():
            if array[0].nbytes < _BYTES_IN_CHUNK:
                _add_copies(store[_INSTANTS], name, numbers, array)
            else:
                _add_views(store[_INSTANTS], name, numbers, root[f"{kind}Data"][name], array.shape[1:])
    if geometry is not None and "Points" not in root:
        root["Points"] = root["PointData"][geometry]
    moved = numbers * (int(root["NumberOfPoints"][0]) if geometry is not None else 0)
    none = np.zeros_like(numbers)
    of_steps = {"Values": times, "PartOffsets": none, "NumberOfParts": none + 1, "PointOffsets": moved}
    for name, rows in of_steps.items():
        append_rows(steps[name], rows)
    for name in ("CellOffsets", "ConnectivityIdOffsets"):
        append_rows(steps[name], np.zeros((n, steps[name].shape[1]), dtype=np.int64))
    steps.attrs["NSteps"] = int(numbers[-1]) + 1
    return int(numbers[0])


def cut_back(store: h5py.File, frames: int) -> None:
    """Remove the instants after the first `frames`."""
    instants = store[_INSTANTS]
    for name in [name for name in instants if int(name.rpartition("_")[2]) >= frames]:
        del instants[name]
    root = store[ROOT]
    steps = root["Steps"]
    for kind in ("Point", "Cell"):
        for values in root[f"{kind}Data"].values():
            values.resize(frames * _rows(root, kind), axis=0)
        for offsets in steps[f"{kind}DataOffsets"].values():
            offsets.resize(frames, axis=0)
    for steps_of in steps.values():
        if isinstance(steps_of, h5py.Dataset):
            steps_of.resize(frames, axis=0)
    steps.attrs["NSteps"] = frames


def times(store: h5py.File) -> Array:
    """Times (nf,) [s] of the instants."""
    values: Array = store[ROOT]["Steps"]["Values"][...]
    return values


def mesh(store: h5py.File) -> tuple[Array, IntArray]:
    """Points (np, 3) [m] and cells (nc, k) of a mesh that stays."""
    root = store[ROOT]
    return root["Points"][...], root["Connectivity"][...].reshape(int(root["NumberOfCells"][0]), -1)


def values_at(store: h5py.File, number: int) -> dict[str, Array]:
    """Values on points and cells of one instant, by their names."""
    of_instant = {}
    for kind in ("Point", "Cell"):
        rows = _rows(store[ROOT], kind)
        for name, values in store[ROOT][f"{kind}Data"].items():
            of_instant[name] = values[number * rows : (number + 1) * rows]
    return of_instant


def _rows(root: h5py.Group, kind: str) -> int:
    """Count of points or cells at one instant."""
    if kind == "Cell" and _KINDS_OF_LINES[1] in root:
        root = root[_KINDS_OF_LINES[1]]
    return int(root[f"NumberOf{kind}s"][0])


def _add_cells(group: h5py.Group, cells: IntArray) -> None:
    count, points = cells.shape
    group["NumberOfCells"] = np.array([count])
    group["NumberOfConnectivityIds"] = np.array([cells.size])
    group["Connectivity"] = np.ascontiguousarray(cells, dtype=np.int64).ravel()
    group["Offsets"] = points * np.arange(count + 1, dtype=np.int64)


def _add_view_of_cells(store: h5py.File, connectivity: h5py.Dataset, shape: tuple[int, ...]) -> None:
    layout = h5p.create(h5p.DATASET_CREATE)
    rows, flat = h5s.create_simple(shape), connectivity.id.get_space()
    layout.set_virtual(rows, b".", connectivity.name.encode(), flat)
    h5d.create(store.id, CELLS.encode(), connectivity.id.get_type(), rows, layout)


def instant(name: str, number: str) -> str:
    """Path of the dataset of a quantity's values at an instant alone; number: six digits."""
    return f"{_INSTANTS}/{name}_{number}"


def _add_copies(instants: h5py.Group, name: str, numbers: IntArray, values: Array) -> None:
    """Values (n, np) or (n, np, 3) of the last instants, each written by itself."""
    space, number_type = h5s.create_simple(values.shape[1:]), h5t.py_create(values.dtype)
    layout = h5p.create(h5p.DATASET_CREATE)
    layout.set_layout(h5d.COMPACT)
    layout.set_obj_track_times(False)
    for number, of_one in zip(numbers.tolist(), values, strict=True):
        made = h5d.create(instants.id, f"{name}_{number:06d}".encode(), number_type, space, layout)
        made.write(h5s.ALL, h5s.ALL, of_one, number_type)


def _add_views(
    instants: h5py.Group, name: str, numbers: IntArray, stacked: h5py.Dataset, shape: tuple[int, ...]
) -> None:
    """The last instants by themselves, as parts of the dataset of all; shape: of one."""
    space, of_all = h5s.create_simple(shape), stacked.id.get_space()
    for number in numbers.tolist():
        layout = h5p.create(h5p.DATASET_CREATE)
        of_all.select_hyperslab((number * shape[0], *(0 for _ in shape[1:])), shape)
        layout.set_virtual(space, b".", stacked.name.encode(), of_all)
        h5d.create(instants.id, f"{name}_{number:06d}".encode(), stacked.id.get_type(), space, layout)


def _append_values(data: h5py.Group, offsets: h5py.Group, numbers: IntArray, values: Mapping[str, Array]) -> None:
    for name, array in values.items():
        rows, row = array.shape[1], array.shape[2:]
        if name not in data:
            together = max(_BYTES_IN_CHUNK // max(array[0].nbytes, 1), 1)
            _make_growing(data, name, row, array.dtype, rows * together)
            if len(offsets):
                offsets[name] = offsets[next(iter(offsets))]
            else:
                _make_growing(offsets, name, (), "i8", _STEPS_IN_CHUNK)
        append_rows(data[name], array.reshape(-1, *row))
    if values:
        name, array = next(iter(values.items()))
        append_rows(offsets[name], numbers * array.shape[1])


def _make_growing(group: h5py.Group, name: str, row: tuple[int, ...], dtype: object, rows: int) -> None:
    group.create_dataset(name, (0, *row), dtype, maxshape=(None, *row), chunks=(rows, *row))
