//! `sprag similar`: responses of blocks with equal dimensionless groups, overlaid.

use clap::Args;
use serde::Serialize;
use sprag_report::columns::{Column, RowWriter, Table, TableError, Value};
use sprag_report::heading::of_scenes;
use sprag_report::plot::{Chart, ChartPanel, FigureTitle, Line, PlotError, Scale, chart_figure};
use sprag_report::progress::Progress;
use sprag_sim::effect::number::number;
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::Scene;
use sprag_sim::scene::overrides::items;
use sprag_sim::simulation::{DeviceRun, simulate};
use sprag_studies::similarity::compare::{Departure, INSTANTS, Response};
use sprag_studies::similarity::groups::{Group, groups, unequal};

use super::context::{Completion, Context, Run};
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::report::{Report, SceneInput};
use super::scene_arguments::SceneArguments;

/// Compare blocks of equal dimensionless groups.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag similar scenes/figure06.toml --with block.size_m=5,block.slenderness_deg=5\n  \
    sprag similar scenes/figure07.toml --with block.size_m=5,block.slenderness_deg=20 --with block.size_m=2,block.slenderness_deg=15\n\n\
    Writes summary.json, similar.csv and similar.svg, with --png similar.png too. Groups that are not equal are named: amplitudes and frequencies \
    should be ratios (amplitude_ratio, frequency_ratio).")]
pub struct SimilarArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Another block: the scene with these values changed, separated by commas.
    #[arg(long, value_name = "KEY=VALUE,…", required = true)]
    pub with: Vec<String>,
    #[command(flatten)]
    pub records: SceneRecordArguments,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// A block with its responses.
struct Block {
    name: String,
    scene: Scene,
    groups: Vec<Group>,
    records: Vec<RecordSummary>,
    runs: Vec<DeviceRun>,
    responses: Vec<Response>,
}

/// What `summary.json` says of the blocks.
#[derive(Serialize)]
struct Answer<'a> {
    with: &'a [String],
    blocks: Vec<BlockSummary<'a>>,
}

#[derive(Serialize)]
struct BlockSummary<'a> {
    block: &'a str,
    groups: &'a [Group],
    unequal_groups: Vec<&'a str>,
    runs: Vec<RunSummary<'a>>,
}

#[derive(Serialize)]
struct RunSummary<'a> {
    #[serde(flatten)]
    run: &'a DeviceRun,
    /// From the first block; none of the first itself.
    departure: Option<Departure>,
}

impl Run for SimilarArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        if self.with.iter().any(|changes| items(changes).next().is_none()) {
            anyhow::bail!("--with: names nothing that differs; give KEY=VALUE, such as block.size_m=2");
        }
        let mut folder = self.output.folder(&self.scene.scene, "similar")?;
        let progress = Progress::new("blocks");
        progress.begin(1 + self.with.len() as u64);
        let mut blocks = vec![block(self, "", None, context.interrupt)?];
        progress.step();
        let first = &blocks[0].scene;
        let mut claim = claim_of_scene("similar", &self.scene.scene, first, &first.file, &["similar"], &[])?;
        claim.subject = claim.subject.with("with", &self.with)?;
        folder.open(&claim)?;
        for changes in &self.with {
            let other = block(self, changes, Some(&blocks[0]), context.interrupt)?;
            for name in unequal(&blocks[0].groups, &other.groups) {
                context.note(format_args!("--with {changes}: {name} is not that of the first block"));
            }
            blocks.push(other);
            progress.step();
        }
        progress.finish();
        let mut records: Vec<RecordSummary> = Vec::new();
        for record in blocks.iter().flat_map(|block| &block.records) {
            if !records.contains(record) {
                records.push(record.clone());
            }
        }
        let of_blocks = blocks.iter().flat_map(|block| block.scene.warnings());
        let warnings = context.warned(of_blocks.chain(warning_lines(&records)));
        let first = &blocks[0];
        let of = |block: &'_ Block, device: usize| {
            (!std::ptr::eq(block, first)).then(|| Departure::between(&first.responses[device], &block.responses[device]))
        };
        let summaries = blocks.iter().map(|block| BlockSummary {
            block: &block.name,
            groups: &block.groups,
            unequal_groups: unequal(&first.groups, &block.groups),
            runs: block.runs.iter().enumerate().map(|(device, run)| RunSummary { run, departure: of(block, device) }).collect(),
        });
        let answer = Answer { with: &self.with, blocks: summaries.collect() };
        let input = SceneInput { scene: &first.scene.file };
        let mut report = Report::new("similar", &folder, &self.output)?;
        report.made_by(input)?;
        report.summary(input, &records, &warnings, &claim.subject, answer)?;
        report.table("similar", &Overlay(&blocks))?;
        report.picture("similar", figure(&blocks))?;
        report.print("largest departure of θ/α from the first block");
        for block in &blocks[1..] {
            for (device, run) in block.runs.iter().enumerate() {
                let departure = Departure::between(&first.responses[device], &block.responses[device]);
                let overturned = [&first.runs[device], run].map(|run| run.outcome.overturned());
                report.print(format_args!("{}, {}: {}", block.name, run.device, in_words(&departure, overturned)));
            }
        }
        report.finish(&folder, context)
    }
}

