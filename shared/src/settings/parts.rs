//! Which setting each field of a controller is, said once for both ways: from words to parameters, and back.

use super::limits::DEFAULTS;
use super::{COUNT, Item, Settings};
use crate::control::clutch_position::ClutchLag;
use crate::control::controller::Horizons;
use crate::control::estimation::Estimator;
use crate::control::estimation::complementary::Complementary;
use crate::control::estimation::estimate::Deviation;
use crate::control::estimation::kalman::Kalman;
use crate::control::estimation::model_aided::ModelAided;
use crate::control::estimation::rest_detection::Standing;
use crate::control::law::any_law::ClutchLaw;
use crate::control::law::costate::Costate;
use crate::control::law::look_ahead::LookAhead;
use crate::control::law::minimum_dwell::Gate;
use crate::control::law::{GatedTable, SignTable};
use crate::control::model::{Model, ModelParameters};
use crate::control::monitor::fault::Wheel;
use crate::control::monitor::{EncoderLimits, MonitorParameters, SensorLimits};
use crate::control::sensing::calibration::Plausible;
use crate::control::sensing::instruments::Instruments;
use crate::control::sensing::required::Required;
use crate::control::supervisor::{Parameters, SafeState};
use crate::equation::FullBlock;
use crate::equation::any_body::AnyBody;
use crate::equation::body::{FullBody, SlenderBody};
use crate::equation::lever::TyingPoint;

/// Words that nobody has checked yet; the defaults where nothing is put.
pub(super) struct Draft {
    pub words: [u32; COUNT],
}

impl Draft {
    pub fn new() -> Draft {
        Draft { words: DEFAULTS }
    }

    fn word(&mut self, item: Item, word: u32) {
        if let Some(place) = self.words.get_mut(usize::from(item.index())) {
            *place = word;
        }
    }
}

/// A value that one word holds.
trait Word: Copy {
    fn of(word: u32) -> Self;
    fn word(self) -> u32;
}

/// Each type with its value of a `word`, and the word of a `value`.
macro_rules! words {
    ($($kind:ty: |$word:ident| $of:expr, |$value:ident| $back:expr;)*) => {$(
        impl Word for $kind {
            fn of($word: u32) -> $kind {
                $of
            }

            fn word(self) -> u32 {
                let $value = self;
                $back
            }
        }
    )*};
}

words! {
    f32: |word| f32::from_bits(word), |value| value.to_bits();
    bool: |word| word != 0, |value| value.into();
    u32: |word| word, |value| value;
    u16: |word| word as u16, |value| value.into();
    u8: |word| word as u8, |value| value.into();
    // A negative number becomes one that is refused.
    i32: |word| word as i32, |value| value as u32;
    SafeState: |word| match word {
        0 => SafeState::Released,
        1 => SafeState::Engaged(Wheel::First),
        _ => SafeState::Engaged(Wheel::Second),
    }, |value| match value {
        SafeState::Released => 0,
        SafeState::Engaged(Wheel::First) => 1,
        SafeState::Engaged(Wheel::Second) => 2,
    };
}

/// Where among the settings a `V` stands.
pub(super) trait Place<V> {
    fn read(&self, settings: &Settings) -> V;
    fn put(&self, value: &V, draft: &mut Draft);
}

impl<V: Word> Place<V> for Item {
    fn read(&self, settings: &Settings) -> V {
        V::of(settings.whole(*self))
    }

    fn put(&self, value: &V, draft: &mut Draft) {
        draft.word(*self, value.word());
    }
}

impl<V, P: Place<V>, const N: usize> Place<[V; N]> for [P; N] {
    fn read(&self, settings: &Settings) -> [V; N] {
        self.each_ref().map(|place| place.read(settings))
    }

    fn put(&self, values: &[V; N], draft: &mut Draft) {
        for (place, value) in self.iter().zip(values) {
            place.put(value, draft);
        }
    }
}

/// The limits of a gyroscope or accelerometer, in the order of their fields.
impl Place<SensorLimits> for [Item; 5] {
    fn read(&self, settings: &Settings) -> SensorLimits {
        let [stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time] = Place::<[f32; 5]>::read(self, settings);
        SensorLimits { stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time }
    }

    fn put(&self, limits: &SensorLimits, draft: &mut Draft) {
        let SensorLimits { stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time } = *limits;
        self.put(&[stale_time, stuck_time, stuck_time_moving, full_scale, saturation_time], draft);
    }
}

/// A part of a controller that has settings of its own.
pub(super) trait Part {
    /// What `settings` say that it is.
    fn read(settings: &Settings) -> Self;

    /// Puts it down in `draft`.
    fn put(&self, draft: &mut Draft);
}

/// The place of a [`Part`].
struct Own;

impl<V: Part> Place<V> for Own {
    fn read(&self, settings: &Settings) -> V {
        V::read(settings)
    }

    fn put(&self, value: &V, draft: &mut Draft) {
        value.put(draft);
    }
}

