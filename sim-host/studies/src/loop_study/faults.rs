//! Every class of fault, at rest, at uplift, in mid-swing and at an impact.

use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::closed_loop::failing::{ALL, Failing, Injected};
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::run::{Tick, TickObserver};

use super::bench::{Conditions, EQUATION_10, StudyError, Variant, each, with_loop};
use super::motion::Motion;
use super::report::Report;

/// When it begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Instant {
    /// Before the motion: the ground moves 1 s later.
    Rest,
    /// When the block lifts off.
    Uplift,
    /// At the largest velocity of the first swing.
    MidSwing,
    /// At the first impact.
    Impact,
}

/// All of them.
pub const INSTANTS: [Instant; 4] = [Instant::Rest, Instant::Uplift, Instant::MidSwing, Instant::Impact];

/// What a loop showed of a fault.
#[derive(Clone, Debug, Default)]
struct Seen {
    from: f64,
    detected: Option<(f64, String)>,
    /// Both clutches were commanded at once while the block moved.
    both: bool,
    /// An estimate or its push was not a number while the controller decided.
    not_a_number: bool,
    /// A clutch was commanded though an engaged clutch is the fault.
    unsafe_after: bool,
}

impl TickObserver for Seen {
    fn tick(&mut self, tick: &Tick) {
        let decision = &tick.decision;
        if tick.plant.time >= self.from && self.detected.is_none() {
            self.detected = decision.fault.map(|fault| (tick.plant.time - self.from, fault.to_string()));
        }
        self.both |= decision.command == [true; 2] && !decision.estimate.standing;
        let finite = decision.estimate.rotation.is_finite() && decision.estimate.velocity.is_finite();
        self.not_a_number |= !finite && decision.phase != Phase::Fault;
        let of_engaged = decision.phase == Phase::Fault && decision.fault.is_some_and(Fault::is_of_an_engaged_clutch);
        self.unsafe_after |= of_engaged && decision.command != [false; 2];
    }
}

/// One fault at one instant.
#[derive(Clone, Debug)]
pub struct FaultResult {
    /// s after its beginning, and its name.
    pub detected: Option<(f64, String)>,
    /// Both clutches at once in motion, a number that is none, or a clutch engaged though an engaged one is the fault.
    pub harm: [bool; 3],
    /// Outcome.
    pub outcome: Outcome,
}

const MOTION: Motion = Motion::Pulse { shape: "sine", frequency: 4.0, amplitude: 3.0 };

/// Stillness before the pulse, s.
const START: &str = "ground.0.start_s=1.0";

/// Instants of the loop without a fault, s.
pub(super) fn instants(motion: &Motion, variant: &Variant, conditions: &Conditions<'_>) -> Result<[f64; 4], StudyError> {
    with_loop(motion, variant, conditions, |task| {
        let mut ticks: Vec<Tick> = Vec::new();
        task.run(&mut Extremes::default(), &mut ticks)?;
        let uplift = ticks.iter().find(|tick| tick.plant.motion.velocity != 0.0).map_or(0.0, |tick| tick.plant.time);
        let impact = ticks.iter().find(|tick| tick.plant.motion.impacts > 0).map_or(0.0, |tick| tick.plant.time);
        let fastest = ticks.iter().filter(|tick| tick.plant.time < impact).fold((0.0, uplift), |best: (f64, f64), tick| {
            let speed = tick.plant.motion.velocity.abs();
            if speed > best.0 && tick.plant.time < 0.9 * impact { (speed, tick.plant.time) } else { best }
        });
        Ok([0.0, uplift, fastest.1, impact])
    })
}

/// One loop with one fault.
fn inject(variant: &Variant, failing: Failing, from: f64, conditions: &Conditions<'_>) -> Result<FaultResult, StudyError> {
    with_loop(&MOTION, variant, conditions, |task| {
        let mut driver = task.driver()?;
        let mut disturbance = Injected::new(failing, from);
        let (mut extremes, mut seen) = (Extremes::default(), Seen { from, ..Seen::default() });
        let ending = task.run_with(&mut *driver, &mut disturbance, &mut extremes, &mut seen)?;
        Ok(FaultResult {
            detected: seen.detected,
            harm: [seen.both, seen.not_a_number, seen.unsafe_after],
            outcome: Outcome::of(&ending.motion, &extremes.peaks),
        })
    })
}

/// Every fault at every instant, by fault, then by instant.
pub fn results(progress: &Progress, conditions: &Conditions<'_>) -> Result<Vec<Vec<FaultResult>>, StudyError> {
    let variant = Variant::new(
        "faults",
        &[
            EQUATION_10,
            "controller.sensors.suite=\"icm-42688-p\"",
            "controller.latency_s=0.001",
            "controller.prelude_s=6.0",
            START,
        ],
    );
    let starts = instants(&MOTION, &variant, conditions)?;
    let motions = vec![MOTION; ALL.len() * INSTANTS.len()];
    let numbers: Vec<Variant> = (0..motions.len()).map(|number| Variant { seed: number as u64, ..variant.clone() }).collect();
    let flat = each(&motions[..1], &numbers, progress, |_, number| {
        let index = number.seed as usize;
        inject(&variant, ALL[index / INSTANTS.len()], starts[index % INSTANTS.len()], conditions)
    })?;
    let flat: Vec<FaultResult> = flat.into_iter().flatten().collect();
    Ok(flat.chunks(INSTANTS.len()).map(<[FaultResult]>::to_vec).collect())
}

/// Runs the study.
pub fn faults(progress: &Progress, conditions: &Conditions<'_>) -> Result<Report, StudyError> {
    let results = results(progress, conditions)?;
    let mut report = Report::new("faults", "Faults in the closed loop");
    report.paragraph(
        "Motion: one one-cycle sine pulse (ω/p 4, a peak of 3 uplift thresholds).\n\nR = 2 m, α = 10°, σ = 0.5, ICM-42688-P, 2 kHz, model-aided, safe state: the first clutch engaged. Time from the beginning of the fault \
         to the fault code, ms, and the code's words where it begins in mid-swing. A dash: not detected in the run.",
    );
    let mut table = TextTable::new(
        9,
        [
            "fault",
            "at rest",
            "at uplift",
            "mid-swing",
            "at impact",
            "in words",
            "both engaged in motion",
            "not a number",
            "engaged where that is the fault",
        ],
    );
    for (failing, row) in ALL.iter().zip(&results) {
        let time =
            |result: &FaultResult| result.detected.as_ref().map_or_else(|| "-".to_owned(), |(time, _)| number(1e3 * time, 1));
        let mut cells = vec![failing.to_string()];
        cells.extend(row.iter().map(time));
        cells.push(row[2].detected.as_ref().map_or_else(String::new, |(_, words)| words.clone()));
        for harm in 0..3 {
            cells.push(if row.iter().any(|result| result.harm[harm]) { "yes" } else { "never" }.to_owned());
        }
        table.row(cells);
    }
    report.table("faults", table);
    super::losses::section(&mut report, progress, conditions)?;
    Ok(report)
}
