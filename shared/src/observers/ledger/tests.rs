use super::*;
use crate::drivetrain::transmission::Account as DeviceAccount;
use crate::drivetrain::transmission::Spent;
use crate::equation::motion::Motion;
use crate::ground::Linear;
use crate::math;
use crate::method::dense_output::DenseOutput;
use crate::motion::ideal::device_view::tests::{Placed, Run, Shake, pseudo_record, pulse, structure};
use crate::motion::state::Phase;
use crate::structure::Structure;
use crate::structure::device::{DeviceKind, KinematicsKind};
use crate::structure::mount::Mount;
use std::vec::Vec;

impl Placed for Ledger<f64> {}

fn ledger(structure: &Structure) -> Ledger<f64> {
    let clutching = match structure.device.kind {
        DeviceKind::ClutchedPair => Clutching::Ideal,
        _ => Clutching::Permanent,
    };
    let mass_ratio = if structure.device.kind == DeviceKind::None { 0.0 } else { structure.device.mass_ratio };
    Ledger::new(&structure.block, structure.geometry, &Account { clutching, mass_ratio, ..Account::default() })
}

fn follow(structure: &Structure, ground: &[(Shake, f64)], from: Option<(f64, f64)>) -> (BlockState<f64>, Entries<f64>) {
    let (state, ledger) = Run { structure, ground, from, observer: ledger(structure) }.go();
    (state, ledger.entries)
}

/// Every composition under `ground`; the largest residual over the input.
fn worst_residual(ground: impl Fn(&Block) -> Vec<(Shake, f64)>) -> f64 {
    let mut worst: f64 = 0.0;
    for geometry in [Geometry::Full, Geometry::Slender] {
        for kind in DeviceKind::ALL {
            for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
                for mount in [Mount::CentreOfMass, Mount::TyingPoint { height: 3.0, pulley_ratio: 1.5 }] {
                    let structure = structure(10.0, geometry, kind, kinematics, mount);
                    let (state, entries) = follow(&structure, &ground(&structure.block), None);
                    assert!(state.impacts > 2, "{structure:?}");
                    let share = entries.residual().abs() / entries.input;
                    assert!(share < 1e-12, "{structure:?}: {share:e} {entries:?}");
                    worst = worst.max(share);
                    looks_right(&structure, &state, &entries);
                }
            }
        }
    }
    worst
}

/// Which entries there are, and their signs.
fn looks_right(structure: &Structure, state: &BlockState<f64>, entries: &Entries<f64>) {
    let paper = structure.device.kinematics == KinematicsKind::Paper && structure.geometry == Geometry::Full;
    let pair = structure.device.kind == DeviceKind::ClutchedPair;
    assert!(entries.input > 0.0 && entries.impact > 0.0);
    assert_eq!(entries.kinematics != 0.0, paper && structure.device.kind != DeviceKind::None);
    // Only the pair's clutch releases.
    assert_eq!(entries.brake > 0.1 * entries.input, pair, "{structure:?} {entries:?}");
    assert!(entries.created >= 0.0 && (pair || entries.created == 0.0));
    assert_eq!([entries.initial, entries.clutch, entries.bearing, entries.rack], [0.0; 4]);
    if state.phase == Phase::Rest {
        assert_eq!(entries.mechanical(), 0.0);
    }
}

#[test]
fn it_closes_under_a_pulse() {
    let worst = worst_residual(|block| pulse(block, 1.8, 4.0, 12.0));
    assert!(worst < 1e-14, "{worst:e}");
}

#[test]
fn it_closes_under_a_record() {
    let worst = worst_residual(|_| pseudo_record(0.5));
    assert!(worst < 5e-13, "{worst:e}");
}

const QUIET: [(Shake, f64); 1] = [(Shake::Line(Linear { start: 0.0, slope: 0.0 }), 60.0)];

