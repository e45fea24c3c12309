//! `sprag accuracy`: what accuracy costs in time, for one scene.

use std::path::PathBuf;

use clap::Args;
use serde::Serialize;
use sprag_report::progress::Progress;
use sprag_sim::record::warning_lines;
use sprag_studies::accuracy_study::figure::figures;
use sprag_studies::accuracy_study::report::{page, row_table};
use sprag_studies::accuracy_study::row::RowText;
use sprag_studies::accuracy_study::study::{CELLS, Extent, SMALLEST_STEPS, check, study};

use super::context::{Completion, Context, Run};
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::report::{Report, SceneInput};
use super::scene_arguments::SceneArguments;
use crate::board::step_cost::measure;

/// Methods, steps and precisions: errors, and what they cost.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag accuracy scenes/figure10.toml\n  \
    sprag accuracy scenes/near_fault.toml --smallest-step 1e-3 --qemu\n\n\
    The scene must have ideal devices over horizontal ground. Writes accuracy.csv, accuracy.md, summary.json and the pictures work_precision.svg, order.svg, sines.svg, wrong_outcomes.svg and, \
    with --qemu, board.svg; with --png as .png too. Times are of this machine; everything else is the same on any.")]
pub struct AccuracyCommandArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub records: SceneRecordArguments,
    /// Cells along each side of the grid of one-cycle pulses that wrong outcomes are counted over, by steps from 1e-3/p on; 0 to 64.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = super::whole_number(CELLS))]
    pub cells: u8,
    /// Smallest fixed step, in 1/p; 3e-5 to 0.1.
    #[arg(long, value_name = "STEP", default_value_t = 1e-4, value_parser = super::number(SMALLEST_STEPS))]
    pub smallest_step: f64,
    /// Also count instructions a step on the microcontroller, in QEMU.
    #[arg(long)]
    pub qemu: bool,
    /// The image for --qemu; it is built by default.
    #[arg(long, value_name = "ELF", requires = "qemu")]
    pub image: Option<PathBuf>,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// What `summary.json` says of the extent and the runs.
#[derive(Serialize)]
struct Answer<'a> {
    cells: u32,
    smallest_step: f64,
    runs: &'a [RowText<'a>],
}

/// Names of what is written beside the summary.
const NAMES: [&str; 6] = ["accuracy", "work_precision", "order", "sines", "wrong_outcomes", "board"];

impl Run for AccuracyCommandArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder(&self.scene.scene, "accuracy")?;
        let mut scene = self.scene.load(None)?;
        self.records.apply(&mut scene)?;
        let mut warnings = context.warned(scene.warnings());
        check(&scene)?;
        let ground = scene.ground_motions()?;
        let cells = u32::from(self.cells) * u32::from(self.cells);
        let mut claim = claim_of_scene("accuracy", &self.scene.scene, &scene, &scene.file, &NAMES, &[])?;
        claim.subject = claim.subject.with("cells", &cells)?.with("smallest_step", &self.smallest_step)?;
        // Where the results go is tried before the work, not after it.
        folder.open(&claim)?;
        warnings.extend(context.warned(warning_lines(&ground.records)));
        let board = if self.qemu { Some(measure(self.image.as_deref())?) } else { None };
        // In stages, whose runs are of no one length.
        let progress = Progress::of_unknown_length("runs");
        let extent = Extent { cells: self.cells.into(), smallest_step: self.smallest_step };
        let rows = study(&scene, &ground, extent, board.as_ref(), &progress, context.interrupt);
        progress.finish();
        let rows = rows?;
        let devices: Vec<String> = scene.devices.iter().map(|device| device.name.clone()).collect();
        let title = if scene.file.title.is_empty() { "Scene" } else { &scene.file.title };
        let runs: Vec<RowText<'_>> = rows.iter().map(|row| row.text(&devices[row.device])).collect();
        let answer = Answer { cells, smallest_step: self.smallest_step, runs: &runs };
        let input = SceneInput { scene: &scene.file };
        let mut report = Report::new("accuracy", &folder, &self.output)?;
        report.made_by(input)?;
        report.summary(input, &ground.records, &warnings, &claim.subject, answer)?;
        report.table("accuracy", &row_table(&runs))?;
        let page = page(title, &rows, &devices);
        report.page("accuracy.md", &page.markdown())?;
        for (name, figure) in figures(title, &rows, &devices)? {
            report.picture(name, Ok(figure))?;
        }
        report.print(page.for_terminal());
        report.finish(&folder, context)
    }
}
