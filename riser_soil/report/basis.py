"""Chapter on the basis: line, materials, contents, environment, vessel, ground, load cases and load steps."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from pydantic import BaseModel

from riser_soil.core.arrays import Array
from riser_soil.plots.curves import Curves
from riser_soil.plots.environment import current_sheet, peaked_spectrum, rao_sheet, spectrum_sheet
from riser_soil.report.document import Block, Paragraph, PictureBlock, ReportSection, TableBlock
from riser_soil.report.inputs import input_rows
from riser_soil.report.parameters import PROPERTIES, reference_of, seeds_of, words_of_path
from riser_soil.report.sources import LoadCase, Sources, flattened, is_seed
from riser_soil.report.tables import NOTHING, ReportTable, compact, given_value, number, without_paths
from riser_soil.results import Run
from riser_soil.scene.motions import Vessel, VesselHistory
from riser_soil.scene.rao import Rao
from riser_soil.scene.riser import RotationSpring
from riser_soil.scene.scene import Scene
from riser_soil.scene.stages import DynamicStage, Stage
from riser_soil.scene.wave_kinds import Airy, DrawnSea, GivenSpectrum, Jonswap, PeakedSea, Record, Regular, WaveKind

MOST_CASES = 80  # rows of the table of load cases
_FEW_PERIODS = 14  # rows of the table of RAOs
_MOST_SPECTRA = 8


def chapter(sources: Sources) -> ReportSection:
    """The basis of the reference case, and the load cases with what differs."""
    first = reference_of(sources)
    scene = first.scene
    if scene is None:
        lost = "The input file cannot be read, so its values are not shown here."
        return ReportSection("Basis", [Paragraph(lost, "warning")])
    return ReportSection(
        "Basis",
        [
            *_lines(sources, first),
            ReportSection("Environment", [*_environment(sources, scene)]),
            ReportSection("Vessel", [*_vessel(scene, first)]),
            ReportSection("Ground", [*_ground(scene)]),
            ReportSection("Load cases", [*_load_cases(sources, scene)]),
        ],
    )


def _lines(sources: Sources, first: LoadCase) -> Iterator[ReportSection]:
    """The line, or each of several lines of the reference case's run."""
    for case in sources.cases:
        if case.folder == first.folder and case.scene is not None:
            yield ReportSection(f"Line {case.line}".strip(), [*_line(case.scene, case.run)])


def _line(scene: Scene, run: Run) -> Iterator[Block]:
    low, high = (", ".join(number(float(x) + 0.0, 5) for x in run["position"][0, at]) for at in (0, -1))
    yield Paragraph(
        f"The line is {number(float(run.arc[-1]))} m long. Arc lengths count from end A at ({low}) m to end B at "
        f"({high}) m (x, y, z; z is positive upwards). {_hang_off(run)}"
    )
    if ends := " ".join([*ends_in_words(scene)]):
        yield Paragraph(ends)
    rows, begin = [], 0.0
    for segment in scene.line.segments:
        end = begin + segment.length
        rows.append([segment.line_type, number(begin), number(end), number(segment.length), _mesh(segment)])
        begin = end
    head = ("line type", "from arc length [m]", "to arc length [m]", "length [m]", "elements [m]")
    yield TableBlock("Line from end A to end B", ReportTable(head, rows))
    yield TableBlock("Properties of the line types", _properties(scene), words=2)
    contents = scene.line.contents
    if contents is not None:
        pressure = f", at a gauge pressure of {number(1e-6 * contents.pressure)} MPa" if contents.pressure else ""
        level = "" if contents.pressure_level is None else f" at z = {number(contents.pressure_level)} m"
        above = level or (" at its higher end" if pressure else "")
        flow = f", flowing at {number(contents.speed)} m/s" if contents.speed else ""
        slugs = f", with {len(contents.slugs)} kinds of slugs" if contents.slugs else ""
        yield Paragraph(f"Contents: {number(contents.density)} kg/m³{pressure}{above}{flow}{slugs}.")


