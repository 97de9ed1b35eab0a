"""A good scene, and changes of it that are wrong: where the message points and what it says."""

from __future__ import annotations

from dataclasses import dataclass

GOOD = """\
title: base
gravity: 9.81
water: {density: 1025.0}
line_types:
  pipe:
    outer_diameter: 0.3
    inner_diameter: 0.2
    mass: 120.0
    EA: 3.0e8
    EI: 5.0e4
    GJ: 4.0e4
    drag: {normal: 1.1, tangential: 0.05}
riser:
  contents: {density: 850.0}
  segments:
    - {line_type: pipe, length: 148.0, elements: 74}
  start: {position: [0.0, 0.0, 0.15], rotation: free}
  end: {position: [80.0, 0.0, 100.0], rotation: free}
  initial: catenary
seabed: {kind: spring, level: 0.0, stiffness: 1.0e5}
soil:
  block: {x: [10.0, 50.0], y: [-2.5, 2.5], depth: 2.5}
  mesh: {kind: hex, size_at_riser: 0.5, size_far: 1.5}
  law: {kind: von-mises, su: 4.0e3, su_gradient: 1.5e3, E_over_su: 300.0, nu: 0.49}
  submerged_unit_weight: 5.0e3
contact: {method: node, stiffness: auto, smoothing: 1.0e-3}
stages:
  - {name: lay, kind: static}
  - name: heave
    kind: dynamic
    duration: 15.0
    time_step: 0.1
    motion:
      end: {harmonic: {amplitude: [0.0, 0.0, 1.5], period: 10.0, ramp: 5.0}}
solver: {max_iterations: 20}
output: {interval: 0.1}
"""


@dataclass(frozen=True)
class Bad:
    """A change of the good scene and the parts of the message that it must cause."""

    old: str
    new: str
    line: int
    path: str
    value: str
    says: str
    lines: int = 1


KEYS = [
    Bad("length: 148.0", "lenght: 148.0", 16, "riser.segments.0.lenght", "148.0", 'did you mean "length"?'),
    Bad("gravity: 9.81", "gravitiy: 9.81", 2, "gravitiy", "9.81", 'did you mean "gravity"?'),
    Bad("    EA:", "    ea:", 9, "line_types.pipe.ea", "300000000.0", 'did you mean "EA"?'),
    Bad("period:", "perod:", 34, "stages.1.motion.end.harmonic.perod", "10.0", 'did you mean "period"?'),
    Bad("su: 4.0e3", "sus: 4.0e3", 24, "soil.law.sus", "4000.0", 'did you mean "su"?'),
    Bad("solver:", "slover:", 35, "slover", '{"max_iterations": 20}', 'did you mean "solver"?'),
    Bad("time_step: 0.1", "timestep: 0.1", 32, "stages.1.timestep", "0.1", 'did you mean "time_step"?'),
    Bad("{interval: 0.1}", "{intervall: 0.1}", 36, "output.intervall", "0.1", 'did you mean "interval"?'),
    Bad("smoothing:", "colour:", 26, "contact.colour", "0.001", "known are method, stiffness, smoothing"),
]

