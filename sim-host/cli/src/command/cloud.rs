//! `sprag cloud`: demand regressions and fragilities over many records.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;
use serde::Serialize;
use sprag_report::columns::{Table, TableError, metadata_of};
use sprag_report::long_run::error::LongRunError;
use sprag_report::long_run::origin::Origin;
use sprag_report::long_run::rows::{Plan, Rows};
use sprag_report::long_run::shard::Shard;
use sprag_report::output::{Claim, Digest, Formats, OutputError, ResultFolder, Results, Subject};
use sprag_report::plot::PlotError;
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::RecordSummary;
use sprag_sim::simulation::RunError;
use sprag_studies::cloud::figures::{demand_picture, fragility_picture};
use sprag_studies::cloud::findings::Findings;
use sprag_studies::cloud::overturning::OverturningError;
use sprag_studies::cloud::pages::{demand_page, demand_table, fragility_notes, fragility_page, fragility_table, ranking_page};
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::runs::{RunList, Runs};
use sprag_studies::cloud::structures::StudyStructure;
use sprag_studies::cloud::study::Study;
use sprag_studies::cloud::study_file::StudyFile;
use sprag_studies::cloud::typed_tables::{DemandTable, FragilityTable, RankingTable, RunsTable};

use super::accuracy_arguments::AccuracyArguments;
use super::format_arguments::FormatArguments;
use super::out_arguments::FolderArguments;
use super::study_input::{StudyArguments, StudyInputError, study_subject};
use super::{DRAWING, ended, resumable};
use crate::command::long_run_arguments::LongRunArguments;