def _mesh(segment: Any) -> str:
    lengths = segment.element_lengths
    least, most = min(lengths), max(lengths)
    size = number(most, 3) if most - least < 1e-6 * most else f"{number(least, 3)} to {number(most, 3)}"
    return f"{len(lengths)} of {size}"


def _properties(scene: Scene) -> ReportTable:
    types = scene.line_types
    rows = []
    for path, words, unit, scale in PROPERTIES:
        values = [_at(each, path) for each in types.values()]
        if any(value not in (None, 0.0) for value in values):
            rows.append([words, unit, *(NOTHING if v is None else number(scale * v, 5) for v in values)])
    return ReportTable(("property", "unit", *types), rows)


def _at(model: BaseModel, path: str) -> Any:
    """The value at a dotted path; None where there is no number."""
    value: Any = model
    for key in path.split("."):
        value = getattr(value, key, None)
    return value if isinstance(value, int | float) and not isinstance(value, bool) else None


def _hang_off(run: Run) -> str:
    """The hang-off asked for, and by what it was met."""
    hang_off = run.summary.get("hang_off")
    if hang_off is None:
        return ""
    angle, tension = (hang_off["asked"].get(key) for key in ("angle_deg", "tension"))
    asked = f"at {number(angle)}° from the vertical" if angle is not None else f"at {number(1e-3 * tension)} kN"
    end = "A" if hang_off["end"] == "start" else "B"
    return f"End {end} hangs off {asked} in the mean position, by a {hang_off['by']} of {number(hang_off['value'])} m."


def ends_in_words(scene: Scene) -> Iterator[str]:
    """Sentences on how the ends turn, and their bend stiffeners."""
    for name, end in (("A", scene.line.start), ("B", scene.line.end)):
        rotation, cone = getattr(end, "rotation", None), getattr(end, "bend_stiffener", None)
        if rotation == "fixed":
            yield f"End {name} cannot turn against its support."
        elif isinstance(rotation, RotationSpring):
            yield f"End {name} has a flex joint of {number(1e-3 * rotation.stiffness)} kN m/rad."
        if cone is not None:
            base, tip = (number(1e3 * diameter) for diameter in (cone.base_diameter, cone.tip_diameter))
            yield (
                f"A bend stiffener at end {name} is {number(cone.length)} m long, with a diameter of {base} mm at its "
                f"base and {tip} mm at its tip; its material has a Young's modulus of {number(1e-6 * cone.E)} MPa and "
                f"{number(cone.density)} kg/m³."
            )


def _environment(sources: Sources, scene: Scene) -> Iterator[Block]:
    water = scene.water
    if water is None:
        yield Paragraph("The line is in air.")
        return
    surface = "" if water.surface_level is None else f" The mean surface is at z = {number(water.surface_level)} m."
    yield Paragraph(f"Density of the water: {number(water.density)} kg/m³.{surface}")
    if water.current is not None:
        yield from _current(water)
    if water.marine_growth:
        rows = [[number(z), number(1e3 * thick), number(density)] for z, thick, density in water.marine_growth]
        yield TableBlock("Marine growth", ReportTable(("z [m]", "thickness [mm]", "density [kg/m³]"), rows), words=0)
    if water.waves is not None:
        yield from _waves(sources)
    if sources.fatigue is not None:
        yield from _scatter(sources.fatigue)


def _current(water: Any) -> Iterator[Block]:
    profiles = {
        "current" if each.profile is not None else f"{number(item.time)} s": np.array(profile)
        for each, item, profile in (
            (water.current, (water.current.history or [None])[n if water.current.history else 0], profile)
            for n, (_, profile) in enumerate(water.current.each)
        )
    }
    rows = [
        [name, number(z), number(ux), number(uy), number(math.hypot(ux, uy), 3)]
        for name, profile in profiles.items()
        for z, ux, uy in profile.tolist()
    ]
    head = ("profile", "z [m]", "x component [m/s]", "y component [m/s]", "speed [m/s]")
    note = "Linear between the heights, constant beyond them; components towards which the water flows."
    yield TableBlock("Current", ReportTable(head, rows, note))
    yield PictureBlock("Current by height", Curves(partial(current_sheet, profiles, water.surface_level)))


