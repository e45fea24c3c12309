//! `sprag simulate`: one scene, every device, a summary, a history and a picture.

use std::num::NonZeroUsize;

use clap::Args;
use serde::Serialize;
use sprag_report::columns::Column;
use sprag_report::heading::title;
use sprag_report::output::{ResultFolder, Subject};
use sprag_report::plot::{energy_figure, history_figure};
use sprag_report::progress::Progress;
use sprag_report::text_table::{TextTable, change, number};
use sprag_sim::history::{History, write_csv};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::warning_lines;
use sprag_sim::scene::Scene;
use sprag_sim::scene::motions::GroundMotions;
use sprag_sim::side_by_side::OnlyRecords;
use sprag_sim::simulation::energy::write_energy;
use sprag_sim::simulation::{DeviceRun, simulate};

use super::accuracy_arguments::AccuracyArguments;
use super::context::{Completion, Context, Run};
use super::impact_specimens;
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::report::{Report, SceneInput};
use super::scene_arguments::SceneArguments;
use super::specimens::{SPECIMENS, Scattered, columns, monte_carlo};
use super::thread_arguments::ThreadArguments;

/// Simulate a scene: every device under the same ground motion.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag simulate scenes/near_fault.toml\n  \
    sprag simulate scenes/record.toml --record RSN181_IMPVALL.H_H-E06230.AT2 --out out/imperial\n  \
    sprag simulate scenes/figure10.toml --set accuracy.method=runge-kutta-4 --set accuracy.step_ratio=1e-3\n  \
    sprag simulate scenes/near_fault.toml --set block.restitution_scatter=0.02 --monte-carlo 200\n\n\
    Writes summary.json, history.csv and history.svg; with output.energy also energy.csv and energy.svg; with --monte-carlo also monte_carlo.csv; with --png the pictures \
    as .png too.")]
pub struct SimulateArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub records: SceneRecordArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    /// Run so many specimens of a block whose impacts differ (block.restitution_scatter), with one seed after the other.
    #[arg(long, value_name = "N", value_parser = super::whole_number(SPECIMENS))]
    pub monte_carlo: Option<NonZeroUsize>,
    #[command(flatten)]
    pub threads: ThreadArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    /// Show the picture.
    #[arg(long)]
    pub open: bool,
}

impl Run for SimulateArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder_at(&self.scene.scene, "simulate", &self.accuracy)?;
        let formats = self.output.formats("simulate")?;
        anyhow::ensure!(
            !self.open || formats.svg || formats.png,
            "--open: there is no picture to show without svg or png in --formats"
        );
        let asked = self.scene.load(None)?;
        if self.monte_carlo.is_some() {
            impact_specimens::check(&asked)?;
        }
        let mut warnings = context.warned(asked.warnings());
        let interrupt = context.interrupt;
        let Simulated { scene, ground, subject, mut runs } =
            self.accuracy.run(context, |change| simulated(self, change, &mut folder, interrupt))?;
        warnings.extend(context.warned(warning_lines(&ground.records)));
        let pool = self.threads.pool()?;
        let mut report = Report::new("simulate", &folder, &self.output)?;
        let mut scattered = None;
        if let Some(count) = self.monte_carlo {
            report.rows_from("monte_carlo", &columns([Column::count("impacts")]), |row| {
                let devices: Vec<_> = scene.devices.iter().map(|device| device.name.as_str()).enumerate().collect();
                let records = OnlyRecords::of(&scene)?;
                let some = |index, numbers| impact_specimens::run((&scene, &ground), records.as_ref(), index, numbers, interrupt);
                scattered = Some(monte_carlo(&pool, &devices, (count, impact_specimens::TOGETHER), some, row)?);
                Ok(())
            })?;
        }
        let scattered = scattered.as_deref();
        let histories: Vec<History> = runs.iter_mut().map(|run| std::mem::take(&mut run.history)).collect();
        let input = SceneInput { scene: &scene.file };
        report.summary(input, &ground.records, &warnings, &subject, Answer { monte_carlo: scattered, runs: &runs })?;
        report.file("history.csv", |file| write_csv(&histories, file).map_err(std::io::Error::other))?;
        let axes = scene.file.output.time_axis.into();
        let picture = report.picture("history", history_figure(title(&scene), &histories, axes))?;
        if scene.file.output.energy {
            report.file("energy.csv", |file| write_energy(&runs, file).map_err(std::io::Error::other))?;
            report.picture("energy", energy_figure(title(&scene), &runs, axes, scene.block.frequency_parameter()))?;
        }
        report.print(device_table(&runs).for_terminal());
        scattered.iter().flat_map(|all| all.iter()).for_each(|device| report.print(device.line()));
        for run in &runs {
            if let Some(error) = &run.error {
                report.print(format_args!("device `{}`: {}", run.device, error.words(run.peak_rotation)));
            }
        }
        for (run, sliding) in runs.iter().filter_map(|run| Some((run, run.sliding?))) {
            report.print(format_args!("device `{}`: {}", run.device, sliding.words()));
        }
        if scene.file.checks.as_ref().is_none_or(|checks| checks.friction_coefficient.is_none()) {
            friction_lines(&runs).iter().for_each(|line| report.print(line));
        }
        report.note_checks(runs.iter().map(|run| (run.device.as_str(), run.checks.as_ref())));
        let ending = report.finish(&folder, context)?;
        if self.open
            && let Some(picture) = picture
            && open::that_detached(&picture).is_err()
        {
            context.note(format_args!("{}: written, but there is no program that could show it", picture.display()));
        }
        Ok(ending)
    }
}

