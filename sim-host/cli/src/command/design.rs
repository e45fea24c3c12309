//! `sprag design`: from a structure with a device and a set of motions to a parts list.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::output::{Claim, ResultFolder, Subject};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Worst;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::Scene;
use sprag_studies::cloud::folder::Named;
use sprag_studies::design::basis::{Basis, TEETH};
use sprag_studies::design::figure::delay_picture;
use sprag_studies::design::page::{page, verdict};
use sprag_studies::design::study::{Findings, PartsList, Problem};
use sprag_studies::design::table::{delay_table, lines, motion_table, parts_table};
use sprag_studies::sensitivity::motion::RecordFiles;

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::read_motions::ReadMotions;
use super::record_arguments::ReadArguments;
use super::report::{Report, SceneInput};
use super::scene_arguments::SceneArguments;
use super::thread_arguments::ThreadArguments;

/// Size the parts of a device for a set of motions: a parts list.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag design scenes/near_fault.toml --set block.mass_kg=10000\n  \
    sprag design pier.toml --records near_fault/*.AT2 --device \"clutched pair\" --out out/pier\n\n\
    Runs every device with a flywheel under the scene's ground motion and under each record in its place, by its controller where the scene has one; \
    then its clutches later and later, and those that are chosen. Writes the page design.md, the tables parts, motions and delays as .csv (with --formats \
    .parquet), delay.svg (with --png delay.png) where clutches take commands, and summary.json. A record that cannot be read and a run that fails are named, \
    the others are still done, and the exit code is 1.")]
pub struct DesignArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Ground motion records and folders of them, each record in the place of the scene's.
    #[arg(long, value_name = "PATH", num_args = 1..)]
    pub records: Vec<PathBuf>,
    #[command(flatten)]
    pub reading: ReadArguments,
    /// Device to design, by its name in tables; may be given more than once. All that have a flywheel without it.
    #[arg(long, value_name = "NAME")]
    pub device: Vec<String>,
    #[command(flatten)]
    pub basis: BasisArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
}

/// The design basis.
#[derive(Args, Clone, Copy, Debug)]
pub struct BasisArguments {
    /// Factor on force, travel and readings of sensors, 1 to 10.
    #[arg(long, value_name = "FACTOR", default_value_t = Basis::default().margin, value_parser = super::any_number)]
    pub margin: f64,
    /// Factor on the torque of a clutch, and on the load of teeth where no clutch limits it, 1 to 10.
    #[arg(long, value_name = "FACTOR", default_value_t = Basis::default().service_factor, value_parser = super::any_number)]
    pub service_factor: f64,
    /// Teeth of the pinion, 12 to 200; below 17 they are undercut unless shifted.
    #[arg(long, value_name = "Z", default_value_t = Basis::default().teeth, value_parser = super::whole_number(TEETH))]
    pub teeth: u32,
    /// Face width of the gear in modules, 4 to 20.
    #[arg(long, value_name = "MODULES", default_value_t = Basis::default().face_width_modules, value_parser = super::any_number)]
    pub face_width: f64,
    /// Bending stress in MPa that teeth may bear by Lewis's formula; without it checks.gear.allowable_stress_mpa of the scene, or else 200, a
    /// third of the tensile strength of a steel of 600 MPa.
    #[arg(long, value_name = "MPA", value_parser = super::any_number)]
    pub allowable_stress: Option<f64>,
    /// Share by which the largest rotation may grow through late clutches, above 0, to 1.
    #[arg(long, value_name = "SHARE", default_value_t = Basis::default().tolerance, value_parser = super::any_number)]
    pub tolerance: f64,
}

impl BasisArguments {
    /// For `scene`.
    fn basis(&self, scene: &Scene) -> Basis {
        Basis {
            margin: self.margin,
            service_factor: self.service_factor,
            teeth: self.teeth,
            face_width_modules: self.face_width,
            allowable_stress_mpa: self.allowable_stress.unwrap_or_else(|| Basis::allowable_stress_of(scene)),
            tolerance: self.tolerance,
        }
    }
}

/// Scene and basis as resolved, and which devices.
#[derive(Clone, Copy, Serialize)]
struct Input<'a> {
    #[serde(flatten)]
    scene: SceneInput<'a>,
    basis: &'a Basis,
    /// Devices that were asked for by name.
    device: &'a [String],
}

/// What `summary.json` says of the runs.
#[derive(Serialize)]
struct Answer<'a> {
    designs: &'a [PartsList],
    unreadable: &'a [String],
    failed: &'a [String],
    left_out: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    accuracy: Option<Worst>,
}

impl Run for DesignArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder_at(&self.scene.scene, "design", &self.accuracy)?;
        let mut warnings = context.warned(self.scene.load(None)?.warnings());
        let named = Named::of(&self.records);
        warnings.extend(context.warned(named.passed_over.clone()));
        let interrupt = context.interrupt;
        let designed = self.accuracy.run(context, |change| designed(self, &named, change, &mut folder, interrupt))?;
        designed.read.errors.iter().for_each(|error| context.note(error));
        let records = designed.read.records();
        warnings.extend(context.warned(warning_lines(&records)));
        let mut report = Report::new("design", &folder, &self.output)?;
        fill(&mut report, self, &designed, &records, &warnings)?;
        report.finish(&folder, context)
    }
}

/// Devices that were designed.
struct Designed {
    scene: Scene,
    subject: Subject,
    read: ReadMotions,
    findings: Findings,
}

/// The design for the scene with `change`.
fn designed(
    arguments: &DesignArguments,
    named: &Named,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<Designed> {
    let mut scene = arguments.scene.load(change)?;
    // What is wrong with the options is said before records are read.
    Problem::new(&scene, &arguments.device, arguments.basis.basis(&scene))?;
    arguments.reading.apply(&mut scene)?;
    let read = ReadMotions::of(&scene, &RecordFiles::horizontal(&named.files), &named.unreadable)?;
    let names = ["design", "parts", "motions", "delays", "delay"];
    let claim = claim_of_scene("design", &arguments.scene.scene, &scene, &scene.file, &names, &named.files)?;
    let subject = claim.subject.with("basis", &arguments.basis.basis(&scene))?.with("device", &arguments.device)?;
    let claim = Claim { subject, ..claim };
    // Where the results go is tried before the work, not after it.
    folder.open(&claim)?;
    let pool = arguments.threads.pool()?;
    // Device by device, and delays only where the runs without them call for any.
    let progress = Progress::of_unknown_length("runs");
    let (begin, done) = (|runs: usize| progress.begin(runs as u64), || progress.step());
    let problem = Problem::new(&scene, &arguments.device, arguments.basis.basis(&scene))?;
    let findings = pool.install(|| problem.solve(&read.motions, interrupt, &begin, &done));
    progress.finish();
    Ok(Designed { findings: findings?, subject: claim.subject, read, scene })
}

/// Puts files, tables and notes into the report.
fn fill(
    report: &mut Report,
    arguments: &DesignArguments,
    designed: &Designed,
    records: &[RecordSummary],
    warnings: &[String],
) -> anyhow::Result<()> {
    let Designed { scene, subject, read: ReadMotions { motions, errors }, findings } = designed;
    let problem = Problem::new(scene, &arguments.device, arguments.basis.basis(scene))?;
    let input = Input { scene: SceneInput { scene: &scene.file }, basis: &problem.basis, device: &arguments.device };
    let Findings { lists, failed, left_out, worst } = findings;
    report.made_by(input)?;
    let answer = Answer { designs: lists, unreadable: errors, failed, left_out, accuracy: *worst };
    report.summary(input, records, warnings, subject, answer)?;
    report.table("parts", &parts_table(findings))?;
    report.table("motions", &motion_table(findings, motions, problem.mass_kg()))?;
    report.table("delays", &delay_table(findings))?;
    report.page("design.md", &page(&problem, findings, motions.len(), errors.len()))?;
    // That of an earlier design whose clutches took commands.
    match delay_picture(&problem, findings).transpose() {
        Some(svg) => _ = report.picture("delay", svg)?,
        None => ["svg", "png"].into_iter().for_each(|ending| report.remove(&format!("delay.{ending}"))),
    }
    for list in lists {
        report.print(format_args!("{}\n\n{}\n", verdict(list), lines(list).for_terminal()));
    }
    report.left_out(left_out);
    report.accuracy(*worst);
    failed.iter().for_each(|error| report.note(error));
    report.complete(errors.is_empty() && failed.is_empty());
    Ok(())
}
