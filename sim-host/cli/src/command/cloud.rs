//! `sprag cloud`: demand regressions and fragilities over many records.

use clap::Args;
use serde::Serialize;
use sprag_report::columns::Table;
use sprag_report::long_run::division::Divisible;
use sprag_report::long_run::origin::Origin;
use sprag_report::long_run::rows::{Plan, Rows};
use sprag_report::long_run::shard::Shard;
use sprag_report::output::{Claim, ResultFolder, Subject};
use sprag_report::progress::Progress;
use sprag_report::text_table::TextTable;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_studies::cloud::figures::{demand_picture, fragility_picture};
use sprag_studies::cloud::findings::Findings;
use sprag_studies::cloud::pages::{demand_page, fragility_notes, fragility_page, ranking_page};
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::runs::{RunList, Runs};
use sprag_studies::cloud::structures::StudyStructure;
use sprag_studies::cloud::study::Study;
use sprag_studies::cloud::study_file::StudyFile;
use sprag_studies::cloud::typed_tables::{demand_table, fragility_table, ranking_table, runs_table};

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::divided::Divided;
use super::out_arguments::OutputArguments;
use super::report::Report;
use super::resumable;
use super::study_input::{StudyArguments, study_subject};
use super::thread_arguments::ThreadArguments;
use crate::command::long_run_arguments::LongRunArguments;