VALUES = [
    Bad(
        "max_iterations: 20",
        "petsc_options: {riser_soil_snes_monitor: true}",
        35,
        "solver.petsc_options",
        '{"riser_soil_snes_monitor": true}',
        "without its dash and the prefix riser_soil_; write it as snes_monitor",
    ),
    Bad(
        "max_iterations: 20",
        "petsc_options: {snes_rtol: [1]}",
        35,
        "solver.petsc_options",
        '{"snes_rtol": [1]}',
        "the value of snes_rtol is neither a number nor a word",
    ),
    Bad("gravity: 9.81", "gravity: down", 2, "gravity", '"down"', "must be a number"),
    Bad("gravity: 9.81", "gravity:", 2, "gravity", "null", "must be a number"),
    Bad("gravity: 9.81", "gravity: -9.81", 2, "gravity", "-9.81", "must be at least 0"),
    Bad("gravity: 9.81", "gravity: .nan", 2, "gravity", "NaN", "must be a finite number"),
    Bad("gravity: 9.81", "gravity: .inf", 2, "gravity", "Infinity", "must be a finite number"),
    Bad("gravity: 9.81", "gravity: true", 2, "gravity", "true", "must be a number"),
    Bad("gravity: 9.81", "gravity: 9.81\ndimension: 4", 3, "dimension", "4", "must be one of auto, 2, 3"),
    Bad("title: base", "title: [1]", 1, "title", "[1]", "must be a text"),
    Bad("length: 148.0", 'length: "148 m"', 16, "riser.segments.0.length", '"148 m"', "without a unit"),
    Bad("length: 148.0", "length: 0", 16, "riser.segments.0.length", "0", "must be greater than 0"),
    Bad("elements: 74", "elements: 7.5", 16, "riser.segments.0.elements", "7.5", "must be a whole number"),
    Bad(
        "elements: 74", "element_length: fine", 16, "riser.segments.0.element_length", '"fine"', "must be a number"
    ),
    Bad(
        "elements: 74",
        "element_length: [1, 2, 3]",
        16,
        "riser.segments.0.element_length",
        "[1, 2, 3]",
        "a list of 2 values",
    ),
    Bad(
        "elements: 74",
        "element_length: [0.5, 0]",
        16,
        "riser.segments.0.element_length.1",
        "0",
        "must be greater than 0",
    ),
    Bad("elements: 74", "elements: 0", 16, "riser.segments.0.elements", "0", "must be at least 1"),
    Bad("    EA:", "    damping: 0.1\n    EA:", 9, "line_types.pipe.damping", "0.1", "with the keys ratio, frequency"),
    Bad(
        "    EA:",
        "    damping: {ratio: 1.5, frequency: 1.0}\n    EA:",
        9,
        "line_types.pipe.damping.ratio",
        "1.5",
        "must be less than 1",
    ),
    Bad(
        "    EA:",
        "    damping: {ratio: 0.02}\n    EA:",
        9,
        "line_types.pipe.damping.frequency",
        "missing",
        "the key is required here",
    ),
    Bad("    EA:", "    min_bend_radius: 0\n    EA:", 9, "line_types.pipe.min_bend_radius", "0", "greater than 0"),
    Bad("    EA:", "    rotary_inertia: -2\n    EA:", 9, "line_types.pipe.rotary_inertia", "-2", "must be at least 0"),
    Bad(
        "    EA:",
        "    rotary_inertia: yes please\n    EA:",
        9,
        "line_types.pipe.rotary_inertia",
        '"yes please"',
        "must be a number or one of true, false",
    ),
    Bad("mass: 120.0", "mass: 12o.0", 8, "line_types.pipe.mass", '"12o.0"', "mass per length"),
    Bad(
        "inner_diameter: 0.2",
        "inner_diameter: 0.4",
        7,
        "line_types.pipe.inner_diameter",
        "0.4",
        "smaller than",
    ),
    Bad("{density: 1025.0}", "1025.0", 3, "water", "1025.0", "must be a mapping with the keys density"),
    Bad("{density: 1025.0}", "{density: 0}", 3, "water.density", "0", "must be greater than 0"),
    Bad("[0.0, 0.0, 0.15]", "[0.0, 0.15]", 17, "riser.start.position", "[0.0, 0.15]", "a list of 3 values"),
    Bad("[0.0, 0.0, 0.15]", "[0, 0, 0, 1]", 17, "riser.start.position", "[0, 0, 0, 1]", "a list of 3 values"),
    Bad("[0.0, 0.0, 0.15]", "0.15", 17, "riser.start.position", "0.15", "must be a list of 3 values"),
    Bad("[0.0, 0.0, 0.15]", "[0, 0, x]", 17, "riser.start.position.2", '"x"', "must be a number"),
    Bad("rotation: free}\n  end", "rotation: fre}\n  end", 17, "riser.start.rotation", '"fre"', '"free"'),
    Bad("initial: catenary", "initial: catinary", 19, "riser.initial", '"catinary"', '"catenary"'),
    Bad("initial: catenary", "initial: 3", 19, "riser.initial", "3", "straight, catenary, unstressed or"),
    Bad("kind: spring", "kind: springs", 20, "seabed.kind", '"springs"', 'did you mean "spring"?'),
    Bad("kind: spring, ", "", 20, "seabed.kind", "missing", "must be one of rigid, spring"),
    Bad("kind: hex", "kind: hexa", 23, "soil.mesh.kind", '"hexa"', 'did you mean "hex"?'),
    Bad(
        "size_far: 1.5", "size_far: 0.1", 23, "soil.mesh.size_far", "0.1", "must not be smaller than size_at"
    ),
    Bad(
        "{kind: hex, size_at_riser: 0.5",
        "{kind: tet, size_at_riser: {along: 0.5, across: 0.1}",
        23,
        "soil.mesh.size_at_riser",
        '{"along"',
        "tetrahedra have one size",
    ),
    Bad("riser: 0.5", "riser: {along: 0.5}", 23, "soil.mesh.size_at_riser.across", "missing", "required"),
    Bad("size_at_riser: 0.5", "size_at_riser: fine", 23, "soil.mesh.size_at_riser", '"fine"', "must be a number"),
    Bad(
        "x: [10.0, 50.0]",
        "x: [50.0, 10.0]",
        22,
        "soil.block.x",
        "[50.0, 10.0]",
        "first bound must be smaller",
    ),
    Bad("nu: 0.49", "nu: 0.5", 24, "soil.law.nu", "0.5", "must be less than 0.5"),
    Bad("kind: von-mises", "kind: mohr", 24, "soil.law.kind", '"mohr"', "linear-elastic, von-mises"),
    Bad("su_gradient: 1.5e3", "su_gradient: -2.0e3", 24, "soil.law", '{"kind"', "su must stay positive"),
    Bad("stiffness: auto", "stiffness: automatic", 26, "contact.stiffness", '"automatic"', '"auto"'),
    Bad("stiffness: auto", "stiffness: -1", 26, "contact.stiffness", "-1", "must be greater than 0"),
    Bad("kind: dynamic", "kind: dynamics", 30, "stages.1.kind", '"dynamics"', 'did you mean "dynamic"?'),
    Bad(
        "time_step: 0.1",
        "time_step: 20",
        32,
        "stages.1.time_step",
        "20",
        "must not exceed the stage's duration",
    ),
    Bad("{interval: 0.1}", "{interval: 0}", 36, "output.interval", "0", "must be greater than 0"),
    Bad(
        "{interval: 0.1}",
        "{fields: [effektive_tension]}",
        36,
        "output.fields.0",
        '"effektive_tension"',
        'did you mean "effective_tension"?',
    ),
    Bad("{interval: 0.1}", "{fields: all}", 36, "output.fields", '"all"', "must be a list"),
]

