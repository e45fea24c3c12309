"""Blocks and devices as frozen values. Made by generate_tables.py from the schema of scenes: do not edit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from .._table import Table


@dataclass(frozen=True, kw_only=True, repr=False)
class Foundation(Table):
    """Compliant base: a spring and a dashpot under each toe; rigid ground without it.

    Attributes
    ----------
    vertical_frequency_hz
        Natural frequency of the block moving up and down on both feet, √(2k/m)/2π. Impacts end: the dashpots
        take what block.restitution took; from 0.5 to 1000.
    damping_ratio
        Damping ratio of that motion, c/√(2km); from 0 to 2.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "block.foundation"

    vertical_frequency_hz: float
    damping_ratio: float


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
    restitution_scatter
        Standard deviation of η from impact to impact: normal about restitution, truncated to 0 < η ≤ 1; from
        0 to 0.5; 0.0 by default.
    restitution_seed
        Seed of what impacts draw; of several specimens that of the first; from 0; 0 by default.
    friction_coefficient
        Coefficient of friction μ under a block without a device, static and kinetic; without it the base
        never slides; above 0, to 10.
    foundation
        Compliant base: a spring and a dashpot under each toe; rigid ground without it.
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
    restitution_scatter: float | None = None
    restitution_seed: int | None = None
    friction_coefficient: float | None = None
    foundation: Foundation | None = None
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
    drag_rate_1_s
        Rate at which drag of an open clutch, rigid or plates with a delay, takes a flywheel to a steady rack:
        e^(−rate t); from 0 to 1000; 0.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.flywheel"

    viscous_rate_1_s: float | None = None
    dry_deceleration_m_s2: float | None = None
    brake_deceleration_m_s2: float | Literal["instant"] | None = None
    drag_rate_1_s: float | None = None


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
    load_friction
        Friction of rack and pinion over the force of a locked flywheel in their mesh; of an inerter, an ideal
        or a rigid clutch; from 0 and below 1.

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
    load_friction: float | None = None


@dataclass(frozen=True, kw_only=True, repr=False)
class Actuation(Table):
    """Delays between a command and a clutch that has obeyed it.

    Attributes
    ----------
    engagement_delay_s
        Time from the command to engagement; in a closed loop below 5 s; from 0 to 10; 0.0 by default.
    release_delay_s
        Time from the command to release; in a closed loop below 5 s; from 0 to 10; 0.0 by default.
    delay
        Kind of these two delays; inertial by default.
    rise_time_s
        Time from first contact to full capacity, linearly; or give time_constant_s. Needs a capacity; from 0
        to 10; 0.0 by default.
    time_constant_s
        Time constant τ of a capacity that rises as 1 − e^(−t/τ), that of a coil; or give rise_time_s. Needs a
        capacity; from 0 to 10; 0.0 by default.
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
    time_constant_s: float | None = None
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
class SupportRecord(Table):
    """Recorded motion of the support itself.

    Attributes
    ----------
    file
        File of the record, relative to the scene.
    units
        Units of a record that does not state its own: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
    time_step_s
        Time step of a record that does not state its own; from 1e-05 to 1.
    component
        Component of a record file with several.
    resample_to_s
        Time step to which the record is resampled linearly; from 1e-05 to 1.
    scale
        Factor on the record; from -1000 to 1000; 1.0 by default.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "device.support_record"

    file: str
    units: str | None = None
    time_step_s: float | None = None
    component: str | None = None
    resample_to_s: float | None = None
    scale: float | None = None


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
        Acceleration of the terminals; "consistent" for flywheels that keep their speed, and clutches that
        follow a support; paper by default.
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
    inertance_corner_hz
        Corner f_c of an inertance that falls as 1/√(1 + (f/f_c)²), by viscous slip; in the place of
        engagement and clutch; above 0, to 1000.
    weight
        Gravitational mass of the device, and what it rides on.
    support_amplification
        Horizontal acceleration of the support that carries the device over the ground's; 1 where it moves
        with the ground; from -10 to 10; 1.0 by default.
    support_frequency_hz
        Natural frequency of a support that is a damped oscillator on the ground, so heavy that the device
        does not move it; from 0.1 to 1000.
    support_damping_ratio
        Damping ratio of the oscillator that the support is; from 0.005 to 0.9.
    support_record
        Recorded motion of the support itself.

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
    inertance_corner_hz: float | None = None
    weight: Weight | None = None
    support_amplification: float | None = None
    support_frequency_hz: float | None = None
    support_damping_ratio: float | None = None
    support_record: SupportRecord | None = None


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
        Acceleration of the terminals; "consistent" for flywheels that keep their speed, and clutches that
        follow a support; paper by default.
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
    inertance_corner_hz
        Corner f_c of an inertance that falls as 1/√(1 + (f/f_c)²), by viscous slip; in the place of
        engagement and clutch; above 0, to 1000.
    weight
        Gravitational mass of the device, and what it rides on.
    support_amplification
        Horizontal acceleration of the support that carries the device over the ground's; 1 where it moves
        with the ground; from -10 to 10; 1.0 by default.
    support_frequency_hz
        Natural frequency of a support that is a damped oscillator on the ground, so heavy that the device
        does not move it; from 0.1 to 1000.
    support_damping_ratio
        Damping ratio of the oscillator that the support is; from 0.005 to 0.9.
    support_record
        Recorded motion of the support itself.

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
    inertance_corner_hz: float | None = None
    weight: Weight | None = None
    support_amplification: float | None = None
    support_frequency_hz: float | None = None
    support_damping_ratio: float | None = None
    support_record: SupportRecord | None = None


Device = NoDevice | Inerter | ClutchedPair
