"""The tables of a scene."""

from .control import Accelerometer, Belief, Controller, Encoder, Gyroscope, Sensors
from .following import Accuracy, Checks, Coil, Duration, Gear, Output
from .motion import Cosine, HalfSine, MavroeidisPapageorgiou, Motion, Rectangular, Ricker, Sine
from .structure import (
    Actuation,
    Block,
    Clutch,
    ClutchedPair,
    Device,
    Flywheel,
    FlywheelLosses,
    Inerter,
    NoDevice,
    Rack,
    Weight,
)

__all__ = [
    "Accelerometer",
    "Accuracy",
    "Actuation",
    "Belief",
    "Block",
    "Checks",
    "Clutch",
    "ClutchedPair",
    "Coil",
    "Controller",
    "Cosine",
    "Device",
    "Duration",
    "Encoder",
    "Flywheel",
    "FlywheelLosses",
    "Gear",
    "Gyroscope",
    "HalfSine",
    "Inerter",
    "MavroeidisPapageorgiou",
    "Motion",
    "NoDevice",
    "Output",
    "Rack",
    "Rectangular",
    "Ricker",
    "Sensors",
    "Sine",
    "Weight",
]