ATTACHED = [
    Bad("850.0}", "850.0, pressure: 2 bar}", 14, "riser.contents.pressure", '"2 bar"', "must be a number"),
    Bad("850.0}", "850.0, pressure_level: top}", 14, "riser.contents.pressure_level", '"top"', "must be a number"),
    Bad("850.0}", "850.0, presure: 2.0}", 14, "riser.contents.presure", "2.0", 'did you mean "pressure"?'),
    Bad(
        "  contents:",
        "  attachments: [{at: 150.0, mass: 10.0}]\n  contents:",
        14,
        "riser.attachments.0.at",
        "150.0",
        "must not exceed the riser's length (148 m)",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: [20.0, 150.0], mass: 10.0}]\n  contents:",
        14,
        "riser.attachments.0.at.1",
        "150.0",
        "must not exceed the riser's length (148 m)",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: -2, mass: 10.0}]\n  contents:",
        14,
        "riser.attachments.0.at",
        "-2",
        "must be at least 0",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: top, mass: 10.0}]\n  contents:",
        14,
        "riser.attachments.0.at",
        '"top"',
        "must be a number",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: [], mass: 10.0}]\n  contents:",
        14,
        "riser.attachments.0.at",
        "[]",
        "must have at least 1",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: 20.0}]\n  contents:",
        14,
        "riser.attachments.0.mass",
        "missing",
        "has no mass, volume or drag_area",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: 20.0, mass: 9.0, added_mass: 0.5}]\n  contents:",
        14,
        "riser.attachments.0.added_mass",
        "0.5",
        "volume is 0",
    ),
    Bad(
        "  contents:",
        "  attachments: [{at: 20.0, weight: 9.0}]\n  contents:",
        14,
        "riser.attachments.0.weight",
        "9.0",
        "known are at, from, to, spacing, mass, volume, drag_area, added_mass",
    ),
]

