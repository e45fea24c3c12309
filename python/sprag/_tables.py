"""The tables of a scene as frozen values. Made by generate_tables.py from the schema of scenes: do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from ._table import Table


@dataclass(frozen=True, kw_only=True, repr=False)
class Block(Table):
    """The block that rocks.

    Attributes
    ----------
    slenderness_deg
        Slenderness α, the angle between the vertical and the line from a toe to the centre of mass; above 0
        and below 90.
    size_m
        Size R, from a toe to the centre of mass; or give frequency_parameter_1_s; from 0.001 to 10000.
    frequency_parameter_1_s
        Frequency parameter p = √(g/(λR)); or give size_m; from 0.01 to 1000.
    inertia_ratio
        Moment of inertia about a toe, λ = I_O/(mR²); 4/3 of a rectangle; from 1 to 4; 1.3333333333333333 by
        default.
    mass_kg
        Mass m; needed by values in kg, N, N/m and N s/m; above 0.
    geometry
        Equation of motion; full by default.
    restitution
        Ratio η of the angular velocities after and before an impact, or where it comes from; from 0 to 1;
        0.85 by default.
    initial_rotation_ratio
        Rotation at the start, θ/α; from -10 to 10; 0.0 by default.
    initial_velocity_ratio
        Angular velocity at the start, θ̇/(pα); from -100 to 100; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "block"

    slenderness_deg: float
    size_m: float | None = None
    frequency_parameter_1_s: float | None = None
    inertia_ratio: float | None = None
    mass_kg: float | None = None
    geometry: Literal["full", "slender"] | None = None
    restitution: float | Literal["geometric", "momentum-balance"] | None = None
    initial_rotation_ratio: float | None = None
    initial_velocity_ratio: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Flywheel(Table):
    """A flywheel and its pinion.

    Attributes
    ----------
    mass_kg
        Mass of the flywheel; from 0.
    radius_m
        Radius of the flywheel; above 0.
    pinion_radius_m
        Radius of its pinion; above 0.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.flywheels.0"

    mass_kg: float
    radius_m: float
    pinion_radius_m: float


@dataclass(frozen=True, kw_only=True, repr=False)
class FlywheelLosses(Table):
    """Losses of the flywheels, as deceleration of a rack that moves with them.

    Attributes
    ----------
    viscous_rate_1_s
        Rate at which an idle flywheel slows down, as e^(−rate t); from 0 to 1e+06; 0.0 by default.
    dry_deceleration_m_s2
        Deceleration by dry friction of the bearings; from 0 to 1e+06; 0.0 by default.
    brake_deceleration_m_s2
        Deceleration by a brake on released flywheels; not of an inerter, an ideal or an overrunning clutch;
        from 0 to 1e+09; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.flywheel"

    viscous_rate_1_s: float | None = None
    dry_deceleration_m_s2: float | None = None
    brake_deceleration_m_s2: float | Literal["instant"] | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Clutch(Table):
    """Properties of the clutches of a clutched pair: a capacity makes plates that slip, a stiffness a spring.

    Attributes
    ----------
    capacity_ratio
        Largest force at the rack over the block's weight; or give capacity_n; above 0, to 1e+06.
    capacity_n
        Largest force at the rack; or give capacity_ratio; above 0.
    stiffness_ratio
        Stiffness K at the rack, K/(mp²); or give stiffness_n_m; above 0.
    stiffness_n_m
        Stiffness K at the rack; or give stiffness_ratio; above 0.
    damping_ratio
        Damping C at the rack, ζ = C/(2 √(K m_r)); or give damping_n_s_m. With a stiffness; from 0.
    damping_n_s_m
        Damping C at the rack; or give damping_ratio. With a stiffness; from 0.
    backlash_m
        Play at the rack from contact to contact. With a stiffness; from 0 to 1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.clutch"

    capacity_ratio: float | None = None
    capacity_n: float | None = None
    stiffness_ratio: float | None = None
    stiffness_n_m: float | None = None
    damping_ratio: float | None = None
    damping_n_s_m: float | None = None
    backlash_m: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Rack(Table):
    """Friction that the rack meets, whatever the clutch does.

    Attributes
    ----------
    viscous_1_s
        Viscous force over the block's mass and the velocity; or give viscous_n_s_m; from 0 to 1000.
    viscous_n_s_m
        Viscous force over the velocity; or give viscous_1_s; from 0.
    dry_friction_ratio
        Dry friction over the block's weight; or give dry_friction_n; from 0 to 10.
    dry_friction_n
        Dry friction; or give dry_friction_ratio; from 0.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.rack"

    viscous_1_s: float | None = None
    viscous_n_s_m: float | None = None
    dry_friction_ratio: float | None = None
    dry_friction_n: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Actuation(Table):
    """Delays between a command and a clutch that has obeyed it.

    Attributes
    ----------
    engagement_delay_s
        Time from the command to engagement; from 0 to 10; 0.0 by default.
    release_delay_s
        Time from the command to release; from 0 to 10; 0.0 by default.
    delay
        Kind of these two delays; inertial by default.
    rise_time_s
        Time from first contact to full capacity; needs a capacity; from 0 to 10; 0.0 by default.
    dwell_s
        Time for which a clutch that has just moved stays so; from 0 to 10; 0.0 by default.
    miss_probability
        Probability that an engagement is missed; from 0 to 1; 0.0 by default.
    miss_seed
        Seed of which engagements are missed; from 0; 0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.actuation"

    engagement_delay_s: float | None = None
    release_delay_s: float | None = None
    delay: Literal["inertial", "transport"] | None = None
    rise_time_s: float | None = None
    dwell_s: float | None = None
    miss_probability: float | None = None
    miss_seed: int | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Weight(Table):
    """Gravitational mass of the device, and what it rides on.

    Attributes
    ----------
    flywheels_ratio
        Mass of all flywheels, gears and housing over the block's; or give flywheels_kg; from 0 to 10.
    flywheels_kg
        Mass of all flywheels, gears and housing; or give flywheels_ratio; from 0.
    flywheels_on
        What flywheels, gears and housing ride on; support by default.
    rack_ratio
        Mass of the rack over the block's; or give rack_kg; from 0 to 10.
    rack_kg
        Mass of the rack; or give rack_ratio; from 0.
    rack_on
        What the rack rides on; support by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.weight"

    flywheels_ratio: float | None = None
    flywheels_kg: float | None = None
    flywheels_on: Literal["support", "block"] | None = None
    rack_ratio: float | None = None
    rack_kg: float | None = None
    rack_on: Literal["support", "block"] | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class NoDevice(Table):
    """No device.

    Attributes
    ----------
    name
        Name in tables and legends; its kind without the key.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device"
    _fixed: ClassVar[dict[str, str]] = {"kind": "none"}

    name: str | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Inerter(Table):
    """One inerter.

    Attributes
    ----------
    name
        Name in tables and legends; its kind without the key.
    mass_ratio
        Mass ratio σ of inertance and block; or give inertance_kg or flywheels; from 0 to 10000.
    inertance_kg
        Inertance m_r; or give mass_ratio or flywheels; from 0.
    flywheels
        Flywheel train (Eq. 9), the first on the rack; or give mass_ratio or inertance_kg.
    mount
        Where the device is attached (Figure 3); centre-of-mass by default.
    mount_height_m
        Height of a tying point above the base; above 0.
    pulley_ratio
        Travel of the terminal over that of the tying point or corner; of "tying-point" and "base-corners";
        above 0; 1.0 by default.
    kinematics
        Acceleration of the terminals; always "consistent" where flywheels have a speed of their own; paper by
        default.
    engagement
        How the flywheels of a clutched pair are coupled, in the place of clutch; ideal by default.
    flywheel
        Losses of the flywheels, as deceleration of a rack that moves with them.
    clutch
        Properties of the clutches of a clutched pair: a capacity makes plates that slip, a stiffness a
        spring.
    rack
        Friction that the rack meets, whatever the clutch does.
    actuation
        Delays between a command and a clutch that has obeyed it.
    weight
        Gravitational mass of the device, and what it rides on.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device"
    _fixed: ClassVar[dict[str, str]] = {"kind": "inerter"}

    name: str | None = None
    mass_ratio: float | None = None
    inertance_kg: float | None = None
    flywheels: Sequence[Flywheel] | None = None
    mount: Literal["centre-of-mass", "tying-point", "base-corners"] | None = None
    mount_height_m: float | None = None
    pulley_ratio: float | None = None
    kinematics: Literal["paper", "consistent"] | None = None
    engagement: Literal["ideal", "rigid", "overrunning"] | None = None
    flywheel: FlywheelLosses | None = None
    clutch: Clutch | None = None
    rack: Rack | None = None
    actuation: Actuation | None = None
    weight: Weight | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class ClutchedPair(Table):
    """Two clutched inerters (Eq. 10).

    Attributes
    ----------
    name
        Name in tables and legends; its kind without the key.
    mass_ratio
        Mass ratio σ of inertance and block; or give inertance_kg or flywheels; from 0 to 10000.
    inertance_kg
        Inertance m_r; or give mass_ratio or flywheels; from 0.
    flywheels
        Flywheel train (Eq. 9), the first on the rack; or give mass_ratio or inertance_kg.
    mount
        Where the device is attached (Figure 3); centre-of-mass by default.
    mount_height_m
        Height of a tying point above the base; above 0.
    pulley_ratio
        Travel of the terminal over that of the tying point or corner; of "tying-point" and "base-corners";
        above 0; 1.0 by default.
    kinematics
        Acceleration of the terminals; always "consistent" where flywheels have a speed of their own; paper by
        default.
    engagement
        How the flywheels of a clutched pair are coupled, in the place of clutch; ideal by default.
    flywheel
        Losses of the flywheels, as deceleration of a rack that moves with them.
    clutch
        Properties of the clutches of a clutched pair: a capacity makes plates that slip, a stiffness a
        spring.
    rack
        Friction that the rack meets, whatever the clutch does.
    actuation
        Delays between a command and a clutch that has obeyed it.
    weight
        Gravitational mass of the device, and what it rides on.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device"
    _fixed: ClassVar[dict[str, str]] = {"kind": "clutched-pair"}

    name: str | None = None
    mass_ratio: float | None = None
    inertance_kg: float | None = None
    flywheels: Sequence[Flywheel] | None = None
    mount: Literal["centre-of-mass", "tying-point", "base-corners"] | None = None
    mount_height_m: float | None = None
    pulley_ratio: float | None = None
    kinematics: Literal["paper", "consistent"] | None = None
    engagement: Literal["ideal", "rigid", "overrunning"] | None = None
    flywheel: FlywheelLosses | None = None
    clutch: Clutch | None = None
    rack: Rack | None = None
    actuation: Actuation | None = None
    weight: Weight | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Sine(Table):
    """One cycle of a sine: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "sine"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Cosine(Table):
    """One cycle of a cosine: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "cosine"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class HalfSine(Table):
    """Half a cycle of a sine: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "half-sine"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Rectangular(Table):
    """Constant for a while: an amplitude and a duration.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    duration_s
        Length of a rectangular pulse; or give duration_ratio; from 1e-06 to 10000.
    duration_ratio
        Length of a rectangular pulse, in 1/p; or give duration_s; from 1e-06 to 10000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "rectangular"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    duration_s: float | None = None
    duration_ratio: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Ricker(Table):
    """Symmetric Ricker wavelet: an amplitude and a frequency.

    Attributes
    ----------
    amplitude_ratio
        Amplitude a_g/(g tan α), or a_g/(gα) for the slender model; of horizontal motions; from -1e+06 to
        1e+06.
    amplitude_g
        Amplitude a_g; from -1000 to 1000.
    amplitude_m_s2
        Amplitude a_g; from -10000 to 10000.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "ricker"}

    amplitude_ratio: float | None = None
    amplitude_g: float | None = None
    amplitude_m_s2: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    scale: float | None = None
    start_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class MavroeidisPapageorgiou(Table):
    """Near-fault velocity pulse: a velocity amplitude, a frequency, oscillations, phase_deg.

    Attributes
    ----------
    velocity_amplitude_m_s
        Velocity amplitude A of a Mavroeidis-Papageorgiou pulse; from -100 to 100.
    frequency_ratio
        Frequency ω_g/p; or give frequency_hz; from 0.001 to 10000.
    frequency_hz
        Frequency; or give frequency_ratio; from 0.001 to 1000.
    oscillations
        Oscillations γ of a Mavroeidis-Papageorgiou pulse; above 1, to 100.
    phase_deg
        Phase ν of a Mavroeidis-Papageorgiou pulse; from -360 to 360.
    scale
        Factor on the whole motion; from -1000 to 1000; 1.0 by default.
    start_s
        Start; from 0 to 10000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "ground"
    _fixed: ClassVar[dict[str, str]] = {"motion": "mavroeidis-papageorgiou"}

    velocity_amplitude_m_s: float | None = None
    frequency_ratio: float | None = None
    frequency_hz: float | None = None
    oscillations: float | None = None
    phase_deg: float | None = None
    scale: float | None = None
    start_s: float | None = None


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
        errors are reported; from 1e-15 to 0.1.
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
        Fixed step; or give step_ratio; from 1e-07 to 1.
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
class Checks(Table):
    """Checks of what a device demands of its support and gears; the table turns them on.

    Attributes
    ----------
    friction_coefficient
        Available coefficient of friction under the block; a warning above. Without it the demand is only
        reported; above 0, to 10.
    gear
        Mesh of rack and first pinion; needs block.mass_kg.
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
    largest_force_ratio: float | None = None
    largest_stroke_m: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Belief(Table):
    """Belief of the controller about the structure, as factors on the truth.

    Attributes
    ----------
    slenderness_factor
        Believed over true slenderness α; from 0.1 to 3; 1.0 by default.
    size_factor
        Believed over true size R; from 0.1 to 3; 1.0 by default.
    mass_ratio_factor
        Believed over true mass ratio σ; from 0.1 to 3; 1.0 by default.
    restitution_factor
        Believed over true restitution η; from 0.1 to 3; 1.0 by default.
    lag_factor
        Believed over true lags of the clutches behind their currents; from 0 to 10; 1.0 by default.
    model_error
        Share of p²α by which the equation of motion may be wrong: process noise of the model-aided estimator;
        from 0.0001 to 10; 0.02 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.belief"

    slenderness_factor: float | None = None
    size_factor: float | None = None
    mass_ratio_factor: float | None = None
    restitution_factor: float | None = None
    lag_factor: float | None = None
    model_error: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Gyroscope(Table):
    """Gyroscope with keys of its own.

    Attributes
    ----------
    preset
        Gyroscope that the other keys change; the suite's without the key.
    noise_density_deg_s_rthz
        Noise density, one-sided; from 0 to 10.
    bias_deg_s
        Bias at turn-on, standard deviation over specimens; from 0 to 100.
    drift_deg_s
        Bias instability as a Gauss-Markov process; from 0 to 100.
    drift_correlation_time_s
        Correlation time of the bias instability; from 0.001 to 1e+06.
    random_walk_deg_s_rts
        Random walk of the bias; from 0 to 10.
    scale_error_ratio
        Scale error as a fraction, standard deviation over specimens; from 0 to 0.5.
    misalignment_deg
        Misalignment of an axis, standard deviation over specimens; from 0 to 45.
    bandwidth_hz
        −3 dB corner; 0 (none), or from 0.1; from 0 to 100000.
    resolution_deg_s
        Reading per count; from 0 to 100.
    full_scale_deg_s
        Full scale either way; 0 (no limit); from 0 to 100000.
    rate_hz
        How often it is read; 0 (continuously), or from 1; from 0 to 100000.
    synchronous
        Whether it is read at whole periods instead of on a clock of its own.
    jitter_s
        Jitter of the instant at which it is read; up to a tenth of the period; from 0 to 0.1.
    latency_s
        Time until a reading is known; up to 32 periods; from 0 to 0.1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors.gyroscope"

    preset: str | None = None
    noise_density_deg_s_rthz: float | None = None
    bias_deg_s: float | None = None
    drift_deg_s: float | None = None
    drift_correlation_time_s: float | None = None
    random_walk_deg_s_rts: float | None = None
    scale_error_ratio: float | None = None
    misalignment_deg: float | None = None
    bandwidth_hz: float | None = None
    resolution_deg_s: float | None = None
    full_scale_deg_s: float | None = None
    rate_hz: float | None = None
    synchronous: bool | None = None
    jitter_s: float | None = None
    latency_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Accelerometer(Table):
    """Accelerometer with keys of its own.

    Attributes
    ----------
    preset
        Accelerometer that the other keys change; the suite's without the key.
    noise_density_ug_rthz
        Noise density, one-sided; from 0 to 1e+06.
    bias_mg
        Bias at turn-on, standard deviation over specimens; from 0 to 1000.
    drift_mg
        Bias instability as a Gauss-Markov process; from 0 to 1000.
    drift_correlation_time_s
        Correlation time of the bias instability; from 0.001 to 1e+06.
    random_walk_mg_rts
        Random walk of the bias; from 0 to 1000.
    scale_error_ratio
        Scale error as a fraction, standard deviation over specimens; from 0 to 0.5.
    misalignment_deg
        Misalignment of an axis, standard deviation over specimens; from 0 to 45.
    bandwidth_hz
        −3 dB corner; 0 (none), or from 0.1; from 0 to 100000.
    resolution_mg
        Reading per count; from 0 to 1000.
    full_scale_g
        Full scale either way; 0 (no limit); from 0 to 10000.
    rate_hz
        How often it is read; 0 (continuously), or from 1; from 0 to 100000.
    synchronous
        Whether it is read at whole periods instead of on a clock of its own.
    jitter_s
        Jitter of the instant at which it is read; up to a tenth of the period; from 0 to 0.1.
    latency_s
        Time until a reading is known; up to 32 periods; from 0 to 0.1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors.block_accelerometer"

    preset: str | None = None
    noise_density_ug_rthz: float | None = None
    bias_mg: float | None = None
    drift_mg: float | None = None
    drift_correlation_time_s: float | None = None
    random_walk_mg_rts: float | None = None
    scale_error_ratio: float | None = None
    misalignment_deg: float | None = None
    bandwidth_hz: float | None = None
    resolution_mg: float | None = None
    full_scale_g: float | None = None
    rate_hz: float | None = None
    synchronous: bool | None = None
    jitter_s: float | None = None
    latency_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Encoder(Table):
    """Encoder with keys of its own.

    Attributes
    ----------
    preset
        Encoder that the other keys change; the suite's without the key.
    resolution_m
        Travel per count; or give counts_per_revolution and pinion_radius_m; from 1e-09 to 0.01.
    counts_per_revolution
        Counts a revolution after quadrature, of an encoder on a pinion; from 4 to 1e+08.
    pinion_radius_m
        Radius of that pinion; from 0.001 to 10.
    miss_probability
        Probability that a count is missed; from 0 to 0.5.
    rate_hz
        How often it is read; 0 (continuously), or from 1; from 0 to 100000.
    synchronous
        Whether it is read at whole periods instead of on a clock of its own.
    jitter_s
        Jitter of the instant at which it is read; up to a tenth of the period; from 0 to 0.1.
    latency_s
        Time until a reading is known; up to 32 periods; from 0 to 0.1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors.encoder"

    preset: str | None = None
    resolution_m: float | None = None
    counts_per_revolution: float | None = None
    pinion_radius_m: float | None = None
    miss_probability: float | None = None
    rate_hz: float | None = None
    synchronous: bool | None = None
    jitter_s: float | None = None
    latency_s: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Sensors(Table):
    """Sensors of the controller; ideal without a key.

    Attributes
    ----------
    suite
        All sensors by one name; each can be replaced by the keys below.
    gyroscope
        Gyroscope on the block, by name or by table.
    block_accelerometer
        Accelerometers on the block, by name or by table.
    ground_accelerometer
        Accelerometer on the ground, by name or by table.
    encoder
        Encoder on the rack, by name or by table.
    seed
        Seed of errors and noise; from 0; 1 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors"

    suite: str | None = None
    gyroscope: Gyroscope | str | None = None
    block_accelerometer: Accelerometer | str | None = None
    ground_accelerometer: Accelerometer | str | None = None
    encoder: Encoder | str | None = None
    seed: int | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Controller(Table):
    """Controller of the clutches.

    Attributes
    ----------
    rate_hz
        Control ticks a second; from 100 to 100000; 2000.0 by default.
    estimator
        Estimator of the motion; model-aided by default.
    law
        Clutch law; resisting-predicted by default.
    sign_table
        Table of the law "sign-table": bit 4 [θ·v > 0] + 2 [a·v > 0] + [ü_g·v > 0] says whether to engage; 102
        without the key; from 0 to 255.
    latency_s
        Time from a sample to the command at the clutch, without the clutch's own delays; from 0 to 0.1; 0.0
        by default.
    hysteresis
        Width of the hysteresis of signs, in standard deviations of the estimate; from 0 to 10; 1.0 by
        default.
    dwell_s
        Least time between two commands; from 0 to 1; 0.0 by default.
    engaged_at_rest
        Whether both clutches are engaged while the block stands, so that a flywheel resists from the start of
        uplift; true by default.
    safe_state
        State of the clutches after a fault; engaged by default.
    feedback
        What tells the controller which clutches are engaged; position by default.
    closing_lag_s
        Time from a current that engages to a closed clutch, with feedback by current; from 0 to 1; 0.0 by
        default.
    opening_lag_s
        Time from a current that has died to an open clutch, with feedback by current; from 0 to 1; 0.0 by
        default.
    substeps
        Parts of a tick at whose ends the sensors see the motion; from 1 to 64; 4 by default.
    shock_s
        Duration of an impact as sensors see it; from 0 to 0.1; 0.001 by default.
    prelude_s
        Stillness before the motion, for self-test and calibration; from 0 to 60; 2.0 by default.
    belief
        Belief of the controller about the structure, as factors on the truth.
    sensors
        Sensors of the controller; ideal without a key.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller"

    rate_hz: float | None = None
    estimator: Literal["model-aided", "kalman", "complementary"] | None = None
    law: Literal["passive", "always-engaged", "resisting", "resisting-predicted", "sign-table", "gated-table", "look-ahead"] | None = None
    sign_table: int | None = None
    latency_s: float | None = None
    hysteresis: float | None = None
    dwell_s: float | None = None
    engaged_at_rest: bool | None = None
    safe_state: Literal["released", "engaged"] | None = None
    feedback: Literal["position", "current"] | None = None
    closing_lag_s: float | None = None
    opening_lag_s: float | None = None
    substeps: int | None = None
    shock_s: float | None = None
    prelude_s: float | None = None
    belief: Belief | None = None
    sensors: Sensors | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Output(Table):
    """What is kept of a run.

    Attributes
    ----------
    interval_s
        Time between samples of the history; 1/2000 of the run without the key; from 1e-06 to 10.
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


Device = NoDevice | Inerter | ClutchedPair

Motion = Sine | Cosine | HalfSine | Rectangular | Ricker | MavroeidisPapageorgiou
