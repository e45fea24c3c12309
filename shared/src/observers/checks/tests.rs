use super::*;
use crate::ground::Linear;
use crate::math;
use crate::motion::ideal::device_view::tests::{Placed, Run, Shake, pulse, structure};
use crate::observers::ledger::Clutching;
use crate::structure::block::GRAVITY;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::{Restitution, Structure};
use std::vec::Vec;

const MOUNTS: [Mount; 4] = [
    Mount::CentreOfMass,
    Mount::TyingPoint { height: 3.0, pulley_ratio: 1.5 },
    Mount::TyingPoint { height: 0.5, pulley_ratio: 1.0 },
    Mount::BaseCorners { pulley_ratio: 4.0 },
];

impl Placed for Checks<f64> {
    fn place(&mut self, origin: f64) {
        self.origin = origin;
    }
}

fn checks(structure: &Structure) -> Checks<f64> {
    let device = &structure.device;
    let (clutching, mass_ratio) = match device.kind {
        DeviceKind::None => (Clutching::Permanent, 0.0),
        DeviceKind::Inerter => (Clutching::Permanent, device.mass_ratio),
        DeviceKind::ClutchedPair => (Clutching::Ideal, device.mass_ratio),
    };
    let account = Account { clutching, mass_ratio, ..Account::default() };
    Checks::new(&structure.block, structure.geometry, &device.mount, &account).unwrap()
}

fn watch(structure: &Structure, ground: &[(Shake, f64)]) -> Report<f64> {
    let (state, seen) = Run { structure, ground, from: None, observer: checks(structure) }.go();
    assert!(state.impacts > 0);
    seen.report
}

/// Every monotone interval at three instants, with its reactions and the centre of mass moved by hand.
struct Probe {
    checks: Checks<f64>,
    alpha: f64,
    looks: Vec<Look>,
}

struct Look {
    side: f64,
    snapshot: Snapshot<f64>,
    reactions: [f64; 2],
    /// Acceleration of the centre of mass over R, by differences of its path.
    path: [f64; 2],
}

impl Placed for Probe {}

impl Observer<f64> for Probe {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        let span = interval.to - interval.from;
        if span < 0.01 {
            return;
        }
        let side: f64 = interval.side.unit();
        let (alpha, step) = (self.alpha, 1e-3);
        for share in [0.2, 0.5, 0.8] {
            let time = interval.from + share * span;
            // Turned as in a drawing: the centre of mass starts up and to the left of the right-hand toe.
            let place = |t: f64| {
                let (sin, cos) = math::sin_cos(output.motion().at(t).rotation);
                let (x, y) = (-side * math::sin(alpha), math::cos(alpha));
                [cos * x + sin * y, cos * y - sin * x]
            };
            let [before, now, after] = [place(time - step), place(time), place(time + step)];
            let path = [0, 1].map(|i| (after[i] - 2.0 * now[i] + before[i]) / (step * step));
            let snapshot = output.snapshot(time);
            let reactions = self.checks.toe.reactions(interval.side, &snapshot);
            self.looks.push(Look { side, snapshot, reactions, path });
        }
    }
}

fn probe(structure: &Structure) -> Vec<Look> {
    let observer = Probe { checks: checks(structure), alpha: structure.block.slenderness(), looks: Vec::new() };
    let ground = pulse(&structure.block, 2.5, 4.0, 6.0);
    let (_, probe) = Run { structure, ground: &ground, from: None, observer }.go();
    assert!(probe.looks.len() > 20);
    probe.looks
}

/// n F/(mg).
fn pull(structure: &Structure, look: &Look) -> f64 {
    let pulley = match structure.device.mount {
        Mount::CentreOfMass => 1.0,
        Mount::TyingPoint { pulley_ratio, .. } | Mount::BaseCorners { pulley_ratio } => pulley_ratio,
    };
    pulley * (look.snapshot.device.force[0] + look.snapshot.device.force[1]) / structure.block.frequency_parameter_squared()
}

