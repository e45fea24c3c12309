//! `sprag loop`: the controller in closed loop with the plant, its sensors and its clutches.

use std::collections::BTreeMap;
use std::io::Write;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use rayon::ThreadPool;
use rayon::prelude::*;
use serde::Serialize;
use sprag_report::heading::of_scene;
use sprag_report::output::{Digest, OutputError, ResultFolder, Results, Subject};
use sprag_report::plot::{FigureTitle, PlotError, loop_figure};
use sprag_report::progress::Progress;
use sprag_shared::observers::outcome::Outcome;
use sprag_sim::accuracy::budget;
use sprag_sim::closed_loop::LoopFailure;
use sprag_sim::closed_loop::answered::Looped;
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::report::{LoopReport, LoopSummary, write_history};
use sprag_sim::closed_loop::run::{Ending, Tick};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::Scene;
use sprag_sim::scene::schema::SceneFile;
use sprag_studies::statistics::quantile;

use super::accuracy_arguments::AccuracyArguments;
use super::format_arguments::PictureArguments;
use super::loop_scene::{LoopScene, LoopSceneError};
use super::loop_trace::loop_trace;
use super::out_arguments::{FolderArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::{DRAWING, ended, warned};

/// Run the controller of a scene in closed loop.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag loop scenes/controller.toml\n  \
    sprag loop scenes/controller.toml --set controller.law=gated-table --out out/gated\n  \
    sprag loop scenes/controller.toml --monte-carlo 200\n\n\
    Writes summary.json, history.csv and loop.svg; with --monte-carlo also monte_carlo.csv; with --png loop.png.")]
pub struct LoopArguments {
    /// Scene file with a clutched pair and a controller table.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Change one value of the scene, such as controller.rate_hz=1000.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Records.
    #[command(flatten)]
    pub records: SceneRecordArguments,
    /// Run so many specimens of the sensors, each with noise and errors of its own.
    #[arg(long, value_name = "N", value_parser = specimen_count)]
    pub monte_carlo: Option<NonZeroUsize>,
    /// Threads of --monte-carlo; all processors by default. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = super::threads)]
    pub threads: Option<u16>,
    /// Where results go.
    #[command(flatten)]
    pub folder: FolderArguments,
    /// Pictures.
    #[command(flatten)]
    pub pictures: PictureArguments,
    /// How accurate.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

/// The most specimens of the sensors.
const MOST_SPECIMENS: u64 = 1_000_000_000;

fn specimen_count(text: &str) -> Result<NonZeroUsize, String> {
    let count = super::whole_number(text, 1, MOST_SPECIMENS)?;
    NonZeroUsize::new(count as usize).ok_or_else(|| "must not be 0".to_owned())
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Scene(#[from] LoopSceneError),
    #[error("{device}: {failure}")]
    Loop { device: String, failure: LoopFailure },
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] PlotError),
    #[error("{0}")]
    Output(#[from] OutputError),
    #[error("no threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    #[error("{0}")]
    Budget(#[from] budget::TooLittleTime),
    #[error("interrupted")]
    Interrupted,
}

#[derive(Serialize)]
struct Summary<'a> {
    command: &'static str,
    version: &'static str,
    scene: &'a SceneFile,
    records: &'a [RecordSummary],
    warnings: &'a [String],
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    files: &'a BTreeMap<String, Digest>,
    #[serde(skip_serializing_if = "Option::is_none")]
    monte_carlo: Option<NonZeroUsize>,
    runs: &'a [LoopSummary],
}

/// Runs the command; a table goes to `out`, errors go to `err`.
pub fn run(arguments: &LoopArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result.map(|()| true), interrupt, err)
}

fn run_or_fail(
    arguments: &LoopArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = arguments.folder.folder(&arguments.scene, "loop").of_any_accuracy(any_accuracy);
    let mut tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build()?;
    let mut run = |change| looped(arguments, change, &mut folder, interrupt);
    let (desk, subject, mut reports) = match (arguments.monte_carlo, arguments.accuracy.time_budget) {
        (Some(count), Some(seconds)) => {
            let start = Instant::now();
            let plan = budget::plan(
                seconds,
                arguments.accuracy.accuracy,
                |accuracy| sample(&pool, count, || run(Some(AccuracyArguments::change(accuracy))), interrupt),
                || start.elapsed(),
            )?;
            tell(&plan.to_string());
            run(Some(AccuracyArguments::change(plan.accuracy)))?
        }
        _ => arguments.accuracy.run(run, tell)?,
    };
    let scene = &desk.scene;
    let warnings = warned(desk.scene.warnings().into_iter().chain(warning_lines(&desk.ground.records)), err);
    let mut results = Results::default();
    if let Some(count) = arguments.monte_carlo {
        let table = monte_carlo(&pool, &desk, &mut reports, count, interrupt)?;
        results.add(&folder.join("monte_carlo.csv"), |file| file.write_all(table.as_bytes()))?;
    }
    let drawing = Progress::uncounted(DRAWING);
    let summaries: Vec<LoopSummary> = reports.iter().map(|report| report.summary.clone()).collect();
    let (file, records, files) = (desk.resolved(), &desk.ground.records, &subject.files);
    let (command, version, monte_carlo, runs) = ("loop", env!("CARGO_PKG_VERSION"), arguments.monte_carlo, &summaries);
    let summary = Summary { command, version, scene: &file, records, warnings: &warnings, files, monte_carlo, runs };
    results.add_json(&folder.join("summary.json"), &summary)?;
    results.add(&folder.join("history.csv"), |file| write_history(&reports, file).map_err(std::io::Error::other))?;
    for (number, report) in reports.iter().enumerate() {
        let picture = loop_figure(heading(scene, report), &loop_trace(report, &scene.block))?;
        let name = if number == 0 { "loop".to_owned() } else { format!("loop-{}", number + 1) };
        results.add_picture(&folder, &name, &picture, arguments.pictures.formats)?;
    }
    if interrupt.is_set() {
        return Err(Failure::Interrupted);
    }
    results.commit_telling(err)?;
    drawing.finish();
    for summary in &summaries {
        let _ = write!(out, "{summary}");
    }
    let _ = writeln!(out, "results in {}", folder.display());
    Ok(())
}

/// The scene with `change`, and a loop for each of its pairs.
fn looped(
    arguments: &LoopArguments,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> Result<(LoopScene, Subject, Vec<LoopReport>), Failure> {
    let mut changes = arguments.set.clone();
    changes.extend(change);
    let desk = LoopScene::load(&arguments.scene, &changes, &arguments.records)?;
    let file = desk.resolved();
    let names = &["history", "loop", "monte_carlo"];
    let mut claim = claim_of_scene("loop", &arguments.scene, &desk.scene, &file, names, &[])?;
    claim.subject = claim.subject.with("monte_carlo", &arguments.monte_carlo)?;
    folder.open(&claim)?;
    let _running = Progress::uncounted("running the loop");
    let mut reports: Vec<LoopReport> = Vec::new();
    for &index in &desk.pairs {
        let failed = |failure| Failure::Loop { device: desk.scene.devices[index].name.clone(), failure };
        let task = desk.task(index, desk.controller.sensors.seed(), interrupt);
        let (task, error, Looped { ending, extremes, ticks, .. }) = task.answered::<Vec<Tick>>().map_err(failed)?;
        let ideal = task.ideal().map_err(failed)?;
        let mut report = LoopReport::new(&task, ending, &extremes.peaks, ideal, ticks);
        report.summary.error = error;
        reports.push(report);
    }
    Ok((desk, claim.subject, reports))
}

pub(super) fn heading(scene: &Scene, report: &LoopReport) -> FigureTitle {
    let title = if scene.file.title.is_empty() { "Closed loop" } else { &scene.file.title };
    let text = format!("{title}: {}, {}, {}", report.summary.device, report.summary.law, report.summary.estimator);
    FigureTitle { text, conditions: of_scene(scene) }
}

/// One specimen of the sensors.
struct Specimen {
    seed: u64,
    outcome: Outcome,
    peak: f64,
    ending: Ending,
}

/// Runs the first `count` specimens with pair `index`; `done` hears of each.
fn specimens(
    pool: &ThreadPool,
    desk: &LoopScene,
    index: usize,
    count: usize,
    interrupt: &Interrupt,
    done: impl Fn() + Sync,
) -> Result<Vec<Specimen>, Failure> {
    let alpha = desk.scene.block.slenderness();
    let one = |number: u64| {
        let seed = desk.controller.sensors.seed().wrapping_add(number);
        let mut extremes = Extremes::default();
        let ending = desk.task(index, seed, interrupt).run(&mut extremes, &mut ());
        done();
        let outcome = |ending: &Ending| Outcome::of(&ending.motion, &extremes.peaks);
        ending.map(|ending| Specimen { seed, outcome: outcome(&ending), peak: extremes.peaks.rotation / alpha, ending })
    };
    let runs: Vec<_> = pool.install(|| (0..count as u64).into_par_iter().map(one).collect());
    let failed = |failure| Failure::Loop { device: desk.scene.devices[index].name.clone(), failure };
    runs.into_iter().map(|run| run.map_err(failed)).collect()
}

/// Specimens of a pair and a thread that are tried to learn what all of them take.
const SAMPLE: usize = 4;

/// Runs the loops by `run` and some of `count` specimens, to learn what all of that takes.
fn sample(
    pool: &ThreadPool,
    count: NonZeroUsize,
    run: impl FnOnce() -> Result<(LoopScene, Subject, Vec<LoopReport>), Failure>,
    interrupt: &Interrupt,
) -> Result<budget::Sample, Failure> {
    let start = Instant::now();
    let (desk, _, reports) = run()?;
    let loops = start.elapsed();
    let _trying = Progress::uncounted(super::TRYING);
    let some = count.get().min(SAMPLE * pool.current_num_threads());
    let start = Instant::now();
    for &index in &desk.pairs {
        specimens(pool, &desk, index, some, interrupt, || ())?;
    }
    let each = start.elapsed().as_secs_f64() / some as f64;
    let errors = reports.iter().filter_map(|report| Some(report.summary.error?.estimate.relative(report.summary.peak_rotation)));
    let error = errors.fold(0.0, f64::max);
    Ok(budget::Sample { seconds: loops.as_secs_f64() + count.get() as f64 * each, error, of: "the loop itself" })
}

/// Runs `count` specimens of the sensors, puts quantiles into the reports, and returns the table of all.
fn monte_carlo(
    pool: &ThreadPool,
    desk: &LoopScene,
    reports: &mut [LoopReport],
    count: NonZeroUsize,
    interrupt: &Interrupt,
) -> Result<String, Failure> {
    let pairs = &desk.pairs;
    let progress = Progress::new("specimens");
    progress.begin((count.get() * pairs.len()) as u64);
    let mut table = String::from("device,seed,outcome,peak_rotation,wrong_share,switches,chatter,faults\n");
    for (report, &index) in reports.iter_mut().zip(pairs) {
        let runs = specimens(pool, desk, index, count.get(), interrupt, || progress.step())?;
        let (mut peaks, mut overturned) = (Vec::new(), 0);
        for Specimen { seed, outcome, peak, ending } in runs {
            if outcome.overturned() {
                overturned += 1;
            } else {
                peaks.push(peak);
            }
            let decisions = &ending.decisions;
            table.push_str(&format!(
                "\"{}\",{seed},{outcome},{peak},{},{},{},{}\n",
                report.summary.device.replace('"', "\"\""),
                decisions.wrong_share,
                decisions.switches,
                decisions.chatter,
                ending.faults.len()
            ));
        }
        let at = |share: f64| quantile(&peaks, share).filter(|value| value.is_finite());
        report.summary.monte_carlo = Some(sprag_sim::closed_loop::report::Scatter {
            specimens: count.get(),
            overturned,
            peak_rotation_05: at(0.05),
            peak_rotation_median: at(0.5),
            peak_rotation_95: at(0.95),
        });
    }
    progress.finish();
    Ok(table)
}
