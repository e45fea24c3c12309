//! `sprag loop`: the controller in closed loop with the plant, its sensors and its clutches.

use std::num::NonZeroUsize;
use std::ops::Range;
use std::time::Instant;

use clap::Args;
use rayon::ThreadPool;
use serde::Serialize;
use sprag_report::columns::Column;
use sprag_report::heading::of_scene;
use sprag_report::output::{ResultFolder, Subject};
use sprag_report::plot::{FigureTitle, LoopTrace, loop_figure};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::budget;
use sprag_sim::closed_loop::decisions::Decisions;
use sprag_sim::closed_loop::report::{LoopReport, LoopSummary, write_history};
use sprag_sim::closed_loop::{LoopFailure, LoopScene};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::warning_lines;
use sprag_sim::scene::Scene;

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::loop_scene;
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::report::{Report, SceneInput};
use super::scene_arguments::SceneArguments;
use super::specimens::{SPECIMENS, Specimen, columns, in_turn, monte_carlo};
use super::thread_arguments::ThreadArguments;

/// Run the controller of a scene in closed loop.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag loop scenes/controller.toml\n  \
    sprag loop scenes/controller.toml --set controller.law=gated-table --out out/gated\n  \
    sprag loop scenes/controller.toml --monte-carlo 200\n\n\
    The scene needs a device of kind clutched-pair; without a [controller] table it has the default controller. Writes summary.json, history.csv and loop.svg; with --monte-carlo also monte_carlo.csv; with --png loop.png.")]
pub struct LoopArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub records: SceneRecordArguments,
    /// Run so many specimens of the sensors, each with noise and errors of its own, and with other impacts where these scatter.
    #[arg(long, value_name = "N", value_parser = super::whole_number(SPECIMENS))]
    pub monte_carlo: Option<NonZeroUsize>,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

/// What `summary.json` says of the loops.
#[derive(Serialize)]
struct Answer<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    monte_carlo: Option<NonZeroUsize>,
    runs: &'a [LoopSummary],
}

impl Run for LoopArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder_at(&self.scene.scene, "loop", &self.accuracy)?;
        let (pool, interrupt) = (self.threads.pool()?, context.interrupt);
        let mut run = |change| looped(self, change, &mut folder, interrupt);
        let (desk, subject, mut reports) = match (self.monte_carlo, self.accuracy.time_budget) {
            (Some(count), Some(seconds)) => {
                let start = Instant::now();
                let plan = budget::plan(
                    seconds,
                    self.accuracy.accuracy,
                    |accuracy| sample(&pool, count, || run(Some(AccuracyArguments::change(accuracy))), interrupt),
                    || start.elapsed(),
                )?;
                context.note(plan);
                run(Some(AccuracyArguments::change(plan.accuracy)))?
            }
            _ => self.accuracy.run(context, run)?,
        };
        let of_loop = |report: &LoopReport| report.summary.warning(&desk.scene.origin, desk.controller.prelude_s);
        let of_loops = reports.iter().filter_map(of_loop);
        let of_controllers =
            desk.pairs.iter().filter_map(|&index| desk.task(index, desk.controller.sensors.seed(), interrupt).warning());
        let of_scene = desk.scene.warnings().into_iter().chain(warning_lines(&desk.ground.records));
        let warnings = context.warned(of_scene.chain(of_controllers).chain(of_loops));
        let mut report = Report::new("loop", &folder, &self.output)?;
        if let Some(count) = self.monte_carlo {
            let [switches, chatter, faults] = ["switches", "chatter", "faults"].map(Column::count);
            let more = [Column::number("wrong_share"), switches, chatter, faults];
            report.rows_from("monte_carlo", &columns(more), |row| {
                let name = |&index: &usize| (index, desk.scene.devices[index].name.as_str());
                let devices: Vec<_> = desk.pairs.iter().map(name).collect();
                let unchecked = desk.unchecked();
                let some = |index, numbers| specimens(&unchecked, index, numbers, interrupt);
                let scattered = monte_carlo(&pool, &devices, (count, 1), some, row)?;
                for (report, of) in reports.iter_mut().zip(scattered) {
                    report.summary.monte_carlo = Some(of.scatter);
                }
                Ok(())
            })?;
        }
        let runs: Vec<LoopSummary> = reports.iter().map(|report| report.summary.clone()).collect();
        let (file, answer) = (desk.resolved(), Answer { monte_carlo: self.monte_carlo, runs: &runs });
        let input = SceneInput { scene: &file };
        report.summary(input, &desk.ground.records, &warnings, &subject, answer)?;
        report.file("history.csv", |file| write_history(&reports, file).map_err(std::io::Error::other))?;
        for (number, closed) in reports.iter().enumerate() {
            let trace = LoopTrace::of(closed, &desk.scene.block);
            let picture = loop_figure(heading(&desk.scene, closed), &trace, desk.scene.file.output.time_axis.into());
            report.picture(&numbered("loop", number), picture)?;
        }
        runs.iter().for_each(|run| report.print(run));
        report.note_checks(runs.iter().map(|run| (run.device.as_str(), run.checks.as_ref())));
        report.finish(&folder, context)
    }
}

