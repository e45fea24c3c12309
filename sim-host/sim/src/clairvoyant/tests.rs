use std::f64::consts::PI;

use sprag_shared::ground::{AnySegment, GroundSegment, Harmonics};
use sprag_shared::math;
use sprag_shared::structure::Structure;
use sprag_shared::structure::block::{Block, Geometry};
use sprag_shared::structure::device::{Device, DeviceKind};
use sprag_shared::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use sprag_shared::structure::restitution::Restitution;

use super::rocker::Place;
use super::{Grid, Rocker, search};
use crate::ground_motion::{Component, GroundMotion};

const ALPHA: f64 = 0.2;

fn rocker(geometry: Geometry, engagement: Engagement) -> Rocker {
    let structure = Structure {
        geometry,
        device: Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, ..Device::NONE },
        ..Structure::new(Block::new(2.0, ALPHA, 4.0 / 3.0).unwrap(), Restitution::Constant(0.85))
    };
    let flywheel = FlywheelLosses { viscous_rate: 0.05, dry_deceleration: 0.0, brake_deceleration: 2.0, drag_rate: 0.0 };
    let drivetrain = match engagement {
        Engagement::Ideal => Drivetrain::default(),
        engagement => Drivetrain { engagement, flywheel, ..Drivetrain::default() },
    };
    Rocker::of(&drivetrain.resolve(&structure, false).unwrap(), geometry).unwrap()
}

/// One cycle of a sine or half of one, `thresholds` times what uplifts the block, of ω/p = `ratio`.
fn sine(thresholds: f64, ratio: f64, cycles: f64) -> GroundMotion {
    let frequency = ratio * rocker(Geometry::Full, Engagement::Ideal).frequency();
    let shape = AnySegment::Sine(Harmonics::sine(thresholds * math::tan(ALPHA), frequency));
    GroundMotion::sum(&[Component::pulse(0.0, 2.0 * PI * cycles / frequency, shape)])
}

/// A released slender block that rises from θ₀ with θ̇₀: q = q₀ cosh pt − (θ̇₀/p) sinh pt.
#[test]
fn steps_converge_to_the_closed_form_at_second_order() {
    let rocker = rocker(Geometry::Slender, Engagement::Ideal);
    let (start, speed, time) = (0.05, 0.2, 0.5);
    let p = rocker.frequency();
    let grown = math::exp(p * time);
    let exact = ALPHA - (ALPHA - start) * 0.5 * (grown + 1.0 / grown) + speed / p * 0.5 * (grown - 1.0 / grown);
    let errors = [20_u32, 40, 80].map(|steps| {
        let mut place = Place { rotation: start, velocity: speed, standing: false, ..Place::REST };
        (0..steps).for_each(|_| rocker.step(&mut place, 0.0, time / f64::from(steps)));
        (place.rotation - exact).abs()
    });
    assert!(errors[0] < 1e-3 * ALPHA, "{errors:?}");
    for pair in errors.windows(2) {
        assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "{errors:?}");
    }
}

/// The turn that the first integral names is the one that steps reach.
#[test]
fn a_block_on_quiet_ground_turns_where_the_first_integral_says() {
    for geometry in [Geometry::Full, Geometry::Slender] {
        let rocker = rocker(geometry, Engagement::Ideal);
        for (rotation, velocity) in [(0.03, 0.22), (0.12, -0.05), (0.0, 0.2)] {
            let start = Place { rotation, velocity, peak: rotation, standing: false, ..Place::REST };
            let settles = rocker.settles_at(&start).unwrap();
            let mut place = Place { peak: 0.0, ..start };
            (0..40_000).for_each(|_| rocker.step(&mut place, 0.0, 1e-4));
            let reached = place.peak.max(rotation);
            assert!((settles - reached).abs() < 2e-4 * ALPHA, "{rotation} {velocity}: {settles} {reached}");
        }
        let thrown = Place { rotation: 0.1, velocity: 0.25, standing: false, ..Place::REST };
        assert_eq!(rocker.settles_at(&thrown), None, "½θ̇² is beyond what the weight takes");
    }
}

