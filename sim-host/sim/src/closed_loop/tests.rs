//! What sensors see between ticks, and what the law on the true motion sees.

use sprag_shared::control::controller::{Circumstances, Decision};
use sprag_shared::control::law::{Law, Situation, Wish};
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::event_log::Entry;
use sprag_shared::math;
use sprag_shared::motion::state::Phase;

use super::decisions::Decisions;
use super::driver::Driver;
use super::plant::{Extremes, Whereabouts};
use super::report::LoopReport;
use super::run::{LoopError, Tick};
use super::{LoopFailure, LoopScene};
use crate::interrupt::Interrupt;
use crate::scene::Scene;
use crate::scene::checks::{ChecksTable, CoilTable};
use crate::sensor::Truth;

const PERIOD: f64 = 5e-4;

/// Instants of the ticks up to `end` (s), `parts` of them each.
fn ticks(end: f64, parts: u32) -> impl Iterator<Item = Vec<f64>> {
    let part = PERIOD / f64::from(parts);
    (0..(end / PERIOD) as u32).map(move |tick| (1..=parts).map(|index| f64::from(tick * parts + index) * part).collect())
}

/// A scene with a device of its own, and a sine that rocks the block and lets it come to rest.
fn scene(device: &str, ground: &str) -> LoopScene {
    let text = format!(
        "block = {{ size_m = 2.0, slenderness_deg = 12.0 }}
        device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, {device} }}]
        ground = [{{ {ground} }}]"
    );
    LoopScene::new(Scene::parse(&text, "scene").unwrap()).unwrap()
}

/// Truths over `end` (s) of a plant whose first clutch is engaged for 0.2 s of each 0.5 s and the other one for 0.2 s after that, seen at
/// so many `parts` of a tick, given for whole ticks or by a plant that `stops` at every instant.
fn truths(desk: &LoopScene, end: f64, parts: u32, stops: bool) -> Vec<(f64, Truth)> {
    let interrupt = Interrupt::default();
    let task = desk.task(0, 1, &interrupt);
    let loaded = desk.scene.structure(0).loaded().unwrap();
    let mut plant = task.plant(&loaded.block).unwrap();
    let mut seen = Vec::new();
    let mut see = |time, truth: &Truth| seen.push((time, *truth));
    for instants in ticks(end, parts) {
        let phase = (instants[instants.len() - 1] - 0.5 * PERIOD) % 0.5;
        plant.order([phase < 0.2, (0.2..0.4).contains(&phase)], &mut Extremes::default());
        for instants in instants.chunks(if stops { 1 } else { instants.len() }) {
            plant.advance(instants, &mut Extremes::default(), &mut see).unwrap();
        }
    }
    seen
}

/// Values of a truth, as sensors have them.
fn values(truth: &Truth) -> [f64; 6] {
    let Truth { rate, block, ground, travel } = *truth;
    [rate, block[0], block[1], ground[0], ground[1], travel]
}

const RIGID: &str = "engagement = 'rigid', flywheel = { viscous_rate_1_s = 0.05 }, actuation = { engagement_delay_s = 0.0023 }";
const SLIPPING: &str = "clutch = { capacity_ratio = 0.1 }";
const ELASTIC: &str = "clutch = { stiffness_ratio = 1.0e4, damping_ratio = 0.1 }";
const VISCOUS: &str = "inertance_corner_hz = 1000.0";
const DRAGGED: &str = "engagement = 'rigid', flywheel = { drag_rate_1_s = 1.0e3 }, actuation = { engagement_delay_s = 0.0023 }";
const FAST_BEARINGS: &str = "engagement = 'rigid', flywheel = { viscous_rate_1_s = 2.0e4 }";
const BEARINGS: &str = "engagement = 'rigid', flywheel = { viscous_rate_1_s = 15.0 }";
const SINE: &str = "motion = 'sine', amplitude_g = 0.5, frequency_hz = 1.3";

/// One step a tick, and what is known between its ends, show what a plant shows that stops at every instant. Stiff devices stop there.
#[test]
fn a_plant_need_not_stop_to_be_seen() {
    // Bearings bring the block to rest.
    for (device, end) in
        [RIGID, SLIPPING, ELASTIC, VISCOUS, DRAGGED].map(|device| (device, 4.0)).into_iter().chain([(BEARINGS, 1.2)])
    {
        let desk = scene(device, SINE);
        let [together, stopped] = [false, true].map(|stops| truths(&desk, end, 4, stops));
        assert_eq!(together.len(), stopped.len(), "{device}");
        let rocks = together.iter().filter(|(_, truth)| truth.rate != 0.0).count();
        assert!(2 * rocks > together.len(), "{device}: {rocks} of {}", together.len());
        for ((time, one), (at, other)) in together.iter().zip(&stopped) {
            assert_eq!(time, at);
            for (one, other) in values(one).into_iter().zip(values(other)) {
                // The shock of an impact magnifies what the length of steps does to its instant.
                assert!((one - other).abs() < 1e-7, "{device} at {time} s: {one} and {other}");
            }
        }
    }
}

