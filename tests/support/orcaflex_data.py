"""A small text data file of OrcaFlex: a riser from a seabed to a vessel, in waves and a current."""

DATA = """%YAML 1.1
# Type: Model
---
General:
  UnitsSystem: SI
  DynamicsSolutionMethod: Implicit time domain
  ImplicitUseVariableTimeStep: No
  ImplicitConstantTimeStep: 0.2
  LogPrecision: Single
  StageDuration: [8, 16]
  DefaultViewSize: 140
Environment:
  WaterSurfaceZ: 0
  KinematicViscosity: 1.35e-6
  Density: 1.025
  SeabedType: Flat
  SeabedOrigin: [0, 0]
  WaterDepth: 100
  SeabedSlope: 0
  SeabedModel: Elastic
  SeabedNormalStiffness: 200
  SeabedShearStiffness: ~
  KinematicStretchingMethod: Wheeler stretching
  WaveTrains:
    - Name: Wave 1
      WaveType: Airy
      WaveDirection: 180
      WaveHeight: 2
      WavePeriod: 8
      WaveOrigin: [0, 0]
      WaveTimeOrigin: 2
  CurrentModel: Variation scheme
  VerticalCurrentVariationMethod: Interpolated
  RefCurrentSpeed: 0.4
  RefCurrentDirection: 90
  CurrentDepth, CurrentFactor, CurrentRotation:
    - [0, 1, 0]
    - [100, 0.25, 0]
  WindSpeed: 12
VesselTypes:
  - Name: Barge
    Length: 100
    RAOResponseUnits: degrees
    RAOWaveUnit: amplitude
    WavesReferredToBy: period (s)
    RAOPhaseConvention: lags
    RAOPhaseUnitsConvention: degrees
    RAOPhaseRelativeToConvention: crest
    SurgePositive: forward
    SwayPositive: port
    HeavePositive: up
    RollPositiveStarboard: down
    PitchPositiveBow: down
    YawPositiveBow: port
    Symmetry: xz plane
    Draughts:
      - Name: Laden
        Mass: 9000
        DisplacementRAOs:
          RAOOrigin: [2, 0, -1]
          PhaseOrigin: [~, ~, ~]
          RAOs:
RAOS
LineTypes:
  - Name: 8" hose
    Category: General
    OD: 0.30
    ID: 0.20
    MassPerUnitLength: 0.12
    EI: [50, ~]
    EA: 4.0e5
    PoissonRatio: 0.5
    GJ: 12
    AllowableTension: 2000
    MinRadius: [3, ~]
    OuterContactDiameter: ~
    Ca: [1, ~, 0]
    Cd: [1.2, ~, 0.01]
    Cl: 0
    NormalDragLiftDiameter: 0.36
    SeabedLateralFrictionCoefficient: 0.5
    SeabedAxialFrictionCoefficient: ~
    RayleighDampingCoefficients: (no damping)
    Pen: [2, Solid, Yellow]
Vessels:
  - Name: Ship
    VesselType: Barge
    Draught: Laden
    InitialPosition: [-20, 0, 0]
    Orientation: [0, 0, 180]
    PrimaryMotion: None
    SuperimposedMotion: RAOs + harmonics
Lines:
  - Name: Riser
    IncludeTorsion: No
    TopEnd: End A
    ? Connection, ConnectionX, ConnectionY, ConnectionZ, ConnectionAzimuth, ConnectionDeclination, ConnectionGamma
    : - [Ship, -20, 0, -4, 0, 170, 0]
      - [Anchored, 80, 0, 0.15, 0, 90, 0]
    ConnectionxBendingStiffness, ConnectionyBendingStiffness:
      - [2, ~]
      - [0, ~]
    LineType, Length, TargetSegmentLength:
      - [8" hose, 110, 2]
      - [8" hose, 40, 4]
    ContentsMethod: Uniform
    ContentsDensity: 0.8
    ContentsPressure: 0
    StaticsStep1: Catenary
    LayAzimuth: 180
    DrawNodesAsDiscs: No
  - Name: Other
    TopEnd: End A
Groups:
  Structure: {Riser: Model}
"""

COLUMNS = "RAOPeriodOrFrequency, " + ", ".join(
    f"RAO{mode}Amp, RAO{mode}Phase" for mode in ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")
)


def raos(rows: str = "[{period}, 0.5, 90, 0.3, 45, 0.8, 10, 1.5, -30, 2, -90, 0.2, 0]") -> str:
    """RAOs in directions of a half circle, for two periods and for waves of none and of an endless one."""
    table = "".join(f"                - {rows.format(period=period)}\n" for period in (2, 40))
    limits = "                - [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n"
    return "".join(
        f"            - RAODirection: {direction}\n              ? {COLUMNS}\n              :\n{limits}{table}"
        for direction in (0, 45, 90, 135, 180)
    )


def data_text(rows: str | None = None) -> str:
    """The whole file."""
    return DATA.replace("RAOS\n", raos() if rows is None else raos(rows))
