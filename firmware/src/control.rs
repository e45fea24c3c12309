//! The control task: one tick, in time or noticed to be late.

use core::sync::atomic::{AtomicU8, Ordering};

use crate::board::{Board, Coils, Light, Selected, Sensors, Watchdog};
use crate::link::Outbox;
use crate::memory;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::device::Device;
use sprag_shared::device::conditions::Conditions;
use sprag_shared::device::recorder::Ring;
use sprag_shared::link::Pace;

/// The part of a period by which a tick may come later than one period after the last and still be in time.
const GRACE: u32 = 8;

/// Time without a sample from the link after which a device that is paced by samples ticks without them, s: the link is dead.
const SILENCE: f32 = 1.0;

/// Ticks of which one shows the light and writes down what shall survive a reset: less than a slot of the light at any period, and too little
/// for the block to move on by more than the encoder's counter knows. A new phase is written down at once.
const EVERY: u8 = 4;

/// What the coils do when the program stops, or the supply is too low: bit 0 the first, bit 1 the second.
static SAFE_STATE: AtomicU8 = AtomicU8::new(0);

/// What the next tick begins with, as bits.
static ASKED: AtomicU8 = AtomicU8::new(0);

/// Of [`ASKED`]: the tick comes after a pause that was meant, so it is not late.
const FORGET_TIME: u8 = 1;
/// Of [`ASKED`]: the sensors are to test themselves.
const TEST_SENSORS: u8 = 2;

/// Delay of the next tick by fault injection, counts.
#[cfg(feature = "board-qemu")]
pub static DAWDLE: core::sync::atomic::AtomicU32 = core::sync::atomic::AtomicU32::new(0);

/// Sets what the coils do when the program stops, or the supply is too low.
pub fn set_safe_state(engaged: [bool; 2]) {
    SAFE_STATE.store(u8::from(engaged[0]) | u8::from(engaged[1]) << 1, Ordering::Relaxed);
}

/// What the coils do when the program stops, or the supply is too low.
pub fn safe_state() -> [bool; 2] {
    let bits = SAFE_STATE.load(Ordering::Relaxed);
    [bits & 1 != 0, bits & 2 != 0]
}

/// Makes the next tick not late, whenever it comes.
pub fn forget_time() {
    ask(FORGET_TIME);
}

/// Has the sensors test themselves from the next tick on. Only where nothing relies on their readings.
pub fn test_sensors() {
    ask(TEST_SENSORS);
}

fn ask(bit: u8) {
    ASKED.fetch_or(bit, Ordering::Relaxed);
}

/// What the control task owns.
pub struct Control {
    conditions: Conditions,
    sensors: <Selected as Board>::Sensors,
    coils: <Selected as Board>::Coils,
    watchdog: <Selected as Board>::Watchdog,
    light: <Selected as Board>::Light,
    keeper: memory::Keeper,
    log: memory::LogKeeper,
    last: Option<u32>,
    /// Periods without a sample.
    silence: u32,
    /// Counts ticks, for what need not be done at each.
    turn: u8,
    /// As written down last.
    phase: Phase,
}

impl Control {
    /// Before the first tick, of a device that is to be within these `conditions`.
    pub fn new(
        conditions: Conditions,
        sensors: <Selected as Board>::Sensors,
        coils: <Selected as Board>::Coils,
        watchdog: <Selected as Board>::Watchdog,
        light: <Selected as Board>::Light,
    ) -> Control {
        Control {
            conditions,
            sensors,
            coils,
            watchdog,
            light,
            keeper: memory::Keeper::new(),
            log: memory::LogKeeper::new(),
            last: None,
            silence: 0,
            turn: 0,
            phase: Phase::Boot,
        }
    }

    /// Looks at what surrounds the controller, every fourth tick.
    #[inline]
    fn look_around(&mut self, device: &mut Device) {
        if self.coils.supply().is_some_and(|volts| self.conditions.see_supply(volts)) {
            device.warn(Fault::SupplyLow);
        }
        if self.turn == 0 {
            self.look_farther(device);
        }
    }

