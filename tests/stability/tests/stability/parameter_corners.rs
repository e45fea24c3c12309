//! The corners of the parameter space, and its inside at random.

use core::f64::consts::TAU;

use sprag_shared::math::{asin, exp, pow, square_root};
use sprag_shared::motion::state::Phase;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
use sprag_shared::structure::device::{DeviceKind, KinematicsKind};
use sprag_stability::{Dice, GEOMETRIES, Outcome, Precision, Segment, Start, Stepping, Tally, in_both_precisions, unit_block};

in_both_precisions!(every_corner, random_points_inside, corners_in_fixed_steps);

/// A place in the parameter space.
#[derive(Clone, Copy, Debug)]
struct Place {
    geometry: Geometry,
    device: DeviceKind,
    kinematics: KinematicsKind,
    /// α, rad.
    slenderness: f64,
    /// R, m.
    size: f64,
    /// σ.
    mass_ratio: f64,
    /// Amplitude over the uplift threshold.
    amplitude: f64,
    /// ω/p.
    frequency: f64,
}

impl Place {
    fn structure(&self) -> Structure {
        let block = Block::new(self.size, self.slenderness, RECTANGLE_INERTIA_RATIO).expect("within range");
        let mut structure = Structure { block, ..unit_block(self.geometry, 10.0, self.device, self.mass_ratio, 0.9) };
        structure.device.kinematics = self.kinematics;
        structure
    }

    /// One sine pulse and 15/p after it. Steps are given in 1/p.
    fn run<S: Precision>(&self, stepping: impl Fn(f64) -> Stepping<S>) -> Outcome<S> {
        let structure = self.structure();
        let p = structure.block.frequency_parameter();
        let level = S::of(structure.geometry.uplift_threshold(structure.block.slenderness())) * S::of(self.amplitude);
        let stepping = stepping(1.0 / p);
        let mut tally = Tally::new();
        match stepping {
            // Bounded by what a step is wrong by instead.
            Stepping::SemiImplicitEuler(_) => tally.floor = f64::INFINITY,
            // An excess of 1e-12 (f32: 2e-7) is a bracket of a few ulps: the four slopes of a step round to a θ that is not smooth.
            Stepping::RungeKutta4(_) => tally.floor = 1e-4 / S::EPSILON.to_f64(),
            _ => {}
        }
        let pulse = Segment::sine(level, S::of(self.frequency * p), S::of(TAU / (self.frequency * p)));
        S::tally(&structure, stepping, Start::Rest, &[pulse, Segment::quiet(S::of(15.0 / p))], tally)
    }

    /// Whether the slender block with one p throughout overturns without an impact: √(β² − 1) − β e^{−(p/ω)(2π − asin 1/β)} > ω/p
    /// with its p_σ. None within `margin` of the boundary, or where the criterion does not hold.
    fn overturns_at_once(&self, margin: f64) -> Option<bool> {
        if self.geometry == Geometry::Full || self.device == DeviceKind::ClutchedPair {
            return None;
        }
        let k = if self.device == DeviceKind::None { 0.0 } else { 0.75 * self.mass_ratio };
        let (b, frequency) = (self.amplitude, self.frequency * square_root(1.0 + k));
        let left = square_root((b - 1.0) * (b + 1.0)) - b * exp(-(TAU - asin(1.0 / b)) / frequency);
        ((left / frequency - 1.0).abs() > margin).then_some(left > frequency)
    }

    fn check<S: Precision>(&self, run: &Outcome<S>, steps: u64) {
        let (end, tally) = (run.end(), &run.tally);
        tally.assert_sane(steps, 20_000);
        let alpha = self.slenderness;
        assert!(tally.peaks.rocked, "{} {self:?}", S::NAME);
        if self.amplitude < 1.0 + 1e-5 {
            // It hardly leaves the floor.
            assert!(
                end.phase != Phase::Overturned && tally.peaks.rotation.to_f64() < 1e-3 * alpha,
                "{} {self:?} {end:?}",
                S::NAME
            );
        }
        if let Some(overturns) = self.overturns_at_once(1e-4) {
            let found = end.phase == Phase::Overturned && end.impacts == 0;
            // 15/p is not enough for a heavy inerter to get past α, nor to come back.
            let slow = self.device == DeviceKind::Inerter && self.mass_ratio > 2.0;
            assert!(found == overturns || slow, "{} {self:?}: {end:?}", S::NAME);
        }
    }
}