/// Name of a result of the device with this index.
pub(super) fn numbered(name: &str, index: usize) -> String {
    if index == 0 { name.to_owned() } else { format!("{name}-{}", index + 1) }
}

/// A loop that failed, of a device of the scene.
pub(super) fn failed(desk: &LoopScene, index: usize, failure: impl Into<LoopFailure>) -> anyhow::Error {
    anyhow::anyhow!("{}: {}", desk.scene.devices[index].name, failure.into())
}

/// The scene with `change`, and a loop for each of its pairs.
fn looped(
    arguments: &LoopArguments,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<(LoopScene, Subject, Vec<LoopReport>)> {
    let desk = loop_scene::load(&arguments.scene.scene, &arguments.scene.changes(change), &arguments.records)?;
    let file = desk.resolved();
    let names = &["history", "loop", "monte_carlo"];
    let mut claim = claim_of_scene("loop", &arguments.scene.scene, &desk.scene, &file, names, &[])?;
    claim.subject = claim.subject.with("monte_carlo", &arguments.monte_carlo)?;
    folder.open(&claim)?;
    let _running = Progress::uncounted("running the loop");
    let mut reports: Vec<LoopReport> = Vec::new();
    for &index in &desk.pairs {
        let failed = |failure| failed(&desk, index, failure);
        let task = desk.task(index, desk.controller.sensors.seed(), interrupt);
        let (task, error, looped) = task.answered().map_err(failed)?;
        reports.push(LoopReport::of_answer(&task, error, looped).map_err(failed)?);
    }
    Ok((desk, claim.subject, reports))
}

pub(super) fn heading(scene: &Scene, report: &LoopReport) -> FigureTitle {
    let title = if scene.file.title.is_empty() { "Closed loop" } else { &scene.file.title };
    let text = format!("{title}: {}, {}, {}", report.summary.device, report.summary.law, report.summary.estimator);
    FigureTitle { text, conditions: of_scene(scene) }
}

/// The pair `index` with the seeds of its sensors that come `numbers` places after that of the scene.
fn specimens(desk: &LoopScene, index: usize, numbers: Range<u64>, interrupt: &Interrupt) -> anyhow::Result<Vec<Specimen<4>>> {
    let one = |number| {
        let seed = desk.controller.sensors.seed().wrapping_add(number);
        // As accurately as the scene asks, as the loop itself.
        let answered = desk.task(index, seed, interrupt).answered::<Decisions>();
        let (.., looped) = answered.map_err(|failure| failed(desk, index, failure))?;
        let (decisions, faults) = (looped.ticks.report(), looped.ending.faults.len());
        Ok(Specimen {
            seed,
            outcome: looped.outcome(),
            peak: Some(looped.extremes.peaks.rotation / desk.scene.block.slenderness()),
            more: [decisions.wrong_share.into(), decisions.switches.into(), decisions.chatter.into(), faults.into()],
        })
    };
    numbers.map(one).collect()
}

/// Specimens of a pair and a thread that are tried to learn what all of them take.
const SAMPLE: usize = 4;

/// Runs the loops by `run` and some of `count` specimens, to learn what all of that takes.
fn sample(
    pool: &ThreadPool,
    count: NonZeroUsize,
    run: impl FnOnce() -> anyhow::Result<(LoopScene, Subject, Vec<LoopReport>)>,
    interrupt: &Interrupt,
) -> anyhow::Result<budget::Sample> {
    let start = Instant::now();
    let (desk, _, reports) = run()?;
    let loops = start.elapsed();
    let _trying = Progress::uncounted(super::TRYING);
    let some = count.get().min(SAMPLE * pool.current_num_threads());
    let desk = desk.unchecked();
    let start = Instant::now();
    for &index in &desk.pairs {
        in_turn(pool, (some, 1), |numbers| specimens(&desk, index, numbers, interrupt), |_| Ok(()))?;
    }
    let each = start.elapsed().as_secs_f64() / some as f64;
    let errors = reports.iter().filter_map(|report| report.summary.error?.estimate.of_peak(report.summary.peak_rotation));
    let error = errors.reduce(f64::max);
    Ok(budget::Sample { seconds: loops.as_secs_f64() + count.get() as f64 * each, error, of: "the loop itself" })
}