fn each_full(mut visit: impl FnMut(&Structure)) {
    for kind in DeviceKind::ALL {
        for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
            for mount in MOUNTS {
                visit(&structure(12.0, Geometry::Full, kind, kinematics, mount));
            }
        }
    }
}

#[test]
fn the_reactions_move_the_centre_of_mass() {
    each_full(|structure| {
        let vertical = matches!(structure.device.mount, Mount::BaseCorners { .. });
        let drop = structure.block.size() / GRAVITY;
        for look in probe(structure) {
            let pull = pull(structure, &look);
            let [x, y] = look.path;
            let sideways = drop * x + look.snapshot.ground[0] + if vertical { 0.0 } else { pull };
            let upward = drop * y + 1.0 + if vertical { look.side * pull } else { 0.0 };
            assert!((look.reactions[0] - sideways).abs() < 2e-5, "{structure:?} {} {sideways}", look.reactions[0]);
            assert!((look.reactions[1] - upward).abs() < 2e-5, "{structure:?} {} {upward}", look.reactions[1]);
        }
    });
}

/// The moments of toe and device about the centre of mass turn the block: I_G = (λ − 1) m R². This is where a force with the
/// wrong sign, size or point of application would show.
#[test]
fn moments_about_the_centre_of_mass_balance() {
    each_full(|structure| {
        let Structure { block, device, .. } = structure;
        let (alpha, size) = (block.slenderness(), block.size());
        let (half_width, height) = (math::sin(alpha), math::cos(alpha));
        for look in probe(structure) {
            let rotation = look.snapshot.motion.rotation;
            let (sin, cos) = math::sin_cos(rotation);
            // Points of the block over R, seen from its centre of mass; positive rotation is clockwise.
            let seen = |x: f64, y: f64| [cos * x + sin * (y - height), cos * (y - height) - sin * x];
            let clockwise = |[x, y]: [f64; 2], [right, up]: [f64; 2]| y * right - x * up;
            let pull = pull(structure, &look);
            let of_device = match device.mount {
                Mount::CentreOfMass => 0.0,
                Mount::TyingPoint { height, .. } => clockwise(seen(0.0, height / size), [-pull, 0.0]),
                Mount::BaseCorners { .. } => clockwise(seen(-look.side * half_width, 0.0), [0.0, -look.side * pull]),
            };
            let moment = clockwise(seen(look.side * half_width, 0.0), look.reactions) + of_device;
            let inertia = (block.inertia_ratio() - 1.0) * size / GRAVITY;
            assert!((moment - inertia * look.snapshot.motion.acceleration).abs() < 1e-13, "{structure:?} {rotation}: {moment}");
        }
    });
}

/// Eq. 1: about to rock, the block needs a friction of tan α and stands with all its weight.
#[test]
fn at_uplift_the_toe_needs_the_tangent_of_the_slenderness() {
    for (geometry, expected) in [(Geometry::Full, math::tan(10_f64.to_radians())), (Geometry::Slender, 10_f64.to_radians())] {
        let structure = structure(10.0, geometry, DeviceKind::Inerter, KinematicsKind::Consistent, Mount::CentreOfMass);
        let ground = pulse(&structure.block, 1.5, 4.0, 0.0);
        let uplift = math::asin(geometry.uplift_threshold(structure.block.slenderness()) / (1.5 * structure.block.slenderness()))
            / (4.0 * structure.block.frequency_parameter());
        // Cut right after the uplift.
        let cut = [(ground[0].0, uplift + 1e-7)];
        let (_, seen) = Run { structure: &structure, ground: &cut, from: None, observer: checks(&structure) }.go();
        let report = seen.report;
        let (friction, vertical) = (report.friction.unwrap(), report.vertical.unwrap());
        assert!((friction.value - expected).abs() < 1e-6 && (friction.time - uplift).abs() < 2e-7);
        assert!((vertical.value - 1.0).abs() < 1e-6);
        assert_eq!((report.contact_lost, report.impact_friction), (None, None));
    }
}

