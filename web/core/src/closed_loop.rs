//! The controller that is flashed, in closed loop, with parts that fail if the page says so.

use sprag_report::heading::title;
use sprag_report::plot::{LoopTrace, loop_figure};
use sprag_shared::control::controller::Circumstances;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::observers::counted_swing::clutches;
use sprag_shared::structure::block::GRAVITY;
use sprag_sim::closed_loop::disturbance::Disturbance;
use sprag_sim::closed_loop::failing::{ALL, Injected};
use sprag_sim::closed_loop::report::{LoopReport, write_history};
use sprag_sim::closed_loop::run::Tick;
use sprag_sim::closed_loop::{LoopFailure, LoopScene};
use sprag_sim::digest::of_decisions;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::scene::Scene;

use crate::columns::{Column, Columns};
use crate::run::response;
use crate::scene::PageError;

/// Several parts that fail, each from its time on.
struct Several(Vec<Injected>);

impl Disturbance for Several {
    fn disturb(&mut self, time: f64, sample: &mut Sample, circumstances: &mut Circumstances) {
        self.0.iter_mut().for_each(|injected| injected.disturb(time, sample, circumstances));
    }

    fn clutches(&mut self, time: f64, command: [bool; 2], last: [bool; 2]) -> [bool; 2] {
        self.0.iter_mut().fold(command, |command, injected| injected.clutches(time, command, last))
    }
}

/// The parts that can fail: names, which are also how they are shown.
pub fn faults() -> Vec<String> {
    ALL.iter().map(ToString::to_string).collect()
}

/// A loop over the first clutched pair of a scene; each fault begins at its time (s).
///
/// # Errors
/// [`PageError`] for a scene without such a pair, a fault that does not exist, and a loop that cannot be run.
pub fn closed_loop(scene: &Scene, faults: &[(String, f64)]) -> Result<Columns, PageError> {
    let report = report(scene, faults)?;
    let ticks = &report.ticks;
    let numbers = |pick: fn(&Tick) -> f64| Column::Numbers(ticks.iter().map(pick).collect());
    let codes = |pick: fn(&Tick) -> u8| Column::Codes(ticks.iter().map(pick).collect());
    let fault = |tick: &Tick| tick.decision.fault.map_or(0, |fault| fault.code());
    let trace = LoopTrace::of(&report, &scene.block);
    let figure = loop_figure(title(scene), &trace, scene.file.output.time_axis.into()).map_err(PageError::failed)?;
    let mut csv = Vec::new();
    write_history(std::slice::from_ref(&report), &mut csv).map_err(PageError::failed)?;
    Ok(vec![
        ("summary", Column::Text(serde_json::to_string(&report.summary).map_err(PageError::failed)?)),
        ("timeS", numbers(|tick| tick.plant.time)),
        ("groundMS2", numbers(|tick| tick.plant.ground[0] * GRAVITY)),
        ("rotationRad", numbers(|tick| tick.plant.motion.rotation)),
        ("velocityRadS", numbers(|tick| tick.plant.motion.velocity)),
        ("push1S2", numbers(|tick| tick.plant.push)),
        ("rotationEstimatedRad", numbers(|tick| f64::from(tick.decision.estimate.rotation))),
        ("velocityEstimatedRadS", numbers(|tick| f64::from(tick.decision.estimate.velocity))),
        ("pushEstimated1S2", numbers(|tick| f64::from(tick.decision.estimate.push))),
        ("command", codes(|tick| clutches(tick.decision.command))),
        ("engaged", codes(|tick| clutches(tick.plant.engaged))),
        ("ideal", codes(|tick| tick.ideal.into())),
        ("state", codes(|tick| tick.decision.phase as u8)),
        ("states", Column::Texts(Phase::ALL.iter().map(|state| format!("{state:?}").to_lowercase()).collect())),
        ("fault", Column::LongCodes(ticks.iter().map(fault).collect())),
        ("idealPair", Column::Columns(response(&report.ideal)?)),
        ("digest", Column::Text(format!("{:016x}", of_decisions(ticks)))),
        ("csv", Column::Text(String::from_utf8(csv).map_err(PageError::failed)?)),
        ("svg", Column::Text(figure)),
    ])
}

/// The loop of [`closed_loop`] with all its ticks.
///
/// # Errors
/// Those of [`closed_loop`].
pub fn report(scene: &Scene, faults: &[(String, f64)]) -> Result<LoopReport, PageError> {
    let injected = |(name, from): &(String, f64)| {
        let failing = ALL.into_iter().find(|failing| failing.to_string() == *name);
        let failing = failing.ok_or_else(|| PageError::Unknown(name.clone(), self::faults().join(", ")))?;
        Ok(Injected::new(failing, *from))
    };
    let mut several = Several(faults.iter().map(injected).collect::<Result<_, PageError>>()?);
    let desk = LoopScene::new(scene.clone()).map_err(PageError::failed)?;
    let interrupt = Interrupt::default();
    let mut run = || -> Result<LoopReport, LoopFailure> {
        let task = desk.task(desk.pairs[0], desk.controller.sensors.seed(), &interrupt);
        if several.0.is_empty() {
            let (task, error, looped) = task.answered()?;
            return LoopReport::of_answer(&task, error, looped);
        }
        let looped = task.looped(&mut *task.driver()?, &mut several)?;
        LoopReport::of_answer(&task, None, looped)
    };
    run().map_err(PageError::failed)
}
