//! Delays, dwell, ramps and missed commands, against the clock.

use std::vec::Vec;

use super::{HybridSystem, Seen, Watcher, constant, pair, tight};
use crate::drivetrain::clutch_state::Coupling;
use crate::ground::Harmonics;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::hybrid::mode_output::Shaking;
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::{BlockState, Limits};
use crate::structure::Structure;
use crate::structure::block::{GRAVITY, Geometry};
use crate::structure::drivetrain::{Actuation, Delay, Drivetrain, Engagement, FlywheelLosses};
use crate::structure::restitution::Restitution;

fn with(actuation: Actuation) -> Drivetrain {
    Drivetrain { actuation, ..Drivetrain::default() }
}

fn switches(seen: &Seen) -> Vec<f64> {
    seen.events.iter().filter(|(event, _)| *event == Event::Switch).map(|(_, time)| *time).collect()
}

/// The first command comes with uplift, and the clutch obeys it after exactly the delay.
#[test]
fn an_engagement_comes_late_by_its_delay() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let uplift = |seen: &Seen| seen.events.iter().find(|(event, _)| *event == Event::Uplift).unwrap().1;
    for delay in [1e-3, 0.02, 0.05] {
        let seen = shake.machine(&with(Actuation { engagement_delay: delay, ..Actuation::default() }), &tight());
        assert!((switches(&seen)[0] - uplift(&seen) - delay).abs() < 1e-12, "{delay}");
    }
}

/// A release comes late by its delay after the bracket has changed its sign.
#[test]
fn a_release_comes_late_by_its_delay() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let prompt = switches(&shake.machine(&Drivetrain::default(), &tight()));
    let delay = 0.01;
    let late = switches(&shake.machine(&with(Actuation { release_delay: delay, ..Actuation::default() }), &tight()));
    // Engaged at uplift, released at the first zero of the acceleration: so far both are one motion.
    assert!((late[1] - prompt[1] - delay).abs() < 1e-9, "{late:?} and {prompt:?}");
}

/// When a clutch moves that is commanded to engage at 0 and to release 5 ms later, and what the last command wants, after 0.1 s.
fn pulse(mut machine: HybridSystem<f64>) -> (Vec<f64>, bool) {
    machine.actuator.controlled = true;
    let mut state = machine.released_at(0.1, 0.0, [0.0; 3]);
    let mut nobody = ();
    let mut watcher = Watcher::new(&mut nobody);
    let shaking = Shaking::level(&Harmonics::QUIET);
    let limits = pair(Geometry::Full, 1.0, 1.0).limits(true);
    for (wanted, until) in [([false, true], 0.005), ([false, false], 0.095)] {
        machine.order(&mut state, wanted, &mut watcher);
        machine.advance(&tight(), &mut state, shaking, until, &limits, &mut watcher).unwrap();
        watcher.peaks.origin += until;
    }
    (watcher.switches.iter().map(|(time, ..)| *time).collect(), state.device.wheels[1].commanded)
}

/// Forces on the support on the ways of the bounces that a rest stands for.
struct Forces(Vec<f64>);

impl Observer<f64> for Forces {
    fn device_bounce(&mut self, _side: Sign, _time: f64, snapshot: &dyn Fn() -> Snapshot<f64>) {
        self.0.push(snapshot().support_force());
    }
}