/// A step of a tick is several times as long as viscous slip or friction takes: it is divided, however often sensors look.
#[test]
fn viscous_forces_stay_stable_however_rarely_sensors_look() {
    for device in [VISCOUS, FAST_BEARINGS] {
        let desk = scene(device, SINE);
        let [rarely, often] = [1, 16].map(|parts| truths(&desk, 4.0, parts, false));
        for ((time, one), (at, other)) in rarely.iter().zip(often.iter().skip(15).step_by(16)) {
            assert!((time - at).abs() < 1e-12);
            let near = (one.rate - other.rate).abs() < 1e-5 && (one.travel - other.travel).abs() < 1e-5;
            assert!(near, "{device} at {time} s: {one:?} {other:?}");
        }
    }
}

/// Of a block that stands on ground whose acceleration goes along a straight line, the truth is given at the ends of ticks alone, and goes
/// along a straight line between them.
#[test]
fn a_straight_line_is_seen_by_its_ends() {
    let record = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/near_fault.csv");
    let desk = scene(RIGID, &format!("motion = 'record', file = '{record}', scale = 0.2"));
    let end = 8.0;
    let [seen, every] = [false, true].map(|stops| truths(&desk, end, 4, stops));
    let ticks = (end / PERIOD) as usize;
    // Where a sample falls within a tick the line breaks, and all is seen.
    assert!(seen.len() < ticks + ticks / 4 && seen.iter().all(|(_, truth)| truth.rate == 0.0), "{} of {ticks}", seen.len());
    let largest = every.iter().fold(0.0_f64, |largest, (_, truth)| largest.max(truth.ground[0].abs()));
    assert!(largest > 0.5, "{largest}");
    let (mut before, mut places) = ((0.0, Truth::STILL), seen.iter().copied().peekable());
    for (time, truth) in &every {
        let Some(after) = places.peek() else { break };
        let part = (time - before.0) / (after.0 - before.0);
        for ((value, first), last) in values(truth).into_iter().zip(values(&before.1)).zip(values(&after.1)) {
            assert!((first + part * (last - first) - value).abs() < 1e-12, "{time} s: {truth:?}");
        }
        if after.0 == *time {
            before = places.next().unwrap();
        }
    }
    assert_eq!(places.next(), None);
}

/// max |θ|/α of a closed loop at `rate_hz` over a block whose clutches are held engaged.
fn peak_of_engaged(rate_hz: u32, device: &str, ground: &str) -> f64 {
    let text = format!(
        "block = {{ size_m = 2.0, slenderness_deg = 12.0, restitution = 0.75 }}
        device = [{{ kind = 'clutched-pair', mass_ratio = 0.3, flywheel.brake_deceleration_m_s2 = 2.5, {device} }}]
        ground = [{{ motion = 'cosine', frequency_ratio = 3.0, {ground} }}]
        controller = {{ law = 'always-engaged', rate_hz = {rate_hz}, substeps = 1 }}"
    );
    let desk = LoopScene::new(Scene::parse(&text, "scene").unwrap()).unwrap();
    let (.., looped) = desk.task(0, 1, &Interrupt::default()).answered::<()>().unwrap();
    looped.extremes.peaks.rotation / desk.scene.block.slenderness()
}

/// Flywheels that swing on the springs of engaged clutches push a block that stands: it does not go back and forth between standing and
/// rocking at one instant.
#[test]
fn elastic_clutches_may_stay_engaged_while_a_block_stands() {
    for amplitude in [1.1, 1.2, 1.6] {
        let peak = |rate_hz| {
            let device = "clutch = { stiffness_ratio = 400, damping_ratio = 0.3 }";
            peak_of_engaged(rate_hz, device, &format!("amplitude_ratio = {amplitude}"))
        };
        let [coarse, fine] = [1000, 4000].map(peak);
        assert!((coarse / fine - 1.0).abs() < 1e-3, "{amplitude}: {coarse} {fine}");
    }
}

