"""Plausibility of a pipe's numbers beside each other: density and moduli of its cross-section, forces by its weight.

A steel pipe is known by its `wall`, or by a bore and the density of steel: EA and EI then give the modulus of a metal,
and the modulus of steel the density of steel. Of any pipe the density, a modulus and the strain by its own weight have
limits. With a bore, EI is at least some ten-thousandths of that of a solid wall.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

from riser_soil.scene.problem import Path, matching
from riser_soil.scene.size import LINES, Doubt, Size, amount_of, meant, number_of

GRAVITY = 9.81
DIAMETER = Size(0.001, 2.5, "m", {"mm": 1e-3, "inches": 0.0254, "cm": 1e-2})
DENSITY = Size(100.0, 2e4, "kg/m3")  # anything with a cross-section
FLOAT = Size(100.0, 1200.0, "kg/m3")  # a section with buoyancy
BODY_DENSITY = Size(10.0, 5e4, "kg/m3")  # from an empty float to what carries more than its own volume
STEEL_DENSITY = Size(6500.0, 1e4, "kg/m3")  # a wall with the modulus of steel; it may be lined or coated
STEEL = Size(7500.0, 8200.0, "kg/m3")  # a steel wall with a bore
STEEL_MODULUS = Size(1.9e11, 2.2e11, "Pa")
METAL = Size(6e10, 2.6e11, "Pa")  # moduli of aluminium, titanium and steel
SHEAR = Size(2e10, 1.1e11, "Pa")  # shear moduli of these
MODULUS = Size(1e6, math.inf, "Pa")  # from rubber to what can't be stretched
LIMP = Size(2e-4, 5.0, "")  # EI of a pipe with a bore, over that of a solid wall of the same EA
STRAIN = Size(0.0, 0.02, "")  # by the weight of what hangs
PULL = Size(0.02, 1e6, "")  # a tension over that weight
BODIES = (("bodies", "*"), *((*line, "attachments", "*") for line in LINES))
MASSES = {"t/m": 1e3, "kN/m": 1e3 / GRAVITY, "lb/ft": 1.488164, "N/m": 1.0 / GRAVITY}
FORCES = {"kN": 1e3, "MN": 1e6}
STIFFNESSES = {"kN.m2": 1e3, "MN.m2": 1e6}
WEIGHTS = {"kN/m": 1e3, "kg/m": GRAVITY, "t/m": 1e3 * GRAVITY}


def doubts_of_pipes(data: Any, doubted: Collection[Path]) -> Iterator[Doubt]:
    """Numbers of line types, and forces on lines, that don't fit the others. doubted: paths that are doubtful alone."""
    places = [(path, given) for path, given in matching(data, ("line_types", "*")) if isinstance(given, dict)]
    given = {path[1]: GivenPipe(path, pipe) for path, pipe in places}
    doubts = [each for pipe in given.values() for each in _of_diameters(pipe)]
    doubtful = {each.path[1] for each in doubts} | {path[1] for path in doubted if path[0] == "line_types"}
    pipes = {name: pipe for name, pipe in given.items() if name not in doubtful}
    doubts += [each for pipe in pipes.values() for each in _of_section(pipe)]
    doubts += [each for pattern in BODIES for path, body in matching(data, pattern) for each in _of_body(path, body)]
    water = first_number(data, ("water", "density"))
    for path, line in (place for pattern in LINES for place in matching(data, pattern)):
        if isinstance(line, dict):
            doubts += _of_line(GivenLine(path, line, pipes, water))
    yield from {each.path: each for each in reversed(doubts)}.values()


def first_number(data: Any, pattern: tuple[str, ...]) -> float:
    """The number at a path, 0 where there is none."""
    return next((amount_of(value) for _, value in matching(data, pattern)), 0.0)


def doubt(
    path: Path,
    number: float,
    unit: str,
    others: Mapping[str, float],
    gives: Callable[[float], float],
    size: Size,
    what: str,
) -> Iterator[Doubt]:
    """About a number that gives a quantity which is not plausible; others: factors of units that it may be in."""
    if number == 0.0 or size.holds(gives(number)):
        return
    fits = {name: number * factor for name, factor in others.items() if size.holds(gives(number * factor))}
    given = f"{gives(number):.3g} {size.unit}".rstrip()
    text = f"{number:g} {unit} gives {what} of {given}, and {size.usual} is usual"
    yield Doubt(path, f"{' '.join(text.split())}: is it {meant(fits, unit)}?")


