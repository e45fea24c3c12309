//! `sprag map`: overturning maps and rocking spectra over two keys of a scene.

use std::path::Path;

use clap::Args;
use serde::Serialize;
use sprag_report::long_run::division::Divisible;
use sprag_report::long_run::origin::Origin;
use sprag_report::long_run::rows::{Plan, Rows};
use sprag_report::long_run::shard::Shard;
use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, number};
use sprag_sim::map::boundaries::{Boundaries, EVALUATIONS};
use sprag_sim::map::grid::Grid;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::ground::GroundTable;
use sprag_sim::scene::map::AxisTable;
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::scene::{Scene, SceneError, document, overrides, text_of};
use sprag_studies::map::boundary_figure;
use sprag_studies::map::boundary_table::boundary_table;
use sprag_studies::map::figures::figures;
use sprag_studies::map::study::study_to;
use sprag_studies::map::table::{Labels, columns};
use sprag_studies::map::tally::{Counts, DeviceMap, Tally};

use super::context::{Completion, Context, Run};
use super::divided::Divided;
use super::map_boundaries::{BoundarySummary, print_boundaries, trace};
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::report::{Report, Runs, SceneInput};
use super::resumable;
use super::scene_arguments::SceneArguments;
use super::thread_arguments::ThreadArguments;
use crate::command::long_run_arguments::LongRunArguments;

/// Map outcomes and peaks over two keys of a scene.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag map scenes/figure08.toml\n  \
    sprag map scenes/figure08.toml --set map.x.cells=512 --set map.y.cells=512\n  \
    sprag map scenes/figure08.toml --x ground.0.frequency_ratio=0.5:8:200:log --y block.restitution=0.5:1:200\n  \
    sprag map scenes/figure08.toml --refine\n  \
    sprag map scenes/figure08.toml --shard 1/2; sprag map scenes/figure08.toml --shard 2/2; sprag map scenes/figure08.toml --merge 2\n\n\
    Writes summary.json, the table map.csv and map.parquet, and the pictures map (outcomes), rotation and acceleration (peaks), each \
    as .svg and .png; without an axis y the picture cut. With --refine the table boundaries too, and for two axes the picture \
    boundaries. Rows go to the disk as they are made, map.run.json says what they come from, and Ctrl-C leaves them there for \
    --resume.")]
pub struct MapArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    /// Axis across, in the place of the scene's: any numeric key; with :log in equal factors.
    #[arg(long, value_name = "KEY=FROM:TO:CELLS")]
    pub x: Option<AxisTable>,
    /// Axis up the map, in the place of the scene's, as --x has it.
    #[arg(long, value_name = "KEY=FROM:TO:CELLS")]
    pub y: Option<AxisTable>,
    /// Leave out the axis up: a cut along x.
    #[arg(long, conflicts_with = "y")]
    pub cut: bool,
    /// Trace the boundaries between outcomes to a relative 1e-6 of the axes' values: boundaries.csv and boundaries.svg. Follows up to
    /// --evaluations blocks for each device, however few cells the map has; --resume traces them from the start.
    #[arg(long)]
    pub refine: bool,
    /// Most blocks that --refine follows for one device; what stays coarser is reported.
    #[arg(long, value_name = "N", requires = "refine", default_value_t = EVALUATIONS, value_parser = super::whole_number(0..=u32::MAX as usize))]
    pub evaluations: usize,
    #[command(flatten)]
    pub records: SceneRecordArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub long_run: LongRunArguments,
}

#[derive(Serialize)]
struct DeviceSummary<'a> {
    device: &'a str,
    cells: usize,
    #[serde(flatten)]
    counts: Counts,
    seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    refined: Option<BoundarySummary>,
}

