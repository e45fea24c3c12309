//! `sprag simulate`: one scene, every device, a summary, a history and a picture.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::heading::title;
use sprag_report::output::{Digest, OutputError, ResultFolder, Results, Subject};
use sprag_report::plot::{PlotError, TimeAxis, energy_figure, history_figure};
use sprag_report::progress::Progress;
use sprag_report::summary_table::{SummaryRow, summary_table};
use sprag_sim::history::{History, write_csv};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::ground::GroundError;
use sprag_sim::scene::schema::{SceneFile, TimeAxisName};
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::simulation::energy::write_energy;
use sprag_sim::simulation::{DeviceRun, RunError, simulate};

use super::accuracy_arguments::AccuracyArguments;
use super::format_arguments::PictureArguments;
use super::out_arguments::{FolderArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::{DRAWING, ended, warned};

/// Simulate a scene: every device under the same ground motion.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag simulate scenes/near_fault.toml\n  \
    sprag simulate scenes/record.toml --record RSN181_IMPVALL.H_H-E06230.AT2 --out out/imperial\n  \
    sprag simulate scenes/figure10.toml --set accuracy.method=runge-kutta-4 --set accuracy.step_ratio=1e-3\n\n\
    Writes summary.json, history.csv and history.svg; with output.energy also energy.csv and energy.svg; with --png the pictures \
    as .png too.")]
pub struct SimulateArguments {
    /// Scene file.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Change one value of the scene, such as block.size_m=2 or device.1.mass_ratio=0.5.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Records.
    #[command(flatten)]
    pub records: SceneRecordArguments,
    /// Where results go.
    #[command(flatten)]
    pub folder: FolderArguments,
    /// How accurate.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    /// Pictures.
    #[command(flatten)]
    pub pictures: PictureArguments,
    /// Show the picture.
    #[arg(long)]
    pub open: bool,
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Ground(#[from] GroundError),
    #[error("{0}")]
    Run(#[from] RunError),
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] PlotError),
    #[error("{0}")]
    Output(#[from] OutputError),
}

/// `summary.json`.
#[derive(Serialize)]
struct Summary<'a> {
    command: &'static str,
    version: &'static str,
    scene: &'a SceneFile,
    records: &'a [RecordSummary],
    warnings: &'a [String],
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    files: &'a BTreeMap<String, Digest>,
    runs: &'a [DeviceRun],
}

/// Runs the command; a table goes to `out`, errors go to `err`.
pub fn run(arguments: &SimulateArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result.map(|()| true), interrupt, err)
}

