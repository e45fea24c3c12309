//! What a closed loop leaves: its figures, its history and its picture.

use std::fmt;
use std::io::Write;

use serde::Serialize;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::observers::counted_swing::clutches;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::error::Number;

use super::answered::Looped;
use super::decisions::{DecisionReport, Decisions};
use super::run::Tick;
use super::{LoopFailure, LoopTask};
use crate::csv_field::quoted;
use crate::effect::number::true_minus;
use crate::simulation::demand::Demand;
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
    /// Its state when the motion began, where self-test or calibration was not done by then.
    #[serde(skip)]
    pub unready: Option<String>,
    /// Faults, but for those of a fall.
    pub faults: Vec<FaultEntry>,
    /// What the motion asks of toe, device and gears, where the scene has `[checks]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub checks: Option<Demand>,
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
        let mut report = LoopReport::new(task, looped, task.ideal()?);
        report.summary.error = error;
        Ok(report)
    }

    /// Report of a loop that has ended, beside the run of the `ideal` pair.
    pub fn new(task: &LoopTask<'_>, looped: Looped<Vec<Tick>>, ideal: DeviceRun) -> LoopReport {
        let (outcome, peak) = (looped.outcome(), looped.peak_rotation());
        let Looped { ending, ticks, checks, .. } = looped;
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
            decisions: Decisions::of(&ticks, outcome.overturned()).report(),
            missed_engagements: ending.missed,
            controller_state: state(ending.phase),
            unready: (!ending.began_ready()).then(|| state(ending.began)),
            faults: faults.collect(),
            checks,
            error: None,
            monte_carlo: None,
        };
        LoopReport { summary, ticks, ideal }
    }
}

/// A state of the controller, as summaries have it.
fn state(phase: Phase) -> String {
    format!("{phase:?}").to_lowercase()
}

impl LoopSummary {
    /// What looks like a mistake in the scene from `origin`, with a stillness of `prelude` (s), as [`crate::scene::Scene::warnings`] have it.
    pub fn warning(&self, origin: &str, prelude: f64) -> Option<String> {
        self.unready.as_ref().map(|state| {
            let (device, prelude) = (&self.device, Number(prelude));
            format!(
                "{origin}: controller.prelude_s is {prelude}: the controller of {device} was in {state}, not armed, when the motion \
                 began"
            )
        })
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

#[cfg(test)]
mod tests {
    use super::super::LoopScene;
    use super::*;
    use crate::interrupt::Interrupt;
    use crate::scene::Scene;

    /// Of a loop with so much stillness before the scene and before its pulse, s.
    fn summary(prelude: f64, start: f64) -> LoopSummary {
        let text = format!(
            "block = {{ size_m = 2.0, slenderness_deg = 12.0 }}
            device = [{{ kind = 'clutched-pair', mass_ratio = 0.5, engagement = 'rigid' }}]
            ground = [{{ motion = 'sine', amplitude_g = 0.4, frequency_hz = 1.3, start_s = {start} }}]
            run = {{ free_time_s = 0.0 }}
            controller = {{ rate_hz = 500.0, prelude_s = {prelude} }}"
        );
        let desk = LoopScene::new(Scene::parse(&text, "scene").unwrap()).unwrap();
        let interrupt = Interrupt::default();
        let (task, error, looped) = desk.task(0, 1, &interrupt).answered().unwrap();
        LoopReport::of_answer(&task, error, looped).unwrap().summary
    }

    /// Self-test and calibration take 1.3 s.
    #[test]
    fn a_controller_that_is_not_armed_when_the_motion_begins_is_warned_of() {
        for (prelude, start, armed) in
            [(2.0, 0.0, true), (0.5, 0.0, false), (0.0, 0.0, false), (0.5, 1.5, true), (0.5, 0.2, false)]
        {
            let summary = summary(prelude, start);
            let warning = summary.warning("scene", prelude);
            assert_eq!(warning.is_none(), armed, "{prelude} s, {start} s: {warning:?}");
            assert!(!summary.to_string().contains("not armed"), "said twice");
            assert!(warning.is_none_or(|line| line.starts_with(&format!("scene: controller.prelude_s is {prelude}: "))));
        }
    }
}