/// What a spring does within a tick, however stiff, leaves the motion as it is with smaller ticks.
#[test]
fn springs_too_stiff_for_a_tick_stay_stable() {
    for stiffness in [2e4, 2e5, 1e8] {
        let device = format!("clutch = {{ stiffness_ratio = {stiffness:e}, damping_ratio = 0.1, capacity_ratio = 0.16 }}");
        let [coarse, fine] = [500, 8000].map(|rate_hz| peak_of_engaged(rate_hz, &device, "amplitude_ratio = 1.5"));
        assert!((coarse / fine - 1.0).abs() < 5e-3, "{stiffness}: {coarse} {fine}");
    }
}

/// Largest growth of [`SINE`], g/s.
const FASTEST: f64 = 0.5 * std::f64::consts::TAU * 1.3;

/// Engages where the ground's acceleration grows by more than half of [`FASTEST`].
struct Growing;

impl Law for Growing {
    fn wish(&self, at: &Situation<'_>) -> Wish {
        if f64::from(at.estimate.ground_rate) > 0.5 * FASTEST { Wish::Resist } else { Wish::Release }
    }
}

/// The law on the true motion looks ahead along the slope that the ground truly has: of sin ωt it is above half of the largest for cos ωt > 1/2.
#[test]
fn the_law_on_the_true_motion_knows_how_the_ground_goes_on() {
    let desk = scene(RIGID, SINE);
    let interrupt = Interrupt::default();
    let task = desk.task(0, 1, &interrupt);
    let (.., looped) = task.answered_by::<Vec<Tick>>(|task| task.driver_by(Growing)).unwrap();
    let mut seen = [0, 0];
    for tick in looped.ticks.iter().filter(|tick| tick.plant.motion.phase == Phase::Rocking) {
        let phase = 1.3 * tick.plant.time;
        let cosine = if phase < 1.0 { math::sin_cos(std::f64::consts::TAU * phase).1 } else { 0.0 };
        if (cosine - 0.5).abs() > 0.01 && (phase - 1.0).abs() > 0.002 {
            assert_eq!(tick.ideal, cosine > 0.5, "{} s", tick.plant.time);
            seen[usize::from(tick.ideal)] += 1;
        }
    }
    assert!(seen[0] > 1000 && seen[1] > 100, "{seen:?}");
}

/// Such noise passes its own standard deviation some hundred times a second.
#[test]
fn a_table_of_signs_does_not_follow_the_noise_of_a_still_ground() {
    let text = "block = { size_m = 2.0, slenderness_deg = 10.0, restitution = 0.9 }
        device = [{ kind = 'clutched-pair', mass_ratio = 0.5 }]
        ground = [{ motion = 'sine', amplitude_g = 0.25, frequency_hz = 1.0 }]
        controller = { law = 'sign-table', sensors.suite = 'adis16470' }";
    let desk = LoopScene::new(Scene::parse(text, "scene").unwrap()).unwrap();
    let (.., looped) = desk.task(0, 1, &Interrupt::default()).answered::<Decisions>().unwrap();
    let report = looped.ticks.report();
    assert!(report.ideal_switches > 50 && report.switches < 2 * report.ideal_switches, "{report:?}");
    assert!(report.wrong_share < 0.05, "{report:?}");
}

/// Before an impact the centre of mass goes down at R sin α |θ̇|, and after it up, on the other toe. What an accelerometer reads in the contact, less
/// what it reads afterwards, is the change of its velocity.
#[test]
fn an_impact_throws_the_centre_of_mass_up() {
    let desk = scene(RIGID, SINE);
    let block = desk.scene.structure(0).loaded().unwrap().block;
    let (size, (sine, cosine)) = (block.size(), math::sin_cos(block.slenderness()));
    // A contact takes two ticks.
    let parts = 32;
    let (step, contact) = (PERIOD / f64::from(parts), 2 * parts as usize + 2);
    let seen: Vec<Truth> = truths(&desk, 4.0, parts, false).into_iter().map(|(_, truth)| truth).collect();
    let mut impacts = 0;
    for at in 1..seen.len() - contact {
        let (before, after, later) = (&seen[at - 1], &seen[at], &seen[at + contact]);
        let jolt = (later.rate / after.rate - 1.0).abs() > 0.05;
        if before.travel * after.travel >= 0.0 || before.rate.abs() < 0.15 || jolt {
            continue;
        }
        let gained =
            |axis: usize| seen[at..at + contact].iter().map(|now| step * (now.block[axis] - later.block[axis])).sum::<f64>();
        let up = size * sine * (before.rate.abs() + after.rate.abs());
        assert!((gained(1) / up - 1.0).abs() < 0.03, "{} m/s up, not {up}", gained(1));
        let across = size * cosine * (after.rate - before.rate);
        assert!((gained(0) / across - 1.0).abs() < 0.1, "{} m/s across, not {across}", gained(0));
        impacts += 1;
    }
    assert!(impacts >= 2, "{impacts}");
}

