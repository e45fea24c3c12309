//! A day of microtremor, and long records: time is counted, so nothing drifts.

use core::f32::consts::TAU;

use sprag_case::{Case, FixedMethod, Ground, Initially};
use sprag_shared::ground::{GroundSegment, Linear};
use sprag_shared::math::scalar::Real;
use sprag_shared::method::fixed::{FixedStep, Scheme};
use sprag_shared::motion::ideal::IdealSystem;
use sprag_shared::motion::observer::{Event, Observer};
use sprag_shared::motion::state::{BlockState, Limits, Phase};
use sprag_shared::observers::digest::Digest;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_shared::structure::drivetrain::Drivetrain;
use sprag_stability::{Dice, Precision, in_both_precisions, unit_block};

in_both_precisions!(a_day_of_microtremor);

/// Samples of an hour at 200 Hz.
const HOUR: usize = 3_600 * 200;

/// The sampling interval, s.
const INTERVAL: f64 = 0.005;

/// An hour of noise of at most 0.6 thresholds that starts and ends at zero, with a knock of 1.4 thresholds every 200 s.
fn hour() -> Vec<f64> {
    let mut dice = Dice(24);
    let mut samples: Vec<f64> = (0..HOUR).map(|_| 0.6 * (2.0 * dice.roll() - 1.0)).collect();
    for knock in (20_000..HOUR).step_by(40_000) {
        for (k, sample) in samples[knock..knock + 40].iter_mut().enumerate() {
            *sample = 1.4 * sprag_shared::math::sin(std::f64::consts::TAU * k as f64 / 40.0);
        }
    }
    samples[0] = 0.0;
    samples
}

/// What an hour left: its events by whole sample and local time, and the digest of all that happened in it.
#[derive(Default)]
struct Watch<S> {
    sample: usize,
    digest: Digest,
    uplifts: Vec<(usize, S)>,
    rests: u32,
}

impl<S: Precision> Observer<S> for Watch<S> {
    fn event(&mut self, event: Event, time: S, state: &BlockState<S>) {
        match event {
            Event::Uplift => self.uplifts.push((self.sample, time)),
            Event::Rest => self.rests += 1,
            _ => {}
        }
        self.digest.event(event, time, state);
    }
}

fn day<S: Precision>(system: &IdealSystem<S>, samples: &[S]) -> Vec<(BlockState<S>, Watch<S>)> {
    let method = FixedStep { scheme: Scheme::RungeKutta4, step: S::of(INTERVAL) };
    let limits = Limits { overturned: S::ONE, events: 1_000 };
    let mut state = BlockState::default();
    let mut hours = Vec::new();
    for _ in 0..24 {
        let mut watch = Watch::default();
        for k in 0..HOUR {
            watch.sample = k;
            let line = Linear::between(samples[k], samples[(k + 1) % HOUR], S::of(INTERVAL));
            system
                .advance(&method, &mut state, &line, S::of(INTERVAL), &limits, &mut watch)
                .unwrap_or_else(|stopped| panic!("{stopped} at sample {k}"));
        }
        hours.push((state, watch));
        // Each hour counts its own impacts.
        state.impacts = 0;
    }
    hours
}