/// How far a block departs from the first, and which of the two overturns.
fn in_words(departure: &Departure, overturned: [bool; 2]) -> String {
    let Departure { largest, at_frequency_parameter_time: at, relative } = departure;
    let share = match relative.map(|share| 100.0 * share) {
        None => String::new(),
        Some(0.0) => " (0 % of the peak)".to_owned(),
        Some(percent) if percent < 0.01 => " (less than 0.01 % of the peak)".to_owned(),
        Some(percent) => format!(" ({percent:.2} % of the peak)"),
    };
    let ends = match overturned {
        [false, false] => "",
        [true, true] => "; both overturn",
        [true, false] => "; the first block overturns, and this one does not",
        [false, true] => "; this block overturns, and the first one does not",
    };
    format!("{} at p t = {at:.2}{share}{ends}", number(*largest))
}

/// The scene with `changes`, simulated; `first` is the block that it is compared with.
fn block(arguments: &SimilarArguments, changes: &str, first: Option<&Block>, interrupt: &Interrupt) -> anyhow::Result<Block> {
    let mut overrides = arguments.scene.set.clone();
    overrides.extend(items(changes).map(str::to_owned));
    let mut scene = Scene::load(&arguments.scene.scene, &overrides)?;
    arguments.records.apply(&mut scene)?;
    scene.refuse_support_records("blocks are compared by dimensionless groups, and a record of the support is none")?;
    if first.is_some_and(|first| first.scene.devices.len() != scene.devices.len()) {
        anyhow::bail!("--with {changes}: the block has another number of devices than the first");
    }
    let ground = scene.ground_motions()?;
    let p = scene.block.frequency_parameter();
    let duration = p * (ground.horizontal.duration() + scene.free_time_s());
    let step = first.map_or(duration / (INSTANTS - 1) as f64, |first| first.responses[0].step);
    scene.file.output.interval_s = Some(step / p);
    let runs = simulate(&scene, &ground, interrupt)?;
    let responses = runs.iter().map(|run| Response::of(&run.history, step)).collect();
    let name = if changes.is_empty() { "first block".to_owned() } else { items(changes).collect::<Vec<_>>().join(", ") };
    Ok(Block { name, groups: groups(&scene)?, scene, records: ground.records, runs, responses })
}

fn figure(blocks: &[Block]) -> Result<String, PlotError> {
    let first = &blocks[0];
    let points = |response: &Response| -> Vec<(f64, f64)> {
        response.rotations.iter().enumerate().map(|(index, rotation)| (index as f64 * response.step, *rotation)).collect()
    };
    let panel = |device: usize| ChartPanel {
        title: first.runs[device].device.clone(),
        y_title: "*θ*/α".to_owned(),
        y: Scale::Linear,
        lines: blocks
            .iter()
            .map(|block| Line { name: block.name.clone(), points: points(&block.responses[device]), ..Line::default() })
            .collect(),
    };
    chart_figure(&Chart {
        title: FigureTitle {
            text: first.scene.file.title.clone(),
            conditions: of_scenes(&blocks.iter().map(|block| &block.scene).collect::<Vec<_>>()),
        },
        x_title: "*p t*".to_owned(),
        x: Scale::Linear,
        panels: (0..first.runs.len()).map(panel).collect(),
        columns: 1,
        ..Chart::default()
    })
}

/// `device`, `frequency_parameter_time` and θ/α of every block; empty where a block has overturned.
struct Overlay<'a>(&'a [Block]);

impl Table for Overlay<'_> {
    fn columns(&self) -> Vec<Column> {
        let blocks = self.0.iter().map(|block| Column::number(&block.name).or_nothing());
        [Column::text("device"), Column::number("frequency_parameter_time")].into_iter().chain(blocks).collect()
    }

    fn rows(&self, writer: &mut dyn RowWriter) -> Result<(), TableError> {
        let first = &self.0[0];
        for (device, (run, response)) in first.runs.iter().zip(&first.responses).enumerate() {
            for instant in 0..INSTANTS {
                let rotation = |block: &Block| block.responses[device].rotations.get(instant).copied().into();
                let place = [(&run.device).into(), (instant as f64 * response.step).into()];
                writer.row(&place.into_iter().chain(self.0.iter().map(rotation)).collect::<Vec<Value<'_>>>())?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn departures_are_plain_numbers_and_name_the_block_that_overturns() {
        let of = |largest, relative| Departure { largest, at_frequency_parameter_time: 3.0, relative };
        for (departure, overturned, words) in [
            (
                of(4.005, Some(2.5)),
                [false, true],
                "4.005 at p t = 3.00 (250.00 % of the peak); this block overturns, and the first one does not",
            ),
            (of(0.0, Some(0.0)), [false; 2], "0 at p t = 3.00 (0 % of the peak)"),
            (of(0.012, Some(1e-6)), [true; 2], "0.012 at p t = 3.00 (less than 0.01 % of the peak); both overturn"),
            (of(0.5, None), [true, false], "0.5 at p t = 3.00; the first block overturns, and this one does not"),
        ] {
            assert_eq!(in_words(&departure, overturned), words);
        }
    }
}
