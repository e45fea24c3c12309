//! Zeros that move: of the encoder by temperature, over a reset, or unknown from the start; and biases that drift.

use super::*;
use crate::control::monitor::fault::Fault;
use crate::control::sensing::sensor::Sensor;
use crate::math::sine32::sin_cos;

/// α, rad.
const SLENDERNESS: f32 = 0.174_532_92;

impl Bench {
    fn lose(&mut self, counts: i32) -> Decision {
        self.spoilt(|sample| sample.encoder.counts = sample.encoder.counts.wrapping_sub(counts))
    }
}

/// Changes of the command, and ticks that do not stand, of a block at rest while `spoil` is given how many ticks it has been so.
fn at_rest(ticks: u32, spoil: impl Fn(&mut Sample, u32)) -> (u32, u32) {
    let mut bench = Bench::armed();
    bench.ticks(4000);
    let (mut changes, mut moved, mut last) = (0, 0, bench.device.decision().command);
    for tick in 0..ticks {
        let now = bench.spoilt(|sample| spoil(sample, tick));
        changes += u32::from(now.command != last);
        moved += u32::from(!now.estimate.standing || now.phase != Phase::Armed);
        last = now.command;
    }
    (changes, moved)
}

#[test]
fn a_rack_that_creeps_moves_no_block() {
    for counts in [4, -4, 5, 20, -20, 100] {
        // Within ten seconds, and then for fifty.
        let creep = |sample: &mut Sample, tick: u32| {
            sample.encoder.counts += counts * i32::try_from(tick.min(20_000)).unwrap() / 20_000;
        };
        assert_eq!(at_rest(120_000, creep), (0, 0), "{counts}");
    }
}

/// ±100 µm, ±0.025 °/s and ±0.75 mg: what steel of a metre and an ICM-42688-P make of some kelvin in an hour.
#[test]
fn an_hour_of_rest_with_drift_changes_no_command() {
    let drift = |sample: &mut Sample, tick: u32| {
        let share = sin_cos(tick as f32 * (core::f32::consts::TAU / 7.2e6)).0;
        sample.encoder.counts += (20.0 * share) as i32;
        sample.gyroscope.value += 4.4e-4 * share;
        for reading in sample.block_accelerometer.iter_mut().chain(&mut sample.ground_accelerometer) {
            reading.value += 7.4e-3 * share;
        }
    };
    assert_eq!(at_rest(7_200_000, drift), (0, 0));
}

/// What a motion comes to after its counts were lost.
#[derive(Debug)]
struct Healed {
    /// Half-cycles until the zero was within 0.5 % of α for good, or until half a second of rest.
    half_cycles: u32,
    /// Worst error of θ in control, and at the end, in α.
    worst: f32,
    last: f32,
    stands: bool,
}

/// Until long after the ground has stopped. The estimate is `off` by that many counts.
fn heal(bench: &mut Bench, counts: i32) -> Healed {
    let mut healed = Healed { half_cycles: 0, worst: 0.0, last: 0.0, stands: false };
    let (mut impacts, mut side) = (0, bench.rig.rotation >= 0.0);
    for tick in 0..24_000 {
        bench.rig.shakes = tick < 9000;
        let decision = bench.lose(counts);
        let now = bench.rig.rotation >= 0.0;
        impacts += u32::from(now != side && tick > 0);
        side = now;
        let error = bench.errors()[0] / SLENDERNESS;
        let estimate = decision.estimate;
        if !estimate.standing && error > 5e-3 {
            healed.half_cycles = impacts + 1;
        }
        if estimate.located(SLENDERNESS) && matches!(decision.phase, Phase::Armed | Phase::Rocking) {
            healed.worst = healed.worst.max(error);
        }
        healed.last = error;
        healed.stands = estimate.standing;
    }
    healed
}

#[test]
fn counts_lost_over_a_reset_are_found_at_an_impact() {
    for phase in 0..20 {
        for boot in [4, 40, 100, 280] {
            let mut bench = Bench::rocking();
            bench.ticks(100 + 37 * phase);
            let retained = Retained::of(&bench.device.retained().words(0)).unwrap();
            let mut again = Bench { rig: bench.rig.clone(), ..Bench::with(bench.device.settings(), Some(&retained)) };
            let before = again.rig.sample().encoder.counts;
            for _ in 0..boot {
                again.rig.sample();
                again.rig.advance([false; 2]);
            }
            let lost = again.rig.clone().sample().encoder.counts - before;
            let healed = heal(&mut again, lost);
            // To the impact and, seen in two readings, a millisecond on; or to a later one, where earlier ones came while a clutch engaged.
            assert!(healed.half_cycles <= 4 && healed.last < 1e-3, "phase {phase}, {boot} ticks: {lost} counts, {healed:?}");
            assert!(healed.stands, "phase {phase}, {boot} ticks: {lost} counts, {healed:?}");
        }
    }
}

#[test]
fn power_that_comes_back_in_motion_finds_its_zero() {
    for phase in 0..20 {
        let mut bench = Bench::rocking();
        bench.ticks(100 + 37 * phase);
        let mut cold = Bench { rig: bench.rig.clone(), ..Bench::new() };
        let first = cold.rig.clone().sample().encoder.counts;
        let healed = heal(&mut cold, first);
        // Where nobody knows the rotation the law does not decide by it.
        assert!(healed.worst < 5e-3 && healed.half_cycles <= 3, "phase {phase}: {first} counts, {healed:?}");
        assert!(healed.stands, "phase {phase}: {first} counts, {healed:?}");
    }
}

/// Its counts stay in motion and go on from elsewhere; before it is calibrated anew the ground shakes again.
#[test]
fn an_encoder_that_is_taken_again_is_off_until_an_impact_or_a_rest_shows_its_zero() {
    for (counts, rested) in [(4000, 20), (-4000, 200), (12_000, 600), (-12_000, 1500)] {
        let mut bench = Bench::rocking();
        let stuck = bench.rig.clone().sample().encoder.counts;
        for _ in 0..200 {
            bench.spoilt(|sample| sample.encoder.counts = stuck);
        }
        assert_eq!(bench.device.decision().fault, Some(Fault::Stuck(Sensor::Encoder)));
        bench.rig.shakes = false;
        assert!((0..60_000).any(|_| bench.lose(counts).phase == Phase::Calibrate), "{:?}", bench.device.decision());
        for _ in 0..rested {
            assert_eq!(bench.lose(counts).phase, Phase::Calibrate);
        }
        let (mut decided, mut worst) = (0, 0.0_f32);
        for tick in 0..20_000 {
            bench.rig.shakes = tick < 9000;
            let Decision { phase, estimate, .. } = bench.lose(counts);
            if matches!(phase, Phase::Armed | Phase::Rocking) && estimate.located(SLENDERNESS) {
                decided += u32::from(!estimate.standing);
                worst = worst.max(bench.errors()[0] / SLENDERNESS);
            }
        }
        assert!(decided > 1000 && worst < 5e-3, "{counts} counts, {rested} ticks: {decided} ticks, off by {worst}");
    }
}
