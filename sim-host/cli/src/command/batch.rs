//! `sprag batch`: many independent cases, one a row.

use std::fs::File;
use std::io::{self, BufReader, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{anyhow, bail};
use clap::Args;
use csv::StringRecord;
use rayon::ThreadPool;
use rayon::prelude::*;
use sprag_report::columns::Column;
use sprag_report::output::{OutputError, Results, claim_file, is_standard_output, open_stream};
use sprag_report::part::Part;
use sprag_report::progress::Progress;
use sprag_sim::accuracy::answer::Comparable;
use sprag_sim::accuracy::{Accuracy, budget};
use sprag_sim::batch::case::{Case, CaseError};
use sprag_sim::batch::lanes::results;
use sprag_sim::batch::table::{CASE_COLUMNS, ERROR_COLUMNS, RESULT_COLUMNS, shown};
use sprag_sim::interrupt::Interrupt;

use super::accuracy_arguments::AccuracyArguments;
use super::batch_cases::{CaseFile, CaseReader, Cases, is_parquet};
use super::batch_results::{Chunk, Found, Sink, are_of, columns};
use super::context::{Completion, Context, Interrupted, Run};
use super::out_arguments::OverwriteArguments;
use super::thread_arguments::ThreadArguments;

/// Run many dimensionless blocks under one-cycle pulses.
#[derive(Args, Clone, Debug)]
#[command(after_help = format!("Examples:\n  sprag batch cases.csv --out results.csv\n  \
    sprag batch cases.parquet --out results.parquet\n  generate | sprag batch - --out - | evaluate\n\nA case file has the columns\n  {CASE_COLUMNS}\n\
    and the result file\n  {RESULT_COLUMNS}\nwith times in 1/p from the pulse's start. end_time is the instant of rest, or from which nothing can stop a fall; that of the pulse's end for a block that does not \
    rock, else that of the free time's. With --accuracy or --time-budget also\n  {ERROR_COLUMNS}\n\
    A case of device none does not depend on its mass_ratio. Rows keep their order, whatever the number of threads. They are read and written in a stream, in constant memory."))]
pub struct BatchArguments {
    /// Case file, CSV or Parquet by its ending, or - for standard input: a block and a pulse in each row.
    #[arg(value_name = "CASES")]
    pub cases: PathBuf,
    /// File for the results, CSV or Parquet by its ending, or - for standard output: a row for each case.
    #[arg(long, value_name = "RESULTS")]
    pub out: PathBuf,
    /// What may be replaced.
    #[command(flatten)]
    pub replace: OverwriteArguments,
    /// Threads.
    #[command(flatten)]
    pub threads: ThreadArguments,
    /// Size of the last terms of the series over the rotation that matters, 1e-20 to 0.01; without errors.
    #[arg(long, value_name = "T", default_value = "1e-15", value_parser = super::number(1e-20..=1e-2), conflicts_with_all = ["accuracy", "time_budget"])]
    pub tolerance: f64,
    /// Accuracy of the runs.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

/// Cases that one task works on before it looks up.
const CHUNK: usize = 512;

/// What is kept of results that go through a stream and are interrupted: who reads it has what came before.
const OF_STREAM: &str = "some rows may have been written";

/// Cases a thread that are in memory at one time.
const WINDOW: usize = 8 * CHUNK;

/// Most cases that are tried to learn what a level of accuracy costs.
const SAMPLE: usize = 512;

/// Some of `cases`, evenly spread, and for how many each of them stands.
fn sample(cases: &mut Cases) -> anyhow::Result<(Vec<Case>, f64)> {
    let (mut some, mut step, mut count) = (Vec::new(), 1, 0_u64);
    cases.each(|_, case| {
        // A full sample has every `step`-th case so far, and every second of it is kept.
        if count.is_multiple_of(step) {
            if some.len() == SAMPLE {
                some = some.drain(..).step_by(2).collect();
                step *= 2;
            }
            some.push(case);
        }
        count += 1;
        true
    })?;
    let share = count as f64 / some.len().max(1) as f64;
    Ok((some, share))
}

/// What `seconds` afford, found by trying `some` of the cases, each for `share` of them.
fn plan(
    seconds: Duration,
    accuracy: Option<Accuracy>,
    (some, share): &(Vec<Case>, f64),
) -> Result<budget::Plan, budget::TooLittleTime> {
    let sample = |accuracy: Accuracy| {
        let start = Instant::now();
        // A case that cannot be run is reported when all are.
        let mut errors: Vec<f64> = some
            .par_iter()
            .filter_map(|case| case.answer(accuracy).ok())
            .filter_map(|answer| answer.error.of_peak(answer.result.compared().peak_rotation))
            .collect();
        errors.sort_by(f64::total_cmp);
        let error = errors.get(errors.len() * 95 / 100).copied();
        Ok(budget::Sample { seconds: share * start.elapsed().as_secs_f64(), error, of: "95 % of the cases that rock and stand" })
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

/// Refuses to write where no results of these cases may go.
fn claim(arguments: &BatchArguments, cases: &CaseFile, columns: &[Column]) -> anyhow::Result<()> {
    let BatchArguments { out, replace, .. } = arguments;
    let input = if arguments.cases == Path::new("-") { Path::new("/dev/stdin") } else { &arguments.cases };
    let mut compared = None;
    let same = |there: BufReader<File>| {
        let same = if cases.is_file() {
            cases.again().and_then(|mut cases| are_of(there.into_inner(), is_parquet(out), columns, &mut cases))
        } else {
            let (out, cases) = (out.display(), cases.name());
            Err(anyhow!(
                "{out}: a file is there, and {cases} cannot be read twice to compare it with the cases; --overwrite replaces it, or give \
                 another place for the new one"
            ))
        };
        compared.insert(same).as_ref().is_ok_and(|same| *same)
    };
    let claimed = claim_file(out, &[input], replace.overwrite, same);
    compared.transpose()?;
    Ok(claimed?)
}

/// What is the same for all cases.
struct Work<'a> {
    columns: Vec<Column>,
    accuracy: Option<Accuracy>,
    tolerance: f64,
    parquet: bool,
    pool: ThreadPool,
    interrupt: &'a Interrupt,
}

impl Work<'_> {
    /// Works out all `cases` into `sink`, a window at a time. An error of the sink is an [`io::Error`].
    fn run(&self, cases: Cases, mut sink: Sink<'_>) -> anyhow::Result<()> {
        let threads = self.pool.current_num_threads();
        let (progress, reader) = (cases.progress(), cases.reader.clone());
        let mut windows = cases.windows(WINDOW * threads, threads > 1);
        let mut used = None;
        loop {
            let (window, more) = windows(used);
            let chunks = window.rows().par_chunks(CHUNK);
            let found: Vec<_> = self.pool.install(|| chunks.map(|rows| self.chunk(&reader, rows)).collect());
            for (chunk, rest) in found {
                sink.take(&self.columns, chunk?)?;
                rest?;
            }
            sink.flush()?;
            progress.advance(window.advance);
            if !more? {
                return Ok(sink.finish()?);
            }
            used = Some(window);
        }
    }

    /// The results of `rows` up to the first that has none, and what is wrong with that.
    fn chunk(&self, reader: &CaseReader, rows: &[StringRecord]) -> (anyhow::Result<Chunk>, anyhow::Result<()>) {
        if self.interrupt.is_set() {
            return (Err(Interrupted.into()), Ok(()));
        }
        let mut wrong = Ok(());
        let read = rows.iter().map_while(|row| reader.case(row).map_err(|error| wrong = Err(error)).ok());
        let (ids, cases): (Vec<&str>, Vec<Case>) = read.unzip();
        let results: Vec<Result<Found, CaseError>> = match self.accuracy {
            Some(accuracy) => {
                cases.iter().map(|case| case.answer(accuracy).map(|answer| (answer.result, Some(answer.error)))).collect()
            }
            None => results(&cases, self.tolerance).into_iter().map(|result| result.map(|result| (result, None))).collect(),
        };
        let named = |id, error| anyhow!("{}: case `{}`: {error}", reader.name(), shown(id));
        let found = ids.into_iter().zip(results);
        let rows: Vec<_> = found
            .map_while(|(id, found)| found.map(|found| (id, found)).map_err(|error| wrong = Err(named(id, error))).ok())
            .collect();
        (Chunk::of(&rows, &self.columns, !self.parquet).map_err(Into::into), wrong)
    }

    /// Works out all `cases` into the file `out`.
    fn write(&self, cases: Cases, out: &mut (dyn Write + Send)) -> anyhow::Result<()> {
        let sink = if self.parquet { Sink::parquet(&self.columns, out)? } else { Sink::csv(out) };
        self.run(cases, sink)
    }
}

fn run(arguments: &BatchArguments, context: &mut Context<'_>) -> anyhow::Result<()> {
    let BatchArguments { out, threads, tolerance, .. } = arguments;
    let AccuracyArguments { mut accuracy, time_budget } = arguments.accuracy;
    let parquet = is_parquet(out);
    if parquet {
        Part::PARQUET.allow(())?;
    }
    let cases = CaseFile::open(&arguments.cases)?;
    // Where the results go is tried before the work, not after it.
    let columns = columns(accuracy.is_some() || time_budget.is_some());
    claim(arguments, &cases, &columns)?;
    let pool = threads.pool()?;
    if let Some(seconds) = time_budget {
        if !cases.is_file() {
            bail!("--time-budget: {} cannot be read twice to try some of the cases; give a file, or --accuracy", cases.name());
        }
        let _trying = Progress::uncounted(super::TRYING);
        let sample = sample(&mut cases.again()?)?;
        let plan = pool.install(|| plan(seconds, accuracy, &sample))?;
        context.note(plan);
        accuracy = Some(plan.accuracy);
    }
    let cases = cases.cases()?;
    let work = Work { columns, accuracy, tolerance: *tolerance, parquet, pool, interrupt: context.interrupt };
    if is_standard_output(out) {
        context.interrupt.keep(OF_STREAM);
        return match work.run(cases, Sink::csv(context.out)) {
            // Reported where standard output ends.
            Err(error) if error.is::<io::Error>() => Ok(()),
            ended => ended,
        };
    }
    let named = |error: anyhow::Error| match error.downcast::<io::Error>() {
        Ok(error) => OutputError::new(out, &error).into(),
        Err(error) => error,
    };
    if let Some(stream) = open_stream(out)? {
        context.interrupt.keep(OF_STREAM);
        return match work.write(cases, &mut BufWriter::new(stream)) {
            // A reader that stops early has what it wanted.
            Err(error) if error.downcast_ref::<io::Error>().is_some_and(|error| error.kind() == ErrorKind::BrokenPipe) => Ok(()),
            ended => ended.map_err(named),
        };
    }
    let mut results = Results::default();
    results.add_by(out, |file| work.write(cases, file).map_err(named))?;
    Ok(results.commit()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_spread_evenly() {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        writeln!(file, "{CASE_COLUMNS}").unwrap();
        (0..5000).for_each(|index| writeln!(file, "{index},full,15,none,0,0.85,sine,2,2,{index}").unwrap());
        let (some, share) = sample(&mut CaseFile::open(file.path()).unwrap().cases().unwrap()).unwrap();
        assert!(some.iter().map(|case| case.free_time as usize).eq((0..5000).step_by(16)));
        assert_eq!(share, 5000.0 / some.len() as f64);
    }
}
