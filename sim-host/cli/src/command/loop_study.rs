//! `sprag loop-study`: the studies of the controller, made again.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use serde::Serialize;
use sprag_report::output::{Claim, OutputError, ResultFolder, Results, Subject};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Accuracy;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_studies::loop_study::bench::{Conditions, StudyError, records_of};
use sprag_studies::loop_study::decisions::decisions;
use sprag_studies::loop_study::faults::faults;
use sprag_studies::loop_study::ideal_limit::ideal_limit;
use sprag_studies::loop_study::laws::laws;
use sprag_studies::loop_study::motion::Motion;
use sprag_studies::loop_study::practice::practice;
use sprag_studies::loop_study::report::Report;
use sprag_studies::loop_study::robustness::robustness;

use super::accuracy_arguments::AccuracyArguments;
use super::format_arguments::PictureArguments;
use super::out_arguments::{OverwriteArguments, digests, file_of};
use super::record_arguments::ReadArguments;
use super::{ended, warned};

/// Which study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Study {
    /// Error against the ideal pair over the control rate.
    IdealLimit,
    /// Real sensors, rates and delays against the ideal pair.
    Practice,
    /// What each clutch law overturns, in the ideal model and in real ones.
    Laws,
    /// How often and how late clutches are wrong: estimators by sensors by delays.
    Decisions,
    /// Delay, noise, rate and wrong beliefs.
    Robustness,
    /// Every class of fault at rest, at uplift, in mid-swing and at an impact.
    Faults,
}

/// Make a study of the controller: tables and pictures.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag loop-study practice --out out/practice\n  \
    sprag loop-study laws --records records/*.AT2 --out out/laws\n\n\
    Writes a page NAME.md, its tables as CSV and its pictures as SVG, with --png as PNG too, and NAME.run.json, which says what they
    are of and has the records that were read. The studies ideal-limit and faults take no records.")]
pub struct LoopStudyArguments {
    /// Which.
    #[arg(value_enum)]
    pub study: Study,
    /// Recorded ground motions to study beside the pulses.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    pub records: Vec<PathBuf>,
    /// How records are read.
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Folder for the results.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// What may be replaced in it.
    #[command(flatten)]
    pub replace: OverwriteArguments,
    /// Threads; all processors by default. Results do not depend on it.
    #[arg(long, value_name = "N", value_parser = super::threads)]
    pub threads: Option<u16>,
    /// How accurate.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    /// Pictures.
    #[command(flatten)]
    pub pictures: PictureArguments,
}

/// `NAME.run.json`.
#[derive(Serialize)]
struct Page<'a> {
    #[serde(flatten)]
    subject: &'a Subject,
    version: &'static str,
    records: &'a [RecordSummary],
    warnings: &'a [String],
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("--records: the study {} takes no records", study.to_possible_value().map_or_else(String::new, |name| name.get_name().to_owned()))]
    NoRecords { study: Study },
    #[error("{0}")]
    Study(#[from] StudyError),
    #[error("{0}")]
    Output(#[from] OutputError),
    #[error("no threads: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

/// Runs the command; the page goes to `out`, errors go to `err`.
pub fn run(arguments: &LoopStudyArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result.map(|()| true), interrupt, err)
}

fn run_or_fail(
    arguments: &LoopStudyArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    if matches!(arguments.study, Study::IdealLimit | Study::Faults) && !arguments.records.is_empty() {
        return Err(Failure::NoRecords { study: arguments.study });
    }
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = ResultFolder::new(arguments.out.clone(), arguments.replace.overwrite).of_any_accuracy(any_accuracy);
    let name = arguments.study.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
    let files: Vec<(PathBuf, PathBuf)> = arguments.records.iter().map(|file| (file.clone(), file.clone())).collect();
    let accuracy = arguments.accuracy.accuracy.map(|accuracy| accuracy.to_string());
    let subject = Subject::new("loop-study", digests(&files)).with("study", &name)?.with("accuracy", &accuracy)?;
    let record = |file: &PathBuf| Motion::Record { file: file.clone(), reading: arguments.reading.table(), scale: 1.0 };
    let records: Vec<Motion> = arguments.records.iter().map(record).collect();
    // Before hours of work, not after them.
    let read = records_of(&records)?;
    let (page, inputs) = (format!("{name}.run.json"), arguments.records.iter().map(|file| file_of(file)).collect());
    folder.open(&Claim { subject: subject.clone(), page: &page, names: &[&name], inputs })?;
    let warnings = warned(warning_lines(&read), err);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(arguments.threads.map_or(0, usize::from)).build()?;
    let progress = Progress::new("runs");
    let study = |accuracy: Option<Accuracy>| {
        let conditions = Conditions::new(accuracy, interrupt);
        let report = pool.install(|| match arguments.study {
            Study::IdealLimit => ideal_limit(&progress, &conditions),
            Study::Practice => practice(&records, &progress, &conditions),
            Study::Laws => laws(&records, &progress, &conditions),
            Study::Decisions => decisions(&records, &progress, &conditions),
            Study::Robustness => robustness(&records, &progress, &conditions),
            Study::Faults => faults(&progress, &conditions),
        })?;
        Ok::<_, StudyError>((report, accuracy.map(|_| conditions.worst())))
    };
    let tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let found = arguments.accuracy.levels(study, tell);
    progress.finish();
    let (report, worst) = found?;
    let page = Page { subject: &subject, version: env!("CARGO_PKG_VERSION"), records: &read, warnings: &warnings };
    write(&report, &page, arguments, &mut folder, out, err)?;
    if let Some(worst) = worst {
        let _ = writeln!(out, "accuracy: {worst}");
    }
    Ok(())
}

fn write(
    report: &Report,
    page: &Page<'_>,
    arguments: &LoopStudyArguments,
    folder: &mut ResultFolder,
    out: &mut impl Write,
    err: &mut impl Write,
) -> Result<(), OutputError> {
    let names = report.tables.iter().map(|(name, _)| name).chain(report.figures.iter().map(|(name, _)| name));
    for (inner, _) in names.filter_map(|name| name.rsplit_once('/')) {
        folder.make(inner)?;
    }
    let drawing = Progress::uncounted(super::DRAWING);
    let mut results = Results::default();
    results.add_json(&folder.join(format!("{}.run.json", report.name)), page)?;
    results.add(&folder.join(format!("{}.md", report.name)), |file| file.write_all(report.text.as_bytes()))?;
    for (name, table) in &report.tables {
        results.add(&folder.join(format!("{name}.csv")), |file| file.write_all(table.csv().as_bytes()))?;
    }
    for (name, svg) in &report.figures {
        results.add_picture(folder, name, svg, arguments.pictures.formats)?;
    }
    results.commit_telling(err)?;
    drawing.finish();
    let _ = write!(out, "{}", report.text);
    let _ = writeln!(out, "results in {}", folder.display());
    Ok(())
}
