//! `sprag optimise`: the inerter's size, mount and clutch law that overturn a structure least under limits on force and stroke.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use sprag_report::columns::{TableError, metadata_of};
use sprag_report::long_run::error::LongRunError;
use sprag_report::long_run::origin::Origin;
use sprag_report::output::{Claim, Digest, Formats, OutputError, ResultFolder, Results, Subject};
use sprag_report::plot::PlotError;
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::RecordSummary;
use sprag_sim::scene::SceneError;
use sprag_sim::simulation::RunError;
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::structures::StudyStructure;
use sprag_studies::cloud::study::Study;
use sprag_studies::cloud::study_file::{RecordEntry, RecordTable, StripesTable};
use sprag_studies::optimise::curve::Curve;
use sprag_studies::optimise::figure::trade_off_picture;
use sprag_studies::optimise::findings::Findings;
use sprag_studies::optimise::page::{choice_table, heading, limits, page};
use sprag_studies::optimise::problem::{Choices, Problem, Solution};
use sprag_studies::optimise::table::OptimiseTable;
use sprag_studies::optimise::tried::{MOST_ROWS, Tried, TriedError};
use sprag_studies::optimise::typed_tables::{DesignTable, MotionTable};

use super::accuracy_arguments::AccuracyArguments;
use super::format_arguments::FormatArguments;
use super::out_arguments::FolderArguments;
use super::study_input::{StudyArguments, StudyInputError, study_subject};
use super::{DRAWING, ended, resumable};
use crate::command::long_run_arguments::ResumeArguments;