def _waves(sources: Sources) -> Iterator[Block]:
    """All different sea states of the cases."""
    rows: dict[tuple[str, ...], list[str]] = {}
    spectra: dict[str, tuple[Array, Array]] = {}
    known: dict[str, Sequence[WaveKind]] = {}
    for case in sources.cases:
        given = case.value("water.waves")
        key = str([(path, value) for path, value in flattened(given, "") if not is_seed(path)])
        if key not in known:  # a scene is read once for all seeds
            water = None if case.scene is None else case.scene.water
            known[key] = () if water is None or water.waves is None else [train for _, train in water.waves.each]
        for train in known[key]:
            rows.setdefault(tuple(_train(train)), []).extend(seeds_of(case))
            name = f"Hs {number(train.height, 3)} m, Tp {number(train.period, 3)} s"
            if isinstance(train, PeakedSea):
                gamma = train.gamma if isinstance(train, Jonswap) else 1.0
                spectra[name] = peaked_spectrum(train.Hs, train.Tp, gamma)
            elif isinstance(train, GivenSpectrum):
                w, density = np.array(train.table.frequency), np.array(train.table.density)
                spectra[name] = 0.5 * w / math.pi, 2.0 * math.pi * density
    head = ("waves", "Hs or height [m]", "Tp or period [s]", "peak factor [-]", "towards [°]", "components", "seeds")
    table = [[*row, _seeds(seeds)] for row, seeds in rows.items()]
    note = "Directions are those towards which waves travel, from x towards y."
    yield TableBlock("Sea states of the load cases", compact(ReportTable(head, table, note)))
    if spectra:
        chosen = dict([*spectra.items()][:_MOST_SPECTRA])
        yield PictureBlock("Wave spectra", Curves(partial(spectrum_sheet, chosen)))


def _seeds(seeds: Sequence[str]) -> str:
    different = [*dict.fromkeys(seed for seed in seeds if seed)]
    return ", ".join(different) if len(different) <= 6 else f"{len(different)}: {different[0]} to {different[-1]}"


def _train(train: WaveKind) -> list[str]:
    match train:
        case Jonswap():
            shape, gamma = "irregular, JONSWAP", number(train.gamma)
        case GivenSpectrum():
            shape, gamma = "irregular, spectrum of a file", NOTHING
        case Record():
            shape, gamma = "record of the surface", NOTHING
        case Airy():
            shape, gamma = "regular, linear", NOTHING
        case Regular():
            shape, gamma = "regular, of finite height", NOTHING
        case _:
            shape, gamma = "irregular, Pierson-Moskowitz", NOTHING
    height = getattr(train, "height", None)
    toward = ", ".join(number(math.degrees(angle) + 0.0) for angle in train.toward[:4])
    components = str(train.components) if isinstance(train, DrawnSea) else ""
    if isinstance(train, DrawnSea) and train.spreading is not None:
        shape += f", spread with s = {number(train.spreading.s)}"
    return [shape, number(height), number(train.period), gamma, toward, components]


def _scatter(fatigue: Mapping[str, Any]) -> Iterator[Block]:
    """Sea states of the fatigue assessment with their shares of the year."""
    rows = []
    for case in fatigue["cases"]:
        sea = case.get("sea") or {}
        share = number(100.0 * case["share"], 4)
        values = [number(sea.get(key), 4) for key in ("height", "period", "direction_deg")]
        rows.append([case["run"], *values, share, number(case["seconds"], 4)])
    head = ("sea state", "Hs [m]", "Tp [s]", "towards [°]", "share of the year [%]", "simulated [s]")
    yield TableBlock("Scatter of sea states for fatigue", compact(ReportTable(head, rows)), key="scatter")


