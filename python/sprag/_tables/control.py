"""Controllers and their sensors as frozen values. Made by generate_tables.py from the schema of scenes: do not edit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from .._table import Table


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
        How often it is read; 0 (continuously), or from 5; from 0 to 100000.
    synchronous
        Whether it is read at whole periods instead of on a clock of its own.
    jitter_s
        Jitter of the instant at which it is read; up to a tenth of the period; from 0 to 0.1.
    latency_s
        Time until a reading is known; up to 32 periods, or substeps of a tick where it is read continuously;
        from 0 to 0.1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors.gyroscope"

    preset: Literal["ideal", "icm-42688-p", "bmi088", "adis16470", "mpu-6050"] | None = None
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
        Time until a reading is known; up to 32 periods, or substeps of a tick where it is read continuously;
        from 0 to 0.1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors.block_accelerometer"

    preset: Literal["ideal", "icm-42688-p", "bmi088", "adis16470", "adxl355", "mpu-6050"] | None = None
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
        Travel per count, such that 32 bits count the rack's travel at θ = 2α; or give counts_per_revolution
        and pinion_radius_m; from 1e-09 to 0.01.
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
        Time until a reading is known; up to 32 periods, or substeps of a tick where it is read continuously;
        from 0 to 0.1.

    Raises
    ------
    InputError
        For a value outside its range.
    """

    _path: ClassVar[str] = "controller.sensors.encoder"

    preset: Literal["ideal", "lm10", "lm10-1um", "lm10-10um", "amt102-v"] | None = None
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

    suite: Literal["ideal", "icm-42688-p", "bmi088", "adis16470", "mpu-6050"] | None = None
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
        Least time between two commands; up to 65535 ticks; from 0 to 1; 0.0 by default.
    engaged_at_rest
        Whether both clutches are engaged while the block stands, so that a flywheel resists from the start of
        uplift; true by default.
    safe_state
        State of the clutches after a fault; engaged by default.
    feedback
        What shows the controller which clutches are engaged; position by default.
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
    law: (
        Literal["passive", "always-engaged", "resisting", "resisting-predicted", "sign-table", "gated-table", "look-ahead", "costate"]
        | None
    ) = None
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
