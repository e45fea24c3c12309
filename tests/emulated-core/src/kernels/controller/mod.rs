//! What a tick of the controller costs, supervisor and all, and a digest of what it decides.
//!
//! Every controller holds the block of a [`rig::Rig`], whose own instructions are not counted. Counts are of the ticks after it has been
//! armed, the digest is of every tick. The emulator's test runs this file too and compares the digests.

mod candidates;
#[path = "../../../../../shared/src/device/tests/rig.rs"]
mod rig;

use candidates::{ideal, spinning};
use core::{fmt, hint::black_box};
use rig::Rig;
use sprag_shared::control::controller::{Choice, Circumstances, Controller, ControllerState, Decision};
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::math::fnv::Fnv;

/// Ticks of a run: still ones for self-test and calibration, then 2.4 s of rocking.
const TICKS: [u16; 2] = [700, 4800];

/// The counts of many ticks, by their size.
struct Counts<const SIZES: usize> {
    ticks: [u16; SIZES],
    total: u32,
    worst: u32,
}

impl<const SIZES: usize> Counts<SIZES> {
    const NONE: Self = Self { ticks: [0; SIZES], total: 0, worst: 0 };

    fn add(&mut self, instructions: u32) {
        // What is larger than the last is there too.
        let size = (instructions as usize).min(SIZES - 1);
        if let Some(ticks) = self.ticks.get_mut(size) {
            *ticks += 1;
        }
        self.total += 1;
        self.worst = self.worst.max(instructions);
    }

    fn median(&self) -> usize {
        let mut below = 0;
        let reaches_half = |&ticks: &u16| {
            below += u32::from(ticks);
            2 * below >= self.total
        };
        self.ticks.iter().position(reaches_half).unwrap_or(SIZES)
    }

    fn print(&self, name: fmt::Arguments<'_>, out: &mut impl fmt::Write) -> fmt::Result {
        writeln!(out, "kernel {name} {} (median of {} ticks, worst {})", self.median(), self.total, self.worst)
    }
}

/// The largest count that is distinguished from larger ones, and one more.
const SIZES: usize = 8192;

#[inline(never)]
fn tick(controller: &Controller, state: &mut ControllerState, sample: &Sample, decision: &mut Decision) {
    *decision = controller.tick(state, sample, Circumstances::default());
}

#[inline(never)]
fn look(controller: &Controller, state: &mut ControllerState, sample: &Sample, choice: &mut Choice) {
    choice.estimate = controller.look(state, sample);
}

#[inline(never)]
fn choose(controller: &Controller, state: &mut ControllerState, sample: &Sample, choice: &mut Choice) {
    (choice.wish, choice.wanted) = controller.choose(state, &choice.estimate, sample.engaged);
}

#[inline(never)]
fn oversee(controller: &Controller, state: &mut ControllerState, sample: &Sample, choice: Choice, decision: &mut Decision) {
    *decision = controller.oversee(state, sample, Circumstances::default(), choice);
}

/// Prints a line of counts and a line with the digest for every candidate, then a line for every part of a tick; counts are 0 on the host.
///
/// # Errors
/// If `out` refuses a line, or a controller a parameter.
pub fn report(counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> fmt::Result {
    let candidates = ideal();
    for candidate in &candidates {
        whole(candidate.name, &candidate.paper()?, counter, out)?;
    }
    for candidate in spinning() {
        whole(candidate.name, &candidate.consistent()?, counter, out)?;
    }
    parts(&candidates[0].paper()?, counter, out)
}

/// A run of `controller`, with `decide` for a tick.
#[inline(never)]
fn run(controller: &Controller, mut decide: impl FnMut(&mut ControllerState, &Sample, bool) -> Decision) -> (Fnv, u32) {
    let (mut state, mut rig, mut digest) = (controller.start(), Rig::new(controller.model), Fnv::default());
    let (mut armed, mut commands, mut last) = (false, 0, [false; 2]);
    for tick in 0..TICKS[0] + TICKS[1] {
        rig.shakes = tick >= TICKS[0];
        let sample = black_box(rig.sample());
        let decision = decide(&mut state, &sample, armed);
        armed = matches!(decision.phase, Phase::Armed | Phase::Rocking);
        decision.feed(&mut digest);
        commands += u32::from(decision.command != last);
        last = decision.command;
        rig.advance(last);
    }
    (digest, commands)
}

// Not inlined, as `parts`: the counts of both would be on the stack at once, which is more than it holds.
#[inline(never)]
fn whole(name: &str, controller: &Controller, counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> fmt::Result {
    let mut counts = Counts::<SIZES>::NONE;
    let mut decision = Decision::before([false; 2]);
    let (digest, commands) = run(black_box(controller), |state, sample, armed| {
        let before = counter();
        tick(controller, state, sample, &mut decision);
        let instructions = counter().wrapping_sub(before);
        if armed {
            counts.add(instructions);
        }
        black_box(decision)
    });
    counts.print(format_args!("controller-{name}"), out)?;
    writeln!(out, "digest controller-{name} {:016x} ({commands} commands)", digest.value())
}

#[inline(never)]
fn parts(controller: &Controller, counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> fmt::Result {
    let mut counts = [Counts::<{ SIZES / 4 }>::NONE; 3];
    let mut decision = Decision::before([false; 2]);
    let mut choice = Choice { estimate: decision.estimate, wish: decision.wish, wanted: decision.command };
    let (digest, commands) = run(black_box(controller), |state, sample, armed| {
        let start = counter();
        look(controller, state, sample, &mut choice);
        let looked = counter();
        choose(controller, state, sample, &mut choice);
        let chosen = counter();
        oversee(controller, state, sample, choice, &mut decision);
        let end = counter();
        if armed {
            for (counts, (from, to)) in counts.iter_mut().zip([(start, looked), (looked, chosen), (chosen, end)]) {
                counts.add(to.wrapping_sub(from));
            }
        }
        black_box(decision)
    });
    for (counts, part) in counts.iter().zip(["instruments-and-estimator", "prediction-and-law", "supervisor"]) {
        counts.print(format_args!("controller-part-{part}"), out)?;
    }
    writeln!(out, "digest controller-parts {:016x} ({commands} commands)", digest.value())
}