def _vessel(scene: Scene, case: LoadCase) -> Iterator[Block]:
    given = [*_vessels(scene)]
    offset = case.run.summary.get("vessel")
    if not given and offset is None:
        if motions := [*_motions(scene)]:
            yield Paragraph(" ".join(motions))
        return
    for end, way in given:
        x, y, z = (number(value, 5) for value in way.reference)
        yield Paragraph(
            f"End {'A' if end == 'start' else 'B'} is part of a vessel with the heading {number(way.heading_deg)}° "
            f"from x towards y; its motions belong to the point ({x}, {y}, {z}) m."
        )
        if isinstance(way, Vessel):
            yield from _raos(way, scene)
        else:
            yield Paragraph(f"The vessel's motions in time are those of the file {way.file.name}.")
    if offset is not None:
        yield Paragraph("Offsets of the vessel are those of the load cases below; hang-offs are found without offset.")


def _vessels(scene: Scene) -> Iterator[tuple[str, Vessel | VesselHistory]]:
    seen = set[tuple[str, str]]()
    for stage in scene.stages:
        motion = getattr(stage, "motion", None)
        for end, each in {} if motion is None else motion.by_end.items():
            for key, way in each.ways.items():
                if isinstance(way, Vessel | VesselHistory) and (end, key) not in seen:
                    seen.add((end, key))
                    yield end, way


def _motions(scene: Scene) -> Iterator[str]:
    for stage in scene.stages:
        motion = getattr(stage, "motion", None)
        for end, each in {} if motion is None else motion.by_end.items():
            words = " and ".join(_motion_words(key, way) for key, way in each.ways.items())
            yield f"In the load step {stage.name}, end {'A' if end == 'start' else 'B'} moves: {words}."


def _motion_words(key: str, way: Any) -> str:
    if key == "harmonic":
        size = ", ".join(number(value) for value in way.amplitude)
        return f"harmonically by the amplitudes ({size}) m at a period of {number(way.period)} s"
    if key in ("arc", "rotation"):
        turned = "on an arc" if key == "arc" else "in rotation"
        return f"{turned}, harmonically by {number(way.amplitude_deg)}° at a period of {number(way.period)} s"
    return f"by the table {way.file.name}"


