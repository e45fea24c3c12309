//! The controller in closed loop: its limit, its worth with real sensors, its faults.

use sprag_report::progress::Progress;
use sprag_shared::equation::clutch_rule::wheel_for;
use sprag_shared::motion::state::Phase;
use sprag_sim::closed_loop::decisions::Decisions;
use sprag_sim::closed_loop::failing::{ALL, Failing, Part};
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::run::Tick;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::controller::{EstimatorName, LawName};
use sprag_studies::loop_study::bench::{Conditions, EQUATION_10, Variant, each, run_ideal, run_loop, with_loop};
use sprag_studies::loop_study::faults::{self, INSTANTS, Instant};
use sprag_studies::loop_study::ideal_limit;
use sprag_studies::loop_study::motion::{Motion, grid};
use sprag_studies::loop_study::practice::Comparison;

fn quiet() -> (Progress, Interrupt) {
    (Progress::new("runs"), Interrupt::default())
}

/// Ideal sensors, no delay: the error against the ideal pair, whose switches are located, shrinks with the first power of the control
/// period or faster.
#[test]
fn the_loop_converges_to_the_ideal_pair_at_first_order() {
    let (progress, interrupt) = quiet();
    let conditions = Conditions::new(None, &interrupt);
    let motions = ideal_limit::standing(&conditions).unwrap();
    assert!(motions.len() >= 5);
    let ideals = each(&motions, &[Variant::new("ideal", &[])], &progress, |m, v| run_ideal(m, v, &conditions)).unwrap();
    for estimator in EstimatorName::ALL {
        let rates = [500.0, 2000.0, 8000.0];
        let variants = rates.map(|rate| ideal_limit::variant(estimator, rate));
        let loops = each(&motions, &variants, &progress, |m, v| run_loop(m, v, &conditions)).unwrap();
        let points: Vec<(f64, f64)> =
            rates.iter().zip(&loops).map(|(rate, loops)| (1.0 / rate, ideal_limit::error(loops, &ideals[0]))).collect();
        let order = ideal_limit::order(&points);
        assert!(order > 0.8, "{}: order {order}, {points:?}", estimator.name());
        assert!(points[2].1 < 5e-4, "{}: {points:?}", estimator.name());
    }
}

/// A sample of `sprag loop-study practice`: real gyroscope and accelerometers, 2 kHz, 1 ms.
#[test]
fn with_real_sensors_the_loop_is_as_good_as_the_ideal_pair() {
    let (progress, interrupt) = quiet();
    let conditions = Conditions::new(None, &interrupt);
    let mut motions = Vec::new();
    for shape in ["sine", "cosine"] {
        for (frequency, amplitude) in
            [(1.0, 1.3), (1.5, 1.6), (2.0, 1.8), (3.0, 2.5), (4.0, 3.2), (5.0, 3.6), (6.0, 5.0), (3.5, 2.0)]
        {
            motions.push(Motion::Pulse { shape, frequency, amplitude });
        }
    }
    let ideals = each(&motions, &[Variant::new("ideal", &[])], &progress, |m, v| run_ideal(m, v, &conditions)).unwrap();
    for estimator in EstimatorName::ALL {
        let real = Variant::new(
            estimator.name(),
            &[
                EQUATION_10,
                &format!("controller.estimator=\"{}\"", estimator.name()),
                "controller.sensors.suite=\"adis16470\"",
                "controller.latency_s=0.001",
            ],
        );
        let loops = each(&motions, &[real], &progress, |m, v| run_loop(m, v, &conditions)).unwrap();
        let comparison = Comparison::of(&loops[0], &ideals[0]);
        assert!(comparison.changes.len() >= 8, "{comparison:?}");
        assert!(comparison.size(0.5) < 0.01 && comparison.size(0.95) < 0.05, "{}: {comparison:?}", estimator.name());
        assert_eq!(comparison.overturned, 0);
        for closed in loops[0].iter().filter(|closed| !closed.outcome.overturned()) {
            assert_eq!(closed.ending.faults, [], "false alarms");
        }
    }
}

/// The same seed gives the same run to the last bit, another seed another one; threads do not matter.
#[test]
fn a_run_is_its_seed() {
    let (progress, interrupt) = quiet();
    let conditions = Conditions::new(None, &interrupt);
    let motion = [Motion::Pulse { shape: "sine", frequency: 4.0, amplitude: 3.0 }];
    let variant = |seed| Variant { seed, ..Variant::new("real", &["controller.sensors.suite=\"icm-42688-p\""]) };
    let variants = [variant(1), variant(2), variant(1)];
    let run = |threads| {
        let pool = rayon_pool(threads);
        pool.install(|| each(&motion, &variants, &progress, |m, v| run_loop(m, v, &conditions)).unwrap())
    };
    let (one, two) = (run(1), run(2));
    let bits = |results: &[Vec<_>], index: usize| -> u64 {
        let closed: &sprag_studies::loop_study::bench::LoopResult = &results[index][0];
        closed.peak.to_bits()
    };
    assert_eq!(bits(&one, 0), bits(&one, 2));
    assert_ne!(bits(&one, 0), bits(&one, 1));
    for index in 0..3 {
        assert_eq!(bits(&one, index), bits(&two, index));
    }
}

