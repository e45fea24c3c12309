"""Rocking structures with inerters and clutches: simulate, and get the numbers to decide with.

Results are the bits of the command `sprag` on every machine. Every name has its unit in it or is a ratio; arguments go by keyword;
values never change, compare, hash and pickle.
"""

from . import errors
from ._board import Board, BoardLoop
from ._columns import Columns
from ._core import DemandModel, Fragility, Record, Situation, __version__, demand, fragility
from ._loop import ClosedLoop, Law, Wish, closed_loop
from ._map import Map, map
from ._outcome import Outcome
from ._plan import Plan, collect, plan, run_part
from ._run import ErrorEstimate, Run, simulate
from ._scene import Axis, Ground, RecordedMotion, Scene
from ._study import Cloud, Optimum, Study, accuracy, cloud, optimise
from ._tables import (
    Accelerometer,
    Accuracy,
    Actuation,
    Belief,
    Block,
    Checks,
    Clutch,
    ClutchedPair,
    Controller,
    Cosine,
    Device,
    Duration,
    Encoder,
    Flywheel,
    FlywheelLosses,
    Gear,
    Gyroscope,
    HalfSine,
    Inerter,
    MavroeidisPapageorgiou,
    Motion,
    NoDevice,
    Output,
    Rack,
    Rectangular,
    Ricker,
    Sensors,
    Sine,
    Weight,
)
from .errors import BoardError, InputError, RunError

__all__ = [
    "Accelerometer",
    "Accuracy",
    "Actuation",
    "Axis",
    "Belief",
    "Block",
    "Board",
    "BoardError",
    "BoardLoop",
    "Checks",
    "ClosedLoop",
    "Cloud",
    "Clutch",
    "ClutchedPair",
    "Columns",
    "Controller",
    "Cosine",
    "DemandModel",
    "Device",
    "Duration",
    "Encoder",
    "ErrorEstimate",
    "Flywheel",
    "FlywheelLosses",
    "Fragility",
    "Gear",
    "Ground",
    "Gyroscope",
    "HalfSine",
    "Inerter",
    "InputError",
    "Law",
    "Map",
    "MavroeidisPapageorgiou",
    "Motion",
    "NoDevice",
    "Optimum",
    "Outcome",
    "Output",
    "Plan",
    "Rack",
    "Record",
    "RecordedMotion",
    "Rectangular",
    "Ricker",
    "Run",
    "RunError",
    "Scene",
    "Sensors",
    "Sine",
    "Situation",
    "Study",
    "Weight",
    "Wish",
    "__version__",
    "accuracy",
    "closed_loop",
    "cloud",
    "collect",
    "demand",
    "errors",
    "fragility",
    "map",
    "optimise",
    "plan",
    "run_part",
    "simulate",
]