#[test]
fn a_free_block_leaves_all_it_had_to_its_impacts_and_brakes() {
    for kind in DeviceKind::ALL {
        let structure = structure(10.0, Geometry::Full, kind, KinematicsKind::Consistent, Mount::CentreOfMass);
        let alpha = structure.block.slenderness();
        let (state, entries) = follow(&structure, &QUIET, Some((-0.6 * alpha, 0.0)));
        assert_eq!(state.phase, Phase::Rest);
        let potential = structure.block.frequency_parameter_squared() * (math::cos(0.4 * alpha) - math::cos(alpha));
        assert!((entries.initial / potential - 1.0).abs() < 1e-14);
        assert_eq!((entries.input, entries.kinematics, entries.mechanical()), (0.0, 0.0, 0.0));
        // On quiet ground the pair works while the block falls back, and lets go at the impact: nothing is created.
        assert_eq!(entries.created, 0.0);
        assert_eq!(entries.brake > 0.1 * potential, kind == DeviceKind::ClutchedPair);
        assert!(((entries.impact + entries.brake) / potential - 1.0).abs() < 1e-13, "{entries:?}");
    }
}

/// At the first impact of the pair the flywheel has its share kℓ²/(1 + kℓ²) of all there is, and the block loses 1 − η² of
/// the rest.
#[test]
fn the_first_impact_parts_what_there_is() {
    for (kind, share) in [(DeviceKind::None, 0.0), (DeviceKind::ClutchedPair, 0.375 / 1.375)] {
        let structure = structure(10.0, Geometry::Slender, kind, KinematicsKind::Paper, Mount::CentreOfMass);
        let alpha = structure.block.slenderness();
        let period = 1.2 / structure.block.frequency_parameter();
        let ground = [(QUIET[0].0, 1.3 * period)];
        let (state, entries) = follow(&structure, &ground, Some((0.4 * alpha, 0.0)));
        assert_eq!(state.impacts, 1);
        let potential = structure.block.frequency_parameter_squared() * alpha * alpha * (0.4 - 0.08);
        assert!((entries.initial / potential - 1.0).abs() < 1e-14);
        assert!((entries.brake - share * potential).abs() < 1e-13 * potential);
        let lost = (1.0 - share) * (1.0 - 0.85 * 0.85) * potential;
        assert!((entries.impact / lost - 1.0).abs() < 1e-13);
        assert!((entries.mechanical() / (potential - lost - share * potential) - 1.0).abs() < 1e-13);
    }
}

/// The ledger at the first impact, before anything is lost.
struct UntilImpact(Ledger<f64>, Option<Entries<f64>>);

impl Placed for UntilImpact {}

impl Observer<f64> for UntilImpact {
    fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
        self.0.device_interval(output, interval);
    }

    fn event(&mut self, event: Event, time: f64, state: &BlockState<f64>) {
        if event == Event::Impact {
            self.1.get_or_insert(self.0.entries);
        }
        self.0.event(event, time, state);
    }
}

/// VERIFICATION: swinging from 0.8 α to impact the paper's kinematics are off by so much of the kinetic energy there.
#[test]
fn what_the_papers_kinematics_give() {
    for (degrees, sigma, expected) in [(10.0, 0.5, 0.004), (20.0, 0.5, 0.016), (20.0, 1.0, 0.025)] {
        for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
            let mut structure = structure(degrees, Geometry::Full, DeviceKind::Inerter, kinematics, Mount::CentreOfMass);
            structure.device.mass_ratio = sigma;
            let from = Some((0.8 * structure.block.slenderness(), 0.0));
            let observer = UntilImpact(ledger(&structure), None);
            let (_, UntilImpact(_, seen)) = Run { structure: &structure, ground: &QUIET, from, observer }.go();
            let entries = seen.unwrap();
            assert!(entries.residual().abs() < 1e-14 * entries.initial);
            let share = entries.kinematics / (entries.kinetic + entries.stored);
            if kinematics == KinematicsKind::Paper {
                assert!((share.abs() - expected).abs() < 0.0005, "{degrees} {sigma}: {share}");
            } else {
                assert_eq!(share, 0.0);
            }
        }
    }
}

