//! `sprag hil`: the firmware in closed loop with the simulator's plant and sensors.

use std::io::Write;

use clap::Args;
use sprag_report::output::{ResultFolder, Subject};
use sprag_report::plot::{LoopTrace, loop_figure};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Closeness;
use sprag_sim::closed_loop::answered::Looped;
use sprag_sim::closed_loop::report::{LoopReport, write_history};
use sprag_sim::closed_loop::run::Tick;
use sprag_sim::closed_loop::{LoopFailure, LoopScene, LoopTask};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::warning_lines;
use sprag_sim::simulation::ErrorReport;

use super::accuracy_arguments::AccuracyArguments;
use super::board_line::{LineArguments, connect};
use super::closed_loop::{failed, heading, numbered};
use super::context::{Completion, Context, Run};
use super::loop_scene;
use super::out_arguments::{OutputArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::report::{Report, Runs, SceneInput};
use super::scene_arguments::SceneArguments;
use crate::board::device_loop::{DeviceLoop, DeviceLoopError};
use crate::board::driver::{DeviceTick, Farewell};
use crate::board::info::firmware;
use crate::board::report::{DeviceSummary, costs, device_ticks};

/// The same with the firmware, in an emulator or on a board.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag hil scenes/controller.toml --qemu\n  \
    sprag hil scenes/controller.toml --qemu --log info --set controller.law=sign-table\n  \
    sprag hil scenes/controller.toml --board-image\n  \
    sprag hil scenes/controller.toml --port /dev/ttyUSB0\n\n\
    The scene is one for `sprag loop`. --qemu starts the emulator itself, with the firmware that is inside this program or that it builds; --board-image builds the firmware as it goes to the board, from the clone that this program was built from, and runs it between \
    models of the board's parts, in some minutes. The device gets its settings from the scene. Writes what `sprag loop` \
    writes, the host's own loop as the thick line (the dashed one is the ideal pair), and device.csv with every tick of the device. However \
    it ends, the device is detached: a board continues with its own sensors and the settings in its flash. Exit code 1 where a decision is \
    not the host's to the last bit.")]
pub struct HilArguments {
    #[command(flatten)]
    pub scene: SceneArguments,
    #[command(flatten)]
    pub records: SceneRecordArguments,
    #[command(flatten)]
    pub output: OutputArguments,
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    /// End with exit code 0 even if the device decided otherwise than the host at some tick.
    #[arg(long)]
    pub allow_different: bool,
    #[command(flatten)]
    pub line: LineArguments,
}

impl Run for HilArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut folder = self.output.folder_at(&self.scene.scene, "hil", &self.accuracy)?;
        let interrupt = context.interrupt;
        let (desk, subject, hosts) = self.accuracy.run(context, |change| on_host(self, change, &mut folder, interrupt))?;
        let mut warnings = context.warned(desk.scene.warnings().into_iter().chain(warning_lines(&desk.ground.records)));
        let runs: Vec<DeviceRun> = desk
            .pairs
            .iter()
            .zip(hosts)
            .map(|(&index, host)| one(self, &desk, index, host, interrupt))
            .collect::<anyhow::Result<_>>()?;
        let of_loop = |run: &DeviceRun| run.report.summary.warning(&desk.scene.origin, desk.controller.prelude_s);
        warnings.extend(context.warned(runs.iter().filter_map(of_loop)));
        let mut report = Report::new("hil", &folder, &self.output)?;
        let (mut reports, mut summaries, mut ticks) = (Vec::new(), Vec::new(), Vec::new());
        for (number, run) in runs.into_iter().enumerate() {
            let mut trace = LoopTrace::of(&run.report, &desk.scene.block);
            let alpha = desk.scene.block.slenderness();
            trace.rotation_host = run.host.iter().map(|tick| (tick.plant.time, tick.plant.motion.rotation / alpha)).collect();
            let axes = desk.scene.file.output.time_axis.into();
            report.picture(&numbered("loop", number), loop_figure(heading(&desk.scene, &run.report), &trace, axes))?;
            if let Some(log) = run.log {
                let name = numbered("log", number) + ".txt";
                report.file(&name, |file| log.iter().try_for_each(|line| writeln!(file, "{line}")))?;
            }
            ticks.push((run.report.summary.device.clone(), run.ticks));
            reports.push(run.report);
            summaries.push(run.summary);
        }
        let (file, records) = (desk.resolved(), &desk.ground.records);
        let input = SceneInput { scene: &file };
        report.summary(input, records, &warnings, &subject, Runs { runs: &summaries })?;
        report.file("history.csv", |file| write_history(&reports, file).map_err(std::io::Error::other))?;
        report.table("device", &device_ticks(&ticks))?;
        summaries.iter().for_each(|summary| report.print(summary));
        report.note_checks(summaries.iter().map(|run| (run.closed.device.as_str(), run.closed.checks.as_ref())));
        let differing: usize = summaries.iter().map(|summary| summary.ticks_differing).sum();
        if differing > 0 && !self.allow_different {
            report.note(format_args!("at {differing} ticks the device decided otherwise than the host, or reported nothing"));
            report.complete(false);
        }
        report.finish(&folder, context)
    }
}

