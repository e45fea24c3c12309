//! `sprag optimise`: the inerter's size, mount and clutch law that overturn a structure least under limits on force and stroke.

use std::path::Path;

use clap::Args;
use serde::Serialize;
use sprag_report::long_run::origin::Origin;
use sprag_report::output::{Claim, ResultFolder, Subject};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::simulation::RunError;
use sprag_studies::cloud::records::StudyRecords;
use sprag_studies::cloud::structures::StudyStructure;
use sprag_studies::cloud::study::Study;
use sprag_studies::cloud::study_file::{RecordEntry, RecordTable, StripesTable};
use sprag_studies::optimise::choice_page::{choice_page, choice_picture, delay_picture};
use sprag_studies::optimise::curve::Curve;
use sprag_studies::optimise::figure::trade_off_picture;
use sprag_studies::optimise::findings::Findings;
use sprag_studies::optimise::page::{choice_table, heading, limits, page};
use sprag_studies::optimise::problem::{Choices, Problem, Solution};
use sprag_studies::optimise::table::OptimiseTable;
use sprag_studies::optimise::tried::{MOST_ROWS, Tried, TriedError};
use sprag_studies::optimise::typed_tables::{design_table, motion_table};

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::out_arguments::OutputArguments;
use super::report::Report;
use super::study_input::{StudyArguments, study_subject};
use super::thread_arguments::ThreadArguments;
use super::{RESUMED, resumable};
use crate::command::long_run_arguments::ResumeArguments;