MISSING = [
    Bad("length: 148.0, ", "", 16, "riser.segments.0.length", "missing", "add it: unstressed length [m]"),
    Bad("    EA: 3.0e8\n", "", 5, "line_types.pipe.EA", "missing", "add it: axial stiffness [N]"),
    Bad("    EI: 5.0e4\n", "", 5, "line_types.pipe.EI", "missing", "give EI, or both EI_y and EI_z"),
    Bad(", elements: 74", "", 16, "riser.segments.0.elements", "missing", "elements or element_length"),
    Bad(", stiffness: 1.0e5", "", 20, "seabed.stiffness", "missing", "the key is required here"),
    Bad("    duration: 15.0\n", "", 29, "stages.1.duration", "missing", "add it: duration [s]"),
]

CONFLICTS = [
    Bad(
        "{line_type: pipe",
        "{line_type: pip",
        16,
        "riser.segments.0.line_type",
        '"pip"',
        'did you mean "pipe"?',
    ),
    Bad(
        "elements: 74", "elements: 74, element_length: 2", 16, "riser.segments.0.elements", "74", "both given"
    ),
    Bad("    mass: 120.0\n", "", 5, "line_types.pipe.mass", "missing", "a dynamic stage needs the mass"),
    Bad("    outer_diameter: 0.3\n", "", 5, "line_types.pipe.outer_diameter", "missing", "buoyancy follows"),
    Bad("    EI: 5", "    EI_y: 5.0e4\n    EI: 5", 11, "line_types.pipe.EI", "50000.0", "given twice"),
    Bad("water: {density: 1025.0}\n", "", 11, "line_types.pipe.drag", '{"normal"', "the scene has no water"),
    Bad(
        "    inner_diameter: 0.2\n",
        "",
        13,
        "riser.contents",
        '{"density"',
        "no line type of the riser has room",
    ),
    Bad("length: 148.0", "length: 115.0", 18, "riser.end.position", "[80.0, 0.0, 100.0]", "only 115 m long"),
    Bad(
        "[0.0, 0.0, 0.15]",
        "[0.0, 0.0, -1.0]",
        17,
        "riser.start.position",
        "[0.0, 0.0, -1.0]",
        "below the seabed",
    ),
    Bad(
        "  end: {position: [80.0, 0.0, 100.0], rotation: free}",
        "  end: free",
        19,
        "riser.initial",
        '"catenary"',
        "give both ends a position",
        lines=2,
    ),
    Bad("initial: catenary", "initial: straight", 19, "riser.initial", '"straight"', "compress"),
    Bad("gravity: 9.81", "gravity: 0", 19, "riser.initial", '"catenary"', "no catenary without gravity"),
    Bad("name: heave", "name: lay", 29, "stages.1.name", '"lay"', "another stage has the same name"),
    Bad("y: [-2.5, 2.5]", "y: [7.5, 9.5]", 22, "soil.block", '{"x"', "never passes over"),
    Bad(
        "hex, size_at",
        "hex, file: none.msh, size_at",
        23,
        "soil.mesh.kind",
        '"hex"',
        "no such key here",
        lines=4,
    ),
    Bad(
        "{kind: hex, size_at_riser: 0.5, size_far: 1.5}",
        "{file: a.msh}",
        23,
        "soil.mesh.file",
        '"a.msh"',
        "no such file",
    ),
    Bad("{max_iterations: 20}", "{min_time_step: 1}", 32, "stages.1.time_step", "0.1", "min_time_step (1 s)"),
    Bad(
        "kind: static}",
        "kind: static, move: {}}\n  - {name: b, kind: static, move: {end: [900, 0, 9]}}",
        29,
        "stages.1.move",
        '{"end"',
        "pulls the ends",
    ),
    Bad(
        "kind: static}",
        "kind: static, loads: [{at: 999.0, force: [0, 0, 1]}]}",
        28,
        "stages.0.loads.0.at",
        "999.0",
        "exceed",
    ),
    Bad(
        "kind: static}",
        "kind: static, loads: [{at: 3.0, moment: [0, 1, 0]}]}",
        28,
        "stages.0.loads.0.at",
        "3.0",
        "nearest",
    ),
    Bad(
        "kind: static}",
        "kind: static, loads: [{force: [0, 0, 1]}]}",
        28,
        "stages.0.loads.0.at",
        "missing",
        "a place",
    ),
    Bad(
        "kind: static}",
        "kind: static, loads: [{at: end}]}",
        28,
        "stages.0.loads.0.force",
        "missing",
        "distributed",
    ),
    Bad(
        "kind: static}",
        "kind: static, loads: [{at: end, force: [0, 0, 1], distributed: [0, 0, 1]}]}",
        28,
        "stages.0.loads.0.at",
        '"end"',
        "load of its own",
    ),
    Bad(
        "period: 10.0, ramp: 5.0",
        "period: 10.0, phase_deg: 90.0",
        34,
        "stages.1.motion.end.harmonic.phase_deg",
        "90.0",
        "jump by 1.5 m",
    ),
    Bad(
        "kind: static}",
        "kind: static, move: {end: [80, 0, -1]}}",
        28,
        "stages.0.move.end",
        "[80, 0, -1]",
        "below the seabed",
    ),
    Bad(
        "kind: spring, level: 0.0, stiffness: 1.0e5}\nsoil:\n  block: {x: [10.0, 50.0], y: [-2.5, 2.5], depth: 2.5}\n"
        "  mesh: {kind: hex, size_at_riser: 0.5, size_far: 1.5}\n"
        "  law: {kind: von-mises, su: 4.0e3, su_gradient: 1.5e3, E_over_su: 300.0, nu: 0.49}\n"
        "  submerged_unit_weight: 5.0e3\n",
        "kind: rigid, level: 0.1}\n",
        17,
        "riser.start.position",
        "[0.0, 0.0, 0.15]",
        "0.1 m into the rigid seabed",
    ),
    Bad(
        "kind: static}",
        "kind: static, loads: [{at: end, force: [1, 0, 0], history: [[1, 0], [0, 1]]}]}",
        28,
        "stages.0.loads.0.history",
        "[[1, 0], [0, 1]]",
        "times must increase",
    ),
    Bad(
        "gravity: 9.81\n",
        "dimension: 2\n",
        34,
        "stages.1.motion.end.harmonic.amplitude",
        "[0.0, 1.0, 1.5]",
        "dimension is 2",
    ),
    Bad(
        "initial: catenary",
        "initial: unstressed",
        18,
        "riser.end.position",
        "[80.0, 0.0, 100.0]",
        "has its end at",
    ),
    Bad(
        "initial: catenary",
        "initial: {points: [[0, 0, 0.15], [1, 0, 1]]}",
        18,
        "riser.end.position",
        "[80.0",
        "has its end at",
    ),
    Bad(
        "initial: catenary",
        "initial: {points: [[0, 0, 0], [0, 0, 0]]}",
        19,
        "riser.initial.points",
        "[[0, 0",
        "coincide",
    ),
    Bad(
        "initial: catenary",
        "unstressed: {arc: {centre: [0, 0, 9], from: [0, 0, 0], angle_deg: 9, axis: [0, 1, 0]}}",
        19,
        "riser.unstressed.arc",
        '{"centre"',
        "1.41372 m long",
    ),
    Bad(
        "initial: catenary",
        "unstressed: {arc: {centre: [0, 0, 9], from: [0, 0, 0], angle_deg: 9, axis: [0, 0, 1]}}",
        19,
        "riser.unstressed.arc.from",
        "[0, 0, 0]",
        "axis",
    ),
]

