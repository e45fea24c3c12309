"""Rocking structures with inerters and clutches: simulate, and get the numbers to decide with.

Results are the bits of the command `sprag` on every machine. Every name has its unit in it or is a ratio; arguments go by keyword;
values never change, compare, hash and pickle.
"""

from . import errors
from ._core import Record, Situation, __version__
from ._loop import ClosedLoop, Law, Wish, closed_loop
from ._map import Map, map
from ._outcome import Outcome
from ._run import ErrorEstimate, Run, simulate
from ._scene import Axis, Ground, RecordedMotion, Scene
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
    "BoardError",
    "Checks",
    "ClosedLoop",
    "Clutch",
    "ClutchedPair",
    "Controller",
    "Cosine",
    "Device",
    "Duration",
    "Encoder",
    "ErrorEstimate",
    "Flywheel",
    "FlywheelLosses",
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
    "Outcome",
    "Output",
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
    "Weight",
    "Wish",
    "__version__",
    "closed_loop",
    "errors",
    "map",
    "simulate",
]
