//! `sprag sensitivity`: what each effect changes, alone and together, under one or many ground motions.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use sprag_report::heading::of_scene;
use sprag_report::output::{Digest, OutputError, ResultFolder, Results, Subject};
use sprag_report::plot::{FigureTitle, OwnMark, PlotError, SensitivityLane, SensitivityRow, sensitivity_figure};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::error::Key;
use sprag_sim::scene::ground::{GroundError, Motion};
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::scene::{Scene, SceneError};
use sprag_sim::simulation::RunError;
use sprag_studies::sensitivity::motion::{RecordFiles, StudyMotion};
use sprag_studies::sensitivity::report::{page, table, write_csv};
use sprag_studies::sensitivity::statistics::{Summary, summaries};
use sprag_studies::sensitivity::study::{Findings, Flip, Study};

use super::accuracy_arguments::AccuracyArguments;
use super::format_arguments::PictureArguments;
use super::out_arguments::{FolderArguments, claim_of_scene};
use super::record_arguments::ReadArguments;
use super::{DRAWING, ended, warned};

/// Turn effects on one by one: what does each change?
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag sensitivity scenes/near_fault.toml\n  \
    sprag sensitivity scenes/near_fault.toml --records records/*.AT2 --out out/sensitivity\n\n\
    Runs every device under the scene's ground motion and under each record in its place, as it is and with each variant. \
    Writes sensitivity.csv, sensitivity.md, sensitivity.svg (with --png sensitivity.png) and summary.json. A record that cannot be read and a run that \
    fails are named, the others are still done, and the exit code is 2.")]
pub struct SensitivityArguments {
    /// Scene file.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Ground motion records, each in the place of the scene's.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub records: Vec<PathBuf>,
    /// Vertical components of the records, as many and in the same order; without them the ground moves vertically by 2/3 of its
    /// horizontal motion.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub records_vertical: Vec<PathBuf>,
    /// How records are read.
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Change one value of the scene, such as block.size_m=2 or device.1.mass_ratio=0.5.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Where results go.
    #[command(flatten)]
    pub folder: FolderArguments,
    /// Threads; all cores by default. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = super::threads)]
    pub threads: Option<u16>,
    /// Pictures.
    #[command(flatten)]
    pub pictures: PictureArguments,
    /// How accurate.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Ground(#[from] GroundError),
    #[error("{0}")]
    Run(#[from] RunError),
    #[error("--records-vertical names {vertical} files, but --records {horizontal}; each record needs its own")]
    Unpaired { vertical: usize, horizontal: usize },
    #[error("{}: vertical: does not belong to the records; leave out [[vertical]] or --records", scene.display())]
    VerticalOfAnother { scene: PathBuf },
    #[error("{}: no ground motion could be read; {first}", scene.display())]
    NoMotion { scene: PathBuf, first: String },
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] PlotError),
    #[error("{0}")]
    Output(#[from] OutputError),
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// `summary.json`.
#[derive(Serialize)]
struct Document<'a> {
    command: &'static str,
    version: &'static str,
    scene: &'a SceneFile,
    records: &'a [RecordSummary],
    warnings: &'a [String],
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    files: &'a BTreeMap<String, Digest>,
    runs: &'a [Summary],
    left_out: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<Worst>,
}

/// Runs the command; a table goes to `out`, errors go to `err`.
pub fn run(arguments: &SensitivityArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result, interrupt, err)
}

/// Whether everything could be read and run.
fn run_or_fail(
    arguments: &SensitivityArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<bool, Failure> {
    let warnings = warned(Scene::load(&arguments.scene, &arguments.set)?.warnings(), err);
    let tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = arguments.folder.folder(&arguments.scene, "sensitivity").of_any_accuracy(any_accuracy);
    let studied = arguments.accuracy.run(|change| studied(arguments, change, &mut folder, interrupt), tell)?;
    for error in &studied.errors {
        let _ = writeln!(err, "sprag: {error}");
    }
    write(arguments, &studied, &warnings, &folder, out, err)?;
    for error in &studied.findings.failed {
        let _ = writeln!(err, "sprag: {error}");
    }
    Ok(studied.errors.is_empty() && studied.findings.failed.is_empty())
}

/// A study that was run.
struct Studied {
    scene: Scene,
    subject: Subject,
    study: Study,
    motions: Vec<StudyMotion>,
    /// Records that could not be read, in a line each.
    errors: Vec<String>,
    findings: Findings,
}

/// The study of the scene with `change`.
fn studied(
    arguments: &SensitivityArguments,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> Result<Studied, Failure> {
    let mut changes = arguments.set.clone();
    changes.extend(change);
    let (mut scene, study) = Study::load(&arguments.scene, &changes)?;
    arguments.reading.apply(&mut scene)?;
    let records = records(arguments, &scene)?;
    require_files(&scene, &records)?;
    let reading = Progress::uncounted("reading records");
    let mut motions: Vec<StudyMotion> = Vec::new();
    let mut errors: Vec<String> = Vec::new();
    motions.extend(StudyMotion::own(&scene)?);
    for record in &records {
        match StudyMotion::record(&scene, record) {
            Ok(motion) => motions.push(motion),
            Err(error @ GroundError::Record { .. }) => errors.push(error.to_string()),
            Err(error) => return Err(error.into()),
        }
    }
    reading.finish();
    if motions.is_empty() {
        let first = errors.first().cloned().unwrap_or_default();
        return Err(Failure::NoMotion { scene: arguments.scene.clone(), first });
    }
    let others = [&arguments.records[..], &arguments.records_vertical].concat();
    let claim = claim_of_scene("sensitivity", &arguments.scene, &scene, &scene.file, &["sensitivity"], &others)?;
    // Where the results go is tried before the work, not after it.
    folder.open(&claim)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build()?;
    let progress = Progress::new("runs");
    progress.begin((study.runs() * motions.len()) as u64);
    let findings = pool.install(|| study.run(&motions, interrupt, &|| progress.step()));
    progress.finish();
    Ok(Studied { findings: findings?, scene, subject: claim.subject, study, motions, errors })
}

/// Refuses a scene that names no file for a record, where none takes its place.
fn require_files(scene: &Scene, records: &[RecordFiles]) -> Result<(), SceneError> {
    let of = [
        ("ground", &scene.file.ground, "a record file here, or --records FILE…"),
        ("vertical", &scene.file.vertical, "a record file here"),
    ];
    for (name, tables, needed) in of {
        let without = tables.iter().position(|table| table.motion == Motion::Record && table.file.is_none());
        if let (Some(index), true) = (without, records.is_empty()) {
            return Err(Key { origin: scene.origin.clone(), key: format!("{name}.{index}.file") }.missing(needed));
        }
    }
    Ok(())
}

/// The records, each with its vertical component.
fn records(arguments: &SensitivityArguments, scene: &Scene) -> Result<Vec<RecordFiles>, Failure> {
    let (horizontal, vertical) = (&arguments.records, &arguments.records_vertical);
    if !vertical.is_empty() && vertical.len() != horizontal.len() {
        return Err(Failure::Unpaired { vertical: vertical.len(), horizontal: horizontal.len() });
    }
    if !horizontal.is_empty() && !scene.file.vertical.is_empty() {
        return Err(Failure::VerticalOfAnother { scene: arguments.scene.clone() });
    }
    let pair =
        |(index, file): (usize, &PathBuf)| RecordFiles { horizontal: file.clone(), vertical: vertical.get(index).cloned() };
    if !horizontal.is_empty() && scene.file.ground.iter().all(|table| table.motion != Motion::Record) {
        scene.clone().use_record(&horizontal[0])?;
    }
    Ok(horizontal.iter().enumerate().map(pair).collect())
}

/// Writes the results.
fn write(
    arguments: &SensitivityArguments,
    studied: &Studied,
    warnings: &[String],
    folder: &Path,
    out: &mut impl Write,
    err: &mut impl Write,
) -> Result<(), Failure> {
    let Studied { scene, subject, study, motions, findings, .. } = studied;
    let drawing = Progress::uncounted(DRAWING);
    let runs = summaries(findings, motions, &study.devices);
    let records: Vec<RecordSummary> = motions.iter().flat_map(|motion| motion.records.iter().cloned()).collect();
    let in_place = motions.iter().filter(|motion| !motion.own).count();
    let warnings = [warnings, &warned(warning_lines(&records), err)].concat();
    let left_out = [&study.left_out[..], &findings.left_out, &findings.failed].concat();
    let title = &scene.file.title;
    let mut conditions = of_scene(scene);
    if let Some(first) = conditions.first_mut() {
        first.insert_str(0, "without a variant: ");
    }
    let heading = FigureTitle { text: title.clone(), conditions };
    let figure = sensitivity_figure(heading, &study.devices, &figure_rows(&runs))?;
    let document = Document {
        command: "sensitivity",
        version: env!("CARGO_PKG_VERSION"),
        scene: &scene.file,
        records: &records,
        warnings: &warnings,
        files: &subject.files,
        runs: &runs,
        left_out: &left_out,
        accuracy: findings.worst,
    };
    let mut results = Results::default();
    results.add_json(&folder.join("summary.json"), &document)?;
    results.add(&folder.join("sensitivity.csv"), |file| {
        write_csv(findings, motions, &study.devices, file).map_err(std::io::Error::other)
    })?;
    results.add(&folder.join("sensitivity.md"), |file| file.write_all(page(title, &runs, in_place, &left_out).as_bytes()))?;
    results.add_picture(folder, "sensitivity", &figure, arguments.pictures.formats)?;
    results.commit_telling(err)?;
    drawing.finish();
    let _ = write!(out, "{}", table(&runs));
    for line in &left_out {
        let _ = writeln!(out, "left out: {line}");
    }
    if let Some(worst) = findings.worst {
        let _ = writeln!(out, "accuracy: {worst}");
    }
    let _ = writeln!(out, "results of {} in {}", arguments.scene.display(), folder.display());
    Ok(())
}

/// One row a variant, one lane a device.
fn figure_rows(summaries: &[Summary]) -> Vec<SensitivityRow> {
    let same = |one: &Summary, other: &Summary| (one.effect, one.variant) == (other.effect, other.variant);
    let lane = |summary: &Summary| SensitivityLane {
        device: summary.device_index,
        changes: summary.changes.clone(),
        quantiles: summary.change.map(|quantiles| [quantiles.p16, quantiles.median, quantiles.p84]),
        own: summary.own_motion.and_then(|own| match (own.flip, own.change) {
            (Some(Flip::ToOverturned), _) => Some(OwnMark::Overturns),
            (Some(Flip::ToStanding), _) => Some(OwnMark::Stands),
            (None, change) => change.map(OwnMark::Change),
        }),
        overturns: summary.overturns_instead,
        stands: summary.stands_instead,
    };
    let row = |of_variant: &[Summary]| SensitivityRow {
        effect: of_variant[0].effect.to_owned(),
        variant: of_variant[0].variant.to_owned(),
        lanes: of_variant.iter().map(lane).collect(),
    };
    summaries.chunk_by(same).map(row).collect()
}
