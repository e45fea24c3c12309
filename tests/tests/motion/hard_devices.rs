//! Motions of real devices in which rounding must not decide.

use std::f64::consts::TAU;

use sprag_ensemble::hybrid::HybridBlock;
use sprag_ensemble::machine::{Registers, shake_hybrid};
use sprag_loops::{Method, hybrid};
use sprag_shared::ground::{AnySegment, DampedOscillation, Harmonics, Ricker};
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{Device, DeviceKind, KinematicsKind};
use sprag_shared::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses};
use sprag_shared::structure::mount::Mount;
use sprag_shared::structure::{Restitution, Structure};
use sprag_sim::batch::case::TIGHT;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::side_by_side::InPieces;
use sprag_sim::simulation::drive::{Course, Overturning};
use sprag_tests::scene_text::runs;

const FREE_TIME: f64 = 6.0;

/// A slender block with a clutched pair at `height` (m).
fn structure(block: (f64, f64), mass_ratio: f64, height: f64, restitution: f64) -> Structure {
    let block = Block::new(block.0, block.1, RECTANGLE_INERTIA_RATIO).unwrap();
    let (kind, kinematics) = (DeviceKind::ClutchedPair, KinematicsKind::Paper);
    let mount = Mount::TyingPoint { height, pulley_ratio: 1.0 };
    Structure {
        geometry: Geometry::Slender,
        device: Device { kind, mass_ratio, mount, kinematics },
        ..Structure::new(block, Restitution::Constant(restitution))
    }
}

fn drivetrain(engagement: Engagement, viscous_rate: f64, actuation: Actuation) -> Drivetrain {
    Drivetrain {
        engagement,
        flywheel: FlywheelLosses { viscous_rate, ..FlywheelLosses::default() },
        actuation,
        ..Drivetrain::default()
    }
}

fn cosine(amplitude: f64, frequency: f64) -> Component {
    Component::pulse(0.37, TAU / frequency, AnySegment::Sine(Harmonics::cosine(amplitude, frequency)))
}

/// State and peaks by the core.
pub(crate) fn follow(course: &Course<'_>, system: &HybridSystem<f64>, tolerance: f64) -> (BlockState<f64>, Peaks<f64>) {
    let (mut state, mut peaks) = (system.at_rest(), Peaks::default());
    course.follow_machine(system, &*hybrid(Method::Adaptive(tolerance)), &mut state, &mut peaks, || true).unwrap();
    (state.motion, peaks)
}

/// Plates that engage at a turn stick there at once, or slip for 1e-19 s before, as rounding has it. The largest |θ̈| is that of the uplift.
#[test]
fn a_mode_that_lasts_no_time_has_no_peak() {
    let structure =
        structure((0.941_411_383_484_243_7, 0.514_799_140_273_519_8), 1.602_311_060_205_757, 1.238_040_854_056_216_4, 0.0);
    let actuation = Actuation { release_delay: 0.1, dwell: 0.1, ..Actuation::default() };
    let system = drivetrain(Engagement::Friction { capacity_ratio: 1.0 }, 30.0, actuation).resolve(&structure, false).unwrap();
    let level = GroundMotion::sum(&[
        cosine(0.519_947_131_676_255_1, 0.071_812_953_939_183_54),
        cosine(0.514_799_191_753_433_9, 89.174_459_631_393_46),
    ]);
    let (_, peaks) = follow(&Course::of(&structure, &level, FREE_TIME, Overturning::Reached), &system, TIGHT);
    let pieces = InPieces::new(&level, None, FREE_TIME);
    let block =
        HybridBlock { system: &system, overturned_at_slenderness: false, ground: pieces.ground(), checks: None, coils: None };
    let in_lanes = shake_hybrid(&[block], Registers::Widest)[0].unwrap().peaks;
    assert!((peaks.acceleration - in_lanes.acceleration).abs() < 1e-9, "{peaks:?} {in_lanes:?}");
    assert!((peaks.rotation - in_lanes.rotation).abs() < 1e-9, "{peaks:?} {in_lanes:?}");
}

/// A flywheel that bearings have slowed down to 1e-18 of what matters is engaged at a turn: it moves the block neither way.
#[test]
fn a_flywheel_slower_than_rounding_turns_no_block() {
    let structure =
        structure((4.126_972_164_363_76, 0.652_362_868_403_324_5), 0.467_935_854_801_109_5, 5.513_473_337_384_140_5, 1.0);
    let actuation = Actuation { delay: Delay::Transport, dwell: 0.1, ..Actuation::default() };
    let system = drivetrain(Engagement::Rigid, 1e4, actuation).resolve(&structure, true).unwrap();
    let wavelet = Ricker { amplitude: -0.652_362_933_639_611_4, rate: 0.322_959_789_895_515_7, centre: 9.289_082_089_663_742 };
    let wavelet = Component::pulse(0.37, 18.578_164_179_327_484, AnySegment::Ricker(wavelet));
    let side = -0.179_430_787_652_432_2;
    let (decay, frequency) = (0.081_654_220_270_291_36, 0.816_542_202_702_913_6);
    let oscillation = DampedOscillation { real: side, imaginary: side, decay, frequency };
    let oscillation = Component::pulse(0.0, 12.0 / frequency, AnySegment::Damped(oscillation));
    let level = [wavelet, cosine(-1.304_725_736_806_649, 7.131_619_111_241_14)];
    let [level, vertical] = GroundMotion::aligned(&level, &[oscillation]);
    let course = Course { vertical: Some(&vertical), ..Course::of(&structure, &level, FREE_TIME, Overturning::Reached) };
    let (state, peaks) = follow(&course, &system, TIGHT);
    for tolerance in [1e-14, 3e-15, 2e-15, 1.1e-15, 9e-16, 1e-16, 1e-17] {
        let (found, other) = follow(&course, &system, tolerance);
        assert_eq!(found.impacts, state.impacts, "{tolerance}");
        assert!((other.rotation - peaks.rotation).abs() <= 1e-9 * peaks.rotation, "{tolerance}: {other:?} {peaks:?}");
        assert!((other.acceleration - peaks.acceleration).abs() <= 1e-9 * peaks.acceleration, "{tolerance}: {other:?} {peaks:?}");
    }
}

/// The last impacts before a rest that is asked for more closely than f32 resolves, of a block that plates hold and let go.
#[test]
fn plates_come_to_rest_in_single_precision() {
    let peak = |accuracy: &str| {
        let text = format!(
            "block = {{ size_m = 0.87, slenderness_deg = 7.0, restitution = 0.65 }}
            device = [{{ kind = 'clutched-pair', mass_ratio = 0.85, clutch = {{ capacity_ratio = 0.14 }},
                flywheel = {{ dry_deceleration_m_s2 = 0.012, brake_deceleration_m_s2 = 'instant' }},
                actuation = {{ release_delay_s = 0.015, rise_time_s = 0.012 }} }}]
            ground = [{{ motion = 'half-sine', amplitude_ratio = 1.2, frequency_ratio = 1.5 }}]
            run = {{ free_time_s = 2.5, rest_speed_ratio = 1e-9 }}
            accuracy = {{ {accuracy} }}"
        );
        runs(&text)[0].peak_rotation.unwrap()
    };
    let exact = peak("");
    for step in [1e-2, 3e-3, 1e-3] {
        let single = peak(&format!("precision = 'f32', method = 'runge-kutta-4', step_ratio = {step}"));
        assert!((single / exact - 1.0).abs() < 1e-3, "{step}: {single} for {exact}");
    }
}