TIME_STEP = "    time_step: 0.1"
MOTION = "\n    motion:\n      end: {harmonic: {amplitude: [0.0, 0.0, 1.5], period: 10.0, ramp: 5.0}}\n"
TOLERANCE = "stages.1.tolerance"
AUTO_STEPS = [
    Bad("time_step: 0.1", "time_step: atuo", 32, "stages.1.time_step", '"atuo"', 'did you mean "auto"?'),
    Bad("time_step: 0.1", "time_step: 0.1\n    tolerance: 0.1", 33, TOLERANCE, "0.1", "of a given size have no"),
    Bad("time_step: 0.1", "time_step: auto\n    tolerance: 0", 33, TOLERANCE, "0", "must be greater than 0"),
    Bad("time_step: 0.1", "time_step: auto\n    tolerance: small", 33, TOLERANCE, '"small"', "must be a number"),
    Bad(
        TIME_STEP + MOTION + "solver: {max_iterations: 20}",
        "    time_step: auto" + MOTION + "solver: {min_time_step: 20.0}",
        31,
        "stages.1.duration",
        "15.0",
        "min_time_step (20 s)",
    ),
]

NOT_YET = [
    Bad("level: 0.0", "slope_deg: 60.0", 20, "seabed.slope_deg", "60.0", "must be"),
    Bad("level: 0.0", "profile: [[0, 0]]", 20, "seabed.profile", "[[0, 0]]", "at least two points"),
    Bad("level: 0.0", "profile: [[0, 0], [0, 1]]", 20, "seabed.profile", "[[0, 0], [0, 1]]", "must increase"),
    Bad("level: 0.0", "grid: t.csv", 20, "seabed.grid", '"t.csv"', "there is no such file as"),
    Bad("level: 0.0", "grid: case.yaml", 20, "seabed.grid", '"case.yaml"', "names no column with its unit"),
    Bad("level: 0.0", "grid: 3", 20, "seabed.grid", "3", "mapping with the keys file"),
    Bad("level: 0.0", "slope_deg: 1.0", 20, "seabed.slope_deg", "1.0", "the soil's top is level"),
    Bad(
        "kind: spring, level: 0.0, stiffness: 1.0e5",
        "kind: hysteretic, law: {kind: randolph}",
        20,
        "seabed.law.kind",
        '"randolph"',
        "randolph-quiggin",
    ),
    Bad("soil:\n", "soil:\n  absorbing: true\n", 22, "soil.absorbing", "true", "belongs to soil with inertia"),
    Bad("soil:\n", "soil:\n  density: 1700.0\n", 22, "soil.density", "1700.0", "belongs to soil with inertia"),
    Bad("method: node", "method: surfaces", 26, "contact.method", '"surfaces"', 'did you mean "surface"?'),
    Bad("method: node", "friction: 0.5", 26, "contact.friction", "0.5", "must be a mapping"),
    Bad("method: node", "suction: {cap: 1.0}", 26, "contact.suction.reach", "missing", "the key is required here"),
    Bad(
        "time_step: 0.1",
        "time_step: 0.1\n    initial_velocity: [1, 0, 0]",
        33,
        "stages.1.initial_velocity",
        "[1, 0, 0]",
        "not supported yet",
    ),
]