/// What the law would want of the true motion, and of a standing block, is worked out only for those who look at it, and changes nothing else.
/// The law's memory of the ground goes on while nobody looks.
#[test]
fn whoever_looks_at_what_the_law_would_want_changes_nothing() {
    let interrupt = Interrupt::default();
    let conditions = Conditions::new(None, &interrupt);
    // The block stands for a while on a ground that moves, and again in the end.
    let motion = Motion::Pulse { shape: "sine", frequency: 1.0, amplitude: 1.5 };
    for law in ["always-engaged", "gated-table", "look-ahead"] {
        let variant = Variant::new(law, &[&format!("controller.law=\"{law}\""), "controller.rate_hz=500.0"]);
        let alone = with_loop(&motion, &variant, &conditions, |task| Ok(task.answered::<()>()?.2)).unwrap();
        let judged = with_loop(&motion, &variant, &conditions, |task| Ok(task.answered::<Decisions>()?.2)).unwrap();
        let seen = with_loop(&motion, &variant, &conditions, |task| Ok(task.answered::<Vec<Tick>>()?.2)).unwrap();
        let decisions = Decisions::of(&seen.ticks, seen.ending.motion.phase == Phase::Overturned);
        assert_eq!((judged.ticks.report(), judged.ticks.delays()), (decisions.report(), decisions.delays()), "{law}");
        for looped in [&alone.extremes, &judged.extremes] {
            assert_eq!(looped.peaks.rotation.to_bits(), seen.extremes.peaks.rotation.to_bits(), "{law}");
        }
        // Clutches switch in a fall too.
        assert_eq!(alone.ending.engagements, Decisions::of(&seen.ticks, false).report().switches.div_ceil(2), "{law}");
        let rests = |tick: &&Tick| tick.plant.motion.phase == Phase::Rest;
        let at_rest: Vec<bool> = seen.ticks.iter().filter(rests).map(|tick| tick.ideal).collect();
        assert!(at_rest.len() > 50 && at_rest.len() + 50 < seen.ticks.len(), "{law}: {} of {}", at_rest.len(), seen.ticks.len());
        assert!(law != "always-engaged" || at_rest.iter().all(|ideal| *ideal));
    }
}

/// A clutch with a jolt, flywheels braked at 2 m/s² once released, 3 ms from sample to clutch.
const BRAKED: [&str; 8] = [
    "block.slenderness_deg=20.0",
    "device.0.engagement=\"rigid\"",
    "device.0.flywheel.viscous_rate_1_s=0.05",
    "device.0.flywheel.brake_deceleration_m_s2=2.0",
    "device.0.actuation.engagement_delay_s=0.002",
    "device.0.actuation.release_delay_s=0.002",
    "controller.rate_hz=1000.0",
    "controller.latency_s=0.001",
];

/// Every tick of a loop, and its largest |θ|/α.
fn watched(motion: &Motion, variant: &Variant) -> (Vec<Tick>, f64) {
    let (_, interrupt) = quiet();
    with_loop(motion, variant, &Conditions::new(None, &interrupt), |task| {
        let (mut ticks, mut extremes) = (Vec::new(), Extremes::default());
        task.run(&mut extremes, &mut ticks)?;
        Ok((ticks, extremes.peaks.rotation / task.scene.block.slenderness()))
    })
    .unwrap()
}

/// The noise of a block at rest decides nothing: both flywheels wait, and under every specimen of the sensors and either sign of the motion
/// the one of the first motion's direction keeps its turn, the other one is let go before the block has got anywhere. So a pulse between
/// outcomes has one outcome.
#[test]
fn the_first_motion_decides_which_flywheel_resists() {
    for law in ["resisting-predicted", "gated-table"] {
        let mut outcomes = Vec::new();
        for (seed, amplitude) in (1..=8).flat_map(|seed| [(seed, 7.97), (seed, -7.97)]) {
            let noisy = ["controller.sensors.suite=\"adis16470\"", &format!("controller.law=\"{law}\"")];
            let variant = Variant { seed, ..Variant::new(law, &[&BRAKED[..], &noisy].concat()) };
            let (ticks, peak) = watched(&Motion::Pulse { shape: "sine", frequency: 4.73, amplitude }, &variant);
            assert_eq!(ticks[0].plant.engaged, [true; 2]);
            let single = ticks.iter().find(|tick| tick.plant.engaged != [true; 2]).unwrap();
            let wheel = wheel_for(single.plant.motion.side);
            assert!(single.plant.engaged[wheel] && !single.plant.engaged[1 - wheel], "{law}, seed {seed}: {single:?}");
            assert!(single.plant.motion.rotation.abs() < 1e-3, "{law}, seed {seed}: {single:?}");
            let both = |tick: &&Tick| tick.plant.time > single.plant.time && tick.decision.command == [true; 2];
            assert!(!ticks.iter().filter(both).any(|tick| !tick.decision.estimate.standing));
            outcomes.push(peak > 2.0);
        }
        assert!(outcomes.iter().all(|outcome| *outcome == outcomes[0]), "{law}: {outcomes:?}");
    }
}