/// Demands and fragilities over many records.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag cloud scenes/cloud.toml --records records/\n  \
    sprag cloud study.toml --records near_fault/*.AT2 --out out/near_fault\n\n\
    Runs every structure of the study under every record, scaled as it says, with every device. Writes the tables runs, demand, \
    fragility and ranking as .csv and .parquet, the last three as .md too, the pictures demand and fragility as .svg and .png, \
    and summary.json. A record that cannot be read and a run that fails are named, the others are still done, and the exit \
    code is 1. Runs go to the disk as they are made, runs.run.json says what they come from, and Ctrl-C leaves them there for \
    --resume.")]
pub struct CloudArguments {
    #[command(flatten)]
    pub input: StudyArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    #[command(flatten)]
    pub long_run: LongRunArguments,
}

/// Study and structures as resolved.
#[derive(Clone, Copy, Serialize)]
struct Input<'a> {
    study: &'a StudyFile,
    structures: &'a [StudyStructure],
}

/// What the Parquet files say of the study.
#[derive(Serialize)]
struct MadeOf<'a> {
    #[serde(flatten)]
    input: Input<'a>,
    seed: u64,
}

/// What `summary.json` says of the runs.
#[derive(Serialize)]
struct Answer<'a> {
    unreadable: &'a [String],
    #[serde(flatten)]
    findings: &'a Findings,
    left_out: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<Worst>,
}

/// Names of what is written beside the summary.
const NAMES: [&str; 4] = ["runs", "demand", "fragility", "ranking"];

/// A study that was run.
struct Studied<'a> {
    study: Study,
    records: &'a StudyRecords,
    subject: Subject,
    runs: Runs,
    /// Those of runs.csv, if it is kept on the way.
    rows: Option<Rows>,
}

impl Run for CloudArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        self.accuracy.keeps_rows(self.long_run.given())?;
        let mut folder = self.output.folder_at(&self.input.study, "cloud", &self.accuracy)?;
        let study = self.input.load(None)?;
        let pool = self.threads.pool()?;
        // Records do not depend on how accurately they are followed.
        let (records, warnings) = self.input.read(&study, false, &pool, context)?;
        let interrupt = context.interrupt;
        let once = |change| pool.install(|| studied(self, change, &records, &mut folder, interrupt));
        let mut studied = self.accuracy.run(context, once)?;
        let complete = studied.records.unreadable.is_empty() && !studied.runs.failed;
        let shard = self.long_run.shard();
        let rows = match studied.rows.take() {
            Some(rows) if shard != Shard::WHOLE => {
                context.print(format_args!("shard {shard}: {}\n", rows.finish()?.display()));
                return Ok(Completion::of(complete));
            }
            rows => rows,
        };
        let mut report = Report::new("cloud", &folder, &self.output)?;
        let findings = pool.install(|| Findings::of(&studied.study, &studied.runs, interrupt))?;
        context.check_interrupt()?;
        fill(&mut report, &studied, rows, &findings, &warnings)?;
        report.complete(complete);
        report.finish(&folder, context)
    }
}

fn studied<'a>(
    arguments: &CloudArguments,
    change: Option<String>,
    records: &'a StudyRecords,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<Studied<'a>> {
    let study = arguments.input.load(change)?;
    let progress = Progress::new("runs");
    // Where the results go is tried before the work, not after it.
    let subject = subject(&study, records)?;
    let inputs = arguments.input.files(&study, records);
    folder.open(&Claim { subject: subject.clone(), page: "summary.json", names: &NAMES, inputs })?;
    if arguments.accuracy.is_chosen() {
        // Runs of several accuracies are tried; only the last are worth keeping.
        let runs = Runs::of(&study, &records.records, interrupt, |runs| progress.begin(runs), &|| progress.step())?;
        return Ok(Studied { study, records, subject, runs, rows: None });
    }
    let list = RunList::new(&study, &records.records);
    let columns = list.columns().into_iter().map(|column| column.name).collect();
    let origin = Origin::new(subject.clone(), list.rows());
    let shard = arguments.long_run.shard();
    let shards = arguments.long_run.shards(folder);
    let plan = Plan { folder, shards, name: "runs", columns, together: list.together(), shard, origin };
    let mut all = Vec::new();
    let mut rows = Rows::begin(&plan, arguments.long_run.start(), |row, record| {
        all.push(list.read(row, record)?);
        Ok(())
    })?;
    interrupt.keep(resumable("finished rows", folder, arguments.long_run.again()));
    progress.begin((rows.done() + rows.left().len()) as u64);
    progress.resume(rows.done() as u64);
    let whole = list.work_through(rows.left(), interrupt, &|| progress.step(), |runs| {
        rows.append(&list.text(&runs)?, runs.len())?;
        all.extend(runs);
        anyhow::Ok(())
    })?;
    if !whole {
        interrupt.keep(rows.interrupted());
        return Err(rows.interrupted().into());
    }
    interrupt.keep(resumable("all rows", folder, arguments.long_run.again()));
    let runs = list.sum_up(all);
    Ok(Studied { study, records, subject, runs, rows: Some(rows) })
}

/// What the runs of `study` under `records` come from.
fn subject(study: &Study, records: &StudyRecords) -> anyhow::Result<Subject> {
    Ok(study_subject("cloud", &records.records).with("study", &study.file)?.with("structures", &study.structures)?)
}

impl Divided for CloudArguments {
    fn divisible(&self, context: &mut Context<'_>) -> anyhow::Result<Divisible> {
        self.accuracy.keeps_rows(Some("a plan"))?;
        let study = self.input.load(self.accuracy.accuracy.map(AccuracyArguments::change))?;
        let (records, _) = self.input.read(&study, false, &self.threads.pool()?, context)?;
        let list = RunList::new(&study, &records.records);
        let origin = Origin::new(subject(&study, &records)?, list.rows());
        Ok(Divisible { origin, name: "runs", columns: list.columns(), seconds_a_row: 2e-3 })
    }

    fn options(&mut self) -> (&mut OutputArguments, &mut ThreadArguments, &mut LongRunArguments) {
        (&mut self.output, &mut self.threads, &mut self.long_run)
    }
}

/// Puts files, tables and notes into the report.
fn fill(
    report: &mut Report,
    studied: &Studied<'_>,
    rows: Option<Rows>,
    findings: &Findings,
    warnings: &[String],
) -> anyhow::Result<()> {
    let Studied { study, records, subject, runs, .. } = studied;
    let input = Input { study: &study.file, structures: &study.structures };
    report.made_by(MadeOf { input, seed: study.bootstrap.seed })?;
    let answer = Answer { unreadable: &records.unreadable, findings, left_out: &runs.left_out, accuracy: runs.worst };
    report.summary(input, &records.summaries(), warnings, subject, answer)?;
    let of_runs = runs_table(study, &records.records, &runs.all);
    match rows {
        None => {
            report.table("runs", &of_runs)?;
            // What a run without a time budget says of its own runs.csv.
            report.remove("runs.run.json");
        }
        Some(rows) => report.rows("runs", rows, &of_runs.columns())?,
    }
    report.table("demand", &demand_table(findings))?;
    report.table("fragility", &fragility_table(findings))?;
    report.table("ranking", &ranking_table(findings))?;
    report.page("demand.md", &demand_page(study, findings)?)?;
    report.page("fragility.md", &fragility_page(study, findings)?)?;
    report.page("ranking.md", &ranking_page(study, findings)?)?;
    for (name, picture) in [("demand", demand_picture(study, findings)), ("fragility", fragility_picture(study, findings))] {
        match picture.transpose() {
            Some(picture) => _ = report.picture(name, picture)?,
            None => report.note(format_args!("there is no picture of the {name}: there are no points for it")),
        }
    }
    report.print(TextTable::of(&demand_table(findings))?.for_terminal());
    report.print(format_args!("\n{}\n", TextTable::of(&fragility_table(findings))?.for_terminal()));
    fragility_notes(&findings.fragility).iter().for_each(|line| report.print(line));
    report.left_out(&runs.left_out);
    report.accuracy(runs.worst);
    Ok(())
}
