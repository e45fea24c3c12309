//! Each kind of drivetrain by a second method, and the methods by their orders.

use super::{drivetrains, pair, tight};
use crate::method::fixed::{FixedStep, Scheme};
use crate::motion::hybrid::series::Series;
use crate::structure::block::Geometry;
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};

/// Series against Runge-Kutta: nothing but the equations and the events is common to them.
#[test]
fn series_and_runge_kutta_agree() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for (name, drivetrain) in drivetrains() {
            let shake = pair(geometry, 3.0, 5.0);
            let series = shake.machine(&drivetrain, &tight());
            let coarse = shake.machine(&drivetrain, &FixedStep { scheme: Scheme::RungeKutta4, step: 4e-4 });
            let fine = shake.machine(&drivetrain, &FixedStep { scheme: Scheme::RungeKutta4, step: 1e-4 });
            let error = |peak: f64| (peak / series.peak - 1.0).abs();
            assert!(error(fine.peak) < 1e-8, "{geometry:?} {name}: {} and {}", fine.peak, series.peak);
            assert!(error(fine.peak) <= error(coarse.peak) + 1e-12, "{geometry:?} {name}: no gain by smaller steps");
            assert_eq!(fine.impacts, series.impacts, "{geometry:?} {name}");
            assert!(
                (fine.spins[0] - series.spins[0]).abs() < 1e-6,
                "{geometry:?} {name}: {:?} and {:?}",
                fine.spins,
                series.spins
            );
        }
    }
}

/// A looser tolerance and a fixed step of the series itself.
#[test]
fn the_series_converges() {
    for (name, drivetrain) in drivetrains() {
        let shake = pair(Geometry::Full, 3.0, 5.0);
        let exact = shake.machine(&drivetrain, &tight());
        let loose = shake.machine(&drivetrain, &Series::<f64, 20>::adaptive(1e-12));
        let fixed = shake.machine(&drivetrain, &Series::<f64, 20>::fixed(2e-3));
        assert!((loose.peak / exact.peak - 1.0).abs() < 1e-10, "{name}: {} and {}", loose.peak, exact.peak);
        assert!((fixed.peak / exact.peak - 1.0).abs() < 1e-9, "{name}: {} and {}", fixed.peak, exact.peak);
    }
}

/// A quarter of the step, a quarter of the error.
#[test]
fn semi_implicit_euler_is_of_order_1() {
    // A flywheel that rising plates just start has a rate of zero but for rounding, and this method steps by nothing else.
    for (name, drivetrain) in drivetrains().into_iter().filter(|(_, drivetrain)| drivetrain.actuation.time_constant == 0.0) {
        let shake = pair(Geometry::Full, 3.0, 5.0);
        let exact = shake.machine(&drivetrain, &tight()).peak;
        let error =
            |step: f64| (shake.machine(&drivetrain, &FixedStep { scheme: Scheme::SemiImplicitEuler, step }).peak - exact).abs();
        let (coarse, fine) = (error(4e-4), error(1e-4));
        assert!(fine < 3e-3 * exact && (0.15..0.35).contains(&(fine / coarse)), "{name}: {coarse:e} and {fine:e}");
    }
}

fn stiff(stiffness: f64, damping_ratio: f64) -> Drivetrain {
    let damping = 2.0 * damping_ratio * (stiffness * 0.5_f64).sqrt();
    Drivetrain {
        engagement: Engagement::Elastic { stiffness, damping, backlash: 0.0, capacity_ratio: f64::INFINITY },
        ..Drivetrain::default()
    }
}

/// Half the step, a quarter of the error.
#[test]
fn the_exponential_midpoint_method_is_of_order_2() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    for stiffness in [50.0, 1e4] {
        let exact = shake.machine(&stiff(stiffness, 0.3), &tight()).peak;
        let error = |step: f64| (shake.exponential(&stiff(stiffness, 0.3), step).peak - exact).abs();
        let (coarse, fine) = (error(4e-3), error(1e-3));
        // 4 ^ 2 for an order of 2.
        let gain = coarse / fine;
        assert!((9.0..36.0).contains(&gain), "K/m = {stiffness}: errors {coarse:e} and {fine:e}");
    }
}

/// At the control period of 2 kHz, whatever the spring: no growth, and the same block.
#[test]
fn no_stiffness_bounds_the_exponential_step() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let mut last = f64::NAN;
    for stiffness in [1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12] {
        let seen = shake.exponential(&stiff(stiffness, 0.3), 5e-4);
        assert!(seen.peak.is_finite() && seen.peak < 1.0, "K/m = {stiffness:e}: {}", seen.peak);
        if stiffness > 1e8 {
            assert!((seen.peak / last - 1.0).abs() < 1e-3, "K/m = {stiffness:e}: {} after {last}", seen.peak);
        }
        last = seen.peak;
    }
}

/// The explicit method needs h √(qK) < 2.8 on the same clutch: beyond it blows up or stops.
#[test]
fn the_explicit_step_is_bounded_by_the_stiffness() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    // q = ℓ²/λ … with K over λm: the frequency of the twist is about √(K/m (1/λ + 1/σ)).
    let stiffness = 1e6;
    let frequency = (stiffness * (0.75 + 2.0_f64)).sqrt();
    let exact = shake.machine(&stiff(stiffness, 0.01), &tight()).peak;
    let stable = shake.machine(&stiff(stiffness, 0.01), &FixedStep { scheme: Scheme::RungeKutta4, step: 1.0 / frequency }).peak;
    assert!((stable / exact - 1.0).abs() < 0.01, "{stable} and {exact}");
    let error = |peak: f64| (peak / exact - 1.0).abs();
    let explicit = std::panic::catch_unwind(|| {
        shake.machine(&stiff(stiffness, 0.01), &FixedStep { scheme: Scheme::RungeKutta4, step: 4.0 / frequency }).peak
    });
    let exponential = shake.exponential(&stiff(stiffness, 0.01), 4.0 / frequency).peak;
    assert!(error(exponential) < 0.01, "{exponential} and {exact}");
    assert!(explicit.is_err() || error(explicit.unwrap()) > 0.05, "Runge-Kutta should have failed here");
}

/// The last swings before a rest that is asked for closely are far below the digits of the twist at which a spring carries the block.
#[test]
fn an_elastic_clutch_comes_to_rest_by_any_method() {
    let mut shake = pair(Geometry::Slender, 2.0, 8.0);
    shake.structure.rest_speed = 1e-9;
    let flywheel = FlywheelLosses { dry_deceleration: 0.015, brake_deceleration: 0.5, ..FlywheelLosses::default() };
    let drivetrain = Drivetrain { flywheel, ..stiff(500.0, 0.0) };
    let series = shake.machine(&drivetrain, &tight());
    for step in [1e-3, 4e-3, 1.28e-2] {
        let exponential = shake.exponential(&drivetrain, step);
        let [here, there] = [exponential.ended, series.ended].map(Option::unwrap);
        assert_eq!(exponential.impacts, series.impacts, "{step}");
        assert!((here / there - 1.0).abs() < step * step, "{step}: {here} and {there}");
    }
}
