"""What of a data file no scene has: everything that nothing asked for, unless it can't change an answer."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

from riser_soil.imported_scene import Remark
from riser_soil.orcaflex.data_file import DataFile, folded, name_of
from riser_soil.scene.problem import Path

# Values, in lower case, by which OrcaFlex says that there is nothing of the kind.
_NOTHING = (None, "", 0, "no", "none", "(none)", "(no damping)")
# Names of data, in lower case, that can't change an answer, whatever their values are.
_WITHOUT_EFFECT = re.compile(
    # names, pictures, views
    r"name|notes|comments?|tags|.*(?<!o)pen|.*colou?r|draw.*|.*drawing.*|shaded.*|default.*|selected.*|north.*|view.*"
    # logs, warnings, restarts, results that are asked for
    r"|log.*|targetlog.*|.*warn.*|restart.*|timehistoryimport.*|results.*|outputs?.*"
    # how OrcaFlex solves
    r"|jacobian.*|implicit.*|explicit.*|innertimestep|outertimestep|numericaldamping.*"
    r"|statics(step[12]|min|max|damping|tol).*|linestaticsstep[12]policy|wholesystemstatics.*|buoysincludedinstatics"
    r"|wavecalculation(time|spatial)interval"
    # the end from which lines are described; the wind beside its speed; water where no drag goes by Reynolds's number
    r"|topend|wind(type|ramping|direction|timeorigin)|include.*windloads|air.*|verticalwind.*|kinematicviscosity"
    r"|seatemperature|reynoldsnumbercalculation"
    # a level seabed's origin and direction, what OrcaFlex checks of stresses
    r"|seabedorigin|seabedslopedirection|apirp.*|dnv.*|pd8010.*|asme.*|allowablestress|stressod|stressid"
    # loads of vessels, which move by their RAOs alone
    r"|include(wave|sumfrequency|addedmass|manoeuvring|other|current|applied).*|calculat.*|imposedmotion.*"
)
# Values, in lower case, that say what a scene has in any case.
_ALIKE: dict[str, tuple[Any, ...]] = {
    "dynamicssolutionmethod": ("implicit time domain", "explicit time domain", None),
    "representation": ("finite element",), "lengthandendorientations": ("explicit",),
    "prebendspecifiedby": ("curvature", "bend angle"), "dragformulation": ("standard",),
    "seabedmodel": ("elastic", "linear"), "wavekinematicscutoffdepth": ("infinity", None),
    "wavecalculationmethod": ("instantaneous position (exact)", "specified by environment", None),
    "bulkmodulus": ("infinity", None), "includedinstatics": ("yes", "none", None),
    "includeaxialcontentsinertia": ("yes", None), "connection": ("free",), "verticaldensityvariation": ("constant",),
    "connectionshortestviablesegmentfactor": (0.001, None), "connectionapplyramp": ("yes", None),
    "connectionusesmoothgrowth": ("yes", None), "simulationtimeorigin": (0, None),
    "tensilestressloadingfactor": (1,), "bendingstressloadingfactor": (1,), "shearstressloadingfactor": (1,),
    "torsionalstressloadingfactor": (1,), "userspecifiedrandomwaveseeds": ("yes", "no"),
    "multiplecurrentdatacanbedefined": ("no",), "currentmodel": ("variation scheme",),
}  # fmt: skip
# Sections of which nothing matters but what was asked for: RAOs tell all of a vessel's motion.
_ASKED_ALONE = (
    "vesseltypes", "variabledata", "groups", "rayleighdampingcoefficients", "solidfrictioncoefficients", "clumptypes",
    "codechecks",
)  # fmt: skip
# What values would have done, by the names of their sections or data in lower case, the first that fits.
_EFFECTS = (
    (r"6dbuoys|3dbuoys", "a buoy, its mass, buoyancy and drag"), (r"winches", "the pull of a winch"),
    (r"links", "the force of a tether or spring"), (r"shapes|solids", "contact, or water that is kept out"),
    (r"vesseltype|draught|(primary|superimposed)motion", "how the vessel moves, which rests here without waves"),
    (r"constraints", "what holds or moves other objects"), (r"turbines", "the loads of a turbine"),
    (r"vessels", "another vessel"), (r"supporttypes|supports", "contact with supports"),
    (r"windspeed", "wind on what is above the water"), (r"layazimuth", "the direction of laying, along the line here"),
    (r"aslaidtension", "the tension of laying"), (r"staticsseabedfrictionpolicy", "friction from laying the line"),
    (r"rayleighdamping.*", "structural damping: give `damping: {ratio, frequency}`"),
    (r"connectiontwistingstiffness", "what keeps an end from spinning"),
    (r"connection", "what it is connected to"), (r"dynamicssolutionmethod", "another kind of solution"),
    (r"connectionreleasestage", "an end let go in that stage"), (r"connectionpayoutrate", "line paid out"),
    (r"contentsflowrate", "a flow: give `contents.speed`"), (r"(statics|dynamics)viv", "vibration by vortices"),
    (r"seabeddamping", "damping by the seabed"), (r"cm", "inertia of the fluid other than 1 + Ca"),
    (r"prebend.*", "a line bent without stress"), (r"pymodel", "lateral resistance of the soil on piles"),
    (r"startattime|starttime|firststage|ramp.*", "another clock"), (r"currentramped", "a current that grows"),
    (r"includedinstatics", "whether statics move it"), (r"nominaldepth", "another depth for the waves"),
    (r"wave.*", "another sea"), (r"(horizontal|vertical).*factor", "a variation in space"),
    (r"tensiontorquecoupling", "torque by tension"), (r"centreofmass|cg", "weight beside the axis"),
)  # fmt: skip
_UNKNOWN = "not known here, whatever it would have done"


def left_out(file: DataFile) -> list[Remark]:
    """All remarks on a file, by line: what was told when it was read, and what nothing asked for."""
    return sorted({*file.remarks, *_unread(file)})


def _unread(file: DataFile) -> Iterator[Remark]:
    for section, content in file.document.data.items():
        if folded(section) not in _ASKED_ALONE:
            yield from _of(file, (section,), section, content)


def _of(file: DataFile, place: Path, name: str, value: Any) -> Iterator[Remark]:
    """Remarks on a value and those within it; of an object of which nothing was asked for, one."""
    if place in file.read or _says_nothing(name.rpartition(": ")[2], value):
        return
    within = [*_within(name, place, value)] if _asked(file, place) or len(place) == 1 else []
    if within:
        for each in within:
            yield from _of(file, *each)
    elif len(place) != 2 or folded(place[0]) != "linetypes":
        effect = _effect(name.rpartition(": ")[2])
        yield file.document.where(place)[0], f"{name}{'' if isinstance(value, dict) else _shown(value)}: {effect}"


def _within(name: str, place: Path, value: Any) -> Iterator[tuple[Path, str, Any]]:
    """Places, names and values within a value; columns by their own names."""
    if isinstance(value, dict):
        yield from (((*place, key), f"{name}: {key}", each) for key, each in value.items())
    elif isinstance(value, list):
        *front, last = name.split(": ")
        for n, (column, each) in enumerate(zip(_columns(last, value), value, strict=False)):
            own = f"{column} {name_of(each)}" if isinstance(each, dict) and name_of(each) else column
            yield (*place, n), ": ".join([*front, own]), each


def _columns(key: str, values: list[Any]) -> list[str]:
    """Names of a list's values: of a table's row its columns, else the list's own."""
    names = [" ".join(name.split()) for name in key.split(",")]
    return names if len(names) > 1 and not isinstance(values[0], list) else [key] * len(values)


def _asked(file: DataFile, place: Path) -> bool:
    return any(read[: len(place)] == place for read in file.read)


def _says_nothing(key: str, value: Any) -> bool:
    if isinstance(value, dict):
        return all(_says_nothing(name, each) for name, each in value.items())
    name = folded(key)
    if _WITHOUT_EFFECT.fullmatch(name):
        return True
    if isinstance(value, list):
        return not value or all(_says_nothing(*each) for each in zip(_columns(key, value), value, strict=False))
    plain = folded(value) if isinstance(value, str) else value
    return plain in _ALIKE.get(name, _NOTHING)


def _effect(key: str) -> str:
    words = (folded(key), folded(key).partition(" ")[0])
    return next((text for word in words for names, text in _EFFECTS if re.fullmatch(names, word)), _UNKNOWN)


def _shown(value: Any) -> str:
    text = " ".join(str(value).split())
    return f" {text}" if len(text) <= 40 else f" {text[:37]}..."