/// Choose the device that overturns least, under limits.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag optimise scenes/optimise.toml --records records/\n  \
    sprag optimise study.toml --records near_fault/*.AT2 --set block.size_m=3 --out out/pier\n\n\
    Tries devices on a grid of mass ratios, for every law and mount of the study's [optimise] table, under every record, scaled \
    as the study says; then more where a limit is reached and around the best. Writes the tables designs and motions as .csv and \
    .parquet, the pictures trade_off and choice as .svg and .png, choice.md (the choice, how sure it is, what it costs), delay where the study names delays, optimise.md and \
    summary.json. Runs go to the disk as they are made, and Ctrl-C leaves \
    them there for --resume. The exit code is 1 when no device respects the limits, and when a record cannot be read or \
    a run fails; results are written all the same.")]
pub struct OptimiseArguments {
    #[command(flatten)]
    pub input: StudyArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    #[command(flatten)]
    pub rows: ResumeArguments,
}

/// Study and structure as resolved.
#[derive(Clone, Copy, Serialize)]
struct Input<'a> {
    study: &'a Resolved<'a>,
    structure: &'a StudyStructure,
}

/// The input, and the devices that it stands for.
#[derive(Serialize)]
struct Candidates<'a> {
    #[serde(flatten)]
    input: Input<'a>,
    curves: &'a [Curve],
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

/// A study, its records, and how it was answered.
struct Answered<'a> {
    study: Study,
    records: &'a StudyRecords,
    subject: Subject,
    solution: Solution,
    /// The runs as they went to the disk.
    tried: Option<Tried>,
}

impl Run for OptimiseArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        self.accuracy.keeps_rows(self.rows.given())?;
        let mut folder = self.output.folder_at(&self.input.study, "optimise", &self.accuracy)?;
        let study = self.input.load(None)?;
        let pool = self.threads.pool()?;
        let of_mounts = context.warned(Choices::of(&study)?.warnings());
        // Records do not depend on how accurately they are followed.
        let (records, warnings) = self.input.read(&study, study.file.has_pulses(), &pool, context)?;
        let interrupt = context.interrupt;
        let once = |change| pool.install(|| answered(self, change, &records, &mut folder, interrupt));
        let answered = self.accuracy.run(context, once)?;
        let mut report = Report::new("optimise", &folder, &self.output)?;
        let Answered { study, records, solution, .. } = &answered;
        let problem = Problem::new(Choices::of(study)?, &records.records);
        let findings = Findings::of(&problem, solution);
        context.check_interrupt()?;
        let left_out = [&problem.choices.left_out[..], &problem.left_out, &solution.failures].concat();
        fill(&mut report, &answered, &problem, &findings, (&left_out, &[of_mounts, warnings].concat()))?;
        if findings.best.is_none() {
            let why = match &findings.nearest {
                Some(_) => format!("no device respects {}", limits(&problem.choices)),
                None => "no device has a response to every motion".to_owned(),
            };
            report.note(format_args!("{}: {why}; results are written", self.input.study.display()));
        }
        report.complete(findings.best.is_some() && records.unreadable.is_empty() && solution.failures.is_empty());
        let ending = report.finish(&folder, context)?;
        answered.tried.map_or(Ok(()), Tried::discard)?;
        Ok(ending)
    }
}

fn answered<'a>(
    arguments: &OptimiseArguments,
    change: Option<String>,
    records: &'a StudyRecords,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<Answered<'a>> {
    let study = arguments.input.load(change)?;
    let choices = Choices::of(&study)?;
    // Where the search goes on depends on what it finds.
    let progress = Progress::of_unknown_length("runs");
    let problem = Problem::new(choices, &records.records);
    let file = arguments.input.study.display();
    if problem.motions.is_empty() {
        let first = problem.left_out.first().map_or_else(String::new, |line| format!("; {line}"));
        anyhow::bail!("{file}: there is no motion{first}");
    }
    // Where the results go is tried before the work, not after it.
    let choices = &problem.choices;
    let subject = study_subject("optimise", &records.records)
        .with("study", &Resolved::of(&study, choices))?
        .with("structure", choices.structure)?;
    let inputs = arguments.input.files(&study, records);
    let names = &["designs", "motions", "optimise", "choice", "delay", "trade_off"];
    folder.open(&Claim { subject: subject.clone(), page: "summary.json", names, inputs })?;
    let (begin, done) = (|runs| progress.begin(runs), |runs| progress.advance(runs));
    let (solution, tried) = if arguments.accuracy.is_chosen() {
        (problem.solve(&mut (), interrupt, &begin, &done)?, None)
    } else {
        let origin = Origin::new(subject.clone(), MOST_ROWS);
        let mut tried = Tried::begin(folder, origin, arguments.rows.start(), problem.trials())?;
        interrupt.keep(resumable("finished rows", folder, RESUMED));
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
        anyhow::bail!("{file}: no device could be tried; {first}");
    }
    Ok(Answered { study, records, subject, solution, tried })
}

/// Puts files, tables and notes into the report.
fn fill(
    report: &mut Report,
    Answered { study, records, subject, solution, .. }: &Answered<'_>,
    problem: &Problem<'_>,
    findings: &Findings,
    (left_out, warnings): (&[String], &[String]),
) -> anyhow::Result<()> {
    let choices = &problem.choices;
    let input = Input { study: &Resolved::of(study, choices), structure: choices.structure };
    report.made_by(input)?;
    let candidates = Candidates { input, curves: &choices.curves };
    let answer = Answer { unreadable: &records.unreadable, findings, left_out, accuracy: solution.worst };
    report.summary(candidates, &records.summaries(), warnings, subject, answer)?;
    report.table("designs", &design_table(findings))?;
    report.table("motions", &motion_table(problem, solution, findings.best.as_ref()))?;
    report.page("optimise.md", &page(problem, findings)?)?;
    report.picture("trade_off", trade_off_picture(problem, findings))?;
    // Those of an earlier search that found one.
    let (choice, compared) = (choice_page(problem, findings), choice_picture(problem, findings).transpose());
    match choice {
        Some(text) => report.page("choice.md", &text)?,
        None => report.remove("choice.md"),
    }
    for (name, picture) in [("choice", compared), ("delay", delay_picture(problem, findings).transpose())] {
        match picture {
            Some(svg) => _ = report.picture(name, svg)?,
            None => ["svg", "png"].into_iter().for_each(|ending| report.remove(&format!("{name}.{ending}"))),
        }
    }
    let Findings { motions, designs, runs, notes, .. } = findings;
    report.print(format_args!("{}: {motions} motions, {}", heading(choices), limits(choices)));
    report.print(format_args!("{designs} devices tried in {runs} runs\n\n{}\n", choice_table(findings)?.for_terminal()));
    let rivals = findings.ranking.iter().flat_map(|ranking| &ranking.rivals);
    rivals.for_each(|rival| report.print(rival.verdict(findings.level)));
    findings.delay_budget.iter().for_each(|budget| report.print(budget.words()));
    notes.iter().for_each(|note| report.print(note));
    report.left_out(left_out);
    report.accuracy(solution.worst);
    Ok(())
}