/// A controller at whose tick of this number Ctrl-C is pressed.
struct Interrupted<'a> {
    own: Box<dyn Driver>,
    interrupt: &'a Interrupt,
    ticks: u32,
    at: u32,
}

impl Driver for Interrupted<'_> {
    fn tick(&mut self, sample: &Sample, circumstances: Circumstances) -> Decision {
        self.ticks += 1;
        if self.ticks == self.at {
            self.interrupt.set();
        }
        self.own.tick(sample, circumstances)
    }

    fn ideal(&mut self, plant: &Whereabouts, asked: bool) -> Wish {
        self.own.ideal(plant, asked)
    }

    fn log(&self) -> Vec<Entry> {
        self.own.log()
    }
}

/// A tick over a device's line may take as long as a real one and more: before the motion and in it, none is made after Ctrl-C.
#[test]
fn an_interrupt_ends_a_loop_at_the_next_tick() {
    let desk = scene(RIGID, SINE);
    let prelude = (desk.controller.prelude_s / PERIOD) as u32;
    for at in [prelude / 2, prelude + 1, prelude + 100] {
        let interrupt = Interrupt::default();
        let task = desk.task(0, 1, &interrupt);
        let mut driver = Interrupted { own: task.driver().unwrap(), interrupt: &interrupt, ticks: 0, at };
        let ended = task.run_with(&mut driver, &mut (), &mut Extremes::default(), &mut ());
        assert!(matches!(ended, Err(LoopFailure::Loop(LoopError::Interrupted))), "{at}: {ended:?}");
        assert_eq!(driver.ticks, at);
    }
}

/// What the checks of a loop find is what they find of the run of its device, and looking changes nothing.
#[test]
fn a_loop_says_what_its_checks_found() {
    let mut desk = scene(RIGID, SINE);
    let interrupt = Interrupt::default();
    let report = |desk: &LoopScene| {
        let (task, error, looped) = desk.task(0, 1, &interrupt).answered().unwrap();
        LoopReport::of_answer(&task, error, looped).unwrap()
    };
    let bare = report(&desk).summary;
    assert!(bare.checks.is_none());
    desk.scene.file.checks = Some(ChecksTable {
        friction_coefficient: Some(0.01),
        largest_force_ratio: Some(1e-6),
        coil: Some(CoilTable { holding_power_w: 10.0, closing_energy_j: 1.0, largest_energy_j: None }),
        ..ChecksTable::default()
    });
    let summary = report(&desk).summary;
    assert_eq!((summary.peak_rotation, summary.impacts, summary.ticks), (bare.peak_rotation, bare.impacts, bare.ticks));
    let checks = summary.checks.unwrap();
    assert_eq!(Some(&checks), desk.task(0, 1, &interrupt).measured().unwrap().checks.as_ref());
    assert!(checks.force_ratio.unwrap() > 0.0 && checks.coil_energy_j.unwrap() > 0.0, "{checks:?}");
    for words in ["the toe would slide: ", "the force on the device's support reaches "] {
        assert!(checks.warnings.iter().any(|warning| warning.starts_with(words)), "{checks:?}");
    }
    // Whoever drives it.
    let task = desk.task(0, 1, &interrupt);
    let driven = task.looped::<()>(&mut *task.driver().unwrap(), &mut ()).unwrap();
    assert_eq!(driven.checks, Some(checks));
    assert!(report(&desk.unchecked()).summary.checks.is_none());
}

/// What a controller commands while the block falls is not counted, whoever looks.
#[test]
fn the_coils_of_a_loop_hold_up_to_the_fall() {
    let mut desk = scene("engagement = 'ideal'", "motion = 'sine', amplitude_ratio = 4.0, frequency_ratio = 1.5");
    desk.scene.file.checks = Some(ChecksTable {
        coil: Some(CoilTable { holding_power_w: 10.0, closing_energy_j: 0.0, largest_energy_j: None }),
        ..ChecksTable::default()
    });
    let interrupt = Interrupt::default();
    let task = desk.task(0, 1, &interrupt);
    let looped = task.looped::<Vec<Tick>>(&mut *task.driver().unwrap(), &mut ()).unwrap();
    assert!(looped.outcome().overturned());
    let held = |ticks: &[Tick]| -> f64 {
        let commands = ticks.iter().flat_map(|tick| tick.decision.command).filter(|command| *command);
        10.0 * task.clock().period * commands.count() as f64
    };
    let falls = looped.ticks.iter().rposition(|tick| !tick.beyond).unwrap() + 1;
    let checks = looped.checks.unwrap();
    let (before, whole) = (checks.coil_energy_j.unwrap(), checks.coil_energy_with_fall_j.unwrap());
    assert!((before - held(&looped.ticks[..falls])).abs() < 1e-9 && before > 0.0, "{before}");
    assert!((whole - held(&looped.ticks)).abs() < 1e-9 && whole > before, "{before} {whole}");
    assert_eq!(task.measured().unwrap().checks.unwrap().coils, checks.coils);
}