/// A stopped flywheel that is taken on at speed shares its momentum: θ̇' = θ̇/(1 + kℓ²).
#[test]
fn a_rigid_clutch_engages_by_a_plastic_impact_and_no_wheel_that_runs_ahead() {
    let rocker = rocker(Geometry::Full, Engagement::Rigid);
    let mut place = Place { rotation: 0.05, velocity: 0.3, standing: false, ..Place::REST };
    let arm = math::cos(ALPHA - 0.05);
    rocker.engage(&mut place, [true, false]);
    let shared = 0.3 / (1.0 + 0.375 * arm * arm);
    assert!((place.velocity - shared).abs() < 1e-12 && (place.spins[0] - arm * shared).abs() < 1e-12);
    rocker.engage(&mut place, [false, false]);
    assert_eq!(place.velocity.to_bits(), shared.to_bits());
    place.velocity = 0.1;
    assert!(!rocker.may_engage(&place, 0) && rocker.may_engage(&place, 1), "the first runs ahead of the rack");
    place.velocity = -0.3;
    assert!(rocker.may_engage(&place, 0), "it runs the other way, and brakes");
}

/// The smallest peak over all 2ⁿ schedules, each stepped from the beginning.
fn exhaustive(rocker: &Rocker, motion: &GroundMotion, grid: &Grid) -> Option<f64> {
    let interval = grid.decision / rocker.frequency();
    let step = interval / f64::from(grid.steps);
    let decisions = ((motion.duration() + 3.0 / rocker.frequency()) / interval).ceil() as u32;
    let last = (motion.duration() / interval).ceil() as u32;
    assert!(last <= decisions && last < 14);
    let ground = |time: f64| {
        motion
            .segments()
            .iter()
            .find(|part| time < part.start + part.duration)
            .map_or(0.0, |part| part.shape.acceleration(time - part.start))
    };
    let peaks = (0..1_u32 << last).filter_map(|bits| {
        let mut place = Place::REST;
        for decision in 0..last {
            rocker.engage(&mut place, [bits >> decision & 1 == 1, false]);
            for part in 0..grid.steps {
                rocker.step(&mut place, ground((f64::from(decision * grid.steps + part) + 0.5) * step), step);
            }
        }
        rocker.settles_at(&place)
    });
    peaks.min_by(f64::total_cmp).map(|peak| peak / rocker.slenderness())
}

#[test]
fn the_search_without_merging_is_exhaustive_search() {
    let rocker = rocker(Geometry::Full, Engagement::Ideal);
    let grid = Grid { cell: 1e-4, spin_cell: 1.0, decision: 0.15, steps: 8, most: usize::MAX };
    for (thresholds, ratio, cycles) in [(3.0, 4.0, 1.0), (2.5, 4.0, 1.0), (1.5, 2.5, 0.5), (9.0, 3.0, 0.5)] {
        let motion = sine(thresholds, ratio, cycles);
        let (exact, found) = (exhaustive(&rocker, &motion, &grid), search(&rocker, &motion, &grid).peak);
        match (exact, found) {
            (Some(exact), Some(found)) => assert!((found - exact).abs() < 2e-3, "{thresholds} {ratio}: {found} {exact}"),
            (exact, found) => assert_eq!(exact, found, "{thresholds} {ratio}"),
        }
    }
}

/// Finer cells lose less by merging: from above, and by less each time.
#[test]
fn finer_cells_lower_the_peak_to_its_limit() {
    for engagement in [Engagement::Ideal, Engagement::Rigid] {
        let rocker = rocker(Geometry::Full, engagement);
        let motion = sine(2.0, 4.0, 1.0);
        let peak = |cell: f64| {
            let grid = Grid { cell, spin_cell: 4.0 * cell, decision: 0.08, steps: 4, most: usize::MAX };
            search(&rocker, &motion, &grid).peak.unwrap_or(f64::INFINITY)
        };
        let [coarse, middle, fine, finest] = [0.12, 0.06, 0.03, 0.01].map(peak);
        assert!(
            finest <= fine + 1e-9 && fine <= middle + 2e-3 && middle <= coarse + 2e-3,
            "{engagement:?}: {coarse} {middle} {fine} {finest}"
        );
        assert!(fine - finest < 0.6 * (coarse - finest) && finest.is_finite(), "{engagement:?}: {coarse} {fine} {finest}");
    }
}
