//! The block of the paper's section 6.2 (α = 10°, R = 2 m, σ = 0.5) under every recorded motion, with all three devices.
//!
//! `cargo test -p sprag-tests --test motion recorded_motions -- --ignored --nocapture` prints the reductions of peak rotation under the
//! pulse-like motions beside the paper's.

use std::path::Path;

use sprag_shared::observers::outcome::Outcome;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::simulation::{DeviceRun, simulate};
use sprag_tests::records::{RecordedMotion, recorded_motions};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/record.toml");

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
#[ignore = "needs the recorded motions beside the repository: run by cargo xtask test"]
fn every_recorded_motion_is_simulated_with_all_three_devices() {
    let mut counted = 0;
    let mut ratios: [[Vec<f64>; 2]; 2] = Default::default();
    let mut overturned = [0; 3];
    for motion in &recorded_motions() {
        let overrides = motion.unsaid_units().map_or_else(Vec::new, |units| {
            vec![format!("ground.0.units={units}"), format!("ground.0.time_step_s={}", motion.time_step_s)]
        });
        let mut scene = Scene::load(Path::new(SCENE), &overrides).unwrap_or_else(|error| panic!("{error}"));
        scene.use_record(&motion.path).unwrap();
        let ground = scene.ground_motions().unwrap_or_else(|error| panic!("{error}"));
        let runs = simulate(&scene, &ground, &Interrupt::default()).unwrap_or_else(|error| panic!("{}: {error}", motion.name));
        let [none, single, pair] = runs.as_slice() else { panic!("three devices") };
        check(motion, &runs, ground.horizontal.peak_m_s2() / 9.806_65 > scene.uplift_threshold());
        if motion.pulse_like {
            counted += 1;
            for (count, run) in overturned.iter_mut().zip(&runs) {
                *count += usize::from(run.outcome.overturned());
            }
            for (index, run) in [single, pair].into_iter().enumerate() {
                if let (Some(bare), Some(protected)) = (none.peak_rotation, run.peak_rotation)
                    && none.outcome == Outcome::Safe
                {
                    ratios[0][index].push(protected / bare);
                }
                if let (Some(bare), Some(protected)) = (none.peak_acceleration, run.peak_acceleration)
                    && none.outcome == Outcome::Safe
                {
                    ratios[1][index].push(protected / bare);
                }
            }
        }
    }
    println!(
        "{counted} pulse-like motions; overturned: none {}, single {}, pair {}",
        overturned[0], overturned[1], overturned[2]
    );
    let papers = [("peak rotation", "30 % and 55 % lower"), ("peak angular acceleration", "25 % lower and no gain")];
    for ((quantity, paper), [single, pair]) in papers.into_iter().zip(&mut ratios) {
        println!(
            "{quantity}, median over {} that stay up: single {:.0} % lower, pair {:.0} % lower (the paper: {paper})",
            single.len(),
            100.0 * (1.0 - median(single)),
            100.0 * (1.0 - median(pair)),
        );
    }
    assert!(counted > 60, "{counted} pulse-like motions");
    // What the paper concludes, as directions: an inerter lowers the rotation, a clutched pair lowers it further.
    assert!(median(&mut ratios[0][0]) < 0.9 && median(&mut ratios[0][1]) < median(&mut ratios[0][0]));
}

/// What holds for any motion: the block uplifts exactly when the peak exceeds the threshold, and every sample is finite.
fn check(motion: &RecordedMotion, runs: &[DeviceRun], uplifts: bool) {
    for run in runs {
        assert_eq!(run.outcome != Outcome::NoRocking, uplifts, "{}: {} {}", motion.name, run.device, run.outcome);
        assert!(
            run.history.samples.iter().all(|s| s.rotation_rad.is_finite() && s.velocity_rad_s.is_finite()),
            "{}",
            motion.name
        );
        assert!(run.history.samples.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s), "{}", motion.name);
        assert!(run.outcome.overturned() || run.peak_rotation.is_some_and(|peak| peak < 1.5), "{}", motion.name);
    }
}
