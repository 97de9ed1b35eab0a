"""What VTK's own readers find in XDMF files: python vtk_reading.py FILE.xdmf FILE.npz, or --times FILE.xdmf ...

The reader of VTKHDF finds the same in the file of that name beside it, or this ends with an error.

A script, not a module to import: VTK aborts in a process that has imported dolfinx before it.
"""

import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

Frame = dict[
    str, Any
]  # points, cell_types, volumes, and the values by name with "point:" or "cell:" before it


def read_by_vtk(path: Path) -> tuple[list[float], list[Frame]]:
    """Times and frames."""
    file = path.with_suffix(".npz")
    subprocess.run([sys.executable, __file__, str(path), str(file)], check=True)
    with np.load(file) as store:
        arrays = {key: store[key] for key in store.files}
    file.unlink()
    times = arrays.pop("times").tolist()
    frames: list[Frame] = [{} for _ in times]
    for key, values in arrays.items():
        number, name = key.split("/")
        frames[int(number)][name] = values
    return times, frames


def times_by_vtk(paths: list[Path]) -> list[list[float]]:
    """Times of many files, whose last frames can be read."""
    call = [sys.executable, __file__, "--times", *map(str, paths)]
    done = subprocess.run(call, check=True, capture_output=True, text=True)
    assert not done.stderr, done.stderr
    times: list[list[float]] = json.loads(done.stdout)
    return times


def tell_times(*paths: str) -> None:
    """Runs may have ended, or met a full disk, when frames were in the VTKHDF file and not yet in the XDMF file."""
    frames = []
    for path in paths:
        times, theirs = times_in(path), times_in(beside(path))
        assert theirs[: len(times)] == (times if theirs else times[1:])
        for number in (len(times) - 1,) if times else ():
            same(look(path, number), look(beside(path), number))
        frames.append(times)
    print(json.dumps(frames))


def main(path: str, output: str) -> None:
    times = times_in(path)
    same_times(path, times)
    arrays: Frame = {"times": np.array(times)}
    for number in range(len(times)):
        frame = look(path, number)
        same(frame, look(beside(path), number))
        arrays |= {f"{number}/{name}": values for name, values in frame.items()}
    np.savez(output, **arrays)


def beside(path: str) -> str:
    return str(Path(path).with_suffix(".vtkhdf"))


def same_times(path: str, times: list[float]) -> None:
    """VTK's reader of VTKHDF tells no time where there is one alone."""
    assert times_in(beside(path)) == (times if len(times) > 1 else [])


def same(frame: Frame, other: Frame) -> None:
    assert frame.keys() == other.keys(), (frame.keys(), other.keys())
    for name, values in frame.items():
        np.testing.assert_array_equal(other[name], values, err_msg=name)


def times_in(path: str) -> list[float]:
    from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

    reader = reader_of(path)
    reader.UpdateInformation()
    return list(reader.GetOutputInformation(0).Get(vtkStreamingDemandDrivenPipeline.TIME_STEPS()) or ())


def look(path: str, number: int) -> Frame:
    """A frame, as a reader that has seen none before it finds it."""
    import pyvista as pv

    reader = reader_of(path)
    reader.UpdateInformation()
    times = times_in(path)
    reader.UpdateTimeStep(times[number] if times else 0.0)
    grid = pv.wrap(reader.GetOutputDataObject(0))
    sizes = grid.compute_cell_sizes(length=False, area=False)
    assert grid.n_points > 0
    return dict(values_of(grid, sizes))


def values_of(grid: Any, sizes: Any) -> Iterator[tuple[str, Any]]:
    yield "points", grid.points
    yield "cell_types", np.array([int(grid.GetCellType(cell)) for cell in range(grid.n_cells)])
    yield "volumes", sizes.cell_data["Volume"]
    for kind, data in (("point", grid.point_data), ("cell", grid.cell_data)):
        yield from ((f"{kind}:{name}", np.asarray(data[name])) for name in data)


def reader_of(path: str) -> Any:
    from vtkmodules.vtkIOHDF import vtkHDFReader
    from vtkmodules.vtkIOXdmf2 import vtkXdmfReader

    reader = vtkXdmfReader() if path.endswith(".xdmf") else vtkHDFReader()
    reader.SetFileName(path)
    return reader


if __name__ == "__main__":
    if sys.argv[1] == "--times":
        tell_times(*sys.argv[2:])
    else:
        main(*sys.argv[1:])