/// Choose the device that overturns least, under limits.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag optimise scenes/optimise.toml --records records/\n  \
    sprag optimise study.toml --records near_fault/*.AT2 --set block.size_m=3 --out out/pier\n\n\
    Tries devices on a grid of mass ratios, for every law and mount of the study's [optimise] table, under every record, scaled \
    as the study says; then more where a limit is reached and around the best. Writes the tables designs and motions as .csv and \
    .parquet, the picture trade_off as .svg and .png, optimise.md and summary.json. Runs go to the disk as they are made, and Ctrl-C leaves \
    them there for --resume. The exit code is 2 when no device respects the limits, and when a record cannot be read or \
    a run fails; results are written all the same.")]
pub struct OptimiseArguments {
    /// The study.
    #[command(flatten)]
    pub input: StudyArguments,
    /// Where results go.
    #[command(flatten)]
    pub folder: FolderArguments,
    /// Threads; all cores by default. The result does not depend on it.
    #[arg(long, value_name = "N", value_parser = super::threads)]
    pub threads: Option<u16>,
    /// What is written.
    #[command(flatten)]
    pub formats: FormatArguments,
    /// How accurate.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    /// Whether some runs are there.
    #[command(flatten)]
    pub rows: ResumeArguments,
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Input(#[from] StudyInputError),
    #[error("{0}")]
    Choices(#[from] SceneError),
    #[error("{}: there is no motion{}", study.display(), first.as_ref().map_or_else(String::new, |line| format!("; {line}")))]
    NoMotion { study: PathBuf, first: Option<String> },
    #[error("{0}")]
    Run(#[from] RunError),
    #[error("{0}")]
    Rows(#[from] LongRunError),
    #[error("{}: no device could be tried; {first}", study.display())]
    AllFailed { study: PathBuf, first: String },
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] PlotError),
    #[error("{0}")]
    Output(#[from] OutputError),
    #[error("{0}")]
    Table(#[from] TableError),
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// `summary.json`.
#[derive(Serialize)]
struct Document<'a> {
    command: &'static str,
    version: &'static str,
    study: Resolved<'a>,
    structure: &'a StudyStructure,
    curves: &'a [Curve],
    records: Vec<RecordSummary>,
    warnings: &'a [String],
    files: &'a BTreeMap<String, Digest>,
    unreadable: &'a [String],
    #[serde(flatten)]
    findings: &'a Findings,
    left_out: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<Worst>,
}

/// What the Parquet files say of themselves.
#[derive(Serialize)]
struct MadeBy<'a> {
    command: &'static str,
    version: &'static str,
    study: &'a Resolved<'a>,
    structure: &'a StudyStructure,
}

/// What of the study an optimisation reads, with defaults filled in.
#[derive(Serialize)]
struct Resolved<'a> {
    title: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    scene: Option<&'a Path>,
    records: &'a [RecordEntry],
    record: &'a RecordTable,
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<&'a [f64]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    stripes: Option<&'a StripesTable>,
    optimise: &'a OptimiseTable,
}

impl<'a> Resolved<'a> {
    fn of(study: &'a Study, choices: &'a Choices<'_>) -> Resolved<'a> {
        Resolved {
            title: &study.file.title,
            scene: study.file.scene.as_deref(),
            records: &study.file.records,
            record: &study.file.record,
            scale: study.file.scale.as_deref(),
            stripes: study.file.stripes.as_ref(),
            optimise: &choices.table,
        }
    }
}

/// Runs the command; a table goes to `out`, errors go to `err`.
pub fn run(arguments: &OptimiseArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result, interrupt, err)
}

/// A study, its records, and how it was answered.
struct Answered<'a> {
    study: Study,
    records: &'a StudyRecords,
    subject: Subject,
    solution: Solution,
    /// The runs as they went to the disk.
    tried: Option<Tried>,
}

/// Whether there is a device, and everything could be read and run.
fn run_or_fail(
    arguments: &OptimiseArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<bool, Failure> {
    if let (Some(_), Some(option)) = (arguments.accuracy.time_budget, arguments.rows.given()) {
        return Err(LongRunError::NoRows { option }.into());
    }
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = arguments.folder.folder(&arguments.input.study, "optimise").of_any_accuracy(any_accuracy);
    let study = arguments.input.load(None)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build()?;
    Choices::of(&study)?;
    // Records do not depend on how accurately they are followed.
    let (records, warnings) = arguments.input.read(&study, &pool, err)?;
    let tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let once = |change| pool.install(|| answered(arguments, change, &records, &mut folder, interrupt));
    let answered = arguments.accuracy.run(once, tell)?;
    let drawing = Progress::uncounted(DRAWING);
    let Answered { study, records, solution, .. } = &answered;
    let problem = Problem::new(Choices::of(study)?, &records.records);
    let findings = Findings::of(&problem, solution);
    if interrupt.is_set() {
        return Err(RunError::Interrupted.into());
    }
    let left_out = [&problem.choices.left_out[..], &problem.left_out, &solution.failures].concat();
    write(&answered, &problem, &findings, (&left_out, &warnings), (&folder, arguments.formats.formats), err)?;
    drawing.finish();
    tell_all(&problem, &findings, out);
    for line in &left_out {
        let _ = writeln!(err, "sprag: left out: {line}");
    }
    if let Some(worst) = solution.worst {
        let _ = writeln!(out, "accuracy: {worst}");
    }
    let _ = writeln!(out, "results of {} in {}", arguments.input.study.display(), folder.display());
    if findings.best.is_none() {
        let study = arguments.input.study.display();
        let why = match &findings.nearest {
            Some(_) => format!("no device respects {}", limits(&problem.choices)),
            None => "no device has a response to every motion".to_owned(),
        };
        let _ = writeln!(err, "sprag: {study}: {why}; results are written");
    }
    let well = findings.best.is_some() && records.unreadable.is_empty() && solution.failures.is_empty();
    answered.tried.map_or(Ok(()), Tried::discard)?;
    Ok(well)
}

fn answered<'a>(
    arguments: &OptimiseArguments,
    change: Option<String>,
    records: &'a StudyRecords,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> Result<Answered<'a>, Failure> {
    let study = arguments.input.load(change)?;
    let choices = Choices::of(&study)?;
    let progress = Progress::new("runs");
    let problem = Problem::new(choices, &records.records);
    let file = || arguments.input.study.clone();
    if problem.motions.is_empty() {
        return Err(Failure::NoMotion { study: file(), first: problem.left_out.first().cloned() });
    }
    // Where the results go is tried before the work, not after it.
    let choices = &problem.choices;
    let subject = study_subject("optimise", &records.records)
        .with("study", &Resolved::of(&study, choices))?
        .with("structure", choices.structure)?;
    let inputs = arguments.input.files(&study, records);
    let names = &["designs", "motions", "optimise", "trade_off"];
    folder.open(&Claim { subject: subject.clone(), page: "summary.json", names, inputs })?;
    let (begin, done) = (|runs| progress.begin(runs), || progress.step());
    let (solution, tried) = if arguments.accuracy.time_budget.is_some() {
        (problem.solve(&mut (), interrupt, &begin, &done)?, None)
    } else {
        let origin = Origin::new(subject.clone(), MOST_ROWS);
        let mut tried = Tried::begin(folder, origin, arguments.rows.start(), problem.motions.len())?;
        interrupt.keep(resumable("finished rows", folder));
        match problem.solve(&mut tried, interrupt, &begin, &done) {
            Err(TriedError::Run(RunError::Interrupted)) => {
                interrupt.keep(tried.interrupted());
                return Err(tried.interrupted().into());
            }
            Err(TriedError::Run(error)) => return Err(error.into()),
            Err(TriedError::Rows(error)) => return Err(error.into()),
            Ok(solution) => (solution, Some(tried)),
        }
    };
    if solution.designs.iter().all(|design| design.score.motions == 0) {
        let first = solution.failures.first().cloned().unwrap_or_default();
        return Err(Failure::AllFailed { study: file(), first });
    }
    Ok(Answered { study, records, subject, solution, tried })
}

/// Writes the results.
fn write(
    Answered { study, records, subject, solution, .. }: &Answered<'_>,
    problem: &Problem<'_>,
    findings: &Findings,
    (left_out, warnings): (&[String], &[String]),
    (folder, formats): (&Path, Formats),
    err: &mut impl Write,
) -> Result<(), Failure> {
    let choices = &problem.choices;
    let document = Document {
        command: "optimise",
        version: env!("CARGO_PKG_VERSION"),
        study: Resolved::of(study, choices),
        structure: choices.structure,
        warnings,
        curves: &choices.curves,
        records: records.summaries(),
        files: &subject.files,
        unreadable: &records.unreadable,
        findings,
        left_out,
        accuracy: solution.worst,
    };
    let picture = trade_off_picture(problem, findings)?;
    let mut results = Results::default();
    results.add_json(&folder.join("summary.json"), &document)?;
    let made_by = metadata_of(&MadeBy {
        command: document.command,
        version: document.version,
        study: &document.study,
        structure: document.structure,
    })?;
    results.add_table(folder, "designs", &DesignTable(findings), &made_by, formats)?;
    let motions = MotionTable { problem, solution, chosen: findings.best.as_ref() };
    results.add_table(folder, "motions", &motions, &made_by, formats)?;
    results.add(&folder.join("optimise.md"), |file| file.write_all(page(problem, findings).as_bytes()))?;
    results.add_picture(folder, "trade_off", &picture, formats)?;
    results.commit_telling(err)?;
    Ok(())
}

/// The table of the choice, and what to know of it.
fn tell_all(problem: &Problem<'_>, findings: &Findings, out: &mut impl Write) {
    let Findings { motions, designs, runs, notes, .. } = findings;
    let _ = writeln!(out, "{}: {motions} motions, {}", heading(&problem.choices), limits(&problem.choices));
    let _ = writeln!(out, "{designs} devices tried in {runs} runs\n\n{}", choice_table(findings).markdown());
    for note in notes {
        let _ = writeln!(out, "{note}");
    }
}
