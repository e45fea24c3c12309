//! `sprag sensitivity`: what each effect changes, alone and together, under one or many ground motions.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::heading::of_scene;
use sprag_report::output::{ResultFolder, Subject};
use sprag_report::plot::{FigureTitle, OwnMark, SensitivityLane, SensitivityRow, sensitivity_figure};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::Scene;
use sprag_studies::cloud::folder::Named;
use sprag_studies::sensitivity::motion::RecordFiles;
use sprag_studies::sensitivity::report::{comparison_table, page, table};
use sprag_studies::sensitivity::statistics::{Summary, summaries};
use sprag_studies::sensitivity::study::{Findings, Flip, Study};

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::read_motions::ReadMotions;
use super::record_arguments::ReadArguments;
use super::report::{Report, SceneInput};
use super::scene_arguments::SceneArguments;
use super::thread_arguments::ThreadArguments;

/// Turn effects on one by one: what does each change?
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag sensitivity scenes/near_fault.toml\n  \
    sprag sensitivity scenes/near_fault.toml --records records/*.AT2 --out out/sensitivity\n\n\
    Runs every device under the scene's ground motion and under each record in its place, as it is and with each variant. \
    Writes sensitivity.csv, sensitivity.md, sensitivity.svg (with --png sensitivity.png) and summary.json. A record that cannot be read and a run that \
    fails are named, the others are still done, and the exit code is 1.")]
pub struct SensitivityArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Ground motion records and folders of them, each record in the place of the scene's.
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub records: Vec<PathBuf>,
    /// Vertical components of the records, as many and in the same order; without them the ground moves vertically by 2/3 of its
    /// horizontal motion.
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub records_vertical: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

/// What `summary.json` says of the runs.
#[derive(Serialize)]
struct Answer<'a> {
    runs: &'a [Summary],
    left_out: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<Worst>,
}

impl Run for SensitivityArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder_at(&self.scene.scene, "sensitivity", &self.accuracy)?;
        let mut warnings = context.warned(self.scene.load(None)?.warnings());
        let named = [&self.records, &self.records_vertical].map(|paths| Named::of(paths));
        named.iter().for_each(|named| warnings.extend(context.warned(named.passed_over.clone())));
        let interrupt = context.interrupt;
        let studied = self.accuracy.run(context, |change| studied(self, &named, change, &mut folder, interrupt))?;
        studied.read.errors.iter().for_each(|error| context.note(error));
        let records = studied.read.records();
        warnings.extend(context.warned(warning_lines(&records)));
        let mut report = Report::new("sensitivity", &folder, &self.output)?;
        fill(&mut report, &studied, &records, &warnings)?;
        report.finish(&folder, context)
    }
}

/// A study that was run.
struct Studied {
    scene: Scene,
    subject: Subject,
    study: Study,
    read: ReadMotions,
    findings: Findings,
}

/// The study of the scene with `change`.
fn studied(
    arguments: &SensitivityArguments,
    named: &[Named; 2],
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<Studied> {
    let (mut scene, study) = Study::load(&arguments.scene.scene, &arguments.scene.changes(change))?;
    arguments.reading.apply(&mut scene)?;
    let [horizontal, vertical] = named;
    let unreadable = [&horizontal.unreadable[..], &vertical.unreadable].concat();
    let read = ReadMotions::of(&scene, &pairs(arguments, &horizontal.files, &vertical.files)?, &unreadable)?;
    let others = [&horizontal.files[..], &vertical.files].concat();
    let claim = claim_of_scene("sensitivity", &arguments.scene.scene, &scene, &scene.file, &["sensitivity"], &others)?;
    // Where the results go is tried before the work, not after it.
    folder.open(&claim)?;
    let pool = arguments.threads.pool()?;
    let progress = Progress::new("runs");
    progress.begin((study.runs() * read.motions.len()) as u64);
    let findings = pool.install(|| study.run(&read.motions, interrupt, &|| progress.step()));
    progress.finish();
    Ok(Studied { findings: findings?, scene, subject: claim.subject, study, read })
}

/// The records, each with its vertical component.
fn pairs(arguments: &SensitivityArguments, horizontal: &[PathBuf], vertical: &[PathBuf]) -> anyhow::Result<Vec<RecordFiles>> {
    if !arguments.records_vertical.is_empty() && vertical.len() != horizontal.len() {
        let (vertical, horizontal) = (vertical.len(), horizontal.len());
        anyhow::bail!("--records-vertical names {vertical} files, but --records {horizontal}; each record needs its own");
    }
    let pair =
        |(index, file): (usize, &PathBuf)| RecordFiles { horizontal: file.clone(), vertical: vertical.get(index).cloned() };
    Ok(horizontal.iter().enumerate().map(pair).collect())
}

/// Puts files, tables and notes into the report.
fn fill(report: &mut Report, studied: &Studied, records: &[RecordSummary], warnings: &[String]) -> anyhow::Result<()> {
    let Studied { scene, subject, study, read: ReadMotions { motions, errors }, findings } = studied;
    let runs = summaries(findings, motions, &study.devices);
    let in_place = motions.iter().filter(|motion| !motion.own).count();
    let left_out = [&study.left_out[..], &findings.left_out, &findings.failed].concat();
    let title = &scene.file.title;
    let mut conditions = of_scene(scene);
    if let Some(first) = conditions.first_mut() {
        first.insert_str(0, "without a variant: ");
    }
    let answer = Answer { runs: &runs, left_out: &left_out, accuracy: findings.worst };
    let input = SceneInput { scene: &scene.file };
    report.made_by(input)?;
    report.summary(input, records, warnings, subject, answer)?;
    report.table("sensitivity", &comparison_table(findings, motions, &study.devices))?;
    report.page("sensitivity.md", &page(title, &runs, in_place, &left_out))?;
    let heading = FigureTitle { text: title.clone(), conditions };
    report.picture("sensitivity", sensitivity_figure(heading, &study.devices, &figure_rows(&runs)))?;
    report.print(table(&runs).for_terminal());
    left_out.iter().for_each(|line| report.print(format_args!("left out: {line}")));
    report.accuracy(findings.worst);
    findings.failed.iter().for_each(|error| report.note(error));
    report.complete(errors.is_empty() && findings.failed.is_empty());
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
