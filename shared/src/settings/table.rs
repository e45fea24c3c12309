//! The parameters, one line each: name, unit, range, default. Their order is that of the words.
//!
//! The defaults are those of a pier of R = 2 m and α = 10° with σ = 0.5 and flywheels that spin down, driven at 2 kHz by the model-aided
//! estimator with the gains of an ICM-42688-P and an encoder of 5 µm, its clutches 5 ms late; what has
//! been commanded stands for as long. The noise of that part's accelerometers, 7 steps in each of two axes, repeats no reading for 4.5 ms;
//! the gyroscope's, 4.5 steps in one axis, would every 16 days, so that it is stuck in motion only.

use core::f32::consts::FRAC_PI_2;

use super::kind::{ABOVE_ZERO, Description, Use, choice, real, switch, whole};

/// Gives every parameter an [`Item`] and a [`Description`].
macro_rules! parameters {
    ($($item:ident $name:literal $description:expr;)*) => {
        /// A parameter; as a number it is the index of its word.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Item {
            $(#[doc = concat!("`", $name, "`.")] $item,)*
        }

        impl Item {
            /// All parameters, in order.
            pub const ALL: [Item; COUNT] = [$(Item::$item),*];
        }

        /// Number of parameters.
        pub const COUNT: usize = [$(Item::$item),*].len();

        /// A constant and no static, so that what is made from it at compile time leaves no names behind.
        pub(super) const TABLE: [Description; COUNT] = [$(Description { name: $name, ..$description }),*];
    };
}

impl Item {
    /// Of its word.
    #[inline]
    pub const fn index(self) -> u16 {
        self as u16
    }
}

const SLENDER: Use = Use::Bodies(0b001);
const FULL: Use = Use::Bodies(0b110);
const MODEL_AIDED_OR_KALMAN: Use = Use::Estimators(0b011);
const KALMAN: Use = Use::Estimators(0b010);
const COMPLEMENTARY: Use = Use::Estimators(0b100);
const TABLES: Use = Use::Laws(0b111_0000);
const GATED: Use = Use::Laws(0b110_0000);
const LOOK_AHEAD: Use = Use::Laws(0b100_0000);
const COSTATE: Use = Use::Laws(0b1000_0000);
const AXES: Description = choice(&["+x", "-x", "+y", "-y", "+z", "-z"], 0).only(Use::Board);

/// Of numbers that nothing but their meaning bounds.
const LARGE: f32 = 1e6;
/// Of gains, whose size goes with powers of the rate, and of counts of the finest encoders.
const GAIN: f32 = 1e12;
/// Of times in ticks that are kept in 16 bits.
const TICKS: u32 = u16::MAX as u32;

const fn gain(unit: &'static str, default: f32) -> Description {
    real(unit, -GAIN, GAIN, default)
}
const fn not_negative(unit: &'static str, default: f32) -> Description {
    real(unit, 0.0, LARGE, default)
}
const fn positive(unit: &'static str, default: f32) -> Description {
    real(unit, ABOVE_ZERO, LARGE, default)
}
const fn duration(most: f32, default: f32) -> Description {
    real("s", ABOVE_ZERO, most, default)
}
const fn span(most: f32, default: f32) -> Description {
    real("s", 0.0, most, default)
}
const fn axis(default: u32) -> Description {
    Description { default, ..AXES }
}