/// The last bounces of a block that hardly lifts off ask of its toe what they ask where they are followed.
#[test]
fn the_checks_of_a_loop_count_the_last_bounces() {
    let interrupt = Interrupt::default();
    let reaction = |rest_speed_ratio: f64| {
        let mut desk = scene(RIGID, "motion = 'half-sine', amplitude_ratio = 1.0001, frequency_ratio = 3.0");
        desk.scene.file.run.rest_speed_ratio = rest_speed_ratio;
        desk.scene.file.checks = Some(ChecksTable::default());
        let (task, error, looped) = desk.task(0, 1, &interrupt).answered().unwrap();
        let checks = LoopReport::of_answer(&task, error, looped).unwrap().summary.checks.unwrap();
        checks.smallest_vertical_reaction_ratio.unwrap()
    };
    let [summed, followed] = [1e-6, 1e-8].map(reaction);
    assert!((summed - followed).abs() < 1e-3 && followed < 0.95, "{summed} {followed}");
}

/// Ticks for which a clutch is closed.
const CLOSED: u32 = 40;

/// Plates with a capacity of F = ct that close four times for τ while the block rocks give its flywheel an impulse of 4 cτ²/2. Where they close
/// while the block stands, they take as long to stop it as c(2τ)²/2 says.
#[test]
fn plates_that_slip_behind_a_standing_block_are_looked_at() {
    let text = "block = { size_m = 2.0, slenderness_deg = 12.0, restitution = 0.5 }
        device = [{ kind = 'clutched-pair', mass_ratio = 0.5, clutch.capacity_ratio = 0.1, actuation.rise_time_s = 2.0 }]
        ground = [{ motion = 'sine', amplitude_g = 0.5, frequency_hz = 1.3 }]
        checks = {}";
    let desk = LoopScene::new(Scene::parse(text, "scene").unwrap()).unwrap();
    let interrupt = Interrupt::default();
    let task = desk.task(0, 1, &interrupt);
    let loaded = desk.scene.structure(0).loaded().unwrap();
    let (mut plant, mut watchers) = (task.plant(&loaded.block).unwrap(), task.task().watchers(&loaded).ok().unwrap());
    // Ticks that are left of a closing, closings so far, and ticks at rest after them.
    let (mut left, mut closings, mut stood) = (0, 0, 0);
    for instants in ticks(20.0, 1) {
        let Whereabouts { motion, time, .. } = plant.whereabouts();
        if left > 0 {
            left -= 1;
        } else if closings < 4 && motion.velocity > 0.2 {
            (left, closings) = (CLOSED, closings + 1);
        }
        let stands = closings == 4 && motion.phase == Phase::Rest && time > 1.0;
        stood += u32::from(stands);
        plant.order([left > 0 || stands, false], &mut watchers);
        plant.advance(&instants, &mut watchers, &mut |_, _| {}).unwrap();
    }
    assert!(stood > 2 * CLOSED, "{closings} closings, {stood} ticks at rest");
    let largest = watchers.checks.unwrap().report.support.unwrap().value;
    // While the block rocks, 0.1 τ/2 s.
    let rocking = 0.1 * f64::from(CLOSED) * PERIOD / 2.0;
    assert!((largest / (2.0 * rocking) - 1.0).abs() < 0.02, "{largest} and {rocking}");
}

/// Ticks of 0.5 ms.
#[test]
fn a_dwell_is_no_shorter_than_asked_for() {
    let mut desk = scene(RIGID, SINE);
    for (seconds, least) in [(0.0, 0), (1e-4, 1), (5e-4, 1), (7e-4, 2), (3e-3, 6), (1.0, 2000)] {
        desk.controller.dwell_s = seconds;
        let controller = desk.task(0, 1, &Interrupt::default()).controller(desk.controller.clutch_law()).unwrap();
        assert_eq!(controller.gate.dwell, least, "{seconds}");
    }
}