/// The last bounces of a block with n flywheels that a controller holds, whichever way it moves: at a = p² sin α/(1 + n k cos² α) each lasts 2 v/a
/// and the next one starts at η v, 2 η v/((1 − η) a) in all after a first impact at v. The flywheels press with n k cos α a on each way.
#[test]
fn bounces_have_the_clutches_that_a_controller_holds() {
    let mut structure = pair(Geometry::Full, 1.0, 1.0).structure;
    structure.rest_speed = 1e-4;
    let (p2, alpha) = (structure.block.frequency_parameter_squared(), structure.block.slenderness());
    let k = structure.device.mass_ratio / structure.block.inertia_ratio();
    let (sine, cosine) = crate::math::sin_cos(alpha);
    for (engagement, restitution) in [
        (Engagement::Ideal, Restitution::Constant(0.85)),
        (Engagement::Rigid, Restitution::Constant(0.85)),
        (Engagement::Rigid, Restitution::MomentumBalance),
    ] {
        let drivetrain = Drivetrain { engagement, ..Drivetrain::default() };
        let mut machine: HybridSystem<f64> = drivetrain.resolve(&Structure { restitution, ..structure }, false).unwrap();
        machine.actuator.controlled = true;
        for (engaged, count) in [([false, false], 0), ([true, false], 1), ([false, true], 1), ([true, true], 2)] {
            for side in [1.0, -1.0] {
                let height = machine.rest_speed * machine.rest_speed / (2.0 * p2 * sine);
                let mut state = machine.released_at(side * height, 0.0, [0.0; 3]);
                machine.order(&mut state, engaged, &mut ());
                let mut forces = Forces(Vec::new());
                let mut watcher = Watcher::new(&mut forces);
                let limits = Limits { overturned: 1.0, events: 10_000 };
                machine.advance(&tight(), &mut state, Shaking::level(&Harmonics::QUIET), 0.1, &limits, &mut watcher).unwrap();
                let case = std::format!("{engagement:?} {restitution:?} {engaged:?} {side}: {:?}", watcher.events);
                let impacts = watcher.events.iter().filter(|(event, _)| *event == Event::Impact).count();
                assert!(impacts == 1 && watcher.switches.is_empty(), "{case}");
                let rate = p2 * sine / (1.0 + f64::from(count) * k * cosine * cosine);
                let fall = crate::math::square_root(2.0 * height / rate);
                let eta = machine.restitution[count as usize];
                let rest = fall + 2.0 * eta * fall / (1.0 - eta);
                let found = watcher.peaks.ended.unwrap();
                assert!((found / rest - 1.0).abs() < 1e-6, "{found} for {rest}, {case}");
                let largest = watcher.peaks.acceleration;
                assert!((largest / rate - 1.0).abs() < 1e-6, "{largest} for {rate}, {case}");
                let force = f64::from(count) * k * cosine * rate;
                let same = |found: &f64| (found.abs() - force).abs() <= 1e-6 * force;
                assert!(forces.0.len() == 4 && forces.0.iter().all(same), "{:?} for {force}, {case}", forces.0);
            }
        }
    }
}

/// Where two rigid clutches change places at one instant, what is released has no part in the jolt: θ̇⁺ = θ̇⁻/(1 + k) from a flywheel that stands,
/// whichever is the first.
#[test]
fn releases_come_before_engagements() {
    let structure = pair(Geometry::Slender, 1.0, 1.0).structure;
    let actuation = Actuation { engagement_delay: 0.01, release_delay: 0.01, ..Actuation::default() };
    let rigid = Drivetrain { engagement: Engagement::Rigid, ..with(actuation) };
    let mut machine: HybridSystem<f64> = rigid.resolve(&structure, false).unwrap();
    machine.actuator.controlled = true;
    let jolt = 1.0 + structure.device.mass_ratio / structure.block.inertia_ratio();
    let shaking = Shaking::level(&Harmonics::QUIET);
    let limits = pair(Geometry::Slender, 1.0, 1.0).limits(true);
    for first in [[true, false], [false, true]] {
        let mut state = machine.released_at(0.1, 0.0, [0.0; 3]);
        let mut nobody = ();
        let mut watcher = Watcher::new(&mut nobody);
        for wanted in [first, first.map(|engaged| !engaged)] {
            machine.order(&mut state, wanted, &mut watcher);
            machine.advance(&tight(), &mut state, shaking, 0.02, &limits, &mut watcher).unwrap();
        }
        assert_eq!(watcher.switches.len(), 3);
        let ((_, before, _), (_, _, after)) = (watcher.switches[1], watcher.switches[2]);
        assert!((before.velocity / after.velocity / jolt - 1.0).abs() < 1e-12, "{first:?}: {before:?} {after:?}");
    }
}

/// A coil never moves for a command that is shorter than its delay; what comes over a line arrives as it was sent, each with its delay.
#[test]
fn a_command_shorter_than_the_delay_is_lost_or_late() {
    let structure = pair(Geometry::Full, 1.0, 1.0).structure;
    let moves = |delay, engagement_delay, release_delay| {
        let actuation = Actuation { delay, engagement_delay, release_delay, ..Actuation::default() };
        pulse(with(actuation).resolve(&structure, false).unwrap()).0
    };
    let near = |found: Vec<f64>, expected: &[f64]| {
        let close = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-12);
        assert!(close && found.len() == expected.len(), "{found:?} {expected:?}");
    };
    near(moves(Delay::Inertial, 0.02, 0.03), &[]);
    near(moves(Delay::Transport, 0.02, 0.03), &[0.02, 0.035]);
    // A command does not overtake the one before it.
    near(moves(Delay::Transport, 0.02, 0.001), &[0.02, 0.02]);
    for delay in [Delay::Inertial, Delay::Transport] {
        near(moves(delay, 0.002, 0.03), &[0.002, 0.035]);
    }
}

