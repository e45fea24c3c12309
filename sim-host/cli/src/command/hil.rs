//! `sprag hil`: the firmware in closed loop with the simulator's plant and sensors.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use serde::Serialize;
use sprag_report::output::{Digest, OutputError, ResultFolder, Results, Subject};
use sprag_report::plot::{PlotError, loop_figure};
use sprag_report::progress::Progress;
use sprag_sim::accuracy::Closeness;
use sprag_sim::closed_loop::answered::Looped;
use sprag_sim::closed_loop::plant::Extremes;
use sprag_sim::closed_loop::report::{LoopReport, write_history};
use sprag_sim::closed_loop::run::Tick;
use sprag_sim::closed_loop::{LoopFailure, LoopTask};
use sprag_sim::interrupt::Interrupt;
use sprag_sim::record::{RecordSummary, warning_lines};
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::simulation::ErrorReport;

use super::accuracy_arguments::AccuracyArguments;
use super::board_line::{LineArguments, connect};
use super::closed_loop::heading;
use super::format_arguments::PictureArguments;
use super::loop_scene::{LoopScene, LoopSceneError};
use super::loop_trace::loop_trace;
use super::out_arguments::{FolderArguments, claim_of_scene};
use super::record_arguments::SceneRecordArguments;
use super::{DRAWING, ended, warned};
use crate::board::driver::{DeviceDriver, DeviceTick, Farewell};
use crate::board::line::DeviceError;
use crate::board::report::{DeviceSummary, costs, write_device_ticks};
use crate::board::session::Session;

/// The same with the firmware, in an emulator or on a board.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag hil scenes/controller.toml --qemu\n  \
    sprag hil scenes/controller.toml --qemu --log info --set controller.law=sign-table\n  \
    sprag hil scenes/controller.toml --board-image\n  \
    sprag hil scenes/controller.toml --port /dev/ttyUSB0\n\n\
    --qemu builds the firmware and starts the emulator itself; --board-image builds the firmware as it goes to the board and runs it between \
    models of the board's parts, in some minutes. The device gets its settings from the scene. Writes what `sprag loop` \
    writes, the host's own loop as the thick line (the dashed one is the ideal pair), and device.csv with every tick of the device. However \
    it ends, the device is detached: a board goes on with its own sensors and the settings in its flash. Exit code 1 where a decision is \
    not the host's to the last bit.")]
pub struct HilArguments {
    /// Scene file with a clutched pair and a controller table.
    #[arg(value_name = "SCENE.toml")]
    pub scene: PathBuf,
    /// Change one value of the scene, such as controller.rate_hz=1000.
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
    /// Records.
    #[command(flatten)]
    pub records: SceneRecordArguments,
    /// Where results go.
    #[command(flatten)]
    pub folder: FolderArguments,
    /// How accurate the plant is; found by the host's own loop.
    #[command(flatten)]
    pub accuracy: AccuracyArguments,
    /// Pictures.
    #[command(flatten)]
    pub pictures: PictureArguments,
    /// End with exit code 0 even if the device decided otherwise than the host at some tick.
    #[arg(long)]
    pub allow_different: bool,
    /// Where the device is.
    #[command(flatten)]
    pub line: LineArguments,
}

