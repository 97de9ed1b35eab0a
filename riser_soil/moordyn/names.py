"""Everything in a deck by all names that MoorDyn gives it: sections, columns, kinds of attachment, options.

From the readers of MoorDyn v1, of MoorDyn v2 in C++ (MoorDyn2.cpp) and in Fortran (MoorDyn.f90 of OpenFAST). Capitals
count nowhere. Headings count by their letters and digits alone: `BA/-zeta` is `bazeta`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Section:
    """A section with a table.

    headers: words, one of which is part of its header. columns: headings by the column's name; a heading that several
    columns share stands for each of them in turn, as `y0` for Y0 and for the angle y0. optional: columns that a table
    may lack. orders: of the columns in MoorDyn's versions, the newest first.
    """

    headers: tuple[str, ...]
    columns: dict[str, tuple[str, ...]]
    optional: tuple[str, ...]
    orders: tuple[tuple[str, ...], ...]


def _orders(*rows: str) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(row.split()) for row in rows)


_ID = ("id", "number", "num", "no", "")  # "#" has neither letters nor digits
_DIAM = ("diam", "diameter", "d", "od")
_MASS_PER_LENGTH = (
    "massm", "massden", "massdenair", "massdeninair", "massdensity", "massperm", "massperlength", "mass", "m", "mlin",
)  # fmt: skip
_X, _Y, _Z = ("x", "x0", "xref", "xpos"), ("y", "y0", "yref", "ypos"), ("z", "z0", "zref", "zpos")
_MASS, _VOLUME = ("mass", "m"), ("volume", "vol", "v", "disp", "displacement")
_OUTPUTS = ("outputs", "output", "outs", "flagsoutputs", "lineoutputs", "rodoutputs", "flags", "outputflags")
_SEGMENTS = ("numsegs", "numseg", "nsegs", "nseg", "segments", "segs", "n", "numelems", "nelems")
_KIND = ("attachment", "attach", "attachmenttype", "type", "connection", "kind", "attachid")

SECTIONS = {
    "line types": Section(
        ("LINE DICTIONARY", "LINE TYPES"),
        {
            "Name": ("name", "typename", "linetype", "linetypename", "type"),
            "Diam": _DIAM,
            "Mass/m": _MASS_PER_LENGTH,
            "EA": ("ea", "axialstiffness"),
            "BA/-zeta": ("bazeta", "ba", "zeta", "cintdamp", "cint", "intdamp", "damping", "c", "bint"),
            "EI": ("ei", "bendingstiffness"),
            "Cd": ("cd", "cdn", "cdnormal", "cdtr", "cdtransverse"),
            "Ca": ("ca", "can", "canormal", "catr", "catransverse"),
            "CdAx": ("cdax", "cdt", "cdaxial", "cdtangential"),
            "CaAx": ("caax", "cat", "caaxial", "catangential"),
            "Cl": ("cl", "clift"),
            "dF": ("df",),
            "cF": ("cf",),
        },
        ("BA/-zeta", "EI", "Cl", "dF", "cF"),
        _orders("Name Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx Cl dF cF",
                "Name Diam Mass/m EA BA/-zeta Ca CaAx Cd CdAx"),
    ),
    "rod types": Section(
        ("ROD DICTIONARY", "ROD TYPES"),
        {
            "Name": ("name", "typename", "rodtype", "rodtypename", "type"),
            "Diam": _DIAM,
            "Mass/m": _MASS_PER_LENGTH,
            "Cd": ("cd", "cdn", "cdnormal"),
            "Ca": ("ca", "can", "canormal"),
            "CdEnd": ("cdend", "cdax", "cdt"),
            "CaEnd": ("caend", "caax", "cat"),
        },
        ("CdEnd", "CaEnd"),
        _orders("Name Diam Mass/m Cd Ca CdEnd CaEnd"),
    ),
    "bodies": Section(
        ("BODIES", "BODY LIST", "BODY PROPERTIES"),
        {
            "ID": (*_ID, "body", "bodyid", "name"),
            "Attachment": _KIND,
            "X0": _X, "Y0": _Y, "Z0": _Z,
            "r0": ("r0", "roll", "roll0", "rx", "r"),
            "p0": ("p0", "pitch", "pitch0", "ry", "p"),
            "y0": ("y0", "yaw", "yaw0", "rz", "y"),
            "Mass": _MASS,
            "CG": ("cg", "rcg", "cgz", "zcg"),
            "I": ("i", "inertia", "moi"),
            "Volume": _VOLUME,
            "CdA": ("cda", "dragarea"),
            "Ca": ("ca",),
        },
        (),
        _orders("ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG I Volume CdA Ca"),
    ),
    "rods": Section(
        ("RODS", "ROD LIST", "ROD PROPERTIES"),
        {
            "ID": (*_ID, "rod", "rodid", "rodnum"),
            "RodType": ("rodtype", "type", "typename", "name", "rodname"),
            "Attachment": _KIND,
            "Xa": ("xa", "xenda"), "Ya": ("ya", "yenda"), "Za": ("za", "zenda"),
            "Xb": ("xb", "xendb"), "Yb": ("yb", "yendb"), "Zb": ("zb", "zendb"),
            "NumSegs": _SEGMENTS,
            "Outputs": _OUTPUTS,
        },
        ("Outputs",),
        _orders("ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs Outputs"),
    ),
    "points": Section(
        ("POINTS", "POINT LIST", "POINT PROPERTIES", "CONNECTION PROPERTIES", "NODE PROPERTIES"),
        {
            "ID": (*_ID, "point", "pointid", "node", "nodeid", "connection", "connect", "name"),
            "Attachment": _KIND,
            "X": _X, "Y": _Y, "Z": _Z,
            "Mass": _MASS,
            "Volume": _VOLUME,
            "FX": ("fx",), "FY": ("fy",), "FZ": ("fz",),
            "CdA": ("cda", "dragarea"),
            "Ca": ("ca",),
        },
        ("FX", "FY", "FZ"),
        _orders("ID Attachment X Y Z Mass Volume CdA Ca",
                "ID Attachment X Y Z Mass Volume FX FY FZ CdA Ca"),
    ),
    "lines": Section(
        ("LINES", "LINE LIST", "LINE PROPERTIES"),
        {
            "ID": (*_ID, "line", "lineid", "lineno", "name"),
            "LineType": ("linetype", "type", "typename", "name", "linetypename"),
            "AttachA": ("attacha", "a", "enda", "nodea", "pointa", "nodeanch", "anchor", "anch", "nodeanchor",
                        "attachida", "attachmenta", "ida", "attachment", "attach", "attachid", "node"),
            "AttachB": ("attachb", "b", "endb", "nodeb", "pointb", "nodefair", "fairlead", "fair", "nodefairlead",
                        "attachidb", "attachmentb", "idb", "attachment", "attach", "attachid", "node"),
            "UnstrLen": ("unstrlen", "unstrlength", "unstretchedlength", "unstretched", "length", "len", "l"),
            "NumSegs": _SEGMENTS,
            "Outputs": _OUTPUTS,
        },
        ("Outputs",),
        _orders("ID LineType AttachA AttachB UnstrLen NumSegs Outputs",
                "ID LineType UnstrLen NumSegs AttachA AttachB Outputs"),
    ),
    "external loads": Section(
        ("EXTERNAL LOADS",),
        {
            "ID": (*_ID, "load", "loadid"),
            "Object": ("object", "name", "target"),
            "Fext": ("fext", "force", "f"),
            "Blin": ("blin",),
            "Bquad": ("bquad",),
            "CSys": ("csys", "system"),
        },
        ("CSys",),
        _orders("ID Object Fext Blin Bquad CSys"),
    ),
}  # fmt: skip
"""In the order in which MoorDyn-F compares a header with them."""

NUMBERED = ("bodies", "rods", "points", "lines")
"""Sections whose entries have an ID each."""

ROWS = {"failure": ("FAILURE",), "control": ("CONTROL",), "syrope": ("SYROPE IC",)}
"""Sections with headings whose rows are not carried over, and of what their headers have a part."""

LISTS = {"options": ("OPTIONS",), "outputs": ("OUTPUT",)}
"""Sections without headings."""

KNOWN = (*SECTIONS, *LISTS)
"""Sections that are read; rows of all others are listed as left out."""

FREE, FIXED, COUPLED, PINNED, COUPLED_PINNED = "free", "fixed", "coupled", "pinned", "coupled pinned"
BODY, TURBINE = "body", "turbine"  # by a number

_FIXED, _COUPLED = ("FIXED", "FIX", "ANCHOR"), ("COUPLED", "CPLD", "VESSEL", "VES")
_TURBINE = ("TURBINE", "T")
_COUPLED_PINNED = ("COUPLEDPINNED", "CPLDPIN", "VESSELPINNED", "VESPIN")
KINDS = {
    "points": {
        FIXED: _FIXED, COUPLED: (*_COUPLED, "FAIRLEAD"), FREE: ("FREE", "POINT", "P", "CONNECT", "CON"),
        BODY: ("BODY",), TURBINE: _TURBINE,
    },
    "bodies": {
        FIXED: _FIXED, COUPLED: _COUPLED, COUPLED_PINNED: _COUPLED_PINNED, FREE: ("FREE",), TURBINE: _TURBINE,
    },
    "rods": {
        FIXED: _FIXED, PINNED: ("PINNED", "PIN"), COUPLED: _COUPLED, COUPLED_PINNED: _COUPLED_PINNED,
        FREE: ("FREE", "POINT", "P", "CON"), BODY: ("BODY",), TURBINE: _TURBINE,
    },
}  # fmt: skip
"""Kinds of attachment by their words, before a number if they have one."""

ENDS = {"points": ("", "P", "POINT", "C", "CON"), "rods": ("R", "ROD"), "bodies": ("BODY", "B")}
"""Words before the number of what a line ends at, or a load acts on."""

ON_THE_SEABED = ("SEABED", "GROUND", "FLOOR")
"""Words in the place of a point's z."""