fn corners<S: Precision>() -> Vec<Place> {
    let mut places = Vec::new();
    for geometry in GEOMETRIES {
        for device in DeviceKind::ALL {
            for slenderness in [1e-4, 60.0_f64.to_radians()] {
                for size in [0.01, 100.0] {
                    for mass_ratio in [0.0, 1.0, 1000.0] {
                        if device == DeviceKind::None && mass_ratio > 0.0 {
                            continue;
                        }
                        for amplitude in [1.0 + S::tolerance(1e-12, 2e-7), 2.0, 1000.0] {
                            for frequency in [0.01, 1.0, 100.0] {
                                for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
                                    let place = Place {
                                        geometry,
                                        device,
                                        kinematics,
                                        slenderness,
                                        size,
                                        mass_ratio,
                                        amplitude,
                                        frequency,
                                    };
                                    places.push(place);
                                }
                            }
                        }
                    }
                }
            }
        }
    }
    places
}

fn every_corner<S: Precision>() {
    let mut most = (0, 0);
    let places = corners::<S>();
    for place in &places {
        let run = place.run::<S>(|_| Stepping::Tight);
        place.check(&run, 60_000);
        most = (most.0.max(run.tally.steps), most.1.max(run.tally.total()));
    }
    println!("{}: {} corners, at most {} steps and {} events each", S::NAME, places.len(), most.0, most.1);
}

fn random_points_inside<S: Precision>() {
    let mut dice = Dice(8);
    let mut overturned = 0;
    for _ in 0..1_000 {
        let mut power = |low: f64, high: f64| low * pow(high / low, dice.roll());
        let (slenderness, size) = (power(1e-4, 1.047), power(0.01, 100.0));
        let (mass_ratio, excess, frequency) = (power(1e-3, 1e3), power(S::tolerance(1e-12, 1e-6), 999.0), power(0.01, 100.0));
        let mut one_of = |count: f64| (dice.roll() * count) as usize;
        let place = Place {
            geometry: GEOMETRIES[one_of(2.0)],
            device: DeviceKind::ALL[one_of(3.0)],
            kinematics: [KinematicsKind::Paper, KinematicsKind::Consistent][one_of(2.0)],
            slenderness,
            size,
            mass_ratio,
            amplitude: 1.0 + excess,
            frequency,
        };
        let run = place.run::<S>(|_| Stepping::Tight);
        place.check(&run, 60_000);
        overturned += u32::from(run.end().phase == Phase::Overturned);
    }
    assert!((50..950).contains(&overturned), "{overturned} of 1000 overturn");
}

/// In steps of 0.02/p and 0.002/p, whatever the pulse: at 100 times the threshold and ω/p = 100 a step is a third of the pulse.
fn corners_in_fixed_steps<S: Precision>() {
    let mut deepest = 0.0_f64;
    for place in corners::<S>() {
        // A pulse of 628/p takes 31,400 steps of 0.02/p.
        let steps = (TAU / place.frequency + 15.0) / 0.02;
        let run = place.run::<S>(|unit| Stepping::RungeKutta4(S::of(0.02 * unit)));
        run.tally.assert_sane(steps as u64 + 4_000, 20_000);
        run.end();
        let run = place.run::<S>(|unit| Stepping::SemiImplicitEuler(S::of(0.02 * unit)));
        run.tally.assert_sane(steps as u64 + 4_000, 20_000);
        run.end();
        // θ of a step is wrong by up to θ̈ h²; so is where the step finds the floor.
        let step = 0.02 / place.structure().block.frequency_parameter();
        let error = run.tally.peaks.acceleration.to_f64() * step * step;
        deepest = deepest.max(run.tally.reach / error);
        assert!(run.tally.reach <= error, "{} {place:?}: {:?}", S::NAME, run.tally);
    }
    println!("{}: Euler steps reach below the floor by at most {deepest:.1e} of their error", S::NAME);
}
