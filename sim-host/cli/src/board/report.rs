//! What a closed loop with a device comes to, beyond what one without a device does.

use std::fmt;

use serde::Serialize;
use sprag_report::text_table::TextTable;
use sprag_shared::link::TickReport;
use sprag_shared::observers::counted_swing::clutches;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::closed_loop::report::LoopSummary;

use super::driver::DeviceTick;

/// One object in `runs` of `summary.json`: that of `sprag loop`, and how the device did.
#[derive(Clone, Debug, Serialize)]
pub struct DeviceSummary {
    /// As `sprag loop` has it, of the loop that the device closed.
    #[serde(flatten)]
    pub closed: LoopSummary,
    /// Outcome of the loop that the host closed.
    pub host_outcome: Outcome,
    /// Its max |θ|/α.
    pub host_peak_rotation: Option<f64>,
    /// Ticks of the device, with those of the stillness before the motion.
    pub device_ticks: usize,
    /// Of these, decisions that are not those of the host's own controller, to the last bit; and ticks without a report.
    pub ticks_differing: usize,
    /// Ticks in a second of the host's time.
    pub ticks_per_second: f64,
    /// The same over the controller's rate: above 1 is faster than real time.
    pub times_real_time: f64,
    /// Median of what a tick took while the controller was armed; counts of the device's counter: in the emulator instructions, on a board cycles.
    pub instructions_per_tick: Option<u32>,
    /// The most.
    pub instructions_per_tick_worst: Option<u32>,
    /// Deepest stack, bytes.
    pub stack_bytes: u32,
    /// Version and build of the firmware, and its board.
    pub firmware: String,
}

/// Median and largest cost of the ticks in which the controller decided.
pub fn costs(ticks: &[DeviceTick]) -> Option<(u32, u32)> {
    use sprag_shared::control::supervisor::Phase;
    let mut costs: Vec<u32> = ticks
        .iter()
        .filter_map(|tick| tick.report)
        .filter(|report| matches!(report.decision.phase, Phase::Armed | Phase::Rocking))
        .map(|report| report.cost)
        .collect();
    costs.sort_unstable();
    Some((*costs.get(costs.len() / 2)?, *costs.last()?))
}

impl fmt::Display for DeviceSummary {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.closed)?;
        writeln!(
            out,
            "  host's loop  {:26} max |θ|/α {}",
            self.host_outcome.name(),
            self.host_peak_rotation.map_or_else(|| "-".to_owned(), |peak| format!("{peak:.4}"))
        )?;
        writeln!(
            out,
            "  device       {}: {} ticks, {}, {:.0} ticks a second ({:.1} times real time)",
            self.firmware,
            self.device_ticks,
            match self.ticks_differing {
                0 => "all decided as by the host".to_owned(),
                differing => format!("{differing} of them decided otherwise than by the host"),
            },
            self.ticks_per_second,
            self.times_real_time
        )?;
        if let (Some(median), Some(worst)) = (self.instructions_per_tick, self.instructions_per_tick_worst) {
            writeln!(
                out,
                "               a tick took {median} counts (median), {worst} at most: instructions in the emulator, cycles on a board; stack {} bytes",
                self.stack_bytes
            )?;
        }
        Ok(())
    }
}

/// One row a tick of the device, from the first one of the stillness before the motion.
pub fn device_ticks(runs: &[(String, Vec<DeviceTick>)]) -> TextTable {
    let columns = ["device", "tick", "device_tick", "counts", "late_counts", "differs", "command", "state", "fault"];
    let mut table = TextTable::new(1, columns);
    for (device, ticks) in runs {
        for (number, tick) in ticks.iter().enumerate() {
            let of_report = |value: &dyn Fn(&TickReport) -> String| tick.report.as_ref().map_or_else(String::new, value);
            table.row(vec![
                device.clone(),
                (number + 1).to_string(),
                of_report(&|report| report.tick.to_string()),
                of_report(&|report| report.cost.to_string()),
                of_report(&|report| report.lateness.to_string()),
                u8::from(tick.differs).to_string(),
                of_report(&|report| clutches(report.decision.command).to_string()),
                of_report(&|report| format!("{:?}", report.decision.phase).to_lowercase()),
                of_report(&|report| report.decision.fault.map_or(0, |fault| fault.code()).to_string()),
            ]);
        }
    }
    table
}
