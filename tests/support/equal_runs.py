"""Two runs' folders, file by file: what in them is not the same."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np

TOLERANCE = 1e-12  # of the largest value of a variable
PARTS = {"riser.vtkhdf": "riser.xdmf", "soil.vtkhdf": "soil.xdmf"}


def unlike(one: Path, other: Path) -> list[str]:
    """Names of what differs by more than TOLERANCE in two folders; times of the computer and checkpoints left out."""
    return [*_series(one, other), *_frames(one, other), *_summaries(one, other)]


def _series(one: Path, other: Path) -> Iterator[str]:
    with h5py.File(one / "results.nc") as a, h5py.File(other / "results.nc") as b:
        yield from (f"results.nc: {name}" for name in _differing(dict(a.attrs), dict(b.attrs)))
        of_a, of_b = dict(datasets(a)), dict(datasets(b))
        if of_a.keys() != of_b.keys():
            yield "results.nc: variables"
        for name in of_a.keys() & of_b.keys():
            if not _near(of_a[name][()], of_b[name][()]) or of_a[name].attrs.keys() != of_b[name].attrs.keys():
                yield f"results.nc: {name} {of_a[name].shape} {of_b[name].shape}"


def _frames(one: Path, other: Path) -> Iterator[str]:
    for numbers, text in PARTS.items():
        if (one / numbers).exists() != (other / numbers).exists():
            yield numbers
        if (one / numbers).exists():
            with h5py.File(one / numbers) as a, h5py.File(other / numbers) as b:
                arrays = ({name: item[()] for name, item in datasets(file)} for file in (a, b))
                yield from (f"{numbers}: {name}" for name in _differing(*arrays))
            if not _same_text(one / text, other / text):
                yield text


_TIME = re.compile(r'<Time Value="([^"]+)"/>')
_BYTES = re.compile(r'Dimensions="([^"]+)"([^>]*) Seek="(\d+)">([^<]+)')


def _same_text(one: Path, other: Path) -> bool:
    """But for the places in the other file, of what lies there in both."""
    texts = [path.read_text() for path in (one, other)]
    times = [np.array([float(t) for t in _TIME.findall(text)]) for text in texts]
    first, second = (_BYTES.sub(r"\1\2\4", _TIME.sub("", text)) for text in texts)
    return _near(*times) and first == second and all(map(_near, _numbers(one), _numbers(other)))


def _numbers(path: Path) -> Iterator[Any]:
    """Numbers that an XDMF file refers to by their bytes."""
    content = dict[str, bytes]()
    for dimensions, _, place, name in _BYTES.findall(path.read_text()):
        if name not in content:
            content[name] = (path.parent / name).read_bytes()
        count = int(np.prod([int(n) for n in dimensions.split()]))
        yield np.frombuffer(content[name], count=count, offset=int(place))


def datasets(group: h5py.Group, at: str = "") -> Iterator[tuple[str, h5py.Dataset]]:
    """All datasets of a file, or of a group, with their names in it."""
    for name, item in group.items():
        if isinstance(item, h5py.Dataset):
            yield f"{at}{name}", item
        else:
            yield from datasets(item, f"{at}{name}/")


def _summaries(one: Path, other: Path) -> Iterator[str]:
    a, b = (json.loads((folder / "summary.json").read_text(encoding="utf-8")) for folder in (one, other))
    a, b = ({name: value for name, value in each.items() if "seconds" not in name} for each in (a, b))
    yield from (f"summary.json: {name}" for name in _differing(dict(_leaves(a)), dict(_leaves(b))))


def _leaves(value: Any, at: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _leaves(item, f"{at}.{name}")
    elif isinstance(value, list):
        for n, item in enumerate(value):
            yield from _leaves(item, f"{at}.{n}")
    else:
        yield at, value


def _differing(one: dict[str, Any], other: dict[str, Any]) -> list[str]:
    names = sorted(one.keys() | other.keys())
    return [name for name in names if name not in one or name not in other or not _near(one[name], other[name])]


def _near(one: Any, other: Any) -> bool:
    a, b = np.asarray(one), np.asarray(other)
    if a.shape != b.shape or a.dtype.kind != b.dtype.kind:
        return False
    if a.dtype.kind != "f":
        return bool(np.all(a == b))
    finite = np.isfinite(a)
    scale = np.abs(a[finite]).max(initial=0.0)
    return np.array_equal(finite, np.isfinite(b)) and bool(np.all(np.abs(a[finite] - b[finite]) <= TOLERANCE * scale))
