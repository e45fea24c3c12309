//! A simulated closed loop as its figure shows it.

use sprag_shared::observers::counted_swing::clutches;
use sprag_shared::structure::block::Block;
use sprag_sim::closed_loop::report::LoopReport;
use sprag_sim::closed_loop::run::Tick;

use super::LoopTrace;

impl LoopTrace {
    /// What the figure of a closed loop around `block` shows of it.
    pub fn of(report: &LoopReport, block: &Block) -> LoopTrace {
        let (alpha, p) = (block.slenderness(), block.frequency_parameter());
        let each = |pick: &dyn Fn(&Tick) -> f64| report.ticks.iter().map(pick).collect::<Vec<f64>>();
        let codes = |pick: &dyn Fn(&Tick) -> u8| report.ticks.iter().map(pick).collect::<Vec<u8>>();
        LoopTrace {
            frequency_parameter_1_s: p,
            time: each(&|tick| tick.plant.time),
            ground_g: each(&|tick| tick.plant.ground[0]),
            rotation: each(&|tick| tick.plant.motion.rotation / alpha),
            rotation_ideal: report
                .ideal
                .history
                .samples
                .iter()
                .map(|sample| (sample.time_s, sample.rotation_rad / alpha))
                .collect(),
            rotation_host: Vec::new(),
            velocity: each(&|tick| tick.plant.motion.velocity / (p * alpha)),
            velocity_estimated: each(&|tick| f64::from(tick.decision.estimate.velocity) / (p * alpha)),
            push: each(&|tick| tick.plant.push / (p * p * alpha)),
            push_estimated: each(&|tick| f64::from(tick.decision.estimate.push) / (p * p * alpha)),
            engaged: codes(&|tick| clutches(tick.plant.engaged)),
            commanded: codes(&|tick| clutches(tick.decision.command)),
            ideal: report.ticks.iter().map(|tick| tick.ideal).collect(),
            faults: report.summary.faults.iter().map(|fault| (fault.time_s, format!("{} {}", fault.code, fault.fault))).collect(),
        }
    }
}