/// With sensors without an error a mirrored motion is a mirrored run: side, clutches and all.
#[test]
fn a_mirrored_motion_has_a_mirrored_run() {
    for shape in ["sine", "cosine"] {
        // `costate` reads the rotation, whose last bits at an impact are not mirrored where a motion has died to 1e-8 rad.
        let variant = Variant::new("mirrored", &BRAKED).with(EQUATION_10);
        let [one, other] = [3.0, -3.0].map(|amplitude| watched(&Motion::Pulse { shape, frequency: 4.0, amplitude }, &variant).0);
        assert_eq!(one.len(), other.len());
        for (one, other) in one.iter().zip(&other) {
            let ([first, second], motion) = (one.decision.command, other.plant.motion);
            assert_eq!([second, first], other.decision.command, "{shape} at {} s", one.plant.time);
            assert!((one.plant.motion.rotation + motion.rotation).abs() < 1e-9, "{shape} at {} s", one.plant.time);
        }
    }
}

fn rayon_pool(threads: usize) -> rayon::ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap()
}

/// Every class of fault at rest, at uplift, in mid-swing and at an impact: detected in time, and harmless.
#[test]
fn faults_are_detected_and_do_no_harm() {
    let (progress, interrupt) = quiet();
    let conditions = Conditions::new(None, &interrupt);
    let results = faults::results(&progress, &conditions).unwrap();
    for (failing, row) in ALL.iter().zip(&results) {
        for (instant, result) in INSTANTS.iter().zip(row) {
            assert_eq!(result.harm, [false; 3], "{failing:?} {instant:?}: {result:?}");
            if *failing == Failing::Contradicts(Part::Ground) && *instant != Instant::Rest {
                // Nothing else measures the ground: a bias that begins in motion is indistinguishable from ground motion until all is still.
                continue;
            }
            let (time, _) = result.detected.clone().unwrap_or_else(|| panic!("{failing:?} {instant:?} is not detected"));
            // What cannot be known at once: a count that stays at rest until the block moves; an encoder that runs backwards likewise; a
            // bias of the ground's accelerometer, which is distinguished from shaking after 100 ms at rest; a clutch that disobeys until it is
            // commanded otherwise. A gyroscope's bias in motion takes the slow window.
            let exempt =
                matches!(failing, Failing::Stuck(Part::Encoder) | Failing::Contradicts(_) | Failing::Refuses | Failing::Sticks);
            assert!(exempt || time <= 0.005, "{failing:?} {instant:?}: {time} s");
        }
    }
    let stuck = ALL.iter().position(|failing| *failing == Failing::Stuck(Part::Encoder)).unwrap();
    for result in &results[stuck][2..] {
        assert!(result.detected.clone().unwrap().0 <= 0.005, "an encoder that is stuck in motion");
    }
}

/// Sine pulses at which other laws save blocks that Eq. 10 does not, in the ideal model.
#[test]
fn there_are_better_laws_than_eq_10_under_sine_pulses() {
    let (progress, interrupt) = quiet();
    let conditions = Conditions::new(None, &interrupt);
    let motions = grid("sine", 10, (0.5, 7.5), (1.5, 9.5));
    let variants = [LawName::Resisting, LawName::AlwaysEngaged, LawName::GatedTable, LawName::LookAhead].map(|law| {
        Variant::new(
            law.name(),
            &[
                "block.slenderness_deg=20.0",
                "controller.rate_hz=500.0",
                "controller.shock_s=0.0",
                "controller.hysteresis=0.0",
                &format!("controller.law=\"{}\"", law.name()),
            ],
        )
    });
    let results = each(&motions, &variants, &progress, |m, v| run_loop(m, v, &conditions)).unwrap();
    let overturned: Vec<usize> =
        results.iter().map(|results| results.iter().filter(|result| result.outcome.overturned()).count()).collect();
    let best_known = overturned[0].min(overturned[1]);
    for (law, count) in variants.iter().zip(&overturned).skip(2) {
        assert!(10 * count <= 9 * best_known, "{}: {count} against {best_known}: {overturned:?}", law.name);
    }
}
