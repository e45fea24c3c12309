"""How a motion is followed as frozen values. Made by generate_tables.py from the schema of scenes: do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from .._table import Table


@dataclass(frozen=True, kw_only=True, repr=False)
class Duration(Table):
    """How long the motion is followed.

    Attributes
    ----------
    free_time_s
        Time after the ground motion; or give free_time_ratio; from 0 to 100000.
    free_time_ratio
        Time after the ground motion, in 1/p; or give free_time_s; from 0 to 100000; 20.0 by default.
    rest_speed_ratio
        Angular velocity θ̇/(pα) below which an impact may end in rest; from 1e-12 to 0.01; 1e-06 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "run"

    free_time_s: float | None = None
    free_time_ratio: float | None = None
    rest_speed_ratio: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Accuracy(Table):
    """How accurately the motion is followed.

    Attributes
    ----------
    level
        Accuracy in place of all other keys of the table: a word, or a relative error of the peak rotation;
        commands with --accuracy report errors; from 1e-15 to 0.1.
    method
        Method of integration; taylor by default.
    precision
        Floating-point numbers that are used; f64 by default.
    events
        Where events take place; located by default.
    tolerance
        Size of the last terms of the series over the rotation that matters; from 1e-20 to 0.01; 1e-15 by
        default.
    step_s
        Fixed step, divided where viscous forces or springs of clutches need shorter ones; or give step_ratio;
        from 1e-07 to 1.
    step_ratio
        Fixed step, in 1/p; or give step_s; from 1e-07 to 1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "accuracy"

    level: float | Literal["fast", "normal", "tight"] | None = None
    method: Literal["taylor", "runge-kutta-4", "semi-implicit-euler", "exponential-midpoint"] | None = None
    precision: Literal["f64", "f32"] | None = None
    events: Literal["located", "step-end"] | None = None
    tolerance: float | None = None
    step_s: float | None = None
    step_ratio: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Gear(Table):
    """Mesh of rack and first pinion; needs block.mass_kg.

    Attributes
    ----------
    module_mm
        Module of rack and pinion; above 0, to 100.
    face_width_mm
        Face width of rack and pinion; above 0, to 10000.
    teeth
        Teeth of the pinion; from 12 to 10000.
    allowable_stress_mpa
        Allowable bending stress at the root of a tooth; a warning above; above 0, to 100000.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "checks.gear"

    module_mm: float
    face_width_mm: float
    teeth: int
    allowable_stress_mpa: float


@dataclass(frozen=True, kw_only=True, repr=False)
class Coil(Table):
    """Coil of each clutch of a clutched pair: the energy that both take is reported.

    Attributes
    ----------
    holding_power_w
        Power of a coil while its clutch is engaged; from 0 to 100000.
    closing_energy_j
        Energy that it takes to engage a clutch once, beside the power that holds it; from 0 to 100000; 0.0 by
        default.
    largest_energy_j
        Largest energy of both coils over a motion; a warning above; above 0, to 1e+09.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "checks.coil"

    holding_power_w: float
    closing_energy_j: float | None = None
    largest_energy_j: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Checks(Table):
    """Checks of what a device demands of its support and gears; the table turns them on.

    Attributes
    ----------
    friction_coefficient
        Available coefficient of friction under the block; a warning above. Without it the demand is only
        reported; above 0, to 10.
    gear
        Mesh of rack and first pinion; needs block.mass_kg.
    coil
        Coil of each clutch of a clutched pair: the energy that both take is reported.
    largest_force_ratio
        Force of both flywheels on their support over the block's weight; a warning above; above 0, to 1e+06.
    largest_stroke_m
        Travel of the terminals; a warning above; above 0, to 10000.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "checks"

    friction_coefficient: float | None = None
    gear: Gear | None = None
    coil: Coil | None = None
    largest_force_ratio: float | None = None
    largest_stroke_m: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Output(Table):
    """What is kept of a run.

    Attributes
    ----------
    interval_s
        Time between samples of the history and of the energy ledger; 1/2000 of the run without the key; from
        1e-06 to 10.
    energy
        Whether the energy ledger is kept and plotted; false by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "output"

    interval_s: float | None = None
    energy: bool | None = None
