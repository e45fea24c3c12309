//! `sprag loop-study`: the studies of the controller, made again.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use serde::Serialize;
use sprag_report::output::{Claim, SCHEMA_VERSION, Subject, VERSION};
use sprag_report::progress::Progress;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_studies::cloud::folder::Named;
use sprag_studies::loop_study::bench::{Conditions, records_of};
use sprag_studies::loop_study::bound::bound;
use sprag_studies::loop_study::decisions::decisions;
use sprag_studies::loop_study::faults::faults;
use sprag_studies::loop_study::ideal_limit::ideal_limit;
use sprag_studies::loop_study::laws::laws;
use sprag_studies::loop_study::motion::Motion;
use sprag_studies::loop_study::practice::practice;
use sprag_studies::loop_study::robustness::robustness;
use sprag_studies::loop_study::train::train;
use sprag_studies::sensitivity::motion::RecordFiles;

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::out_arguments::{OutputArguments, digests, file_of};
use super::record_arguments::ReadArguments;
use super::report::Report;
use super::thread_arguments::ThreadArguments;

/// Study of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Study {
    /// Error against the ideal pair over the control rate.
    IdealLimit,
    /// Real sensors, rates and delays against the ideal pair.
    Practice,
    /// What each clutch law overturns, in the ideal model and in real ones.
    Laws,
    /// What a law that knew the ground motion would do, and how much of it each law does.
    Bound,
    /// Weights of the law costate, by random pulses and the records.
    Train,
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
    Writes a page NAME.md, its tables as CSV and its pictures as SVG, with --png as PNG too, and NAME.run.json, which says what they \
    are of and has the records that were read. The studies ideal-limit and faults take no records.")]
pub struct LoopStudyArguments {
    /// Study to make.
    #[arg(value_enum)]
    pub study: Study,
    /// Recorded ground motions, and folders of them, to study beside the pulses.
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub records: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

/// `NAME.run.json`.
#[derive(Serialize)]
struct Page<'a> {
    #[serde(flatten)]
    subject: &'a Subject,
    version: &'static str,
    schema_version: u32,
    records: &'a [RecordSummary],
    warnings: &'a [String],
}

impl Run for LoopStudyArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let name = self.study.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default();
        if matches!(self.study, Study::IdealLimit | Study::Faults) && !self.records.is_empty() {
            anyhow::bail!("--records: the study {name} takes no records");
        }
        let mut folder = self.output.folder_at(Path::new(&name), "loop-study", &self.accuracy)?;
        let named = named_once(&self.records)?;
        let files: Vec<(PathBuf, PathBuf)> = named.files.iter().map(|file| (file.clone(), file.clone())).collect();
        let accuracy = self.accuracy.accuracy.map(|accuracy| accuracy.to_string());
        let subject = Subject::new("loop-study", digests(&files)).with("study", &name)?.with("accuracy", &accuracy)?;
        let record = |file: &PathBuf| Motion::Record { file: file.clone(), reading: self.reading.table(), scale: 1.0 };
        let records: Vec<Motion> = named.files.iter().map(record).collect();
        // Before hours of work, not after them.
        let read = records_of(&records)?;
        let (page, inputs) = (format!("{name}.run.json"), named.files.iter().map(|file| file_of(file)).collect());
        folder.open(&Claim { subject: subject.clone(), page: &page, names: &[&name], inputs })?;
        let warnings = context.warned([named.passed_over, warning_lines(&read)].concat());
        let (pool, interrupt) = (self.threads.pool()?, context.interrupt);
        let progress = self.progress();
        let found = self.accuracy.levels(context, |accuracy| {
            let conditions = Conditions::new(accuracy, interrupt);
            let made = pool.install(|| match self.study {
                Study::IdealLimit => ideal_limit(&progress, &conditions),
                Study::Practice => practice(&records, &progress, &conditions),
                Study::Laws => laws(&records, &progress, &conditions),
                Study::Bound => bound(&records, &progress, &conditions),
                Study::Train => train(&records, &progress, &conditions),
                Study::Decisions => decisions(&records, &progress, &conditions),
                Study::Robustness => robustness(&records, &progress, &conditions),
                Study::Faults => faults(&progress, &conditions),
            })?;
            Ok((made, accuracy.map(|_| conditions.worst())))
        });
        progress.finish();
        let (made, worst) = found?;
        let names = made.tables.iter().map(|(name, _)| name).chain(made.figures.iter().map(|(name, _)| name));
        for (inner, _) in names.filter_map(|name| name.rsplit_once('/')) {
            folder.make(inner)?;
        }
        let mut report = Report::new("loop-study", &folder, &self.output)?;
        let (version, schema_version) = (VERSION, SCHEMA_VERSION);
        report.document(&page, &Page { subject: &subject, version, schema_version, records: &read, warnings: &warnings })?;
        report.page(&format!("{name}.md"), &made.page.markdown())?;
        for (name, table) in &made.tables {
            report.table(name, table)?;
        }
        for (name, svg) in made.figures {
            report.picture(&name, Ok(svg))?;
        }
        report.print(made.page.for_terminal());
        report.accuracy(worst);
        report.finish(&folder, context)
    }
}

impl LoopStudyArguments {
    fn progress(&self) -> Progress {
        match self.study {
            // All other studies go in stages, and know their runs stage by stage; a time budget runs a study again.
            Study::Decisions if !self.accuracy.is_chosen() => Progress::new("runs"),
            _ => Progress::of_unknown_length("runs"),
        }
    }
}

/// The record files among `paths` and in their folders, each once.
fn named_once(paths: &[PathBuf]) -> anyhow::Result<Named> {
    let named = Named::of(paths);
    if let Some(unreadable) = named.unreadable.first() {
        anyhow::bail!("{unreadable}");
    }
    let records = RecordFiles::horizontal(&named.files);
    let files = RecordFiles::named(&records).into_iter().map(|(_, record)| record.horizontal.clone()).collect();
    Ok(Named { files, ..named })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_named_twice_is_one_record() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("inside")).unwrap();
        for name in ["a.csv", "inside/b.csv"] {
            std::fs::write(at(name), "").unwrap();
        }
        let named = named_once(&[at("inside/../a.csv"), at("inside"), at("a.csv"), folder.path().to_owned()]).unwrap();
        assert_eq!(named.files, [at("inside/../a.csv"), at("inside/b.csv")]);
    }
}