#[test]
fn the_travel_is_the_integral_of_the_lever() {
    for geometry in [Geometry::Full, Geometry::Slender] {
        for mount in MOUNTS {
            let structure = structure(12.0, geometry, DeviceKind::Inerter, KinematicsKind::Consistent, mount);
            let (checks, block) = (checks(&structure), &structure.block);
            for rotation in [-1.1_f64, -0.2, 0.05, 0.9] {
                // Simpson's rule, from just beside zero so that ℓ is that of the side.
                let lever = |theta: f64| mount.lever_at(block, geometry, theta).unwrap();
                let count = 2000;
                let step = rotation / f64::from(count);
                let sum: f64 = (0..=count)
                    .map(|i| {
                        let ends = i == 0 || i == count;
                        let weight = if ends { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
                        weight * lever((f64::from(i) * step).abs().max(1e-300).copysign(rotation))
                    })
                    .sum();
                let expected = block.size() * sum * step / 3.0;
                let side = Sign::of(rotation, Sign::Positive);
                assert!((checks.toe.travel(side, rotation) - expected).abs() < 1e-12, "{mount:?} {geometry:?} {rotation}");
            }
        }
    }
}

/// The extremes of a dense history of its own.
#[derive(Default)]
struct Dense {
    friction: f64,
    vertical: f64,
    force: [f64; 2],
    support: f64,
    travel: [f64; 2],
}

struct DenseWatch(Checks<f64>, Dense);

impl Placed for DenseWatch {}

impl Observer<f64> for DenseWatch {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        for i in 0..=2000 {
            let snapshot = output.snapshot(interval.from + (interval.to - interval.from) * f64::from(i) / 2000.0);
            let [horizontal, vertical] = self.0.toe.reactions(interval.side, &snapshot);
            let travel = self.0.toe.travel(interval.side, snapshot.motion.rotation);
            let dense = &mut self.1;
            dense.friction = dense.friction.max(horizontal.abs() / vertical);
            dense.vertical = dense.vertical.min(vertical);
            for (most, force) in dense.force.iter_mut().zip(snapshot.device.force) {
                *most = most.max(self.0.toe.over_weight(force).abs());
            }
            dense.support = dense.support.max(self.0.toe.over_weight(snapshot.device.force[0] + snapshot.device.force[1]).abs());
            dense.travel = [dense.travel[0].max(travel), dense.travel[1].max(-travel)];
        }
    }
}

#[test]
fn the_extremes_are_those_of_a_dense_history() {
    each_full(|structure| {
        let ground = pulse(&structure.block, 1.8, 4.0, 6.0);
        let report = watch(structure, &ground);
        let observer = DenseWatch(checks(structure), Dense { vertical: 1.0, ..Dense::default() });
        let (_, DenseWatch(_, dense)) = Run { structure, ground: &ground, from: None, observer }.go();
        let near = |found: Option<Extreme<f64>>, dense: f64| {
            let value = found.unwrap().value;
            // Never below what a sample shows, and hardly above.
            assert!(value >= dense - 1e-12 && value <= dense + 1e-6 * (1.0 + dense.abs()), "{structure:?} {value} {dense}");
        };
        near(report.friction, dense.friction);
        near(report.force[0], dense.force[0]);
        near(report.force[1], dense.force[1]);
        near(report.support, dense.support);
        near(report.travel[0], dense.travel[0]);
        near(report.travel[1], dense.travel[1]);
        let vertical = report.vertical.unwrap().value;
        assert!(vertical <= dense.vertical + 1e-12 && vertical >= dense.vertical - 1e-6, "{vertical} {}", dense.vertical);
        let stroke = report.stroke().unwrap();
        assert!(stroke.value == report.travel[0].unwrap().value.max(report.travel[1].unwrap().value) && stroke.time > 0.0);
        assert_eq!(dense.force[1] > 0.0, structure.device.kind == DeviceKind::ClutchedPair);
        assert_eq!(report.contact_lost, None);
    });
}