parameters! {
    Body "body" choice(&["slender", "full-paper", "full-consistent"], 2);
    Lever "body.lever" real("", ABOVE_ZERO, 1e3, 1.0).only(SLENDER);
    LeverAlong "body.lever_along" real("", -1e3, 1e3, 1.0).only(FULL);
    LeverAcross "body.lever_across" real("", -1e3, 1e3, 0.0).only(FULL);

    Frequency "model.frequency" real("1/s", 1e-3, 1e3, 1.917_679_3);
    FrequencySquared "model.frequency_squared" real("1/s²", 1e-6, 1e6, 3.677_493_8);
    Slenderness "model.slenderness" real("rad", ABOVE_ZERO, FRAC_PI_2.next_down(), 0.174_532_92);
    Size "model.size" real("m", 1e-3, 1e3, 2.0);
    Restitution "model.restitution" real("", 0.0, 1.0, 0.85);
    Uplift "model.uplift" real("g", ABOVE_ZERO, 1e3, 0.176_326_98);
    Coupling "model.coupling" not_negative("", 0.375);
    WheelsSpin "model.wheels_spin" switch(true);
    Decay "model.decay" not_negative("1/s", 0.05);
    Drag "model.drag" not_negative("1/s²", 2.65);
    StopsAtOnce "model.stops_at_once" switch(false);

    Period "instruments.period" real("s", 1e-5, 0.01, 0.0005);
    TravelPerCount "instruments.travel_per_count" real("", ABOVE_ZERO, 1.0, 2.5e-6);
    GyroscopeDelay "instruments.gyroscope_delay" span(0.1, 5.324_236_5e-4);
    EncoderDelay "instruments.encoder_delay" span(0.1, 0.0);
    GroundDelay "instruments.ground_delay" span(0.1, 5.324_236_5e-4);
    TrackingValue "instruments.tracking_value" real("", 0.0, 1.0, 0.486_582_9);
    TrackingGrowth "instruments.tracking_growth" real("", 0.0, 1.0, 0.080_354_504);

    BlockAlong "instruments.block_along" real("m", -100.0, 100.0, 0.0);
    BlockUp "instruments.block_up" real("m", -100.0, 100.0, 0.0);

    Estimator "estimator" choice(&["model-aided", "kalman", "complementary"], 0);
    RotationByEncoder "estimator.rotation_by_encoder" gain("", 0.287_661_64);
    RotationByGyroscope "estimator.rotation_by_gyroscope" gain("s", 2.167_216e-5).only(MODEL_AIDED_OR_KALMAN);
    RotationByAccelerometers "estimator.rotation_by_accelerometers" gain("s²", 0.0).only(KALMAN);
    VelocityByEncoder "estimator.velocity_by_encoder" gain("1/s", 99.620_54);
    VelocityByGyroscope "estimator.velocity_by_gyroscope" gain("", 0.017_028_436).only(MODEL_AIDED_OR_KALMAN);
    VelocityByAccelerometers "estimator.velocity_by_accelerometers" gain("s", 0.0).only(KALMAN);
    AccelerationByEncoder "estimator.acceleration_by_encoder" gain("1/s²", 0.0).only(KALMAN);
    AccelerationByGyroscope "estimator.acceleration_by_gyroscope" gain("1/s", 0.0).only(KALMAN);
    AccelerationByAccelerometers "estimator.acceleration_by_accelerometers" gain("", 0.0).only(KALMAN);
    BiasByEncoder "estimator.bias_by_encoder" gain("1/s", 0.0).only(KALMAN);
    BiasByGyroscope "estimator.bias_by_gyroscope" gain("", 0.0).only(KALMAN);
    BiasByAccelerometers "estimator.bias_by_accelerometers" gain("s", 0.0).only(KALMAN);
    Smoothing "estimator.smoothing" real("", 0.0, 1.0, 1.0).only(COMPLEMENTARY);
    Blank "estimator.blank" whole("ticks", 0, TICKS, 5);
    Jump "estimator.jump" not_negative("rad/s", 0.033_469_82).only(MODEL_AIDED_OR_KALMAN);
    StandingRotation "estimator.standing.rotation" not_negative("rad", 1.265_482_9e-4);
    StandingVelocity "estimator.standing.velocity" not_negative("rad/s", 0.002_215_856);
    StandingTicks "estimator.standing.ticks" whole("ticks", 0, TICKS, 40);
    DeviationRotation "estimator.deviation.rotation" not_negative("rad", 3.870_707_4e-7);
    DeviationVelocity "estimator.deviation.velocity" not_negative("rad/s", 0.000_201_911_05);
    DeviationPush "estimator.deviation.push" not_negative("1/s²", 0.004_891_986);
    DeviationGround "estimator.deviation.ground" not_negative("g", 0.001_329_863);

    Law "law" choice(
        &["passive", "always-engaged", "resisting", "resisting-predicted", "sign-table", "gated-table", "look-ahead", "costate"],
        3,
    );
    LawTable "law.table" whole("", 0, 255, 0b0100_1110).only(TABLES);
    LawRow "law.row" whole("", 0, 7, 5).only(GATED);
    LawThreshold "law.threshold" not_negative("", 0.8).only(GATED);
    LawStep "law.step" real("1/p", ABOVE_ZERO, 10.0, 0.1).only(LOOK_AHEAD);
    LawChosen "law.chosen" whole("steps", 0, 255, 3).only(LOOK_AHEAD);
    LawFading "law.fading" real("", 0.0, 1.0, 0.716_531_3).only(LOOK_AHEAD);
    LawFadingHalf "law.fading_half" real("", 0.0, 1.0, 0.846_481_7).only(LOOK_AHEAD);
    LawMargin "law.margin" real("", -10.0, 10.0, 0.014).only(LOOK_AHEAD);
    LawRotation "law.rotation" real("", -10.0, 10.0, 0.18).only(COSTATE);
    LawCurvature "law.curvature" real("", -10.0, 10.0, 0.45).only(COSTATE);
    LawGround "law.ground" real("", -10.0, 10.0, -0.41).only(COSTATE);
    LawDrift "law.drift" real("", -10.0, 10.0, 0.73).only(COSTATE);
    LawJolt "law.jolt" real("", -10.0, 10.0, 0.6).only(COSTATE);
    LawTake "law.take" real("", -10.0, 10.0, -0.01).only(COSTATE);
    LawKeep "law.keep" real("", -10.0, 10.0, -0.01).only(COSTATE);

    Horizon "controller.horizon" span(1.0, 0.005_25);
    ReleaseHorizon "controller.release_horizon" span(1.0, 0.005_25);
    Bands "controller.bands" real("", 0.0, 1e3, 1.0);
    EngagedAtRest "controller.engaged_at_rest" switch(true);
    Dwell "controller.gate.dwell" whole("ticks", 0, TICKS, 10);
    ClosingLag "controller.lag.closing" whole("ticks", 0, TICKS, 0);
    OpeningLag "controller.lag.opening" whole("ticks", 0, TICKS, 0);
    ClosingTime "controller.lag.closing_time" span(1.0, 0.0);

    RequiredGyroscope "supervisor.required.gyroscope" switch(true);
    RequiredBlockAccelerometer "supervisor.required.block_accelerometer" switch(false);
    RequiredGroundAccelerometer "supervisor.required.ground_accelerometer" switch(true);
    RequiredEncoder "supervisor.required.encoder" switch(true);
    SafeState "supervisor.safe_state" choice(&["released", "engaged-first", "engaged-second"], 1);
    BothAllowed "supervisor.both_allowed" switch(false);
    SelfTestClutches "supervisor.self_test_clutches" switch(true);
    BootTime "supervisor.boot_time" duration(10.0, 1.0);
    ActuatorTime "supervisor.actuator_time" duration(10.0, 0.03);
    FeedbackTime "supervisor.feedback_time" duration(10.0, 0.003);
    StillnessTime "supervisor.stillness_time" duration(10.0, 0.1);
    CalibrationTime "supervisor.calibration_time" duration(3600.0, 1.0);
    CalibrationPatience "supervisor.calibration_patience" duration(3600.0, 3.0);
    QuietTime "supervisor.quiet_time" duration(3600.0, 2.0);
    RecoverAfter "supervisor.recover_after" duration(3600.0, 1.0);
    PlausibleGyroscope "supervisor.plausible.gyroscope" positive("rad/s", 0.2);
    PlausibleAccelerometer "supervisor.plausible.accelerometer" positive("m/s²", 1.0);
    Shaking "supervisor.shaking" positive("m/s²", 0.3);
    MovingCounts "supervisor.moving_counts" whole("counts", 0, i32::MAX as u32, 2);
    OverrunTicks "supervisor.overrun_ticks" whole("ticks", 1, u32::MAX, 3);
    OverrunLimit "supervisor.overrun_limit" duration(1.0, 0.002);
    ProofTestInterval "supervisor.proof_test_interval" span(1e9, 2_592_000.0);

    GyroscopeStaleTime "monitor.gyroscope.stale_time" duration(10.0, 0.003);
    GyroscopeStuckTime "monitor.gyroscope.stuck_time" span(10.0, 0.0);
    GyroscopeStuckTimeMoving "monitor.gyroscope.stuck_time_moving" span(10.0, 0.004);
    GyroscopeFullScale "monitor.gyroscope.full_scale" positive("rad/s", 8.7);
    GyroscopeSaturationTime "monitor.gyroscope.saturation_time" span(10.0, 0.002);
    BlockStaleTime "monitor.block_accelerometer.stale_time" duration(10.0, 0.003);
    BlockStuckTime "monitor.block_accelerometer.stuck_time" span(10.0, 0.0045);
    BlockStuckTimeMoving "monitor.block_accelerometer.stuck_time_moving" span(10.0, 0.0045);
    BlockFullScale "monitor.block_accelerometer.full_scale" positive("m/s²", 78.0);
    BlockSaturationTime "monitor.block_accelerometer.saturation_time" span(10.0, 0.004);
    GroundStaleTime "monitor.ground_accelerometer.stale_time" duration(10.0, 0.003);
    GroundStuckTime "monitor.ground_accelerometer.stuck_time" span(10.0, 0.0045);
    GroundStuckTimeMoving "monitor.ground_accelerometer.stuck_time_moving" span(10.0, 0.0045);
    GroundFullScale "monitor.ground_accelerometer.full_scale" positive("m/s²", 78.0);
    GroundSaturationTime "monitor.ground_accelerometer.saturation_time" span(10.0, 0.004);
    EncoderStaleTime "monitor.encoder.stale_time" duration(10.0, 0.003);
    CountsPerRadian "monitor.encoder.counts_per_radian" real("counts/rad", -GAIN, GAIN, 398_477.88);
    EncoderTravel "monitor.encoder.travel" whole("counts", 0, i32::MAX as u32, 0);
    ContradictionTime "monitor.contradiction_time" duration(1.0, 0.004);
    SlowContradictionTime "monitor.slow_contradiction_time" duration(1.0, 0.064);
    RestContradictionTime "monitor.rest_contradiction_time" duration(10.0, 0.1);
    RestTolerance "monitor.rest_tolerance" positive("m/s²", 0.5);
    CountTolerance "monitor.count_tolerance" real("counts", 1.0, 1e9, 4.0);
    RateTolerance "monitor.rate_tolerance" not_negative("rad/s", 0.02);
    LeverTolerance "monitor.lever_tolerance" real("", 0.0, 0.9, 0.25);
    SensorDelay "monitor.sensor_delay" span(1.0, 0.002);
    MovingRate "monitor.moving_rate" positive("rad/s", 0.02);
    Gravity "monitor.gravity" positive("m/s²", 9.81);

    CoilPullInTime "board.coil_pull_in_time" span(1.0, 0.02).only(Use::Board);
    CoilHoldShare "board.coil_hold_share" real("", 0.05, 1.0, 0.35).only(Use::Board);
    CoilEngagedCurrent "board.coil_engaged_current" real("A", 0.0, 20.0, 0.2).only(Use::Board);
    CoilFullCurrent "board.coil_full_current" real("A", 0.0, 20.0, 1.2).only(Use::Board);
    CoilSupplyLeast "board.coil_supply_least" real("V", 0.0, 36.0, 21.6).only(Use::Board);
    TemperatureLeast "board.temperature_least" real("°C", -40.0, 125.0, -20.0).only(Use::Board);
    TemperatureMost "board.temperature_most" real("°C", -40.0, 125.0, 70.0).only(Use::Board);
    BlockGyroscopeAxis "board.block_gyroscope_axis" axis(2);
    BlockAlongAxis "board.block_along_axis" axis(0);
    BlockUpAxis "board.block_up_axis" axis(4);
    GroundAlongAxis "board.ground_along_axis" axis(0);
    GroundUpAxis "board.ground_up_axis" axis(4);
    EncoderReversed "board.encoder_reversed" switch(false).only(Use::Board);
}