HEAVE = "{harmonic: {amplitude: [0.0, 0.0, 1.5], period: 10.0, ramp: 5.0}}"
MOTION = "stages.1.motion.end"
ARC = "hub: [80, 0, 110], amplitude_deg: 5.0, period: 10.0"
MOTIONS = [
    Bad(HEAVE, "{table: t.csv}", 34, f"{MOTION}.table", '"t.csv"', "there is no such file as"),
    Bad(HEAVE, "{table: {file: t.csv}}", 34, f"{MOTION}.table.file", '"t.csv"', "there is no such file as"),
    Bad(HEAVE, "{table: case.yaml}", 34, f"{MOTION}.table", '"case.yaml"', "names no column with its unit"),
    Bad(HEAVE, "{vessel_history: t.csv}", 34, f"{MOTION}.vessel_history", '"t.csv"', "must be a mapping with the keys"),
    Bad(HEAVE, "{table: 3}", 34, f"{MOTION}.table", "3", "mapping with the keys file, ramp"),
    Bad(HEAVE, "{arc: {period: 9, amplitude_deg: 5}}", 34, f"{MOTION}.arc.hub", "missing", "add it: the hub"),
    Bad(HEAVE, f"{{arc: {{{ARC}, plane: zx}}}}", 34, f"{MOTION}.arc.plane", '"zx"', "must be one of xz, yz, xy"),
    Bad(HEAVE, f"{{arc: {{{ARC}, phase_deg: 30}}}}", 34, f"{MOTION}.arc.phase_deg", "30", "end would jump by 2.5 deg"),
    Bad(HEAVE, f"{{arc: {{{ARC.replace('110', '100')}}}}}", 34, f"{MOTION}.arc.hub", "[80, 0, 100]", "lies at its hub"),
    Bad(HEAVE, f"{{arc: {{{ARC}}}, table: case.yaml}}", 34, f"{MOTION}.table", '"case.yaml"', "names no column"),
    Bad(HEAVE, f"{{arc: {{{ARC}}}, {HEAVE[1:]}", 34, f"{MOTION}.arc", '{"hub"', "moves by harmonic already"),
    Bad(HEAVE, "{}", 34, f"{MOTION}.harmonic", "missing", "there is no motion"),
    Bad("ramp: 5.0", "phase_deg: [0, 30, 90]", 34, f"{MOTION}.harmonic.phase_deg", "[0, 30, 90]", "jump by 1.5 m"),
    Bad("ramp: 5.0", "phase_deg: [0, 30]", 34, f"{MOTION}.harmonic.phase_deg", "[0, 30]", "must be a list of 3 values"),
    Bad("ramp: 5.0", "phase_deg: x", 34, f"{MOTION}.harmonic.phase_deg", '"x"', "must be a number"),
    Bad(
        HEAVE,
        "{rotation: {axis: [0, 1, 0], amplitude_deg: 5, period: 9}}",
        34,
        f"{MOTION}.rotation",
        '{"axis"',
        "riser.end.rotation is free",
    ),
    Bad(
        HEAVE,
        "{rotation: {axis: [0, 0, 0], amplitude_deg: 5, period: 9}}",
        34,
        f"{MOTION}.rotation.axis",
        "[0, 0, 0]",
        "must not be zero",
    ),
]