/// Parts, and where each of their fields stands. A field that is forgotten does not compile.
macro_rules! parts {
    ($($part:ident { $($field:tt: $place:expr),* $(,)? })*) => {$(
        impl Part for $part {
            fn read(settings: &Settings) -> $part {
                $part { $($field: $place.read(settings)),* }
            }

            fn put(&self, draft: &mut Draft) {
                $($place.put(&self.$field, draft);)*
            }
        }
    )*};
}

parts! {
    ModelParameters {
        frequency: Item::Frequency,
        frequency_squared: Item::FrequencySquared,
        slenderness: Item::Slenderness,
        size: Item::Size,
        restitution: Item::Restitution,
        uplift: Item::Uplift,
        coupling: Item::Coupling,
        wheels_spin: Item::WheelsSpin,
        decay: Item::Decay,
        drag: Item::Drag,
        stops_at_once: Item::StopsAtOnce,
    }

    ModelAided {
        gains: [[Item::RotationByEncoder, Item::RotationByGyroscope], [Item::VelocityByEncoder, Item::VelocityByGyroscope]],
        blank: Item::Blank,
        jump: Item::Jump,
        standing: Own,
        deviation: Own,
    }
    Kalman {
        gains: [
            [Item::RotationByEncoder, Item::RotationByGyroscope, Item::RotationByAccelerometers],
            [Item::VelocityByEncoder, Item::VelocityByGyroscope, Item::VelocityByAccelerometers],
            [Item::AccelerationByEncoder, Item::AccelerationByGyroscope, Item::AccelerationByAccelerometers],
            [Item::BiasByEncoder, Item::BiasByGyroscope, Item::BiasByAccelerometers],
        ],
        blank: Item::Blank,
        jump: Item::Jump,
        standing: Own,
        deviation: Own,
    }
    Complementary {
        gains: [Item::RotationByEncoder, Item::VelocityByEncoder],
        smoothing: Item::Smoothing,
        blank: Item::Blank,
        standing: Own,
        deviation: Own,
    }
    Standing { rotation: Item::StandingRotation, velocity: Item::StandingVelocity, ticks: Item::StandingTicks }
    Deviation {
        rotation: Item::DeviationRotation,
        velocity: Item::DeviationVelocity,
        push: Item::DeviationPush,
        ground: Item::DeviationGround,
    }

    SignTable { 0: Item::LawTable }
    GatedTable { table: Item::LawTable, row: Item::LawRow, threshold: Item::LawThreshold }
    LookAhead {
        step: Item::LawStep,
        chosen: Item::LawChosen,
        fading: Item::LawFading,
        fading_half: Item::LawFadingHalf,
        margin: Item::LawMargin,
        base: Own,
    }
    Costate {
        rotation: Item::LawRotation,
        curvature: Item::LawCurvature,
        ground: Item::LawGround,
        drift: Item::LawDrift,
        jolt: Item::LawJolt,
        take: Item::LawTake,
        keep: Item::LawKeep,
    }
    Gate { dwell: Item::Dwell }
    ClutchLag { closing: Item::ClosingLag, opening: Item::OpeningLag, closing_time: Item::ClosingTime }
    Horizons { engagement: Item::Horizon, release: Item::ReleaseHorizon }

    Parameters {
        period: Item::Period,
        monitor: Own,
        required: Own,
        safe_state: Item::SafeState,
        both_allowed: Item::BothAllowed,
        self_test_clutches: Item::SelfTestClutches,
        boot_time: Item::BootTime,
        actuator_time: Item::ActuatorTime,
        feedback_time: Item::FeedbackTime,
        stillness_time: Item::StillnessTime,
        calibration_time: Item::CalibrationTime,
        calibration_patience: Item::CalibrationPatience,
        quiet_time: Item::QuietTime,
        recover_after: Item::RecoverAfter,
        plausible: Own,
        shaking: Item::Shaking,
        moving_counts: Item::MovingCounts,
        overrun_ticks: Item::OverrunTicks,
        overrun_limit: Item::OverrunLimit,
        proof_test_interval: Item::ProofTestInterval,
    }
    Required {
        gyroscope: Item::RequiredGyroscope,
        block_accelerometer: Item::RequiredBlockAccelerometer,
        ground_accelerometer: Item::RequiredGroundAccelerometer,
        encoder: Item::RequiredEncoder,
    }
    Plausible { gyroscope: Item::PlausibleGyroscope, accelerometer: Item::PlausibleAccelerometer }
    MonitorParameters {
        gyroscope: [
            Item::GyroscopeStaleTime,
            Item::GyroscopeStuckTime,
            Item::GyroscopeStuckTimeMoving,
            Item::GyroscopeFullScale,
            Item::GyroscopeSaturationTime,
        ],
        block_accelerometer: [
            Item::BlockStaleTime,
            Item::BlockStuckTime,
            Item::BlockStuckTimeMoving,
            Item::BlockFullScale,
            Item::BlockSaturationTime,
        ],
        ground_accelerometer: [
            Item::GroundStaleTime,
            Item::GroundStuckTime,
            Item::GroundStuckTimeMoving,
            Item::GroundFullScale,
            Item::GroundSaturationTime,
        ],
        encoder: Own,
        contradiction_time: Item::ContradictionTime,
        slow_contradiction_time: Item::SlowContradictionTime,
        rest_contradiction_time: Item::RestContradictionTime,
        rest_tolerance: Item::RestTolerance,
        count_tolerance: Item::CountTolerance,
        rate_tolerance: Item::RateTolerance,
        lever_tolerance: Item::LeverTolerance,
        sensor_delay: Item::SensorDelay,
        moving_rate: Item::MovingRate,
        gravity: Item::Gravity,
    }
    EncoderLimits { stale_time: Item::EncoderStaleTime, counts_per_radian: Item::CountsPerRadian, travel: Item::EncoderTravel }
}

