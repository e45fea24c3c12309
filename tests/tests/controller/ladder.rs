//! A sensor that is lost in mid-swing: another one stands in for it, and the law continues.

use sprag_report::progress::Progress;
use sprag_sim::interrupt::Interrupt;
use sprag_studies::loop_study::bench::Conditions;
use sprag_studies::loop_study::losses::{LOSSES, losses, pulses};
use sprag_studies::statistics::quantile;

/// Two of three give the rate: gyroscope, encoder's derivative, and the accelerometers by the equation of motion.
#[test]
fn any_one_sensor_lost_in_mid_swing_costs_less_than_five_percent() {
    let interrupt = Interrupt::default();
    let compared = losses(&pulses(), &Progress::new("runs"), &Conditions::new(None, &interrupt)).unwrap();
    let median = |index: usize| quantile(&compared[index].changes, 0.5).unwrap();
    for (index, (name, ..)) in LOSSES.iter().enumerate() {
        println!("{name}: median {:+.2} %, overturned {}", 100.0 * median(index), compared[index].overturned);
    }
    for (index, (name, _, _)) in LOSSES.iter().enumerate().take(6) {
        assert!(compared[index].changes.len() > 20, "{name}");
        assert!(median(index).abs() < 0.05, "{name}: {}", median(index));
        assert!(compared[index].overturned <= 1, "{name}: {}", compared[index].overturned);
    }
    let (engaged, released) = (6, 7);
    assert!(compared[engaged].overturned <= compared[released].overturned);
    assert!(median(engaged) < median(released), "one engaged {} and both released {}", median(engaged), median(released));
}