/// One device of the scene.
struct DeviceRun {
    report: LoopReport,
    summary: DeviceSummary,
    ticks: Vec<DeviceTick>,
    host: Vec<Tick>,
    log: Option<Vec<String>>,
}

/// A loop as the host's own controller closes it.
struct Host {
    closeness: Option<Closeness>,
    error: Option<ErrorReport>,
    looped: Looped<Vec<Tick>>,
}

/// The scene with `change`, and the host's own loops.
fn on_host(
    arguments: &HilArguments,
    change: Option<String>,
    folder: &mut ResultFolder,
    interrupt: &Interrupt,
) -> anyhow::Result<(LoopScene, Subject, Vec<Host>)> {
    let desk = loop_scene::load(&arguments.scene.scene, &arguments.scene.changes(change), &arguments.records)?;
    // What the device's own decisions ask of it is what counts.
    let unchecked = desk.unchecked();
    let file = desk.resolved();
    let names = &["history", "loop", "device", "log"];
    let claim = claim_of_scene("hil", &arguments.scene.scene, &desk.scene, &file, names, &[])?;
    folder.open(&claim)?;
    let _running = Progress::uncounted("running the host's own loop");
    let host = |&index: &usize| {
        let task = unchecked.task(index, desk.controller.sensors.seed(), interrupt);
        let (task, error, looped) = task.answered().map_err(|failure| failed(&desk, index, failure))?;
        Ok(Host { closeness: task.closeness, error, looped })
    };
    let hosts = desk.pairs.iter().map(host).collect::<anyhow::Result<_>>()?;
    Ok((desk, claim.subject, hosts))
}

fn one(arguments: &HilArguments, desk: &LoopScene, index: usize, host: Host, interrupt: &Interrupt) -> anyhow::Result<DeviceRun> {
    let failed = |failure: LoopFailure| failed(desk, index, failure);
    let Host { closeness, error, looped } = host;
    let task = LoopTask { closeness, ..desk.task(index, desk.controller.sensors.seed(), interrupt) };
    let ideal = task.ideal().map_err(failed)?;

    let device = connect(&arguments.line)?;
    let running = Progress::uncounted("running the loop over the device");
    let closed = DeviceLoop::run(&task, device.line, ideal);
    running.finish();
    let DeviceLoop { mut report, farewell, took } = closed.map_err(|error| match error {
        DeviceLoopError::Loop(failure) => failed(failure),
        DeviceLoopError::Device(error) => error.into(),
    })?;
    let Farewell { ticks, state, identity, .. } = farewell;
    report.summary.error = error;
    let ticks_per_second = ticks.len() as f64 / took.as_secs_f64();
    let cost = costs(&ticks);
    let summary = DeviceSummary {
        closed: report.summary.clone(),
        host_outcome: looped.outcome(),
        host_peak_rotation: looped.peak_rotation(),
        device_ticks: ticks.len(),
        ticks_differing: ticks.iter().filter(|tick| tick.differs).count(),
        ticks_per_second,
        times_real_time: ticks_per_second / desk.controller.rate_hz,
        instructions_per_tick: cost.map(|cost| cost.0),
        instructions_per_tick_worst: cost.map(|cost| cost.1),
        stack_bytes: state.stack,
        firmware: firmware(&identity),
    };
    let log = device.log.map(|log| log.read()).transpose()?;
    Ok(DeviceRun { report, summary, ticks, host: looped.ticks, log })
}