#[test]
fn a_ledger_without_one_of_its_entries_does_not_close() {
    let structure = structure(10.0, Geometry::Full, DeviceKind::ClutchedPair, KinematicsKind::Paper, Mount::CentreOfMass);
    let (_, entries) = follow(&structure, &pulse(&structure.block, 1.8, 4.0, 2.0), None);
    let without = [
        Entries { input: 0.0, ..entries },
        Entries { potential: 0.0, ..entries },
        Entries { kinetic: 0.0, ..entries },
        Entries { impact: 0.0, ..entries },
        Entries { brake: 0.0, ..entries },
        Entries { kinematics: 0.0, ..entries },
    ];
    for entries in without {
        assert!(entries.residual().abs() > 1e-5 * entries.input.max(entries.impact), "{entries:?}");
    }
    let Entries { initial, input, created, kinetic, potential, stored, impact, clutch, brake, bearing, rack, kinematics } =
        entries;
    let there = kinetic + potential + stored + impact + clutch + brake + bearing + rack + kinematics;
    assert!((initial + input + created - there - entries.residual()).abs() < 1e-15);
    let joules = entries.scaled(7.0);
    assert_eq!(joules.each(|entry| entry / 7.0), entries.each(|entry| 7.0 * entry / 7.0));
}

#[test]
fn the_barrier_is_the_potential_at_the_top() {
    for (geometry, expected) in [(Geometry::Full, 1.0 - math::cos(0.3)), (Geometry::Slender, 0.045)] {
        let block = Block::of_unit_frequency(0.3, 4.0 / 3.0).unwrap();
        let ledger = Ledger::<f64>::new(&block, geometry, &Account::default());
        assert!((ledger.barrier - expected).abs() < 1e-15);
        // The potential is what the weight's moment holds against: dU/dθ = p² sin δ.
        for rotation in [-0.25, -1e-3, 1e-9, 0.4] {
            let side = Sign::of(rotation, Sign::Positive);
            let slope = (ledger.potential(side, rotation + 1e-6) - ledger.potential(side, rotation - 1e-6)) / 2e-6;
            let delta = 0.3 * side.unit::<f64>() - rotation;
            let moment = if geometry == Geometry::Full { math::sin(delta) } else { delta };
            assert!((slope - moment).abs() < 1e-9);
        }
    }
}

/// A device whose snapshots are given: flywheels of k = 0.4 on a lever of 1.
struct Script<F>(F);

impl<F: Fn(f64) -> Snapshot<f64>> DenseOutput<f64> for Script<F> {
    fn length(&self) -> f64 {
        1.0
    }

    fn at(&self, time: f64) -> Motion<f64> {
        (self.0)(time).motion
    }

    fn switching(&self, _time: f64) -> f64 {
        1.0
    }
}

impl<F: Fn(f64) -> Snapshot<f64>> DeviceOutput<f64> for Script<F> {
    fn motion(&self) -> &dyn DenseOutput<f64> {
        self
    }

    fn snapshot(&self, time: f64) -> Snapshot<f64> {
        (self.0)(time)
    }
}

fn snapshot(rotation: f64, velocity: f64, spin: f64, engaged: bool) -> Snapshot<f64> {
    Snapshot {
        motion: Motion { rotation, velocity, acceleration: 0.0 },
        ground: [0.0; 3],
        terminal_velocity: velocity,
        device: DeviceAccount {
            engaged: [engaged, false],
            spin: [spin, 0.0],
            stored: 0.2 * spin * spin,
            ..DeviceAccount::default()
        },
    }
}

fn scripted(clutching: Clutching, rack_mass_ratio: f64) -> Ledger<f64> {
    let block = Block::of_unit_frequency(0.3, 1.25).unwrap();
    Ledger::new(&block, Geometry::Full, &Account { clutching, mass_ratio: 0.5, rack_mass_ratio, ..Account::default() })
}

