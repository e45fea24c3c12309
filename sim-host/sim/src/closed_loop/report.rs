//! What a closed loop leaves: its figures, its history and its picture.

use std::fmt;
use std::io::Write;

use serde::Serialize;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;

use super::answered::Looped;
use super::decisions::{DecisionReport, Decisions};
use super::run::{Ending, Tick};
use super::{LoopFailure, LoopTask};
use crate::csv_field::quoted;
use crate::effect::number::true_minus;
use crate::simulation::scatter::Scatter;
use crate::simulation::{DeviceRun, ErrorReport};

/// A fault as a summary has it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FaultEntry {
    /// When it was entered, s.
    pub time_s: f64,
    /// Code of the fault.
    pub code: u16,
    /// In words.
    pub fault: String,
}

/// One object in `runs` of `summary.json`.
#[derive(Clone, Debug, Serialize)]
pub struct LoopSummary {
    /// Device.
    pub device: String,
    /// Law.
    pub law: String,
    /// Estimator.
    pub estimator: String,
    /// Outcome.
    pub outcome: Outcome,
    /// max |θ|/α; null when overturned.
    pub peak_rotation: Option<f64>,
    /// Outcome of the ideal pair without a controller.
    pub ideal_outcome: Outcome,
    /// Its max |θ|/α.
    pub ideal_peak_rotation: Option<f64>,
    /// Relative change of the peak against it.
    pub peak_change: Option<f64>,
    /// Impacts.
    pub impacts: u32,
    /// Control ticks while the scene lasted, without those of the stillness before.
    pub ticks: u64,
    /// How good the decisions were.
    pub decisions: DecisionReport,
    /// Engagements that the clutches missed.
    pub missed_engagements: u32,
    /// State of the controller at the end, or when the fall began.
    pub controller_state: String,
    /// Faults, but for those of a fall.
    pub faults: Vec<FaultEntry>,
    /// How accurate it is, where that was asked for.
    #[serde(rename = "error_estimate", skip_serializing_if = "Option::is_none")]
    pub error: Option<ErrorReport>,
    /// Of a Monte-Carlo run.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub monte_carlo: Option<Scatter>,
}

/// A loop with everything that was seen of it.
#[derive(Clone, Debug)]
pub struct LoopReport {
    /// Figures of the run.
    pub summary: LoopSummary,
    /// Ticks of the controller.
    pub ticks: Vec<Tick>,
    /// The ideal pair without a controller.
    pub ideal: DeviceRun,
}

impl LoopReport {
    /// Report of what [`LoopTask::answered`] gave, beside the ideal pair.
    ///
    /// # Errors
    /// [`LoopFailure`] where the ideal pair cannot be followed.
    pub fn of_answer(
        task: &LoopTask<'_>,
        error: Option<ErrorReport>,
        looped: Looped<Vec<Tick>>,
    ) -> Result<LoopReport, LoopFailure> {
        let mut report = LoopReport::new(task, looped.ending, &looped.extremes.peaks, task.ideal()?, looped.ticks);
        report.summary.error = error;
        Ok(report)
    }

    /// Report of a loop that has ended.
    pub fn new(task: &LoopTask<'_>, ending: Ending, peaks: &Peaks<f64>, ideal: DeviceRun, ticks: Vec<Tick>) -> LoopReport {
        let outcome = Outcome::of(&ending.motion, peaks);
        let peak = (!outcome.overturned()).then_some(peaks.rotation / task.scene.block.slenderness());
        let faults =
            ending.faults.iter().map(|(time, fault)| FaultEntry { time_s: *time, code: fault.code(), fault: fault.to_string() });
        let summary = LoopSummary {
            device: task.scene.devices[task.index].name.clone(),
            law: task.controller.law.name().to_owned(),
            estimator: task.controller.estimator.name().to_owned(),
            outcome,
            peak_rotation: peak,
            ideal_outcome: ideal.outcome,
            ideal_peak_rotation: ideal.peak_rotation,
            peak_change: peak.zip(ideal.peak_rotation).filter(|(_, ideal)| *ideal > 0.0).map(|(peak, ideal)| peak / ideal - 1.0),
            impacts: ending.motion.impacts,
            ticks: ending.ticks,
            decisions: Decisions::of(&ticks).report(),
            missed_engagements: ending.missed,
            controller_state: format!("{:?}", ending.phase).to_lowercase(),
            faults: faults.collect(),
            error: None,
            monte_carlo: None,
        };
        LoopReport { summary, ticks, ideal }
    }
}