/// 17,280,000 samples, the same hour 24 times. The block starts each hour standing, so each must be the first one to the last bit,
/// with every uplift where the record passes the threshold: no time is lost, no angle is left over.
fn a_day_of_microtremor<S: Precision>() {
    let structure = unit_block(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, 0.6);
    let threshold = structure.geometry.uplift_threshold(structure.block.slenderness());
    let noise = hour();
    let samples: Vec<S> = noise.iter().map(|&ratio| S::of(ratio * threshold)).collect();
    let hours = day(&structure.resolve().expect("parameters within range"), &samples);
    let (first_end, first) = &hours[0];
    // Each knock passes the threshold once each way; the second may find the block still rocking.
    assert!(first.uplifts.len() >= 18 && first.uplifts.len() <= 36, "{:?}", first.uplifts.len());
    for &(k, time) in &first.uplifts {
        let (from, to) = (noise[k].abs(), noise[k + 1].abs());
        let exact = if from > 1.0 { 0.0 } else { INTERVAL * (1.0 - from) / (to - from) };
        assert!((time.to_f64() - exact).abs() < S::tolerance(1e-14, 1e-7), "{}: {time:?} for {exact}", S::NAME);
    }
    for (index, (end, hour)) in hours.iter().enumerate() {
        assert_eq!((end.phase, end.rotation, end.velocity), (Phase::Rest, S::ZERO, S::ZERO), "{} hour {index}", S::NAME);
        assert_eq!(hour.uplifts.len(), hour.rests as usize, "{} hour {index}", S::NAME);
        assert_eq!(
            (end, hour.digest.hash(), &hour.uplifts),
            (first_end, first.digest.hash(), &first.uplifts),
            "{} hour {index}",
            S::NAME
        );
    }
    println!("{}: {} uplifts in each of 24 hours, to the same bits", S::NAME, first.uplifts.len());
}

/// f32 sums of 5 ms stop at 2¹⁷ s and are wrong long before; the case counts. A pulse after 10,000 s of quiet: the first impact
/// and the end come out at their time, to an ulp of it.
#[test]
fn a_case_keeps_the_time_of_a_long_record() {
    let structure = unit_block(Geometry::Full, 10.0, DeviceKind::Inerter, 0.5, 0.7);
    let pulse: Vec<u32> = (0..=200).map(|k| (0.5 * (TAU * k as f32 / 200.0).sin_cos_of_phase().0).to_bits()).collect();
    let run = |quiet: usize| {
        let samples: Vec<u32> = std::iter::repeat_n(0, quiet).chain(pulse.iter().copied()).collect();
        let case = Case {
            structure,
            drivetrain: Drivetrain::default(),
            initially: Initially::Rest,
            method: FixedMethod::RungeKutta4,
            step: 0.005,
            ground: Ground::Record { interval: 0.005, samples: &samples, vertical: None },
            free_time: 30.0,
        };
        case.run(&mut ()).unwrap_or_else(|error| panic!("{error}")).peaks
    };
    let (soon, late) = (run(0), run(2_000_000));
    for (soon, late) in [(soon.first_impact, late.first_impact), (soon.ended, late.ended)] {
        let (soon, late) = (soon.expect("an event"), late.expect("an event"));
        assert!((late - (10_000.0 + soon)).abs() < 3e-3, "{late} for {}", 10_000.0 + soon);
    }
    assert_eq!(soon.rotation.to_bits(), late.rotation.to_bits());
}

/// Over a sample a standing block does nothing, whatever the step.
#[test]
fn a_standing_block_costs_a_few_looks_at_the_ground() {
    use std::cell::Cell;
    struct Looked(Linear<f32>, Cell<u32>);
    impl GroundSegment<f32> for Looked {
        fn acceleration(&self, time: f32) -> f32 {
            self.1.set(self.1.get() + 1);
            self.0.acceleration(time)
        }

        fn slope(&self, time: f32) -> f32 {
            GroundSegment::slope(&self.0, time)
        }

        fn gain(&self, time: f32) -> f32 {
            GroundSegment::gain(&self.0, time)
        }

        fn curvature_bound(&self) -> f32 {
            0.0
        }

        fn series(&self, time: f32, coefficients: &mut [f32]) {
            self.0.series(time, coefficients);
        }
    }
    let structure = unit_block(Geometry::Full, 10.0, DeviceKind::ClutchedPair, 0.5, 0.6);
    let system = structure.resolve().expect("parameters within range");
    let piece = Looked(Linear::between(0.05, -0.07, 0.005), Cell::new(0));
    let limits = Limits { overturned: 1.0, events: 10 };
    let mut state = BlockState::default();
    let method = FixedStep { scheme: Scheme::RungeKutta4, step: 1e-4 };
    system.advance(&method, &mut state, &piece, 0.005, &limits, &mut ()).expect("rest");
    assert_eq!(state, BlockState::default());
    // Both thresholds at the start and the end, whatever the step.
    assert!(piece.1.get() <= 8, "{} looks", piece.1.get());
}