/// A brief look finds the same force and impulses, one at the device the same travel too, and nothing else.
#[test]
fn a_brief_look_finds_what_a_full_one_does() {
    each_full(|structure| {
        let ground = pulse(&structure.block, 1.8, 4.0, 6.0);
        let full = watch(structure, &ground);
        let (_, seen) = Run { structure, ground: &ground, from: None, observer: checks(structure).brief() }.go();
        let Report { impact_friction, support, .. } = full;
        let support = support.filter(|_| structure.device.kind != DeviceKind::None);
        assert_eq!(seen.report, Report { impact_friction, support, ..Report::default() });
        let (_, seen) = Run { structure, ground: &ground, from: None, observer: checks(structure).of_device() }.go();
        assert_eq!(seen.report, Report { impact_friction, support, travel: full.travel, ..Report::default() });
    });
}

/// (1 − η)/(1 + η) (1 + σ)/tan α of a block of 10° with η = 0.85: 0.15/1.85/0.176327 = 0.4598, and half as much again with σ = 0.5.
#[test]
fn the_usual_restitution_needs_a_rough_base() {
    for (kind, expected) in
        [(DeviceKind::None, 0.459_834), (DeviceKind::ClutchedPair, 0.459_834), (DeviceKind::Inerter, 0.689_750)]
    {
        let structure = structure(10.0, Geometry::Full, kind, KinematicsKind::Consistent, Mount::CentreOfMass);
        let found = watch(&structure, &pulse(&structure.block, 1.8, 4.0, 3.0)).impact_friction.unwrap().value;
        assert!((found - expected).abs() < 1e-6, "{kind:?}: {found}");
    }
}

#[test]
fn an_impacts_friction_is_the_ratio_of_its_impulses() {
    let alpha = 12_f64.to_radians();
    for eta in [0.85, 0.6, 0.0] {
        let report = |kind, geometry| {
            let mut structure = structure(12.0, geometry, kind, KinematicsKind::Consistent, Mount::CentreOfMass);
            structure.restitution = Restitution::Constant(eta);
            watch(&structure, &pulse(&structure.block, 1.8, 4.0, 3.0)).impact_friction.unwrap().value
        };
        let bare = (1.0 - eta) / (1.0 + eta);
        assert!((report(DeviceKind::None, Geometry::Full) - bare / math::tan(alpha)).abs() < 1e-12);
        assert!((report(DeviceKind::None, Geometry::Slender) - bare / alpha).abs() < 1e-12);
        // The pair lets go; a single inerter of σ = 0.5 is slowed down too, along the same path.
        let pair = report(DeviceKind::ClutchedPair, Geometry::Full);
        assert!((pair - bare / math::tan(alpha)).abs() < 1e-12, "{pair}");
        if eta > 0.0 {
            let single = report(DeviceKind::Inerter, Geometry::Full);
            assert!((single - 1.5 * bare / math::tan(alpha)).abs() < 1e-12, "{single}");
        }
    }
}

/// V of a free bare block follows from its energy e (in mgR): V = 1 − (1 + 2e cos δ − 3 cos² δ)/λ, which is 0 at
/// 3 cos δ = e + √(e² − 3(λ − 1)). A block that falls over loses its toe's contact there, and one that does not never does.
#[test]
fn contact_is_lost_where_the_block_would_fly() {
    let structure = structure(12.0, Geometry::Full, DeviceKind::None, KinematicsKind::Paper, Mount::CentreOfMass);
    let block = &structure.block;
    let (alpha, p2) = (block.slenderness(), block.frequency_parameter_squared());
    let go = |energy: f64, duration: f64| {
        let quiet = [(Shake::Line(Linear::constant(0.0)), duration)];
        let speed = math::square_root(2.0 * p2 * (energy - math::cos(0.5 * alpha)));
        let from = Some((0.5 * alpha, speed));
        let (state, seen) = Run { structure: &structure, ground: &quiet, from, observer: checks(&structure) }.go();
        (state.rotation, seen.report)
    };
    let (_, report) = go(0.999, 3.0);
    assert!(report.contact_lost.is_none() && report.vertical.unwrap().value > 0.8, "{report:?}");
    for energy in [1.1, 1.3] {
        let (_, report) = go(energy, 3.0);
        let (there, _) = go(energy, report.contact_lost.unwrap());
        let expected = alpha + math::acos((energy + math::square_root(energy * energy - 1.0)) / 3.0);
        assert!((there - expected).abs() < 1e-9, "{there} {expected}");
        assert!(report.vertical.unwrap().value < 0.0);
    }
}

