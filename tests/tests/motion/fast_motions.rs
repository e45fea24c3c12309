//! Time has no unit: what is a thousand times as fast is followed as well.

use sprag_loops::{Method, Precision};
use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Geometry;
use sprag_sim::batch::case::{Case, PulseShape, TIGHT};
use sprag_sim::scene::Scene;
use sprag_sim::simulation::DeviceRun;
use sprag_tests::scene_text::{self, IDEAL_DEVICES, RIGID_PAIR};

/// Runs that in units of 1/p are the same for every `p` (1/s).
fn runs(geometry: &str, p: f64) -> Vec<DeviceRun> {
    scene_text::runs(&format!(
        "[block]\nfrequency_parameter_1_s = {p:?}\nslenderness_deg = 10.0\ngeometry = \"{geometry}\"\n{IDEAL_DEVICES}{RIGID_PAIR}\
         [[ground]]\nmotion = \"sine\"\namplitude_ratio = 2.0\nfrequency_ratio = 4.0\n[run]\nfree_time_ratio = 20.0\n"
    ))
}

/// Blocks of 7 km, 0.7 m and 7 µm under pulses of the same ratios.
#[test]
fn self_similar_blocks_move_alike_however_fast() {
    for geometry in ["full", "slender"] {
        let expected = runs(geometry, 1.0);
        assert!(expected.iter().filter(|run| run.outcome == Outcome::Safe && run.impacts > 3).count() >= 2);
        for p in [0.03, 100.0, 1000.0] {
            for (run, expected) in runs(geometry, p).iter().zip(&expected) {
                assert_eq!(
                    (run.outcome, run.impacts),
                    (expected.outcome, expected.impacts),
                    "{geometry} {}: p = {p}",
                    run.device
                );
                let peaks = [(run.peak_rotation, expected.peak_rotation), (run.peak_acceleration, expected.peak_acceleration)];
                for (found, expected) in peaks.into_iter().filter_map(|(found, expected)| found.zip(expected)) {
                    assert!((found / expected - 1.0).abs() < 1e-10, "{geometry} {}: p = {p}: {found} {expected}", run.device);
                }
            }
        }
    }
}

/// The slender block under a sine pulse is linear: with x = |θ|/α and time in 1/p, ẍ = x − 1 + a sin ωt from the instant at which
/// a sin ωt = 1.
#[test]
fn pulses_of_any_frequency_are_those_of_the_closed_form() {
    let tau = core::f64::consts::TAU;
    for (frequency, amplitude) in [(100.0, 500.0), (1000.0, 1e4), (3000.0, 1e5), (10_000.0, 1e6)] {
        let (w, a): (f64, f64) = (frequency, amplitude);
        let uplift = math::asin(1.0 / a) / w;
        let gain = a / (1.0 + w * w);
        let (first, second) = (gain * math::sin(w * uplift) - 1.0, gain * w * math::cos(w * uplift));
        let at = |time: f64| {
            let free = time - uplift;
            let (sinh, cosh) = (math::sinh(free), math::cosh(free));
            let position = 1.0 - gain * math::sin(w * time) + first * cosh + second * sinh;
            let velocity = -gain * w * math::cos(w * time) + first * sinh + second * cosh;
            (position, velocity)
        };
        // The velocity is above 0 in mid-pulse and below at its end, where gravity has had the last word.
        let (mut low, mut high) = (0.5 * tau / w, tau / w);
        assert!(at(low).1 > 0.0 && at(high).1 < 0.0, "{frequency}");
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if at(middle).1 > 0.0 { low = middle } else { high = middle }
        }
        let expected = at(low).0;
        assert!(expected > 0.01 && expected < 0.9, "{frequency}: {expected}");
        let case = Case {
            geometry: Geometry::Slender,
            pulse: PulseShape::Sine,
            frequency_ratio: frequency,
            amplitude_ratio: amplitude,
            free_time: 10.0,
            ..Case::default()
        };
        let result = case.run(&*f64::ideal(Method::Adaptive(TIGHT))).unwrap();
        let found = result.peak_rotation;
        assert!((found / expected - 1.0).abs() < 1e-9, "ω/p = {frequency}: {found}, not {expected}");
    }
}

/// A coarse step of the scheme that looks at events at its end may throw a block over in one go, by thousands of radians: it lies where
/// its fall is decided, with finite numbers.
#[test]
fn a_block_thrown_over_within_one_step_lies_where_it_falls() {
    for method in ["semi-implicit-euler", "runge-kutta-4"] {
        for precision in ["f32", "f64"] {
            for step_s in [0.07, 2.0, 20.0, 206.713_944] {
                let text = format!(
                    "block = {{ frequency_parameter_1_s = 0.14255538702010995, slenderness_deg = 89.999999, restitution = 0.18 }}\n\
                     device = [{{ kind = 'clutched-pair', mass_ratio = 6.7, mount = 'tying-point', mount_height_m = 59.0 }}]\n\
                     ground = [{{ motion = 'sine', amplitude_ratio = 3.46, frequency_ratio = 0.01 }}]\n\
                     accuracy = {{ method = '{method}', step_s = 1.0, precision = '{precision}', events = 'step-end' }}\n\
                     run = {{ free_time_ratio = 0.001 }}"
                );
                let mut scene = Scene::parse(&text, "scene").expect("a scene");
                // Longer than a scene may ask for.
                scene.file.accuracy.step_s = Some(step_s);
                let run = &scene_text::run(&scene)[0];
                assert!(run.outcome.overturned() && run.end_time_s.is_finite(), "{text}\n{step_s} {run:?}");
                for sample in &run.history.samples {
                    assert!(
                        sample.rotation_rad.abs() < 1.6 && sample.acceleration_rad_s2.is_finite(),
                        "{text}\n{step_s} {sample:?}"
                    );
                }
            }
        }
    }
}
