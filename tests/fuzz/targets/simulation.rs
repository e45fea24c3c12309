//! Whole simulations of random scenes: whatever a scene may ask for, a run neither panics nor hangs, every number of its
//! result and history is finite, and the outcome agrees with what happened.
#![no_main]

#[path = "simulation/draw.rs"]
mod draw;
#[path = "simulation/random_scene.rs"]
mod random_scene;

use draw::Draw;
use libfuzzer_sys::{Corpus, fuzz_target};
use sprag_shared::motion::state::Stopped;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::drivetrain::Engagement;
use sprag_sim::ground_motion::{Component, GroundMotion};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::simulation::{DeviceRun, RunError, simulate};

/// Steps of a fixed length, or periods of the fastest part, that one run may take.
const MOST_STEPS: f64 = 10_000.0;

/// Samples of a record.
const MOST_SAMPLES: usize = 32;

fuzz_target!(|input: &[u8]| -> Corpus {
    let mut draw = Draw(input);
    let text = random_scene::text(&mut draw);
    let mut scene = match Scene::parse(&text, "scene.toml") {
        Ok(scene) => scene,
        Err(error) => {
            one_line(&error.to_string());
            return Corpus::Reject;
        }
    };
    let ground =
        if draw.seldom(3) { records(&mut draw, &scene) } else { scene.ground_motions().map_err(|error| error.to_string()) };
    let ground = match ground {
        Ok(ground) => ground,
        Err(error) => {
            one_line(&error);
            return Corpus::Reject;
        }
    };
    let rings = scene.file.device.iter().filter_map(|device| device.support_oscillator()).map(|support| support.rings_for());
    let shaking = ground.horizontal.duration() + rings.fold(0.0, f64::max);
    if !bounded(&mut scene, shaking) {
        return Corpus::Reject;
    }
    match simulate(&scene, &ground, &Interrupt::default()) {
        Ok(runs) => {
            for (index, run) in runs.iter().enumerate() {
                // An oscillating support rings on after the ground.
                let of_device = ground.of_device(&scene, index).expect("a run has its motion");
                check(run, of_device.horizontal.duration() + scene.free_time_s(), &text);
            }
        }
        Err(error) => {
            one_line(&error.to_string());
            // A fixed step may be too long for what it has to follow; a step of the series' own choice never is.
            let own_step = scene.file.accuracy.step_s.is_none();
            let not_finite = matches!(error, RunError::Stopped { error: Stopped::NotFinite { .. }, .. });
            assert!(!(own_step && not_finite), "{error}\n{text}");
        }
    }
    Corpus::Keep
});

fn one_line(message: &str) {
    assert!(!message.contains('\n'), "an error of several lines: {message}");
}

/// A small record, and half of it vertically where the scene has a vertical motion.
fn records(draw: &mut Draw<'_>, scene: &Scene) -> Result<GroundMotions, String> {
    let step = draw.number(1e-5, 1.0);
    let peak = draw.number(1e-2, 1e2) * scene.uplift_threshold();
    let count = 2 + draw.below(MOST_SAMPLES - 1);
    let samples: Vec<f64> = (0..count).map(|_| peak * draw.share()).collect();
    let horizontal = [Component::record(0.0, step, samples.iter().copied())];
    if scene.file.vertical.is_empty() {
        return Ok(GroundMotions::of(GroundMotion::sum(&horizontal), None));
    }
    let vertical = Component::record(0.0, step, samples.iter().map(|sample| 0.5 * sample / peak));
    let [horizontal, vertical] = GroundMotion::aligned(&horizontal, &[vertical]);
    Ok(GroundMotions::of(horizontal, Some(vertical)))
}