/// Demands and fragilities over many records.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag cloud scenes/cloud.toml --records records/\n  \
    sprag cloud study.toml --records near_fault/*.AT2 --out out/near_fault\n\n\
    Runs every structure of the study under every record, scaled as it says, with every device. Writes the tables runs, demand, \
    fragility and ranking as .csv and .parquet, the last three as .md too, the pictures demand and fragility as .svg and .png, \
    and summary.json. A record that cannot be read and a run that fails are named, the others are still done, and the exit \
    code is 2. Runs go to the disk as they are made, runs.run.json says what they come from, and Ctrl-C leaves them there for \
    --resume.")]
pub struct CloudArguments {
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
    /// Which of the runs, and whether some are there.
    #[command(flatten)]
    pub long_run: LongRunArguments,
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Input(#[from] StudyInputError),
    #[error("{0}")]
    Run(#[from] RunError),
    #[error("{0}")]
    Rows(#[from] LongRunError),
    #[error("{0}")]
    Fragility(#[from] OverturningError),
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
    study: &'a StudyFile,
    structures: &'a [StudyStructure],
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
    study: &'a StudyFile,
    structures: &'a [StudyStructure],
    seed: u64,
}

/// Names of what is written beside the summary.
const NAMES: [&str; 4] = ["runs", "demand", "fragility", "ranking"];

/// Runs the command; tables go to `out`, errors go to `err`.
pub fn run(arguments: &CloudArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result, interrupt, err)
}

/// A study that was run.
struct Studied<'a> {
    study: Study,
    records: &'a StudyRecords,
    subject: Subject,
    runs: Runs,
    /// runs.csv, if it is written.
    rows: Option<PathBuf>,
}

/// Whether everything could be read and run.
fn run_or_fail(
    arguments: &CloudArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<bool, Failure> {
    if let (Some(_), Some(option)) = (arguments.accuracy.time_budget, arguments.long_run.given()) {
        return Err(LongRunError::NoRows { option }.into());
    }
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = arguments.folder.folder(&arguments.input.study, "cloud").of_any_accuracy(any_accuracy);
    let study = arguments.input.load(None)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build()?;
    // Records do not depend on how accurately they are followed.
    let (records, warnings) = arguments.input.read(&study, &pool, err)?;
    let tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let once = |change| pool.install(|| studied(arguments, change, &records, &mut folder, interrupt));
    let studied = arguments.accuracy.run(once, tell)?;
    let shard = arguments.long_run.shard();
    if let (true, Some(rows)) = (shard != Shard::WHOLE, &studied.rows) {
        let _ = writeln!(out, "shard {shard}: {}", rows.display());
        return Ok(studied.records.unreadable.is_empty() && !studied.runs.failed);
    }
    let drawing = Progress::uncounted(DRAWING);
    let findings = pool.install(|| Findings::of(&studied.study, &studied.runs))?;
    if interrupt.is_set() {
        return Err(RunError::Interrupted.into());
    }
    let complete = write(&studied, &findings, &warnings, (&folder, arguments.formats.formats), out, err)?;
    drawing.finish();
    let _ = writeln!(out, "results of {} in {}", arguments.input.study.display(), folder.display());
    Ok(complete)
}

fn studied<'a>(
    arguments: &CloudArguments,
    change: Option<String>,
    records: &'a StudyRecords,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> Result<Studied<'a>, Failure> {
    let study = arguments.input.load(change)?;
    let progress = Progress::new("runs");
    // Where the results go is tried before the work, not after it.
    let subject = study_subject("cloud", &records.records).with("study", &study.file)?.with("structures", &study.structures)?;
    let inputs = arguments.input.files(&study, records);
    folder.open(&Claim { subject: subject.clone(), page: "summary.json", names: &NAMES, inputs })?;
    if arguments.accuracy.time_budget.is_some() {
        // Runs of several accuracies are tried; only the last are worth keeping.
        let runs = Runs::of(&study, &records.records, interrupt, |runs| progress.begin(runs), &|| progress.step())?;
        return Ok(Studied { study, records, subject, runs, rows: None });
    }
    let list = RunList::new(&study, &records.records);
    let columns = list.columns().into_iter().map(|column| column.name).collect();
    let origin = Origin::new(subject.clone(), list.rows());
    let shard = arguments.long_run.shard();
    let plan = Plan { folder, name: "runs", columns, together: list.together(), shard, origin };
    let mut all = Vec::new();
    let mut rows = Rows::begin(&plan, arguments.long_run.start(), |row, record| {
        all.push(list.read(row, record)?);
        Ok(())
    })?;
    interrupt.keep(resumable("finished rows", folder));
    progress.begin((rows.done() + rows.left().len()) as u64);
    progress.resume(rows.done() as u64);
    let whole = list.work_through(rows.left(), interrupt, &|| progress.step(), |runs| {
        rows.append(&list.text(&runs)?, runs.len())?;
        all.extend(runs);
        Ok::<(), Failure>(())
    })?;
    if !whole {
        interrupt.keep(rows.interrupted());
        return Err(rows.interrupted().into());
    }
    let rows = rows.finish()?;
    interrupt.keep(resumable("all rows", &rows));
    let runs = list.sum_up(all);
    Ok(Studied { study, records, subject, runs, rows: Some(rows) })
}

/// Writes the results; returns whether everything was read and run.
fn write(
    studied: &Studied<'_>,
    findings: &Findings,
    warnings: &[String],
    (folder, formats): (&Path, Formats),
    out: &mut impl Write,
    err: &mut impl Write,
) -> Result<bool, Failure> {
    let Studied { study, records, subject, runs, rows } = studied;
    let (command, version) = ("cloud", env!("CARGO_PKG_VERSION"));
    let (file, structures) = (&study.file, &study.structures[..]);
    let document = Document {
        command,
        version,
        study: file,
        structures,
        warnings,
        records: records.summaries(),
        files: &subject.files,
        unreadable: &records.unreadable,
        findings,
        left_out: &runs.left_out,
        accuracy: runs.worst,
    };
    let mut results = Results::default();
    results.add_json(&folder.join("summary.json"), &document)?;
    let made_by = metadata_of(&MadeBy { command, version, study: file, structures, seed: study.bootstrap.seed })?;
    let of_runs = RunsTable { study, records: &records.records, runs: &runs.all };
    match rows {
        None => {
            results.add_table(folder, "runs", &of_runs, &made_by, formats)?;
            // What a run without a time budget says of its own runs.csv.
            results.remove(folder.join("runs.run.json"));
        }
        Some(rows) if formats.parquet => results.add_parquet_of(rows, &of_runs.columns(), &made_by)?,
        Some(_) => {}
    }
    let tables: [(&str, &dyn Table); 3] =
        [("demand", &DemandTable(findings)), ("fragility", &FragilityTable(findings)), ("ranking", &RankingTable(findings))];
    for (name, table) in tables {
        results.add_table(folder, name, table, &made_by, formats)?;
    }
    let pages = [
        ("demand.md", demand_page(study, findings)),
        ("fragility.md", fragility_page(study, findings)),
        ("ranking.md", ranking_page(study, findings)),
    ];
    for (name, page) in pages {
        results.add(&folder.join(name), |file| file.write_all(page.as_bytes()))?;
    }
    let pictures = [("demand", demand_picture(study, findings)?), ("fragility", fragility_picture(study, findings)?)];
    for (name, picture) in pictures {
        match picture {
            Some(picture) => _ = results.add_picture(folder, name, &picture, formats)?,
            None => _ = writeln!(err, "sprag: there is no picture of the {name}: there are no points for it"),
        }
    }
    results.commit_telling(err)?;
    let _ = writeln!(out, "{}\n{}", demand_table(findings).markdown(), fragility_table(findings).markdown());
    for line in fragility_notes(&findings.fragility) {
        let _ = writeln!(out, "{line}");
    }
    for line in &runs.left_out {
        let _ = writeln!(err, "sprag: left out: {line}");
    }
    if let Some(worst) = runs.worst {
        let _ = writeln!(out, "accuracy: {worst}");
    }
    Ok(records.unreadable.is_empty() && !runs.failed)
}