def water(more: str, path: str, value: str, says: str) -> Bad:
    """What is added to the water, and the message about it."""
    return Bad("{density: 1025.0}", f"{{density: 1025.0, {more}}}", 3, f"water.{path}", value, says)


def airy(values: str, path: str, value: str, says: str) -> Bad:
    return water(f"surface_level: 100.0, waves: {{airy: {{{values}}}}}", f"waves.{path}", value, says)


def jonswap(values: str, path: str, value: str, says: str) -> Bad:
    return water(f"surface_level: 100.0, waves: {{jonswap: {{{values}}}}}", f"waves.jonswap.{path}", value, says)


WATER = [
    water("surfacelevel: 9.0", "surfacelevel", "9.0", 'did you mean "surface_level"?'),
    water("surface_level: high", "surface_level", '"high"', "must be a number"),
    water("surface_level: -3.0", "surface_level", "-3.0", "must lie above the seabed (z = 0 m)"),
    water("depth: 0", "depth", "0", "must be greater than 0"),
    water("current: 1.0", "current", "1.0", "must be a mapping with the keys profile"),
    water("current: {profile: []}", "current.profile", "[]", "must have at least 1 entries"),
    water("current: {profile: [[0, 1]]}", "current.profile.0", "[0, 1]", "must be a list of 3 values"),
    water("current: {profile: [[0, 1, .inf]]}", "current.profile.0.2", "Infinity", "must be a finite number"),
    water("current: {profile: [[0, 1, 0], [0, 2, 0]]}", "current.profile", "[[0, 1, 0], [0", "heights z must increase"),
    water("waves: {airy: {height: 2, period: 9}}", "surface_level", "missing", "waves need a surface"),
    water("surface_level: 9.0, waves: {}", "waves.airy", "missing", "no wave is given"),
    water("surface_level: 9.0, waves: {stokes: {}}", "waves.stokes", "{}", "known are airy, jonswap, pierson_mosk"),
    water(
        "surface_level: 9.0, waves: {airy: {height: 2, period: 9}, jonswap: {Hs: 2, Tp: 9}}",
        "waves.jonswap",
        '{"Hs": 2, "Tp": 9}',
        "both given",
    ),
    airy("period: 9.0", "airy.height", "missing", "add it: height from trough to crest [m]"),
    airy("height: 2.0", "airy.period", "missing", "add it: period [s]"),
    airy("height: 0, period: 9", "airy.height", "0", "must be greater than 0"),
    airy("height: 2, period: .inf", "airy.period", "Infinity", "must be a finite number"),
    airy("height: 2, period: nine", "airy.period", '"nine"', "must be a number"),
    airy("height: 9, period: 6", "airy.height", "9", "must not exceed 7.981 m"),
    airy("height: 2, period: 9}, stretching: {a: 1", "stretching", '{"a": 1}', "must be one of wheeler, vertical"),
    water(
        "surface_level: 9.0, waves: {ramp: -1.0, airy: {height: 2, period: 9}}",
        "waves.ramp",
        "-1.0",
        "must be at least 0",
    ),
    jonswap("Hs: 2.0", "Tp", "missing", "add it: period of the spectrum's peak [s]"),
    jonswap("Hs: -2.0, Tp: 9.0", "Hs", "-2.0", "must be greater than 0"),
    jonswap("Hs: 9.0, Tp: 5.0", "Hs", "9.0", "must not exceed 5.543 m"),
    jonswap("Hs: 2.0, Tp: 9.0, gamma: 0.9", "gamma", "0.9", "must be at least 1"),
    jonswap("Hs: 2.0, Tp: 9.0, gamma: 8", "gamma", "8", "must be at most 7"),
    jonswap("Hs: 2.0, Tp: 9.0, seed: 1.5", "seed", "1.5", "must be a whole number"),
    jonswap("Hs: 2.0, Tp: 9.0, components: 0", "components", "0", "must be at least 1"),
]

ALL = KEYS + VALUES + ATTACHED + MISSING + CONFLICTS + MOTIONS + AUTO_STEPS + NOT_YET + WATER
