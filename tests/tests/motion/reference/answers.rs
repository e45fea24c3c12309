//! Answers that are known: closed forms of the slender block, the paper's Figure 5, and two scenes that an independent C++ program
//! had solved before.

use std::f64::consts::LN_2;
use std::path::Path;

use sprag_reference::guard::Guard;
use sprag_reference::scene::Scene;
use sprag_reference::simulate::{Run, run};

fn of(text: &str) -> Run {
    let scene = Scene::parse(text).expect("a scene");
    run(&scene, 0, Path::new(".")).expect("a run")
}

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} ± {tolerance}");
}

/// A slender block of p = 1 and α = 0.1 rad with a device and a motion.
fn slender(device: &str, motion: &str, free: f64) -> String {
    format!(
        "[block]\nfrequency_parameter_1_s = 1\nslenderness_deg = {}\ngeometry = \"slender\"\n{device}\n{motion}\n\
         [run]\nfree_time_s = {free}\n",
        0.1_f64.to_degrees()
    )
}

#[test]
fn free_rocking_has_housners_period_and_amplitudes() {
    let block = "restitution = 0.9\ninitial_rotation_ratio = 0.5\n[[device]]\nkind = \"none\"";
    let run = of(&slender(block, "", 12.0));
    let times = |guard: Guard| run.events.iter().filter(move |event| event.1 == guard).map(|event| event.0);
    let quarter = |amplitude: f64| (1.0 / (1.0 - amplitude)).acosh();
    // Each half swing is a quarter of the period before and one of the period after an impact.
    let mut time = quarter(0.5);
    let mut expected = Vec::new();
    for impact in 1..=5 {
        expected.push(time);
        let amplitude = 1.0 - (1.0 - 0.9_f64.powi(2 * impact) * (1.0 - 0.25)).sqrt();
        time += 2.0 * quarter(amplitude);
    }
    for (found, expected) in times(Guard::Impact).zip(expected) {
        near(found, expected, 1e-10);
    }
    assert!(times(Guard::Impact).count() > 5);
}

#[test]
fn pulses_overturn_from_the_amplitudes_of_the_closed_forms_on() {
    let none = "[[device]]\nkind = \"none\"";
    let overturns = |motion: &str| of(&slender(none, motion, 8.0)).outcome == "overturned-without-impact";
    let rectangle =
        |duration: f64| format!("[[ground]]\nmotion = \"rectangular\"\namplitude_ratio = 2\nduration_ratio = {duration}");
    assert!(!overturns(&rectangle(LN_2 - 1e-4)) && overturns(&rectangle(LN_2 + 1e-4)));
    for (shape, ratio, boundary) in [("half-sine", 4.0, 2.790_798_0), ("sine", 3.0, 3.631_149_9), ("cosine", 2.0, 5.225_828_5)] {
        let pulse = |amplitude: f64| {
            format!("[[ground]]\nmotion = \"{shape}\"\namplitude_ratio = {amplitude}\nfrequency_ratio = {ratio}")
        };
        assert!(!overturns(&pulse(boundary * (1.0 - 1e-4))), "{shape} below");
        assert!(overturns(&pulse(boundary * (1.0 + 1e-4))), "{shape} above");
    }
}

#[test]
fn figure_5_has_its_peaks() {
    let motion = "[[ground]]\nmotion = \"sine\"\namplitude_ratio = 1.5\nfrequency_ratio = 4";
    for (device, peak) in [
        ("kind = \"none\"", 0.4082),
        ("kind = \"inerter\"\nmass_ratio = 0.5", 0.2728),
        ("kind = \"clutched-pair\"\nmass_ratio = 0.5", 0.2372),
    ] {
        near(of(&slender(&format!("[[device]]\n{device}"), motion, 10.0)).peak / 0.1, peak, 5e-5);
    }
}

#[test]
fn a_flywheel_at_rest_receives_the_reaction_of_rising_plates() {
    // An independent program has found these peaks, and 1e-9 m/s² of bearing friction may not matter.
    for (rise, expected) in [(0.02, 0.816), (0.05, 0.801), (0.1, 0.778)] {
        let [without, with] = ["", ", dry_deceleration_m_s2 = 1e-9"].map(|dry| {
            let scene = format!(
                "[block]\nsize_m = 2.6\nslenderness_deg = 9.0\ngeometry = \"slender\"\n[[device]]\nkind = \"clutched-pair\"\n\
                 mass_ratio = 0.7\nclutch = {{ capacity_ratio = 0.08 }}\n\
                 flywheel = {{ brake_deceleration_m_s2 = \"instant\"{dry} }}\nactuation = {{ rise_time_s = {rise} }}\n\
                 [[ground]]\nmotion = \"cosine\"\namplitude_ratio = 1.7\nfrequency_ratio = 2.2\n[run]\nfree_time_s = 6\n"
            );
            of(&scene).peak / 9.0_f64.to_radians()
        });
        near(without, expected, 1e-3);
        near(with, without, 1e-7);
    }
}

#[test]
fn a_second_uplift_is_pushed_by_flywheels_that_still_spin() {
    let run = of("[block]\nsize_m = 2\nslenderness_deg = 10\n[[device]]\nkind = \"clutched-pair\"\nmass_ratio = 0.5\n\
        clutch = { capacity_ratio = 0.01 }\n[[ground]]\nmotion = \"sine\"\namplitude_ratio = 1.8\nfrequency_hz = 1.4\n\
        [[ground]]\nmotion = \"sine\"\namplitude_ratio = 1.05\nfrequency_hz = 0.5\nstart_s = 9\n[run]\nfree_time_s = 6\n\
        [output]\ninterval_s = 0.001\n");
    let second = run.samples.iter().filter(|sample| sample[0] > 9.0).map(|sample| sample[1].abs()).fold(0.0, f64::max);
    near(second / 10.0_f64.to_radians(), 0.016_65, 2e-5);
}
