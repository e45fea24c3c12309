//! What `sprag accuracy` finds must be what theory says: orders with and without located events, closed forms to rounding, f32 where it ends.

use std::path::Path;

use sprag_report::progress::Progress;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;
use sprag_sim::scene::accuracy::EventTreatment;
use sprag_studies::accuracy_study::row::{Row, order};
use sprag_studies::accuracy_study::study::{Extent, study};
use sprag_studies::accuracy_study::variant::{Family, Method, Number, Setting};

const PAIR: usize = 2;

fn rows(scene: &str, extent: Extent) -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(scene);
    let scene = Scene::load(&path, &[]).unwrap();
    let ground = scene.ground_motions().unwrap();
    study(&scene, &ground, extent, None, &Progress::new("runs"), &Interrupt::default()).unwrap()
}

fn family(rows: &[Row], device: usize, method: Method, events: EventTreatment, number: Number) -> Vec<&Row> {
    let is = |row: &&Row| row.device == device && row.variant.family == Family { method, events, number };
    rows.iter().filter(is).collect()
}

fn order_of(rows: &[&Row]) -> f64 {
    let points = rows.iter().filter_map(|row| match row.variant.setting {
        Setting::Step(step) => Some((step, row.history_error?)),
        Setting::Tolerance(_) => None,
    });
    order(points, 1e-12).expect("an order")
}

fn smallest(rows: &[&Row]) -> f64 {
    rows.iter().filter_map(|row| row.history_error).fold(f64::INFINITY, f64::min)
}

#[test]
fn orders_are_those_of_the_methods_only_where_events_are_located() {
    use EventTreatment::{Located, StepEnd};
    let rows = rows("figure05.toml", Extent { cells: 0, smallest_step: 1e-4 });
    for device in 0..3 {
        let of = |method, events| order_of(&family(&rows, device, method, events, Number::F64Libm));
        let (rk4, euler) = (of(Method::RungeKutta4, Located), of(Method::SemiImplicitEuler, Located));
        assert!((3.6..4.6).contains(&rk4), "Runge-Kutta, device {device}: {rk4}");
        assert!((0.85..1.2).contains(&euler), "Euler, device {device}: {euler}");
        let late = of(Method::RungeKutta4, StepEnd);
        assert!((0.5..1.6).contains(&late), "Runge-Kutta with events at step ends, device {device}: {late}");
        // The closed form is exact at any step; f32 ends at some hundreds of its roundings.
        let exact = family(&rows, device, Method::ClosedForm, Located, Number::F64Libm);
        assert!(
            exact.len() > 5 && exact.iter().all(|row| row.history_error.is_some_and(|error| error < 1e-11)),
            "device {device}"
        );
        let single = smallest(&family(&rows, device, Method::RungeKutta4, Located, Number::F32Own));
        assert!((1e-9..1e-4).contains(&single), "f32, device {device}: {single:e}");
    }
}

#[test]
fn a_clutch_looked_at_once_a_step_flips_figure_10() {
    use EventTreatment::{Located, StepEnd};
    let rows = rows("figure10.toml", Extent { cells: 6, smallest_step: 1e-3 });
    let at = |events, step: f64| {
        let family = family(&rows, PAIR, Method::RungeKutta4, events, Number::F64Libm);
        family.into_iter().find(|row| row.variant.setting == Setting::Step(step)).unwrap()
    };
    for step in [1e-2, 3e-3, 1e-3] {
        assert!(!at(StepEnd, step).outcome_right, "step {step}: the clutch comes late by up to a step");
        assert!(at(Located, step).outcome_right, "step {step}");
    }
    let taylor = family(&rows, PAIR, Method::Taylor, Located, Number::F64Libm);
    assert!(
        taylor
            .iter()
            .filter(|row| row.variant.setting.value() <= 1e-5)
            .all(|row| row.outcome_right && row.wrong_share == Some(0.0))
    );
}

#[test]
fn a_closer_step_spoils_fewer_outcomes() {
    let rows = rows("near_fault.toml", Extent { cells: 10, smallest_step: 1e-3 });
    for device in 0..3 {
        let family = family(&rows, device, Method::SemiImplicitEuler, EventTreatment::StepEnd, Number::F64Libm);
        let share = |row: &Row| row.wrong_share.unwrap();
        let (coarsest, closest) = (share(family[0]), share(family[family.len() - 1]));
        assert!(coarsest > 0.02, "device {device}: {coarsest} at the coarsest step, so this test can fail");
        assert!(closest < 0.5 * coarsest, "device {device}: {coarsest} to {closest}");
    }
}