/// Choices, and the word of each. All words but those in front are the last choice's.
macro_rules! choices {
    ($($choice:ident by $item:expr => { $($word:literal $name:ident $(($own:ident))?,)* ; $last:literal $other:ident($its:ident) })*) => {$(
        impl Part for $choice {
            fn read(settings: &Settings) -> $choice {
                match settings.whole($item) {
                    $($word => $choice::$name $(({ let $own = Part::read(settings); $own }))?,)*
                    _ => $choice::$other(Part::read(settings)),
                }
            }

            fn put(&self, draft: &mut Draft) {
                let word = match self {
                    $($choice::$name $(($own))? => { $($own.put(draft);)? $word })*
                    $choice::$other($its) => { $its.put(draft); $last }
                };
                draft.word($item, word);
            }
        }
    )*};
}

choices! {
    Estimator by Item::Estimator => { 0 ModelAided(own), 1 Kalman(own), ; 2 Complementary(own) }
    ClutchLaw by Item::Law => {
        0 Passive, 1 AlwaysEngaged, 2 Resisting, 3 ResistingPredicted, 4 SignTable(own), 5 GatedTable(own), 6 LookAhead(own), ;
        7 Costate(own)
    }
}

/// Words of `body`.
const SLENDER: u32 = 0;
const PAPER: u32 = 1;
const CONSISTENT: u32 = 2;

const LEVER: [Item; 2] = [Item::LeverAlong, Item::LeverAcross];

impl Part for AnyBody<f32> {
    fn read(settings: &Settings) -> AnyBody<f32> {
        let [frequency_squared, slenderness] = [Item::FrequencySquared, Item::Slenderness].read(settings);
        let (choice, vertical) = (settings.whole(Item::Body), true);
        if choice == SLENDER {
            let lever = Item::Lever.read(settings);
            return AnyBody::Slender(SlenderBody { frequency_squared, slenderness, lever, vertical });
        }
        let block = FullBlock { frequency_squared, slenderness };
        let ([along, across], consistent) = (LEVER.read(settings), choice == CONSISTENT);
        AnyBody::Full(FullBody { block, lever: TyingPoint { along, across }, consistent, vertical })
    }

    // Frequency and slenderness are those of the model.
    fn put(&self, draft: &mut Draft) {
        let choice = match self {
            AnyBody::Slender(body) => {
                Item::Lever.put(&body.lever, draft);
                SLENDER
            }
            AnyBody::Full(body) => {
                LEVER.put(&[body.lever.along, body.lever.across], draft);
                if body.consistent { CONSISTENT } else { PAPER }
            }
        };
        draft.word(Item::Body, choice);
    }
}

impl Part for Model {
    fn read(settings: &Settings) -> Model {
        Model::of(Part::read(settings), Part::read(settings))
    }

    fn put(&self, draft: &mut Draft) {
        self.body.put(draft);
        self.parameters.put(draft);
    }
}

const FROM_READINGS: [Item; 2] = [Item::Period, Item::TravelPerCount];
const DELAYS: [Item; 3] = [Item::GyroscopeDelay, Item::EncoderDelay, Item::GroundDelay];
const BLOCK_POSITION: [Item; 2] = [Item::BlockAlong, Item::BlockUp];
const TRACKING: [Item; 2] = [Item::TrackingValue, Item::TrackingGrowth];

impl Part for Instruments {
    fn read(settings: &Settings) -> Instruments {
        let [period, travel_per_count] = FROM_READINGS.read(settings);
        let made = Instruments::of_gains(period, travel_per_count, DELAYS.read(settings), TRACKING.read(settings));
        Instruments { block_position: BLOCK_POSITION.read(settings), ..made }
    }

    fn put(&self, draft: &mut Draft) {
        FROM_READINGS.put(&[self.period, self.travel_per_count], draft);
        DELAYS.put(&[self.gyroscope_delay, self.encoder_delay, self.ground_delay], draft);
        TRACKING.put(&self.gains, draft);
        BLOCK_POSITION.put(&self.block_position, draft);
    }
}