fn show(ledger: &mut Ledger<f64>, to: f64, script: impl Fn(f64) -> Snapshot<f64>) {
    let ends = [script(0.0).motion, script(to).motion];
    let interval = MonotoneInterval {
        start: 0.0,
        from: 0.0,
        to,
        first: ends[0],
        last: ends[1],
        engaged: true,
        side: Sign::Positive,
        direction: Sign::Positive,
    };
    ledger.device_interval(&Script(script), &interval);
}

fn event(ledger: &mut Ledger<f64>, event: Event, velocity: f64) {
    ledger.event(event, 0.0, &BlockState { velocity, ..BlockState::default() });
}

#[test]
fn a_jolt_costs_what_the_momentum_balance_says() {
    let mut ledger = scripted(Clutching::Real, 0.0);
    show(&mut ledger, 0.0, |_| snapshot(0.1, 2.0, 0.5, false));
    // (1 + 0.4) v = 2 + 0.4 · 0.5; the loss is ½ μ (2 − 0.5)² with μ = 0.4/1.4.
    let after = 2.2 / 1.4;
    event(&mut ledger, Event::Switch, after);
    show(&mut ledger, 0.0, |_| snapshot(0.1, after, after, true));
    let entries = ledger.entries;
    assert!((entries.clutch - 0.5 * 0.4 / 1.4 * 2.25).abs() < 1e-15 && entries.residual().abs() < 1e-15);
    assert_eq!((entries.brake, entries.created, entries.impact), (0.0, 0.0, 0.0));
}

#[test]
fn what_jumps_at_an_event_goes_to_its_cause() {
    let mut ledger = scripted(Clutching::Rigid, 0.0);
    show(&mut ledger, 0.0, |_| snapshot(0.0, -2.0, -2.0, true));
    // Everything locked is slowed by 0.9.
    event(&mut ledger, Event::Impact, -1.8);
    show(&mut ledger, 0.0, |_| snapshot(0.0, -1.8, -1.8, true));
    assert!((ledger.entries.impact - 0.5 * 1.4 * 4.0 * 0.19).abs() < 1e-14);
    // Released to a brake that stops it at once.
    event(&mut ledger, Event::Switch, -1.8);
    show(&mut ledger, 0.0, |_| snapshot(0.0, -1.8, 0.0, false));
    assert!((ledger.entries.brake - 0.2 * 3.24).abs() < 1e-15 && ledger.entries.clutch == 0.0);
    assert!(ledger.entries.residual().abs() < 1e-15);
    // An overrunning flywheel turns on while the block comes to rest and stands.
    let mut ledger = scripted(Clutching::Real, 0.0);
    show(&mut ledger, 0.0, |_| snapshot(0.0, -1e-3, -3.0, false));
    event(&mut ledger, Event::Impact, -9e-4);
    event(&mut ledger, Event::Rest, 0.0);
    assert!((ledger.entries.impact - 5e-7).abs() < 1e-18 && (ledger.entries.stored - 1.8).abs() < 1e-15);
    show(&mut ledger, 2.0, |time| {
        let spin = time - 3.0;
        let mut coasting = snapshot(0.0, 0.0, spin, false);
        coasting.device.spent.bearing = -0.4 * spin;
        coasting
    });
    assert!((ledger.entries.bearing - 0.2 * 8.0).abs() < 1e-15 && ledger.entries.residual().abs() < 1e-15);
}