/// Where every command outlasts its delay, both kinds are one, to the last bit. The last swings before rest are shorter than any delay.
#[test]
fn delays_that_cut_nothing_short_are_one() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let run = |delay| {
        let actuation = Actuation { delay, engagement_delay: 1e-3, release_delay: 1e-3, dwell: 0.01, ..Actuation::default() };
        let seen = shake.machine(&with(actuation), &tight());
        let early: Vec<f64> = switches(&seen).into_iter().filter(|time| *time < 4.0).collect();
        (early, seen.peak.to_bits())
    };
    let (moves, peak) = run(Delay::Inertial);
    assert!(moves.len() > 10);
    assert_eq!((moves, peak), run(Delay::Transport));
}

/// No delay is no delay, to the last bit.
#[test]
fn a_seed_without_a_probability_changes_nothing() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let (plain, seeded) = (Actuation::default(), Actuation { miss_seed: 7, ..Actuation::default() });
    let peaks = [plain, seeded].map(|actuation| shake.machine(&with(actuation), &tight()).peak.to_bits());
    assert_eq!(peaks[0], peaks[1]);
}

/// A clutch that misses every command is none.
#[test]
fn a_clutch_that_never_obeys_is_none() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let never = shake.machine(&with(Actuation { miss_probability: 1.0, ..Actuation::default() }), &tight());
    let mut alone = shake.clone();
    alone.structure.device = crate::structure::device::Device::NONE;
    assert!(switches(&never).is_empty());
    assert!((never.peak / alone.ideal().peak - 1.0).abs() < 1e-12);
}

/// Missed commands are drawn from seed and number: one in four, and the same ones every time.
#[test]
fn misses_follow_their_probability() {
    let actuator =
        crate::motion::hybrid::Actuator::<f64>::of(&Actuation { miss_probability: 0.25, miss_seed: 42, ..Actuation::default() });
    let missed = (0..100_000).filter(|count| actuator.misses(*count)).count();
    assert!((missed as f64 / 25_000.0 - 1.0).abs() < 0.03, "{missed}");
}

/// Between two moves of one clutch lies at least its dwell.
#[test]
fn a_clutch_dwells() {
    let shake = pair(Geometry::Full, 6.0, 6.0);
    let dwell = 0.08;
    let seen = shake.machine(&with(Actuation { dwell, ..Actuation::default() }), &tight());
    let moves = switches(&seen);
    let rests: Vec<f64> = seen.events.iter().filter(|(event, _)| *event == Event::Rest).map(|(_, time)| *time).collect();
    assert!(moves.len() > 4);
    // Two clutches: every second move may belong to the other one.
    for triple in moves.windows(3) {
        let ends = rests.iter().any(|rest| (triple[2] - rest).abs() < 1e-12);
        assert!(ends || triple[2] - triple[0] > dwell - 1e-9, "{triple:?}");
    }
}

/// A slow rise of the capacity lies between no clutch and a fast one, and takes less from the plates' force.
#[test]
fn a_capacity_that_rises_slowly_carries_less() {
    let shake = pair(Geometry::Full, 3.0, 5.0);
    let plates = |rise_time: f64| Drivetrain {
        engagement: Engagement::Friction { capacity_ratio: 0.05 },
        flywheel: FlywheelLosses { brake_deceleration: f64::INFINITY, ..FlywheelLosses::default() },
        actuation: Actuation { rise_time, ..Actuation::default() },
        ..Drivetrain::default()
    };
    let peak = |rise_time: f64| shake.machine(&plates(rise_time), &tight()).peak;
    let mut alone = shake.clone();
    alone.structure.device = crate::structure::device::Device::NONE;
    let (at_once, short, never) = (peak(0.0), peak(1e-6), alone.ideal().peak);
    assert!((short / at_once - 1.0).abs() < 1e-4, "{short} and {at_once}");
    assert!((peak(9.0) / never - 1.0).abs() < 0.05, "{} and {never}", peak(9.0));
}