/// What `summary.json` says of the runs.
#[derive(Serialize)]
struct Answer<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    monte_carlo: Option<&'a [Scattered]>,
    runs: &'a [DeviceRun],
}

/// A scene that was run.
struct Simulated {
    scene: Scene,
    ground: GroundMotions,
    subject: Subject,
    runs: Vec<DeviceRun>,
}

/// The scene with `change`, and its runs.
fn simulated(
    arguments: &SimulateArguments,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<Simulated> {
    let mut scene = arguments.scene.load(change)?;
    let _simulating = Progress::uncounted("simulating");
    arguments.records.apply(&mut scene)?;
    let ground = scene.ground_motions()?;
    // Where the results go is tried before the work, not after it.
    let names = &["history", "energy", "monte_carlo"];
    let mut claim = claim_of_scene("simulate", &arguments.scene.scene, &scene, &scene.file, names, &[])?;
    if arguments.monte_carlo.is_some() {
        claim.subject = claim.subject.with("monte_carlo", &arguments.monte_carlo)?;
    }
    folder.open(&claim)?;
    let runs = simulate(&scene, &ground, interrupt)?;
    Ok(Simulated { scene, ground, subject: claim.subject, runs })
}

/// The friction that impacts and jolts need under the toe, device by device, where nobody has said how much there is.
fn friction_lines(runs: &[DeviceRun]) -> Vec<String> {
    let line = |what: &str, value: &dyn Fn(&DeviceRun) -> Option<String>| {
        let of: Vec<String> = runs.iter().filter_map(|run| value(run).map(|value| format!("{value} ({})", run.device))).collect();
        (!of.is_empty()).then(|| format!("friction needed at {what}: {}", of.join(", ")))
    };
    let impact = |run: &DeviceRun| run.impulses.impact_friction_needed.map(|needed| format!("{needed:.3}"));
    let jolt = |run: &DeviceRun| match (run.impulses.jolt_pull_m_s, run.impulses.jolt_friction_needed) {
        (Some(_), _) => Some("none is enough, the toe lifts".to_owned()),
        (None, needed) => needed.map(|needed| format!("{needed:.3}")),
    };
    [line("impacts", &impact), line("jolts", &jolt)].into_iter().flatten().collect()
}

/// A row a device; the last column compares its peak rotation with that of the first, where neither overturns and the first rocks.
fn device_table(runs: &[DeviceRun]) -> TextTable {
    let first = runs.first().map_or("first", |run| &run.device);
    let versus = format!("peak θ vs {first}");
    let headings = ["device", "outcome", "peak θ/α", "peak |θ''|/(p²α)", "impacts", "first impact (s)", "peak F/(mg)", &versus];
    let reference = runs.first().and_then(|run| run.peak_rotation).filter(|peak| *peak > 0.0);
    let mut table = TextTable::new(2, headings);
    for (index, run) in runs.iter().enumerate() {
        let peaks = run.peak_rotation.zip(reference).filter(|_| index > 0);
        table.row(vec![
            run.device.clone(),
            run.outcome.to_string(),
            number(run.peak_rotation, 3),
            number(run.peak_acceleration, 3),
            run.impacts.to_string(),
            number(run.first_impact_time_s, 3),
            number(run.peak_force_ratio.filter(|force| *force > 0.0), 3),
            change(peaks.map(|(peak, reference)| peak / reference - 1.0)),
        ]);
    }
    table
}
