//! `sprag batch`: many independent cases, one a row.

use std::io::{BufReader, Read, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use clap::Args;
use rayon::prelude::*;
use sprag_loops::{Method, Precision};
use sprag_report::output::{Results, claim_file};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::answer::Comparable;
use sprag_sim::accuracy::{Accuracy, ErrorEstimate, budget};
use sprag_sim::batch::case::{Case, CaseError, CaseResult};
use sprag_sim::batch::table::{CASE_COLUMNS, ERROR_COLUMNS, RESULT_COLUMNS, read_cases, shown, write_result};

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::out_arguments::OverwriteArguments;
use super::thread_arguments::ThreadArguments;

/// Run many dimensionless blocks under one-cycle pulses.
#[derive(Args, Clone, Debug)]
#[command(after_help = format!("Example:\n  sprag batch cases.csv --out results.csv\n\nA case file has the columns\n  {CASE_COLUMNS}\n\
    and the result file\n  {RESULT_COLUMNS}\nwith times in 1/p from the pulse's start; with --accuracy or --time-budget also\n  {ERROR_COLUMNS}\n\
    Rows keep their order, whatever the number of threads."))]
pub struct BatchArguments {
    /// Case file: a block and a pulse in each row.
    #[arg(value_name = "CASES.csv")]
    pub cases: PathBuf,
    /// File for the results, a row for each case.
    #[arg(long, value_name = "RESULTS.csv")]
    pub out: PathBuf,
    /// What may be replaced.
    #[command(flatten)]
    pub replace: OverwriteArguments,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadArguments,
    /// Size of the last terms of the series over the rotation that matters, 1e-20 to 0.01; without errors.
    #[arg(long, value_name = "T", default_value = "1e-15", value_parser = tolerance, conflicts_with_all = ["accuracy", "time_budget"])]
    pub tolerance: f64,
    /// Accuracy of the runs.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-20..=1e-2).contains(&value) => Ok(value),
        _ => Err("must be a number from 1e-20 to 0.01".to_owned()),
    }
}

/// Largest case file that is read, bytes: some ten million cases.
const LARGEST_FILE: u64 = 1 << 30;

/// Cases that one task works on before it looks up.
const CHUNK: usize = 256;

/// Cases that are tried to learn what a level of accuracy costs.
const SAMPLE: usize = 512;

/// A result, with its error where that is asked for.
type Row = (CaseResult, Option<ErrorEstimate>);

/// What `seconds` afford, found by trying some of the cases, evenly spread.
fn plan(seconds: Duration, accuracy: Option<Accuracy>, cases: &[(String, Case)]) -> Result<budget::Plan, budget::TooLittleTime> {
    let some: Vec<&Case> = cases.iter().step_by(cases.len().div_ceil(SAMPLE).max(1)).map(|(_, case)| case).collect();
    let share = cases.len() as f64 / some.len().max(1) as f64;
    let sample = |accuracy: Accuracy| {
        let start = Instant::now();
        // A case that cannot be run is reported when all are.
        let mut errors: Vec<f64> = some
            .par_iter()
            .filter_map(|case| case.answer(accuracy).ok())
            .map(|answer| answer.error.relative(answer.result.compared().peak_rotation))
            .collect();
        errors.sort_by(f64::total_cmp);
        let error = errors.get(errors.len() * 95 / 100).copied().unwrap_or(0.0);
        Ok(budget::Sample { seconds: share * start.elapsed().as_secs_f64(), error, of: "95 % of the cases" })
    };
    // What is touched for the first time is slow.
    let _ = sample(Accuracy::Fast);
    let start = Instant::now();
    budget::plan(seconds, accuracy, sample, || start.elapsed())
}

impl Run for BatchArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        run(self, context).map(|()| Completion::Complete)
    }
}

/// The first line of a result file.
fn heading(with_errors: bool) -> String {
    if with_errors { format!("{RESULT_COLUMNS},{ERROR_COLUMNS}") } else { RESULT_COLUMNS.to_owned() }
}

/// Whether `file` has results below this heading, of these cases by their ids.
fn results_of(file: impl Read, heading: &str, cases: &[(String, Case)]) -> bool {
    let mut reader = csv::Reader::from_reader(file);
    let same = reader.headers().is_ok_and(|titles| titles.iter().eq(heading.split(',')));
    same && reader.records().map(|row| row.ok()?.get(0).map(str::to_owned)).eq(cases.iter().map(|(id, _)| Some(id.clone())))
}

fn run(arguments: &BatchArguments, context: &mut Context<'_>) -> anyhow::Result<()> {
    let interrupt = context.interrupt;
    let name = arguments.cases.display();
    let path = &arguments.cases;
    let file = std::fs::File::open(path).map_err(|error| anyhow!("{name}: {error}"))?;
    if !file.metadata().is_ok_and(|data| data.len() <= LARGEST_FILE) {
        anyhow::bail!("{name}: too large; case files of at most 1 GiB are read");
    }
    let reading = Progress::uncounted("reading cases");
    let cases = read_cases(BufReader::new(file)).map_err(|error| anyhow!("{name}: {error}"))?;
    reading.finish();
    // Where the results go is tried before the work, not after it.
    let heading = heading(arguments.accuracy.accuracy.is_some() || arguments.accuracy.is_chosen());
    let same = |file| results_of(file, &heading, &cases);
    claim_file(&arguments.out, &[path], arguments.replace.overwrite, same)?;
    let pool = arguments.threads.pool()?;
    let AccuracyArguments { mut accuracy, time_budget } = arguments.accuracy;
    if let Some(seconds) = time_budget {
        let _trying = Progress::uncounted(super::TRYING);
        let plan = pool.install(|| plan(seconds, accuracy, &cases))?;
        context.note(plan);
        accuracy = Some(plan.accuracy);
    }
    let progress = Progress::new("cases");
    progress.begin(cases.len() as u64);
    let answers: Vec<Result<Row, CaseError>> = pool.install(|| {
        cases
            .par_chunks(CHUNK)
            .flat_map_iter(|chunk| {
                let method = f64::ideal(Method::Adaptive(arguments.tolerance));
                let row = |case: &Case| match accuracy {
                    Some(accuracy) => case.answer(accuracy).map(|answer| (answer.result, Some(answer.error))),
                    None => case.run(&*method).map(|result| (result, None)),
                };
                let stop = interrupt.is_set();
                let answers: Vec<_> = if stop { Vec::new() } else { chunk.iter().map(|(_, case)| row(case)).collect() };
                progress.advance(chunk.len() as u64);
                answers
            })
            .collect()
    });
    progress.finish();
    context.check_interrupt()?;
    if let Some((id, error)) = cases.iter().zip(&answers).find_map(|((id, _), answer)| answer.as_ref().err().map(|e| (id, *e))) {
        anyhow::bail!("{name}: case `{}`: {error}", shown(id));
    }
    let _writing = Progress::uncounted("writing results");
    let mut results = Results::default();
    results.add(&arguments.out, |out| {
        writeln!(out, "{heading}")?;
        for ((id, _), answer) in cases.iter().zip(&answers) {
            if let Ok((result, error)) = answer {
                write_result(out, id, result, error.as_ref())?;
            }
        }
        Ok(())
    })?;
    results.commit()?;
    Ok(())
}