def _raos(way: Vessel, scene: Scene) -> Iterator[Block]:
    table: Rao = way.table
    waves = None if scene.water is None else scene.water.waves
    toward = (0.0,) if waves is None else waves.toward
    relative = [(angle - math.radians(way.heading_deg)) % (2.0 * math.pi) for angle in toward]
    chosen = list(dict.fromkeys(n for angle in relative for n in table.around(angle)))
    response = {mode: np.array(values) for mode, values in table.response.items()}
    modes = [mode for mode in response if any(np.abs(response[mode][n]).max() > 1e-9 for n in chosen)]
    if not modes:
        return
    step = max(1, len(table.frequency) // _FEW_PERIODS)
    rows = []
    for n in chosen[:2]:
        for at in range(0, len(table.frequency), step):
            period = number(2.0 * math.pi / table.frequency[at], 4)
            values = [_amplitude(mode, response[mode][n][at]) for mode in modes]
            rows.append([f"{math.degrees(table.direction[n]):.4g}", period, *values])
    rows.sort(key=lambda row: (float(row[0]), float(row[1])))
    units = {mode: "°/m" if mode in ("roll", "pitch", "yaw") else "m/m" for mode in modes}
    head = ("waves from the heading [°]", "period [s]", *(f"{mode} [{unit}]" for mode, unit in units.items()))
    note = f"Amplitudes of {way.rao.name}; all of its {len(table.frequency)} periods are used."
    yield TableBlock("Response amplitude operators (RAOs) of the vessel", ReportTable(head, rows, note), words=0)
    shown = {mode: response[mode] for mode in modes}
    yield PictureBlock(
        "RAOs of the vessel: amplitudes by period",
        Curves(partial(rao_sheet, table.frequency, table.direction, shown, chosen)),
    )


def _amplitude(mode: str, value: complex) -> str:
    size = abs(value) * (math.degrees(1.0) if mode in ("roll", "pitch", "yaw") else 1.0)
    return f"{size:.3f}"


def _ground(scene: Scene) -> Iterator[Block]:
    rows: list[list[str]] = []
    if scene.seabed is not None:
        kind = {"spring": "linear springs", "hysteretic": "hysteretic clay", "rigid": "rigid"}[scene.seabed.kind]
        rows.append(["seabed", kind, ""])
        rows += input_rows(scene.seabed, skip=("kind", "contact_at"))
    if scene.soil is not None:
        rows.append(["soil", "finite elements in a block" if scene.soil.model == "block" else "sections across", ""])
        rows += input_rows(scene.soil, only=("law", "layers", "submerged_unit_weight", "K0"))
    if not rows:
        yield Paragraph("There is no ground.")
        return
    yield TableBlock("Ground", ReportTable(("quantity", "value", "unit"), rows))
    if scene.contact is not None and scene.contact.friction is not None:
        yield from _friction(scene)


def _friction(scene: Scene) -> Iterator[Block]:
    assert scene.contact is not None
    rows = input_rows(scene.contact, skip=("method", "stiffness", "smoothing"))
    yield TableBlock("Friction and suction", ReportTable(("quantity", "value", "unit"), rows))


def _load_cases(sources: Sources, scene: Scene) -> Iterator[Block]:
    if len(sources.cases) > 1 or sources.failed:
        axes = list(dict.fromkeys(name for case in sources.cases for name in case.axes))
        rows = [[case.name, *(_axis_value(case, name) for name in axes)] for case in sources.cases[:MOST_CASES]]
        head = ("load case", *(words_of_path(name) if "." in name else name for name in axes))
        more = len(sources.cases) - len(rows)
        note = f"{more} more cases are in the tables of the cases' folder." if more > 0 else ""
        yield TableBlock("Load cases", ReportTable(head, rows, note), words=1 + len(axes), key="cases")
    if sources.failed:
        lost = "; ".join(f"{name}: {without_paths(why)}" for name, why in [*sources.failed.items()][:20])
        yield Paragraph(f"Not computed, and in none of the results: {lost}.", "warning")
    rows = [[stage.name, stage.kind, _lasts(stage), *_does(stage)] for stage in scene.stages]
    head = ("load step", "kind", "duration [s]", "time step [s]", "what happens")
    yield TableBlock("Load steps", compact(ReportTable(head, rows)), words=2)
    yield Paragraph(
        "Waves and motions of the vessel act in dynamic load steps; static ones have weight, current and ground."
    )


def _axis_value(case: LoadCase, axis: str) -> str:
    """The case's value on an axis; where the axis is a path, and the case has none, that of its scene."""
    if axis in case.axes:
        return given_value(case.axes[axis])
    return given_value(case.value(axis)) if "." in axis else NOTHING


def _lasts(stage: Stage) -> str:
    return NOTHING if stage.kind == "static" else number(stage.duration)


def _does(stage: Stage) -> list[str]:
    given = stage.time_step if isinstance(stage, DynamicStage) else None
    step = number(given) if isinstance(given, float) else NOTHING
    done = []
    if getattr(stage, "move", None) is not None:
        done.append("ends are moved")
    if stage.loads:
        done.append("loads")
    motion = getattr(stage, "motion", None)
    if motion is not None:
        ends = ["A" if end == "start" else "B" for end in motion.by_end]
        done.append(f"end {' and end '.join(ends)} moves")
    return [step, ", ".join(done)]
