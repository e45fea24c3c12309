//! What a sensor that is lost in mid-swing costs, and what the rungs of the safe state below cost.

use sprag_report::long_run::in_order::all_in_order;
use sprag_report::progress::Progress;
use sprag_report::text_table::TextTable;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::closed_loop::failing::{Failing, Injected, Part};
use sprag_sim::closed_loop::plant::Extremes;

use super::bench::{Conditions, EQUATION_10, StudyError, Variant, each, with_loop};
use super::faults::instants;
use super::motion::{Motion, grid};
use super::practice::{COLUMNS, Comparison};
use super::report::Report;

/// What is lost, and with which safe state.
pub const LOSSES: [(&str, Failing, &str); 8] = [
    ("gyroscope delivers nothing new", Failing::Stale(Part::Gyroscope), "engaged"),
    ("gyroscope is stuck", Failing::Stuck(Part::Gyroscope), "engaged"),
    ("ground accelerometer delivers nothing new", Failing::Stale(Part::Ground), "engaged"),
    ("ground accelerometer is stuck", Failing::Stuck(Part::Ground), "engaged"),
    ("encoder delivers nothing new", Failing::Stale(Part::Encoder), "engaged"),
    ("encoder is stuck", Failing::Stuck(Part::Encoder), "engaged"),
    ("ticks come late: one clutch engaged", Failing::Overrun, "engaged"),
    ("ticks come late: both released", Failing::Overrun, "released"),
];

/// Thirty-six pulses of each shape: ω/p 1 to 6, amplitudes 1.5 to 5.2.
pub fn pulses() -> Vec<Motion> {
    [grid("sine", 6, (1.0, 6.0), (1.5, 5.2)), grid("cosine", 6, (1.0, 6.0), (1.5, 5.2))].concat()
}

/// Peaks with each of [`LOSSES`] from mid-swing of the first swing on, against the same loop without it, under `motions`.
pub fn losses(motions: &[Motion], progress: &Progress, conditions: &Conditions<'_>) -> Result<Vec<Comparison>, StudyError> {
    let variants = LOSSES.map(|(name, _, safe)| {
        let safe = format!("controller.safe_state=\"{safe}\"");
        Variant::new(name, &[EQUATION_10, "controller.sensors.suite=\"icm-42688-p\"", "controller.latency_s=0.001", &safe])
    });
    let whole = each(motions, &variants[..1], progress, |motion, variant| {
        let from = instants(motion, variant, conditions)?[2];
        let undisturbed = peak(motion, variant, None, conditions)?;
        Ok((from, undisturbed))
    })?;
    let numbers: Vec<usize> = (0..motions.len()).collect();
    let mut compared = Vec::new();
    for ((_, failing, _), variant) in LOSSES.iter().zip(&variants) {
        let jobs = all_in_order(&numbers, progress, |&number| {
            peak(&motions[number], variant, Some(Injected::new(*failing, whole[0][number].0)), conditions)
        })?;
        let mut comparison = Comparison { motions: motions.len(), ..Comparison::default() };
        for ((_, (outcome, peak)), (lost, lost_peak)) in whole[0].iter().zip(jobs) {
            comparison.note((lost, lost_peak), (*outcome, *peak));
        }
        compared.push(comparison);
    }
    Ok(compared)
}

/// Outcome and peak |θ|/α.
fn peak(
    motion: &Motion,
    variant: &Variant,
    injected: Option<Injected>,
    conditions: &Conditions<'_>,
) -> Result<(Outcome, f64), StudyError> {
    with_loop(motion, variant, conditions, |task| {
        let mut driver = task.driver()?;
        let mut extremes = Extremes::default();
        let ending = match injected {
            Some(mut injected) => task.run_with(&mut *driver, &mut injected, &mut extremes, &mut ())?,
            None => task.run_with(&mut *driver, &mut (), &mut extremes, &mut ())?,
        };
        Ok((Outcome::of(&ending.motion, &extremes.peaks), extremes.peaks.rotation / task.scene.block.slenderness()))
    })
}

/// Adds them to a report.
pub fn section(report: &mut Report, progress: &Progress, conditions: &Conditions<'_>) -> Result<(), StudyError> {
    let motions = pulses();
    let compared = losses(&motions, progress, conditions)?;
    report.section("What a loss in mid-swing costs");
    report.paragraph(&format!(
        "Change of the peak rotation from the same loop without the loss, under {} one-cycle sine and cosine pulses (ω/p 1 to 6, peaks of 1.5 to \
         5.2 uplift thresholds); \"ideal\" in the headings is that loop. The loss begins at the largest velocity of the first swing and lasts.",
        motions.len()
    ));
    let mut table = TextTable::new(1, [&["loss"], &COLUMNS[..]].concat());
    for ((name, _, _), comparison) in LOSSES.iter().zip(&compared) {
        table.row([vec![(*name).to_owned()], comparison.cells()].concat());
    }
    report.table("losses", table);
    Ok(())
}