fn run_or_fail(
    arguments: &SimulateArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = arguments.folder.folder(&arguments.scene, "simulate").of_any_accuracy(any_accuracy);
    let mut warnings = warned(Scene::load(&arguments.scene, &arguments.set)?.warnings(), err);
    let tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let Simulated { scene, subject, records, mut runs } =
        arguments.accuracy.run(|change| simulated(arguments, change, &mut folder, interrupt), tell)?;
    warnings.extend(warned(warning_lines(&records), err));
    let drawing = Progress::uncounted(DRAWING);
    let rows: Vec<SummaryRow> = runs.iter().map(row).collect();
    let axis = match scene.file.output.time_axis {
        TimeAxisName::Seconds => TimeAxis::Seconds,
        TimeAxisName::FrequencyParameter => TimeAxis::TimesFrequencyParameter,
    };
    let histories: Vec<History> = runs.iter_mut().map(|run| std::mem::take(&mut run.history)).collect();
    let figure = history_figure(title(&scene), &histories, axis)?;
    let (command, version, files) = ("simulate", env!("CARGO_PKG_VERSION"), &subject.files);
    let (records, warnings) = (&records, &warnings);
    let summary = Summary { command, version, scene: &scene.file, records, warnings, files, runs: &runs };
    let formats = arguments.pictures.formats;
    let mut results = Results::default();
    results.add_json(&folder.join("summary.json"), &summary)?;
    results.add(&folder.join("history.csv"), |file| write_csv(&histories, file).map_err(std::io::Error::other))?;
    let picture = results.add_picture(&folder, "history", &figure, formats)?;
    if scene.file.output.energy {
        let figure = energy_figure(title(&scene), &runs)?;
        results.add(&folder.join("energy.csv"), |file| write_energy(&runs, file).map_err(std::io::Error::other))?;
        results.add_picture(&folder, "energy", &figure, formats)?;
    }
    if interrupt.is_set() {
        return Err(RunError::Interrupted.into());
    }
    results.commit_telling(err)?;
    drawing.finish();
    let _ = write!(out, "{}", summary_table(&rows));
    for run in &runs {
        if let Some(error) = &run.error {
            let _ = writeln!(out, "device `{}`: {}", run.device, error.words(run.peak_rotation));
        }
    }
    if scene.file.checks.as_ref().is_none_or(|checks| checks.friction_coefficient.is_none()) {
        friction_lines(&runs).iter().for_each(|line| _ = writeln!(out, "{line}"));
    }
    for run in &runs {
        for warning in run.checks.iter().flat_map(|checks| &checks.warnings) {
            let _ = writeln!(err, "sprag: warning: {}: {warning}", run.device);
        }
    }
    let _ = writeln!(out, "results in {}", folder.display());
    if arguments.open
        && let Some(picture) = picture
        && let Err(error) = open::that_detached(&picture)
    {
        let _ = writeln!(err, "sprag: the picture cannot be shown: {error}");
    }
    Ok(())
}

/// A scene that was run.
struct Simulated {
    scene: Scene,
    subject: Subject,
    records: Vec<RecordSummary>,
    runs: Vec<DeviceRun>,
}

/// The scene with `change`, and its runs.
fn simulated(
    arguments: &SimulateArguments,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> Result<Simulated, Failure> {
    let mut changes = arguments.set.clone();
    changes.extend(change);
    let mut scene = Scene::load(&arguments.scene, &changes)?;
    let _simulating = Progress::uncounted("simulating");
    arguments.records.apply(&mut scene)?;
    let ground = scene.ground_motions()?;
    // Where the results go is tried before the work, not after it.
    let claim = claim_of_scene("simulate", &arguments.scene, &scene, &scene.file, &["history", "energy"], &[])?;
    folder.open(&claim)?;
    let runs = simulate(&scene, &ground, interrupt)?;
    Ok(Simulated { scene, subject: claim.subject, records: ground.records, runs })
}

/// The friction that impacts and jolts need under the toe, device by device, where nobody has said how much there is.
fn friction_lines(runs: &[DeviceRun]) -> Vec<String> {
    let line = |what: &str, value: &dyn Fn(&DeviceRun) -> Option<String>| {
        let of: Vec<String> = runs.iter().filter_map(|run| value(run).map(|value| format!("{value} ({})", run.device))).collect();
        (!of.is_empty()).then(|| format!("friction needed at {what}: {}", of.join(", ")))
    };
    let impact = |run: &DeviceRun| run.impulses.impact_friction_needed.map(|needed| format!("{needed:.3}"));
    let jolt = |run: &DeviceRun| match (run.impulses.jolt_pull_m_s, run.impulses.jolt_friction_needed) {
        (Some(_), _) => Some("none is enough, the toe lifts".to_owned()),
        (None, needed) => needed.map(|needed| format!("{needed:.3}")),
    };
    [line("impacts", &impact), line("jolts", &jolt)].into_iter().flatten().collect()
}

fn row(run: &DeviceRun) -> SummaryRow {
    SummaryRow {
        device: run.device.clone(),
        outcome: run.outcome.to_string(),
        peak_rotation_ratio: run.peak_rotation,
        peak_acceleration_ratio: run.peak_acceleration,
        impacts: run.impacts as usize,
        first_impact_s: run.first_impact_time_s,
        peak_force_ratio: run.peak_force_ratio.filter(|force| *force > 0.0),
    }
}