#[derive(Debug, thiserror::Error)]
enum Failure {
    #[error("{0}")]
    Scene(#[from] LoopSceneError),
    #[error("{device}: {failure}")]
    Loop { device: String, failure: LoopFailure },
    #[error("{0}")]
    Device(#[from] DeviceError),
    #[error("the picture cannot be drawn: {0}")]
    Plot(#[from] PlotError),
    #[error("{0}")]
    Output(#[from] OutputError),
    #[error("interrupted")]
    Interrupted,
}

#[derive(Serialize)]
struct Summary<'a> {
    command: &'static str,
    version: &'static str,
    scene: &'a SceneFile,
    records: &'a [RecordSummary],
    warnings: &'a [String],
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    files: &'a BTreeMap<String, Digest>,
    runs: &'a [DeviceSummary],
}

/// Exit code where the device and the host decided differently.
const DIFFERENT: i32 = 1;

/// Runs the command; a table goes to `out`, errors go to `err`.
pub fn run(arguments: &HilArguments, out: &mut impl Write, err: &mut impl Write, interrupt: &Interrupt) -> i32 {
    let result = run_or_fail(arguments, out, err, interrupt);
    match result {
        Ok(0) => 0,
        Ok(_) if arguments.allow_different => 0,
        Ok(differing) => {
            let _ = writeln!(err, "sprag: at {differing} ticks the device decided otherwise than the host, or reported nothing");
            DIFFERENT
        }
        Err(failure) => ended(Err(failure), interrupt, err),
    }
}

/// Gives the ticks at which a device decided otherwise than the host.
fn run_or_fail(
    arguments: &HilArguments,
    out: &mut impl Write,
    err: &mut impl Write,
    interrupt: &Interrupt,
) -> Result<usize, Failure> {
    let any_accuracy = arguments.accuracy.time_budget.is_some();
    let mut folder = arguments.folder.folder(&arguments.scene, "hil").of_any_accuracy(any_accuracy);
    let tell = |line: &str| _ = writeln!(err, "sprag: {line}");
    let (desk, subject, hosts) = arguments.accuracy.run(|change| on_host(arguments, change, &mut folder, interrupt), tell)?;
    let warnings = warned(desk.scene.warnings().into_iter().chain(warning_lines(&desk.ground.records)), err);
    let mut results = Results::default();
    let (mut reports, mut summaries, mut ticks) = (Vec::new(), Vec::new(), Vec::new());
    for (number, (&index, host)) in desk.pairs.iter().zip(hosts).enumerate() {
        let run = one(arguments, &desk, index, host, interrupt)?;
        let mut trace = loop_trace(&run.report, &desk.scene.block);
        let alpha = desk.scene.block.slenderness();
        trace.rotation_host = run.host.iter().map(|tick| (tick.plant.time, tick.plant.motion.rotation / alpha)).collect();
        let picture = loop_figure(heading(&desk.scene, &run.report), &trace)?;
        let name = if number == 0 { "loop".to_owned() } else { format!("loop-{}", number + 1) };
        results.add_picture(&folder, &name, &picture, arguments.pictures.formats)?;
        ticks.push((run.report.summary.device.clone(), run.ticks));
        reports.push(run.report);
        if let Some(log) = run.log {
            let name = if number == 0 { "log.txt".to_owned() } else { format!("log-{}.txt", number + 1) };
            results.add(&folder.join(name), |file| log.iter().try_for_each(|line| writeln!(file, "{line}")))?;
        }
        summaries.push(run.summary);
    }
    let drawing = Progress::uncounted(DRAWING);
    let (file, records, files) = (desk.resolved(), &desk.ground.records, &subject.files);
    let (command, version, runs) = ("hil", env!("CARGO_PKG_VERSION"), &summaries);
    let summary = Summary { command, version, scene: &file, records, warnings: &warnings, files, runs };
    results.add_json(&folder.join("summary.json"), &summary)?;
    results.add(&folder.join("history.csv"), |file| write_history(&reports, file).map_err(std::io::Error::other))?;
    results.add(&folder.join("device.csv"), |file| write_device_ticks(&ticks, file))?;
    if interrupt.is_set() {
        return Err(Failure::Interrupted);
    }
    results.commit_telling(err)?;
    drawing.finish();
    for summary in &summaries {
        let _ = write!(out, "{summary}");
    }
    let _ = writeln!(out, "results in {}", folder.display());
    Ok(summaries.iter().map(|summary| summary.ticks_differing).sum())
}

/// One device of the scene.
struct Run {
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
) -> Result<(LoopScene, Subject, Vec<Host>), Failure> {
    let mut changes = arguments.set.clone();
    changes.extend(change);
    let desk = LoopScene::load(&arguments.scene, &changes, &arguments.records)?;
    let file = desk.resolved();
    let names = &["history", "loop", "device", "log"];
    let claim = claim_of_scene("hil", &arguments.scene, &desk.scene, &file, names, &[])?;
    folder.open(&claim)?;
    let _running = Progress::uncounted("running the host's own loop");
    let host = |&index: &usize| {
        let task = desk.task(index, desk.controller.sensors.seed(), interrupt);
        let failed = |failure| Failure::Loop { device: desk.scene.devices[index].name.clone(), failure };
        let (task, error, looped) = task.answered().map_err(failed)?;
        Ok(Host { closeness: task.closeness, error, looped })
    };
    let hosts = desk.pairs.iter().map(host).collect::<Result<_, Failure>>()?;
    Ok((desk, claim.subject, hosts))
}

fn one(arguments: &HilArguments, desk: &LoopScene, index: usize, host: Host, interrupt: &Interrupt) -> Result<Run, Failure> {
    let failed = |failure: LoopFailure| Failure::Loop { device: desk.scene.devices[index].name.clone(), failure };
    let Host { closeness, error, looped } = host;
    let task = LoopTask { closeness, ..desk.task(index, desk.controller.sensors.seed(), interrupt) };
    let ideal = task.ideal().map_err(failed)?;
    let host_report = LoopReport::new(&task, looped.ending, &looped.extremes.peaks, ideal.clone(), Vec::new());

    let settings = task.settings().map_err(|error| failed(error.into()))?;
    let own = task.driver(task.controller.clutch_law()).map_err(|error| failed(error.into()))?;
    let device = connect(&arguments.line)?;
    let session = Session::new(device.line);
    let mut driver = DeviceDriver::attach(session, &settings, own)?;
    let (mut seen, mut extremes) = (Vec::new(), Extremes::default());
    let running = Progress::uncounted("running the loop over the device");
    let begun = Instant::now();
    let ending = task.run_with(&mut driver, &mut (), &mut extremes, &mut seen);
    let seconds = begun.elapsed().as_secs_f64();
    running.finish();
    // A device that has gone explains whatever became of the loop.
    let Farewell { ticks, state, identity, .. } = driver.finish()?;
    let ending = ending.map_err(failed)?;
    let mut report = LoopReport::new(&task, ending, &extremes.peaks, ideal, seen);
    report.summary.error = error;
    let ticks_per_second = ticks.len() as f64 / seconds;
    let cost = costs(&ticks);
    let summary = DeviceSummary {
        closed: report.summary.clone(),
        host_outcome: host_report.summary.outcome,
        host_peak_rotation: host_report.summary.peak_rotation,
        device_ticks: ticks.len(),
        ticks_differing: ticks.iter().filter(|tick| tick.differs).count(),
        ticks_per_second,
        times_real_time: ticks_per_second / desk.controller.rate_hz,
        instructions_per_tick: cost.map(|cost| cost.0),
        instructions_per_tick_worst: cost.map(|cost| cost.1),
        stack_bytes: state.stack,
        firmware: super::board_line::firmware(&identity),
    };
    let log = device.log.map(|log| log.read()).transpose()?;
    Ok(Run { report, summary, ticks, host: looped.ticks, log })
}