impl<'a> DeviceSummary<'a> {
    fn of(map: &'a DeviceMap, boundaries: Option<(&Boundaries, &f64)>) -> DeviceSummary<'a> {
        let refined = boundaries.map(|(boundaries, seconds)| BoundarySummary::of(boundaries, *seconds));
        DeviceSummary { device: &map.device, cells: map.counts.cells(), counts: map.counts, seconds: map.seconds, refined }
    }
}

/// Names of what is written beside the summary.
const NAMES: [&str; 5] = ["map", "cut", "rotation", "acceleration", "boundaries"];

impl Run for MapArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder(&self.scene.scene, "map")?;
        let (grid, file) = grid(self)?;
        let records = records(&grid, &file)?;
        let warnings = context.warned(grid.scene.warnings().into_iter().chain(warning_lines(&records)));
        let (labels, mut tally) = (Labels::new(&grid)?, Tally::new(&grid));
        if self.refine && tally.maps.iter().any(|map| map.shown.len() != grid.columns() * grid.rows()) {
            anyhow::bail!("--refine divides squares where boundaries are, and takes maps of at most 1024 x 1024 cells");
        }
        let claim = claim_of_scene("map", &self.scene.scene, &grid.scene, &file, &NAMES, &[])?;
        folder.open(&claim)?;
        let subject = claim.subject;
        let origin = Origin::new(subject.clone(), grid.table_rows());
        let shard = self.long_run.shard();
        let columns = columns(&grid);
        let titles = columns.iter().map(|column| column.name.clone()).collect();
        let shards = self.long_run.shards(&folder);
        let plan = Plan { folder: &folder, shards, name: "map", columns: titles, together: 1, shard, origin };
        let mut rows = Rows::begin(&plan, self.long_run.start(), |row, record| {
            tally.add(row, labels.read(row, record)?);
            Ok(())
        })?;
        let pool = self.threads.pool()?;
        let interrupt = context.interrupt;
        let again = self.long_run.again();
        interrupt.keep(resumable("finished rows", &folder, again));
        let progress = Progress::new("cells");
        let whole = pool.install(|| study_to(&mut rows, &grid, &labels, &mut tally, &progress, interrupt));
        progress.finish();
        match whole {
            Ok(true) => {}
            Ok(false) => {
                interrupt.keep(rows.interrupted());
                return Err(rows.interrupted().into());
            }
            Err(error) if self.long_run.in_scratch => return Err(error.into()),
            Err(error) if rows.done() == 0 => {
                rows.discard()?;
                return Err(error.into());
            }
            Err(error) => anyhow::bail!("{error}; {}", rows.interrupted()),
        }
        if shard != Shard::WHOLE {
            context.print(format_args!("shard {shard}: {}\n", rows.finish()?.display()));
            return Ok(Completion::Complete);
        }
        interrupt.keep(if self.refine {
            format!("all rows are kept in {}; {again} traces the boundaries from the start", folder.display())
        } else {
            resumable("all rows", &folder, again)
        });
        let trace = || trace(&grid, &tally.maps, self.evaluations, interrupt);
        let (boundaries, seconds) = if self.refine { pool.install(trace)? } else { Default::default() };
        let mut report = Report::new("map", &folder, &self.output)?;
        let maps = tally.maps.iter().enumerate();
        let runs: Vec<_> =
            maps.map(|(device, map)| DeviceSummary::of(map, boundaries.get(device).zip(seconds.get(device)))).collect();
        let input = SceneInput { scene: &file };
        report.made_by(input)?;
        report.summary(input, &records, &warnings, &subject, Runs { runs: &runs })?;
        report.rows("map", rows, &columns)?;
        if report.draws() {
            for (name, picture) in figures(&grid, &tally) {
                report.picture(name, picture)?;
            }
        }
        report.print(outcome_table(&tally.maps));
        if self.refine {
            report.table("boundaries", &boundary_table(&grid, &boundaries))?;
            if let Some(picture) = boundary_figure::figure(&grid, &tally, &boundaries).transpose() {
                report.picture("boundaries", picture)?;
            }
            print_boundaries(&mut report, &boundaries, &seconds);
        }
        report.finish(&folder, context)
    }
}

impl Divided for MapArguments {
    fn divisible(&self, _context: &mut Context<'_>) -> anyhow::Result<Divisible> {
        let (grid, file) = grid(self)?;
        let claim = claim_of_scene("map", &self.scene.scene, &grid.scene, &file, &NAMES, &[])?;
        // In lanes, or block by block.
        let seconds_a_row = match (grid.map.laws.is_empty(), grid.pulsed(0, 0, 0)?) {
            (true, Some(_)) => 2e-6,
            (true, None) => 2e-3,
            (false, _) => 2e-2,
        };
        let origin = Origin::new(claim.subject, grid.table_rows());
        Ok(Divisible { origin, name: "map", columns: columns(&grid), seconds_a_row })
    }