/// A pulse throws the block over: its demands are those up to |θ| = α, whatever the fall asks for, with every kind of device.
#[test]
fn a_fall_can_be_left_out() {
    for geometry in [Geometry::Full, Geometry::Slender] {
        for kind in DeviceKind::ALL {
            let structure = structure(12.0, geometry, kind, KinematicsKind::Consistent, Mount::CentreOfMass);
            let alpha = structure.block.slenderness();
            let go =
                |ground: &[(Shake, f64)]| Run { structure: &structure, ground, from: None, observer: checks(&structure) }.go();
            let whole = pulse(&structure.block, 6.0, 2.0, 20.0);
            let (state, seen) = go(&whole);
            assert_eq!(state.phase, crate::motion::state::Phase::Overturned, "{geometry:?} {kind:?}");
            let report = seen.before_fall();
            assert!(report.contact_lost.is_none() && report.friction.unwrap().value < 10.0, "{report:?}");
            let stroke = report.stroke().unwrap();
            assert!(seen.report.stroke().unwrap().value > 1.5 * stroke.value);
            let limit = checks(&structure).toe.travel(Sign::of(state.rotation, Sign::Positive), state.side.times(alpha)).abs();
            assert!((stroke.value - limit).abs() < 1e-9, "{stroke:?} {limit}");
            // The same motion cut where it passes α found the same.
            let (cycle, free) = (whole[0].1, stroke.time - whole[0].1);
            let cut = [(whole[0].0, cycle.min(stroke.time)), (whole[1].0, free.max(0.0))];
            let (passing, seen) = go(if free > 0.0 { &cut } else { &cut[..1] });
            assert!((passing.rotation.abs() - alpha).abs() < 1e-9);
            let near = |a: Option<Extreme<f64>>, b: Option<Extreme<f64>>| match (a, b) {
                (Some(a), Some(b)) => assert!((a.value - b.value).abs() < 1e-6 * (1.0 + a.value.abs()), "{a:?} {b:?}"),
                (a, b) => assert_eq!(a, b),
            };
            let up_to_it = seen.report;
            near(report.friction, up_to_it.friction);
            near(report.vertical, up_to_it.vertical);
            near(report.force[0], up_to_it.force[0]);
            near(report.force[1], up_to_it.force[1]);
        }
    }
}

/// Beyond α and back: nothing of a block that stands is left out.
#[test]
fn a_block_that_comes_back_from_beyond_its_slenderness_is_looked_at_all_the_way() {
    let structure = structure(12.0, Geometry::Full, DeviceKind::None, KinematicsKind::Paper, Mount::CentreOfMass);
    let (alpha, p) = (structure.block.slenderness(), structure.block.frequency_parameter());
    // Pushed back by a constant ground acceleration until it is well below.
    let ground = [(Shake::Line(Linear::constant(0.6)), 1.0 / p)];
    let from = Some((1.05 * alpha, 0.1 * p * alpha));
    let (state, seen) = Run { structure: &structure, ground: &ground, from, observer: checks(&structure) }.go();
    assert!(state.phase == crate::motion::state::Phase::Rocking && state.rotation.abs() < alpha, "{state:?}");
    assert_eq!(seen.before_fall(), seen.report);
    let stroke = seen.report.stroke().unwrap().value;
    assert!(stroke > checks(&structure).toe.travel(Sign::Positive, 1.05 * alpha), "{stroke}");
}
