//! Clutches that are known by the currents of their coils, which go before the armatures.

use sprag_report::progress::Progress;
use sprag_sim::interrupt::Interrupt;
use sprag_studies::loop_study::bench::{Conditions, EQUATION_10, Variant, each, run_ideal, run_loop};
use sprag_studies::loop_study::losses::pulses;
use sprag_studies::loop_study::practice::Comparison;

/// A clutch of 20 ms: its current is there after 2 ms, the armature 18 ms later; released, 2 ms after the current has died.
#[test]
fn lags_that_are_known_make_the_current_as_good_as_a_switch() {
    let (progress, interrupt) = (Progress::new("runs"), Interrupt::default());
    let conditions = Conditions::new(None, &interrupt);
    let motions = pulses();
    let ideals = each(&motions, &[Variant::new("ideal", &[])], &progress, |m, v| run_ideal(m, v, &conditions)).unwrap();
    let variant = |name: &str, more: &[&str]| {
        let mut keys = vec![EQUATION_10, "controller.sensors.suite=\"icm-42688-p\"", "controller.latency_s=0.02"];
        keys.extend(more);
        Variant::new(name, &keys)
    };
    let current = ["controller.feedback=\"current\"", "controller.closing_lag_s=0.018", "controller.opening_lag_s=0.018"];
    let variants = [
        variant("switch", &[]),
        variant("current, lags known", &current),
        variant("current for position", &[&current[..], &["controller.belief.lag_factor=0.0"]].concat()),
    ];
    let loops = each(&motions, &variants, &progress, |m, v| run_loop(m, v, &conditions)).unwrap();
    let sizes: Vec<(f64, f64)> = loops
        .iter()
        .zip(&variants)
        .map(|(loops, variant)| {
            let comparison = Comparison::of(loops, &ideals[0]);
            let (median, high) = (100.0 * comparison.size(0.5), 100.0 * comparison.size(0.95));
            println!("{}: median {median:.3} %, 95th percentile {high:.2} %, overturned {}", variant.name, comparison.overturned);
            (median, high)
        })
        .collect();
    assert!((sizes[1].0 - sizes[0].0).abs() < 0.05 && (sizes[1].1 - sizes[0].1).abs() < 1.0, "{sizes:?}");
    assert!(sizes[2].1 > sizes[0].1, "{sizes:?}");
}