DEFAULTS = {
    "g": 9.80665, "rho": 1025.0, "WtrDpth": 0.0, "kBot": 3.0e6,
    "FrictionCoefficient": 0.0, "mu_kA": 0.0, "mu_kT": 0.0,
}  # fmt: skip
"""Options that a scene has, and MoorDyn's values where a deck lacks them."""

ALIASES = {
    "g": ("g", "gravity"),
    "rho": ("rho", "rhow", "wtrdnsty"),
    "WtrDpth": ("wtrdpth", "depth", "waterdepth"),
    "kBot": ("kbot", "kb"),
    "FrictionCoefficient": ("frictioncoefficient",),
    "mu_kA": ("mu_ka",),
    "mu_kT": ("mu_kt",),
}

HARMLESS = (
    "dtm", "dt", "cfl", "tscheme", "dtic", "icdt", "tmaxic", "ictmax", "cdscaleic", "icdfac", "threshic", "icthresh",
    "gendynamicic", "icgendynamic", "writelog", "writeunits", "dtout", "outswitch", "disableoutput", "disableouttime",
)  # fmt: skip
"""Options that can't change an answer: time steps, the way to rest, output. No others pass without a remark."""

LOST = {
    ("cbot", "cb"): (0.0, "the seabed's damping, which slows what moves on it"),
    ("wavekin",): (0.0, "waves from files; give water.waves"),
    ("waterkin",): (0.0, "waves and currents from a file; give water.waves and water.current"),
    ("currents",): (0.0, "currents from files; give water.current"),
    ("dtwave",): (None, "the time step of waves from files"),
    ("unifycurrentgrid",): (None, "how waves and currents from files are added"),
    ("fricdamp", "cv"): (0.0, "friction's damping; it is elastic below its limit here"),
    ("statdynfricscale", "mc"): (1.0, "static friction over dynamic friction; the two are equal here"),
    ("seafloorfile",): (None, "the seabed's shape; it is level here"),
    ("fileic", "icfile"): (None, "a state from a file to begin with; a scene finds its rest"),
    ("inertialf",): (0.0, "inertia in the forces that a coupled program gets"),
    ("inertialf_rampt",): (0.0, "the time in which inertia comes into the forces that a coupled program gets"),
}
"""Options that a scene lacks: the value that is without effect, and what they do."""


def plain(heading: str) -> str:
    """A heading's letters and digits, in lower case."""
    return re.sub(r"[^a-z0-9]", "", heading.lower())


def option_of(word: str) -> str | None:
    """The option that a scene has by this name; None where it has none."""
    return next((name for name, words in ALIASES.items() if word.lower() in words), None)


def lost_option(word: str) -> tuple[float | None, str] | None:
    """What an option that a scene lacks does, with its value without effect; None where it is none of them."""
    return next((reason for words, reason in LOST.items() if word.lower() in words), None)


def split(word: str) -> tuple[str, str, str]:
    """A word's letters, number and letters, in capitals: Body1Pinned gives BODY, 1, PINNED; R2a gives R, 2, A."""
    match = re.match(r"([A-Z]*)(\d*)([A-Z]*)", re.sub(r"[^A-Z0-9]", "", word.upper()))
    assert match is not None, "all its parts may be empty"
    return match.group(1), match.group(2), match.group(3)