def _over(divisor: float) -> Callable[[float], float]:
    return lambda number: number / divisor


class GivenPipe(NamedTuple):
    """A line type of plain data, at its path."""

    path: Path
    given: Mapping[str, Any]

    def number(self, key: str) -> float:
        return amount_of(self.given.get(key))

    @property
    def diameters(self) -> tuple[float, float]:
        """Outer and inner [m]; 0 where they are not given."""
        return self.number("outer_diameter"), self.number("inner_diameter")

    @property
    def wall(self) -> tuple[float, float]:
        """Sizes of the wall that bears stress."""
        outer, inner = (first_number(self.given, ("wall", key)) for key in ("outer_diameter", "inner_diameter"))
        return outer or self.diameters[0], inner or self.diameters[1]

    @property
    def is_metal(self) -> bool:
        area = area_of(*self.diameters)
        steel = self.diameters[1] > 0.0 and area > 0.0 and STEEL.holds(self.number("mass") / area)
        return isinstance(self.given.get("wall"), dict) or (steel and self.number("mass") > 0.0)

    def weight(self, water: float, contents: float) -> float:
        """Weight in the water [N/m], by densities [kg/m3]; 0 where it is not known."""
        outer, inner = self.diameters
        if given := number_of(self.given.get("submerged_weight")):
            return given
        mass = self.number("mass")
        return GRAVITY * (mass + area_of(inner, 0.0) * contents - area_of(outer, 0.0) * water) if mass else 0.0


def area_of(outer: float, inner: float) -> float:
    """Area of a ring's cross-section [m2]."""
    return 0.25 * math.pi * (outer**2 - inner**2)


def _of_diameters(pipe: GivenPipe) -> Iterator[Doubt]:
    """Diameters in another unit, by which the mass has a plausible density; a wide pipe may float."""
    diameters = dict(zip(("outer_diameter", "inner_diameter"), pipe.diameters, strict=True))
    if all(map(DIAMETER.holds, pipe.diameters)) or _dense(pipe, 1.0, FLOAT) is True:
        return
    likely = [unit for unit, factor in DIAMETER.others.items() if _dense(pipe, factor, DENSITY) is not False]
    size = replace(DIAMETER, others={unit: DIAMETER.others[unit] for unit in likely or DIAMETER.others})
    for key, value in diameters.items():
        if text := size.doubt(value):
            yield Doubt((*pipe.path, key), text)


def _dense(pipe: GivenPipe, factor: float, size: Size) -> bool | None:
    """Whether the mass has a plausible density with implausible diameters in another unit; None where it has none."""
    outer, inner = (value if DIAMETER.holds(value) else factor * value for value in pipe.diameters)
    mass, area = pipe.number("mass"), area_of(outer, inner)
    return size.holds(mass / area) if mass > 0.0 and area > 0.0 else None


def _of_section(pipe: GivenPipe) -> Iterator[Doubt]:
    """Doubts about the section of a pipe whose diameters are known."""
    (outer, inner), area, whole = pipe.wall, area_of(*pipe.wall), area_of(*pipe.diameters)
    if area <= 0.0 or whole <= 0.0:
        return
    second, EA = area * (outer**2 + inner**2) / 16.0, pipe.number("EA")
    steel = pipe.is_metal and STEEL_MODULUS.holds(EA / area) and pipe.wall == pipe.diameters
    density, modulus = STEEL_DENSITY if steel else DENSITY, METAL if pipe.is_metal else MODULUS
    path, mass = (*pipe.path, "mass"), pipe.number("mass")
    yield from doubt(path, mass, "kg/m", MASSES, _over(whole), density, "a density")
    yield from doubt((*pipe.path, "EA"), EA, "N", FORCES, _over(area), modulus, "a modulus EA/A")
    for key in ("EI", "EI_y", "EI_z"):
        path, EI = (*pipe.path, key), pipe.number(key)
        if pipe.is_metal:
            yield from doubt(path, EI, "N.m2", STIFFNESSES, _over(second), METAL, "a modulus EI/I")
            path, GJ, what = (*pipe.path, "GJ"), pipe.number("GJ"), "a modulus GJ/J"
            yield from doubt(path, GJ, "N.m2", STIFFNESSES, _over(2.0 * second), SHEAR, what)
        elif EA > 0.0 and inner > 0.0:
            solid, what = EA * second / area, "over that of a solid wall with this EA a share"
            yield from doubt(path, EI, "N.m2", STIFFNESSES, _over(solid), LIMP, what)