    /// The same every 256th tick.
    #[inline(never)]
    fn look_farther(&mut self, device: &mut Device) {
        if self.sensors.temperature().is_some_and(|celsius| self.conditions.see_temperature(celsius)) {
            device.warn(Fault::TemperatureUnusual);
        }
        if let Some(fault) = self.sensors.untrue() {
            device.warn(fault);
        }
    }
}

/// The interrupt of the control task, by the `timer` or because a sample has come. Reaches no panic: `cargo xtask firmware` shows it.
#[inline(never)]
pub fn control_tick(control: &mut Control, device: &mut Device, ring: &mut Ring, outbox: &mut Outbox, timer: bool) {
    if device.attached() == Some(Pace::Sample) {
        // The clock is the sender's, so nothing is ever late; only the end of the link is noticed.
        control.last = None;
        control.watchdog.feed();
        if device.has_sample() {
            control.silence = 0;
        } else if timer {
            control.silence = control.silence.saturating_add(1);
        }
        if device.has_sample() || control.silence as f32 * device.period() > SILENCE {
            tick(control, device, ring, outbox, 0);
        }
    } else if timer {
        let begun = Selected::now();
        let asked = ASKED.load(Ordering::Relaxed);
        if asked != 0 {
            ASKED.store(0, Ordering::Relaxed);
            // Either has taken longer than a period may, and the period may be another.
            control.last = None;
            control.coils.set_period(device.period());
            if asked & TEST_SENSORS != 0 {
                control.sensors.test(device.period(), device.patience());
            }
        }
        let period = device.period_counts(Selected::COUNTER_HZ);
        let late = control.last.map_or(0, |last| begun.wrapping_sub(last).saturating_sub(period));
        let late = if late > period / GRACE { late } else { 0 };
        control.last = Some(begun);
        tick(control, device, ring, outbox, late);
        if Selected::now().wrapping_sub(begun) < period {
            control.watchdog.feed();
        }
    }
}

/// Sensors, controller, coils.
fn tick(control: &mut Control, device: &mut Device, ring: &mut Ring, outbox: &mut Outbox, late: u32) {
    let begun = Selected::now();
    let Control { sensors, coils, .. } = &mut *control;
    #[cfg(feature = "log")]
    let before = *device.decision();
    let seen = Coils::read(coils);
    device.note_coils(seen);
    device.tick(
        |sample| {
            Sensors::read(sensors, sample);
            sample.engaged = seen.map(|coil| coil.engaged);
        },
        late as f32 / Selected::COUNTER_HZ as f32,
    );
    let decision = device.decision();
    // With samples from the link the clutches are somewhere else.
    let command = if device.attached().is_some() { device.safe_command() } else { decision.command };
    coils.drive(command, device.tests_coils());
    ring.note(device);
    control.turn = control.turn.wrapping_add(1);
    let in_turn = control.turn.is_multiple_of(EVERY);
    if in_turn {
        control.light.show(device.shown(), device.light_slot());
    }
    if in_turn || decision.phase != control.phase {
        control.phase = decision.phase;
        set_safe_state(device.safe_command());
        control.keeper.save(&device.retained());
        control.log.save(device);
    }
    #[cfg(feature = "log")]
    crate::log::decision(&before, decision);
    if in_turn {
        control.look_around(device);
    }
    #[cfg(feature = "deliberate-panic")]
    deliberate_panic(device);
    #[cfg(feature = "board-qemu")]
    while Selected::now().wrapping_sub(begun) < DAWDLE.load(Ordering::Relaxed) {}
    #[cfg(feature = "board-qemu")]
    DAWDLE.store(0, Ordering::Relaxed);
    let cost = Selected::now().wrapping_sub(begun);
    if let Some(report) = device.report(cost, late) {
        outbox.put(report);
    }
}

/// Shows that the check for panics in the control path sees one.
#[cfg(feature = "deliberate-panic")]
#[inline(never)]
fn deliberate_panic(device: &Device) {
    let words = device.settings().words();
    let index = device.safe_command()[0] as usize * 1000;
    core::hint::black_box(words[index]);
}