    fn options(&mut self) -> (&mut OutputArguments, &mut ThreadArguments, &mut LongRunArguments) {
        (&mut self.output, &mut self.threads, &mut self.long_run)
    }
}

/// The records of the first cell, by the names that `file` has for them.
fn records(grid: &Grid, file: &SceneFile) -> anyhow::Result<Vec<RecordSummary>> {
    let mut first = grid.scene_of(0, 0)?;
    let as_written = |tables: &mut [GroundTable], written: &[GroundTable]| {
        for (table, written) in tables.iter_mut().zip(written) {
            (table.file, table.of_command_line) = (written.file.clone(), written.of_command_line);
        }
    };
    as_written(&mut first.file.ground, &file.ground);
    as_written(&mut first.file.vertical, &file.vertical);
    Ok(first.records()?)
}

/// The scene with its overrides, records and axes, and what it says with its records named as the user wrote them, so that
/// summaries do not depend on where they were made.
fn grid(arguments: &MapArguments) -> Result<(Grid, SceneFile), SceneError> {
    let origin = arguments.scene.scene.display().to_string();
    let text = text_of(&arguments.scene.scene)?;
    let mut table = document::table(&text, &origin)?;
    let mut changes = arguments.scene.set.clone();
    let axes = [("x", &arguments.x), ("y", &arguments.y)];
    for (name, axis) in axes {
        if let Some(axis) = axis {
            let refused = |error: toml::ser::Error| SceneError::Conflict {
                origin: origin.clone(),
                key: format!("--{name}"),
                reason: error.to_string(),
            };
            changes.push(format!("map.{name}={}", toml::Value::try_from(axis).map_err(refused)?));
        }
    }
    overrides::apply_all(&mut table, &changes, &origin)?;
    let with_records = arguments.records.is_given();
    let mut written = None;
    if with_records {
        let mut place = Scene::of_table(table.clone(), &origin)?;
        arguments.records.apply(&mut place)?;
        for (name, tables) in [("ground", &place.file.ground), ("vertical", &place.file.vertical)] {
            put(&mut table, name, tables);
        }
        written = Some((place.file.ground, place.file.vertical));
    }
    if let (true, Some(toml::Value::Table(map))) = (arguments.cut, table.get_mut("map")) {
        map.remove("y");
    }
    // A scene whose file has no line for its keys any more differs from one that was read as it is.
    let mut scene = if changes.is_empty() && !with_records && !arguments.cut {
        Scene::parse(&text, &origin)?
    } else {
        Scene::of_table(table.clone(), &origin)?
    };
    scene.folder = arguments.scene.scene.parent().map(Path::to_path_buf).unwrap_or_default();
    let mut file = scene.file.clone();
    if let Some((ground, vertical)) = written {
        (file.ground, file.vertical) = (ground, vertical);
    }
    Ok((Grid::new(scene, table)?, file))
}

/// Puts the motions `tables` into the scene `table` under `name`, with files that do not depend on the scene's folder.
fn put(table: &mut toml::Table, name: &str, tables: &[GroundTable]) {
    let Some(toml::Value::Array(places)) = table.get_mut(name) else { return };
    for (place, motion) in places.iter_mut().zip(tables) {
        let mut motion = motion.clone();
        if motion.of_command_line {
            motion.file = motion.file.map(|file| std::path::absolute(&file).unwrap_or(file));
        }
        if let Ok(motion) = toml::Value::try_from(motion) {
            *place = motion;
        }
    }
}

/// Outcomes of every device, for people.
fn outcome_table(maps: &[DeviceMap]) -> String {
    let headings = ["device", "cells", "no rocking", "safe", "over, no impact", "over, impact", "cells/s"];
    let mut table = TextTable::new(1, headings);
    for map in maps {
        let counts = &map.counts;
        let speed = (map.worked_out > 0).then(|| map.worked_out as f64 / map.seconds);
        table.row(vec![
            map.device.clone(),
            counts.cells().to_string(),
            counts.no_rocking.to_string(),
            counts.safe.to_string(),
            counts.overturned_without_impact.to_string(),
            counts.overturned_after_impact.to_string(),
            number(speed, 0),
        ]);
    }
    table.for_terminal()
}
