"""What VTK's own reader finds in XDMF files: python vtk_reading.py FILE.xdmf FILE.npz, or --times FILE.xdmf ...

A script, not a module to import: VTK aborts in a process that has imported dolfinx before it.
"""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

Frame = dict[
    str, Any
]  # points, cell_types, volumes, and the values by name with "point:" or "cell:" before it


def read_by_vtk(path: Path) -> tuple[list[float], list[Frame]]:
    """Times and frames."""
    found = path.with_suffix(".npz")
    subprocess.run([sys.executable, __file__, str(path), str(found)], check=True)
    with np.load(found) as store:
        arrays = {key: store[key] for key in store.files}
    found.unlink()
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
    found: list[list[float]] = json.loads(done.stdout)
    return found


def tell_times(*paths: str) -> None:
    import pyvista as pv

    found = []
    for path in paths:
        reader = pv.XdmfReader(path)
        times = list(reader.time_values)
        for time in times[-1:]:
            reader.set_active_time_value(time)
            assert reader.read().n_points > 0
        found.append(times)
    print(json.dumps(found))


def main(path: str, found: str) -> None:
    import pyvista as pv

    reader = pv.XdmfReader(path)
    arrays: Frame = {"times": np.array(reader.time_values)}
    for number, time in enumerate(reader.time_values):
        reader.set_active_time_value(time)
        grid = reader.read()
        sizes = grid.compute_cell_sizes(length=False, area=False)
        arrays[f"{number}/points"] = grid.points
        arrays[f"{number}/cell_types"] = np.array([int(cell.type) for cell in grid.cell])
        arrays[f"{number}/volumes"] = sizes.cell_data["Volume"]
        for kind, data in (("point", grid.point_data), ("cell", grid.cell_data)):
            arrays.update({f"{number}/{kind}:{name}": np.asarray(data[name]) for name in data})
    np.savez(found, **arrays)


if __name__ == "__main__":
    if sys.argv[1] == "--times":
        tell_times(*sys.argv[2:])
    else:
        main(*sys.argv[1:])