impl fmt::Display for LoopSummary {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
        writeln!(out, "{}: {} by {}", self.device, self.law, self.estimator)?;
        writeln!(
            out,
            "  closed loop  {:26} max |θ|/α {}  impacts {}",
            self.outcome.name(),
            number(self.peak_rotation),
            self.impacts
        )?;
        writeln!(out, "  ideal pair   {:26} max |θ|/α {}", self.ideal_outcome.name(), number(self.ideal_peak_rotation))?;
        let delayed = |delay: f64| true_minus(&format!("{:.2} ms", 1e3 * delay));
        let milliseconds = |delay: Option<f64>| delay.map_or_else(|| "-".to_owned(), delayed);
        let DecisionReport { wrong_share, delay_median_s, delay_95_s, switches, ideal_switches, .. } = &self.decisions;
        writeln!(
            out,
            "  decisions    wrong {:.2} % of the way, late by {} (median), {} (95th percentile)",
            100.0 * wrong_share,
            milliseconds(*delay_median_s),
            milliseconds(*delay_95_s)
        )?;
        writeln!(out, "  switches     {switches}, by the law on the true motion {ideal_switches}")?;
        let when = if self.outcome.overturned() { "when the fall began" } else { "at the end" };
        writeln!(
            out,
            "  controller   {} {when}; {} ticks after the stillness before the motion",
            self.controller_state, self.ticks
        )?;
        for fault in &self.faults {
            writeln!(out, "  fault {}     at {:.4} s: {}", fault.code, fault.time_s, fault.fault)?;
        }
        if let Some(error) = &self.error {
            writeln!(out, "  accuracy     {}", error.words(self.peak_rotation))?;
        }
        if let Some(scatter) = &self.monte_carlo {
            writeln!(
                out,
                "  {} specimens  {} overturned, max |θ|/α {} / {} / {} (5, 50, 95 %)",
                scatter.specimens,
                scatter.overturned,
                number(scatter.peak_rotation_05),
                number(scatter.peak_rotation_median),
                number(scatter.peak_rotation_95)
            )?;
        }
        Ok(())
    }
}

/// Which clutches are engaged, as a number: 0 none, 1 the first, 2 the second, 3 both.
pub fn clutches(engaged: [bool; 2]) -> u8 {
    u8::from(engaged[0]) + 2 * u8::from(engaged[1])
}

/// Columns of the history.
const COLUMNS: &str = "device,time_s,ground_m_s2,rotation_rad,velocity_rad_s,push_1_s2,rotation_estimated_rad,velocity_estimated_rad_s,\
    push_estimated_1_s2,standing_estimated,wish,command,engaged,ideal,state,fault";

/// Writes one row a tick: truth, estimates, commands and clutches (0 none, 1 first, 2 second, 3 both).
///
/// # Errors
/// The errors of the writer.
pub fn write_history(reports: &[LoopReport], mut out: impl Write) -> Result<(), csv::Error> {
    writeln!(out, "{COLUMNS}")?;
    for report in reports {
        // Nothing else needs quotes, and there are many ticks.
        let device = quoted(&report.summary.device)?;
        for tick in &report.ticks {
            let (plant, decision) = (&tick.plant, &tick.decision);
            let estimate = &decision.estimate;
            writeln!(
                out,
                "{device},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                plant.time,
                plant.ground[0] * sprag_shared::structure::block::GRAVITY,
                plant.motion.rotation,
                plant.motion.velocity,
                plant.push,
                estimate.rotation,
                estimate.velocity,
                estimate.push,
                u8::from(estimate.standing),
                format!("{:?}", decision.wish).to_lowercase(),
                clutches(decision.command),
                clutches(plant.engaged),
                u8::from(tick.ideal),
                format!("{:?}", decision.phase).to_lowercase(),
                decision.fault.map_or(0, |fault| fault.code()),
            )?;
        }
    }
    Ok(())
}