/// While they slip, plates pass on the impulse of their capacity, F_c (t − τ(1 − e^(−t/τ))): that is what the flywheel has taken on.
#[test]
fn a_coil_drives_its_flywheel_by_an_exponential() {
    let (capacity_ratio, tau) = (0.02, 0.06);
    let drivetrain = Drivetrain {
        engagement: Engagement::Friction { capacity_ratio },
        actuation: Actuation { time_constant: tau, ..Actuation::default() },
        ..Drivetrain::default()
    };
    let structure = pair(Geometry::Full, 1.0, 1.0).structure;
    let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
    let block = &structure.block;
    // Thrown outward, under a push that keeps it going and its command as it is.
    let push = [-1.5, 0.0, 0.0];
    let ground = constant(push[0]);
    let mut state = machine.released_at(0.02, 0.8, push);
    let shaking = Shaking::level(&ground);
    let limits = Limits { overturned: 1.5, events: 10_000 };
    let mut passed = 0.0;
    for time in [0.03, 0.06, 0.12, 0.2] {
        machine.advance(&tight(), &mut state, shaking, time - passed, &limits, &mut ()).unwrap();
        passed = time;
        assert!(matches!(state.device.wheels[0].coupling, Coupling::Slipping(Sign::Positive)), "slips at {time}");
        let impulse = time - tau * (1.0 - Real::exp(-time / tau));
        let spin = capacity_ratio * GRAVITY * impulse / (structure.device.mass_ratio * block.size());
        let found = state.device.wheels[0].spin;
        // The lines are within 0.05 % of the capacity at every instant.
        assert!((found - spin).abs() < 5e-4 * spin * time / impulse, "{found} and {spin} at {time}");
        let linear = capacity_ratio * GRAVITY * time / (structure.device.mass_ratio * block.size());
        assert!(found < 0.9 * linear);
    }
}

/// A standing flywheel turns from the instant at which rising plates overcome its bearings, by whatever rounding the clock comes to it: it turns, or
/// that instant is still waited for.
#[test]
fn rising_plates_start_a_flywheel_whatever_rounding_says() {
    let structure = pair(Geometry::Full, 1.0, 1.0).structure;
    for tenths in 1..10 {
        let drivetrain = Drivetrain {
            engagement: Engagement::Friction { capacity_ratio: 0.1 },
            flywheel: FlywheelLosses { dry_deceleration: 0.1 * f64::from(tenths), ..FlywheelLosses::default() },
            actuation: Actuation { rise_time: 0.05, ..Actuation::default() },
            ..Drivetrain::default()
        };
        let machine: HybridSystem<f64> = drivetrain.resolve(&structure, false).unwrap();
        let parameters = &machine.transmission.parameters;
        let engaged = || {
            let mut state = machine.released_at(0.02, -0.1, [0.0; 3]);
            let wheel = &mut state.device.wheels[1];
            (wheel.coupling, wheel.turning, wheel.commanded) = (Coupling::Slipping(Sign::Negative), None, true);
            (wheel.spin, wheel.engaged_for) = (0.0, 0.0);
            state
        };
        let (contact, growth) = parameters.capacity_of(&engaged().device.wheels[1]);
        let starts = (parameters.inertance * parameters.bearing_dry - contact) / growth;
        for roundings in -10..50 {
            let mut state = engaged();
            state.device.wheels[1].engaged_for = starts * (1.0 - 0.5 * f64::EPSILON * f64::from(roundings));
            machine.ramps(&mut state);
            let waits = machine.next_due(&state).unwrap() < 1e-9 * starts;
            let turns = state.device.wheels[1].turning == Some(Sign::Negative);
            assert!(turns != waits, "{tenths} at {roundings}: it turns: {turns}, it is waited for: {waits}");
        }
    }
}

/// A spring without a damper passes on what its twist says: the force does not jump where plates of rising capacity begin or end to slip.
#[test]
fn the_force_of_a_spring_does_not_jump_with_its_plates() {
    #[derive(Default)]
    struct Forces {
        last: Option<[f64; 2]>,
        slips: u32,
        jump: f64,
    }
    impl Observer<f64> for Forces {
        fn device_interval(&mut self, output: &dyn DeviceOutput<f64>, interval: &MonotoneInterval<f64>) {
            let first = output.snapshot(interval.from).device.force;
            for (before, after) in self.last.into_iter().flatten().zip(first) {
                self.jump = self.jump.max((after - before).abs());
            }
            self.last = Some(output.snapshot(interval.to).device.force);
        }

        fn event(&mut self, event: Event, _time: f64, _state: &BlockState<f64>) {
            self.slips += u32::from(event == Event::Coupling);
            if matches!(event, Event::Switch | Event::Rest) {
                self.last = None;
            }
        }
    }
    let engagement = Engagement::Elastic { stiffness: 2e4, damping: 0.0, backlash: 0.0, capacity_ratio: 0.05 };
    for rise_time in [0.0, 0.05, 0.2] {
        let shake = pair(Geometry::Full, 3.0, 5.0);
        let mut forces = Forces::default();
        let actuation = Actuation { engagement_delay: 0.01, release_delay: 0.02, rise_time, ..Actuation::default() };
        shake.watched(&Drivetrain { engagement, actuation, ..Drivetrain::default() }, &tight(), &mut forces);
        let capacity = 0.05 * shake.structure.block.frequency_parameter_squared();
        assert!(forces.slips > 10, "{} slips", forces.slips);
        assert!(forces.jump < 1e-9 * capacity, "rise {rise_time}: {:e} of the capacity", forces.jump / capacity);
    }
}