#[test]
fn a_spring_that_an_impact_lets_go_is_lost_in_its_clutch() {
    let mut ledger = scripted(Clutching::Real, 0.3);
    // Rack and spring beside a flywheel that turns faster than both.
    let sprung = |velocity: f64, sprung: f64, engaged: bool| {
        let mut snapshot = snapshot(0.0, velocity, -3.0, engaged);
        snapshot.device.stored = snapshot.device.stored + 0.12 * velocity * velocity + sprung;
        snapshot.device.sprung = sprung;
        snapshot
    };
    show(&mut ledger, 0.0, |_| sprung(-2.0, 0.7, true));
    event(&mut ledger, Event::Impact, -1.0);
    event(&mut ledger, Event::Switch, -1.0);
    show(&mut ledger, 0.0, |_| sprung(-1.0, 0.0, false));
    let Entries { impact, clutch, brake, .. } = ledger.entries;
    assert!((impact - (0.5 + 0.12) * 3.0).abs() < 1e-15 && (clutch - 0.7).abs() < 1e-15 && brake == 0.0, "{impact} {clutch}");
    assert!(ledger.entries.residual().abs() < 1e-15);
}

/// On a support of its own motion an ideal clutch gives a flywheel ½ · 0.4 · 2² and its brake takes it, in swings that count: faster than 3e-7.
#[test]
fn what_a_clutch_creates_in_a_swing_too_slow_to_count_goes_back() {
    let block = Block::of_unit_frequency(0.3, 1.25).unwrap();
    let account = Account { clutching: Clutching::Ideal, mass_ratio: 0.5, on_support: true, ..Account::default() };
    let mut ledger = Ledger::new(&block, Geometry::Full, &account);
    let mut counts = 0.0;
    for (after_impact, at_release, counted) in [(1e-6, 1e-6, true), (1e-7, 1e-7, false), (1e-7, 1e-3, true)] {
        show(&mut ledger, 0.0, |_| snapshot(0.0, -1e-5, 0.0, false));
        event(&mut ledger, Event::Impact, after_impact);
        event(&mut ledger, Event::Switch, after_impact);
        show(&mut ledger, 0.0, |_| snapshot(0.0, after_impact, 2.0, true));
        let near = |value: f64, exact: f64| assert!((value - exact).abs() < 1e-15, "{value} and {exact}");
        near(ledger.entries.created, 0.8 * (counts + 1.0));
        near(ledger.entries.brake, 0.8 * counts);
        show(&mut ledger, 0.0, |_| snapshot(1e-3, at_release, 2.0, true));
        event(&mut ledger, Event::Switch, at_release);
        show(&mut ledger, 0.0, |_| snapshot(1e-3, at_release, 0.0, false));
        counts += f64::from(counted);
        near(ledger.entries.created, 0.8 * counts);
        near(ledger.entries.brake, 0.8 * counts);
    }
}

#[test]
fn powers_are_integrated_and_the_ground_works_on_block_and_rack() {
    let mut ledger = scripted(Clutching::Real, 0.3);
    // θ = 0.1 + 0.2 t², over ground that pushes steadily by 0.7 g to the side and 0.2 g upward.
    show(&mut ledger, 1.5, |time| {
        let plain = snapshot(0.1 + 0.2 * time * time, 0.4 * time, 0.0, false);
        let spent = Spent { clutch: time, brake: 2.0, bearing: math::cos(time), rack: time * time * time, kinematics: -time };
        let device = DeviceAccount { spent, ..plain.device };
        Snapshot { ground: [0.7, 0.2, 0.0], terminal_velocity: 3.0 * time * time, device, ..plain }
    });
    let entries = ledger.entries;
    let (before, after) = (0.2_f64, 0.3 - 0.55);
    let sideways = 0.7 * (math::sin(before) - math::sin(after)) + 0.3 * 0.7 * 3.375;
    let upward = 0.2 * (math::cos(after) - math::cos(before));
    let near = |value: f64, exact: f64| assert!((value - exact).abs() < 1e-14, "{value} and {exact}");
    near(entries.input, -(sideways + upward));
    near(entries.clutch, 1.125);
    near(entries.brake, 3.0);
    near(entries.bearing, math::sin(1.5));
    near(entries.rack, 1.5 * 1.5 * 1.5 * 1.5 / 4.0);
    near(entries.kinematics, -1.125);
}