/// Makes a run over `shaking` (s) short enough, if it can be done with its free time and its step.
fn bounded(scene: &mut Scene, shaking: f64) -> bool {
    let p = scene.block.frequency_parameter();
    let longest = MOST_STEPS / fastest(scene);
    if shaking > longest {
        return false;
    }
    scene.file.run.free_time_s = Some(scene.free_time_s().min(longest));
    scene.file.run.free_time_ratio = None;
    if let Some(step) = scene.file.accuracy.step(p) {
        scene.file.accuracy.step_s = Some(step.max((shaking + scene.free_time_s()) / MOST_STEPS));
        scene.file.accuracy.step_ratio = None;
    }
    true
}

/// The fastest rate of the block and its devices, 1/s.
fn fastest(scene: &Scene) -> f64 {
    let devices = scene.devices.iter().zip(&scene.file.device).map(|(device, table)| {
        let (train, sigma) = (&device.drivetrain, device.device.mass_ratio);
        let clutch = match train.engagement {
            // Block and flywheel against each other.
            Engagement::Elastic { stiffness, damping, .. } => {
                (stiffness * (1.0 + 1.0 / sigma)).sqrt() + damping * (1.0 + 1.0 / sigma)
            }
            Engagement::Viscous { corner_frequency } => core::f64::consts::TAU * corner_frequency * (1.0 + sigma),
            _ => 0.0,
        };
        // A clutch that answers late may switch as often as it can.
        let answer = train.actuation.engagement_delay + train.actuation.release_delay + train.actuation.dwell;
        let chatter = if answer > 0.0 { 1.0 / answer } else { 0.0 };
        let support = table.support_oscillator().map_or(0.0, |support| core::f64::consts::TAU * support.frequency_hz);
        support + clutch + chatter + train.rack.viscous + train.flywheel.viscous_rate + train.flywheel.drag_rate * (1.0 + 2.0 * sigma)
    });
    devices.fold(scene.block.frequency_parameter(), f64::max)
}

fn check(run: &DeviceRun, end: f64, text: &str) {
    let results = [run.peak_rotation, run.peak_acceleration, run.first_impact_time_s, Some(run.end_time_s), run.peak_force_ratio];
    assert!(results.iter().flatten().all(|number| number.is_finite() && *number >= 0.0), "{results:?}\n{text}");
    for sample in &run.history.samples {
        let numbers = [sample.time_s, sample.ground_m_s2, sample.rotation_rad, sample.velocity_rad_s, sample.acceleration_rad_s2];
        assert!(numbers.iter().chain(&sample.force_ratio).all(|number| number.is_finite()), "{sample:?}\n{text}");
    }
    assert!(run.history.samples.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s), "time runs back\n{text}");
    assert!(run.history.impacts_s.iter().all(|time| time.is_finite()), "{text}");
    let late = end * (1.0 + 1e-6);
    assert!(
        run.end_time_s <= late && run.first_impact_time_s.is_none_or(|time| time <= late),
        "{} s, not {end} s\n{text}",
        run.end_time_s
    );
    assert_eq!(run.peak_rotation.is_some(), run.outcome.stands(), "{text}");
    assert_eq!(run.impacts > 0, run.first_impact_time_s.is_some(), "{text}");
    match run.outcome {
        Outcome::NoRocking => assert_eq!((run.impacts, run.peak_rotation), (0, Some(0.0)), "{text}"),
        Outcome::OverturnedWithoutImpact => assert_eq!(run.impacts, 0, "{text}"),
        // An impact too weak to count is one, too.
        Outcome::OverturnedAfterImpact | Outcome::Safe | Outcome::LiftedOff => {}
    }
    if let Some(energy) = &run.energy {
        assert!(energy.entries.residual.is_finite(), "{:?}\n{text}", energy.entries);
    }
    if let Some(demand) = &run.checks {
        let numbers = [demand.friction_needed, demand.smallest_vertical_reaction_ratio, demand.force_ratio, demand.stroke_m];
        assert!(numbers.iter().flatten().all(|number| number.is_finite()), "{demand:?}\n{text}");
        demand.warnings.iter().for_each(|warning| one_line(warning));
    }
}
