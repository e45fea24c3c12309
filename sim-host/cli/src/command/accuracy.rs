//! `sprag accuracy`: what accuracy costs in time, for one scene.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::output::{Digest, OutputError, Results};
use sprag_report::plot::PlotError;
use sprag_report::progress::Progress;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::ground::GroundError;
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::scene::{Scene, SceneError};
use sprag_studies::accuracy_study::figure::figures;
use sprag_studies::accuracy_study::report::{page, write_csv};
use sprag_studies::accuracy_study::row::RowText;
use sprag_studies::accuracy_study::study::{Extent, StudyError, study};

use super::format_arguments::PictureArguments;
use super::out_arguments::{FolderArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::{ended, warned};
use crate::board::step_cost::{BoardError, measure};

/// Methods, steps and precisions: errors, and what they cost.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag accuracy scenes/figure10.toml\n  \
    sprag accuracy scenes/near_fault.toml --smallest-step 1e-3 --qemu\n\n\
    Writes accuracy.csv, accuracy.md, summary.json and the pictures work_precision.svg, order.svg, sines.svg, wrong_outcomes.svg and, \
    with --qemu, board.svg; with --png as .png too. Times are of this machine; everything else is the same on any.")]
pub struct AccuracyCommandArguments {
    /// Scene file, of ideal devices over horizontal ground.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Change one value of the scene, such as block.size_m=2 or device.1.mass_ratio=0.5.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Records.
    #[command(flatten)]
    pub records: SceneRecordArguments,
    /// Cells along each side of the grid of one-cycle pulses that wrong outcomes are counted over, by steps from 1e-3/p on; 0 to 64.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u8).range(0..=64))]
    pub cells: u8,
    /// Smallest fixed step, in 1/p; 3e-5 to 0.1.
    #[arg(long, value_name = "STEP", default_value_t = 1e-4, value_parser = smallest_step)]
    pub smallest_step: f64,
    /// Also count instructions a step on the microcontroller, in QEMU.
    #[arg(long)]
    pub qemu: bool,
    /// The image for --qemu; it is built by default.
    #[arg(long, value_name = "ELF", requires = "qemu")]
    pub image: Option<PathBuf>,
    /// Pictures.
    #[command(flatten)]
    pub pictures: PictureArguments,
    /// Where results go.
    #[command(flatten)]
    pub folder: FolderArguments,
}

fn smallest_step(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(step) if (3e-5..=0.1).contains(&step) => Ok(step),
        _ => Err("must be a number from 3e-5 to 0.1".to_owned()),
    }
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Ground(#[from] GroundError),
    #[error("{scene}: accuracy is for ideal devices over horizontal ground, and {what} goes beyond them")]
    BeyondIdeal { scene: String, what: String },
    #[error("{0}")]
    Board(#[from] BoardError),
    #[error("{0}")]
    Study(#[from] StudyError),
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] PlotError),
    #[error("{0}")]
    Output(#[from] OutputError),
}

/// `summary.json`.
#[derive(Serialize)]
struct Summary<'a> {
    command: &'static str,
    version: &'static str,
    scene: &'a SceneFile,
    records: &'a [RecordSummary],
    warnings: &'a [String],
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    files: &'a BTreeMap<String, Digest>,
    cells: u32,
    smallest_step: f64,
    runs: Vec<RowText<'a>>,
}

/// Names of what is written beside the summary.
const NAMES: [&str; 6] = ["accuracy", "work_precision", "order", "sines", "wrong_outcomes", "board"];

/// Runs the command; a table goes to `out`, errors go to `err`.
pub fn run(arguments: &AccuracyCommandArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    ended(result.map(|()| true), interrupt, err)
}

fn run_or_fail(
    arguments: &AccuracyCommandArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<(), Failure> {
    let mut scene = Scene::load(&arguments.scene, &arguments.set)?;
    arguments.records.apply(&mut scene)?;
    let mut warnings = warned(scene.warnings(), err);
    if let Some(what) = scene.first_beyond_ideal() {
        return Err(Failure::BeyondIdeal { scene: scene.origin.clone(), what });
    }
    let ground = scene.ground_motions()?;
    let mut folder = arguments.folder.folder(&arguments.scene, "accuracy");
    let cells = u32::from(arguments.cells) * u32::from(arguments.cells);
    let mut claim = claim_of_scene("accuracy", &arguments.scene, &scene, &scene.file, &NAMES, &[])?;
    claim.subject = claim.subject.with("cells", &cells)?.with("smallest_step", &arguments.smallest_step)?;
    // Where the results go is tried before the work, not after it.
    folder.open(&claim)?;
    warnings.extend(warned(warning_lines(&ground.records), err));
    let board = if arguments.qemu { Some(measure(arguments.image.as_deref())?) } else { None };
    let progress = Progress::new("runs");
    let extent = Extent { cells: arguments.cells.into(), smallest_step: arguments.smallest_step };
    let rows = study(&scene, &ground, extent, board.as_ref(), &progress, interrupt);
    progress.finish();
    let rows = rows?;
    let devices: Vec<String> = scene.devices.iter().map(|device| device.name.clone()).collect();
    let title = if scene.file.title.is_empty() { "Scene" } else { &scene.file.title };
    let drawing = Progress::uncounted(super::DRAWING);
    let page = page(title, &rows, &devices);
    let summary = Summary {
        command: "accuracy",
        version: env!("CARGO_PKG_VERSION"),
        scene: &scene.file,
        records: &ground.records,
        warnings: &warnings,
        files: &claim.subject.files,
        cells,
        smallest_step: arguments.smallest_step,
        runs: rows.iter().map(|row| row.text(&devices[row.device])).collect(),
    };
    let mut results = Results::default();
    results.add_json(&folder.join("summary.json"), &summary)?;
    results.add(&folder.join("accuracy.csv"), |file| write_csv(&rows, &devices, file))?;
    results.add(&folder.join("accuracy.md"), |file| file.write_all(page.as_bytes()))?;
    for (name, figure) in figures(title, &rows, &devices)? {
        results.add_picture(&folder, name, &figure, arguments.pictures.formats)?;
    }
    results.commit_telling(err)?;
    drawing.finish();
    let _ = write!(out, "{page}");
    let _ = writeln!(out, "results in {}", folder.display());
    Ok(())
}