def _of_body(path: Path, body: Any) -> Iterator[Doubt]:
    """The density of a body or an attachment that displaces water."""
    mass, volume = (amount_of(body.get(key)) if isinstance(body, dict) else 0.0 for key in ("mass", "volume"))
    if volume > 0.0:
        yield from doubt((*path, "mass"), mass, "kg", {"t": 1e3}, _over(volume), BODY_DENSITY, "a density")


class GivenLine(NamedTuple):
    """A line of plain data, at its path, with its pipes by name, in water of a density [kg/m3]."""

    path: Path
    given: Mapping[str, Any]
    pipes: Mapping[Any, GivenPipe]
    water: float

    @property
    def contents(self) -> float:
        """Density of the contents [kg/m3]."""
        return first_number(self.given, ("contents", "density"))

    @property
    def height(self) -> float:
        """Between the ends [m]; 0 where one is free."""
        start, end = (list(matching(self.given, (name, "position", "2"))) for name in ("start", "end"))
        return abs(number_of(end[0][1]) - number_of(start[0][1])) if start and end else 0.0

    @property
    def lengths(self) -> dict[Any, float]:
        """Length [m] of each pipe on the line."""
        segments = [segment for _, segment in matching(self.given, ("segments", "*")) if isinstance(segment, dict)]
        used = {name: [each for each in segments if each.get("line_type") == name] for name in self.pipes}
        return {name: math.fsum(amount_of(each.get("length")) for each in of) for name, of in used.items() if of}

    @property
    def hanging_weight(self) -> float:
        """Weight in water of a piece as long as the line is high [N]."""
        weights = [self.pipes[name].weight(self.water, self.contents) * length for name, length in self.lengths.items()]
        length = math.fsum(self.lengths.values())
        return abs(math.fsum(weights)) * min(1.0, self.height / length) if length > 0.0 else 0.0


def _of_line(line: GivenLine) -> Iterator[Doubt]:
    """Forces and stiffnesses by the weight of what hangs, and given weights by masses."""
    for name, length in line.lengths.items():
        pipe = line.pipes[name]
        weight = pipe.weight(line.water, line.contents)
        yield from _of_strain(pipe, abs(weight) * min(length, line.height))
        yield from _of_given_weight(line, pipe)
        yield from _of_pull(line, (*pipe.path, "max_tension"), pipe.number("max_tension"))
    for end in ("start", "end"):
        for key in ("hang_off", "tensioner"):
            path = (end, key, "tension")
            yield from _of_pull(line, (*line.path, *path), first_number(line.given, path))


def _of_strain(pipe: GivenPipe, weight: float) -> Iterator[Doubt]:
    path, EA, what = (*pipe.path, "EA"), pipe.number("EA"), "by the weight of what hangs a strain"
    yield from doubt(path, EA, "N", FORCES, lambda EA: weight / EA, STRAIN, what)


def _of_pull(line: GivenLine, path: Path, tension: float) -> Iterator[Doubt]:
    if (weight := line.hanging_weight) > 0.0:
        what = "over the weight of a piece as long as the line is high a share"
        yield from doubt(path, tension, "N", FORCES, _over(weight), PULL, what)


def _of_given_weight(line: GivenLine, pipe: GivenPipe) -> Iterator[Doubt]:
    """A submerged_weight that would be that of mass and diameters in another unit."""
    given, mass, outer = number_of(pipe.given.get("submerged_weight")), pipe.number("mass"), pipe.diameters[0]
    if not (given and mass and outer):
        return
    bare = {key: value for key, value in pipe.given.items() if key != "submerged_weight"}
    expected = pipe._replace(given=bare).weight(line.water, line.contents)
    meanings = {unit: given * factor for unit, factor in WEIGHTS.items()}
    fits = {unit: value for unit, value in meanings.items() if abs(value - expected) < 0.1 * abs(expected)}
    if fits and not 0.3 * abs(expected) < abs(given) < 3.0 * abs(expected):
        text = f"{given:g} N/m, and mass, contents and diameters in the water give {expected:.4g} N/m"
        yield Doubt((*pipe.path, "submerged_weight"), f"{text}: is it {meant(fits, 'N/m')}?")
