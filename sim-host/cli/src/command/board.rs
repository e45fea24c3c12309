//! `sprag board`: talk to a device.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Error, anyhow};
use clap::{Args, Subcommand};
use serde::Serialize;
use sprag_report::columns::write_csv;
use sprag_report::output::{Results, Versioned, claim_file, is_standard_output};
use sprag_shared::control::monitor::fault::{Fault, Recovery};
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::Request;
use sprag_shared::settings::{Item, Settings};
use sprag_sim::interrupt::Interrupt;

use super::board_line::{Connected, LineArguments, connect};
use super::board_record::{self, RecordArguments};
use super::board_watch::{self, WatchArguments};
use super::context::{Completion, Context, Interrupted, Run, write_json};
use super::loop_scene;
use super::out_arguments::OverwriteArguments;
use super::record_arguments::SceneRecordArguments;
use crate::board::event_table::{LogRow, log_rows, rows, table, what};
use crate::board::info::{DeviceInfo, phase_text};
use crate::board::line::Line;
use crate::board::session::Session;
use crate::board::{parameters, setting_text};

/// Talk to a board: settings, self-test, logs, recordings.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag board info --port /dev/ttyUSB0\n  \
    sprag board parameters --port /dev/ttyUSB0 --set law=passive --store\n  \
    sprag board log --port /dev/ttyUSB0 --csv events.csv\n  \
    sprag board record --port /dev/ttyUSB0 --out earthquake.csv\n  \
    sprag board watch --port /dev/ttyUSB0\n\n\
    With --qemu a new device is started for each command, so nothing is left of what the one before was given; and since it has no \
    settings of its own it is in Fault: not commissioned.")]
pub struct BoardArguments {
    #[command(subcommand)]
    command: DeviceCommand,
}

#[derive(Subcommand, Clone, Debug)]
enum DeviceCommand {
    /// Show who the device is and how it is.
    #[command(after_help = "Examples:\n  sprag board info --port /dev/ttyUSB0\n  sprag board info --qemu")]
    Info(InfoArguments),
    /// Show, change, save and restore its parameters.
    Parameters(ParameterArguments),
    /// Make it test its clutches and calibrate its sensors again, and wait for the outcome; it must be Armed.
    #[command(after_help = "Example:\n  sprag board self-test --port /dev/ttyUSB0")]
    SelfTest(InfoArguments),
    /// Show its event log.
    #[command(
        after_help = "Examples:\n  sprag board log --port /dev/ttyUSB0\n  sprag board log --port /dev/ttyUSB0 --csv events.csv"
    )]
    Log(LogArguments),
    /// List the earthquakes that its flight recorder has kept, save one as CSV, draw it, or erase all.
    Record(RecordArguments),
    /// Make it leave Fault, once what was wrong has been seen to; it must be at rest.
    #[command(after_help = "Example:\n  sprag board clear --port /dev/ttyUSB0")]
    Clear(OrderArguments),
    /// Protect its flash, from the next power-on on: the program against writing, and all of it against being read out by a probe.
    ///
    /// Its jumper JP1 must be closed. Only erasing the whole chip with a probe undoes it, and that takes program and settings with it.
    #[command(after_help = "Example:\n  sprag board protect --port /dev/ttyUSB0")]
    Protect(OrderArguments),
    /// Make it use its own sensors again, with the settings in its flash, after a loop that ended without letting go of it.
    #[command(after_help = "Example:\n  sprag board detach --port /dev/ttyUSB0")]
    Detach(OrderArguments),
    /// Plot rotation, velocity and commands as they come; CSV lines where the output is not a terminal. Ends with Ctrl-C.
    ///
    /// The emulated device has no settings of its own: with --qemu there is a device in Fault to be seen.
    #[command(
        after_help = "Examples:\n  sprag board watch --port /dev/ttyUSB0\n  sprag board watch --port /dev/ttyUSB0 --seconds 60 > motion.csv"
    )]
    Watch(WatchArguments),
}

#[derive(Args, Clone, Debug)]
struct InfoArguments {
    #[command(flatten)]
    line: LineArguments,
    #[command(flatten)]
    json: JsonArguments,
}

#[derive(Args, Clone, Debug)]
struct OrderArguments {
    #[command(flatten)]
    line: LineArguments,
}

#[derive(Args, Clone, Copy, Debug)]
pub(super) struct JsonArguments {
    /// Print results as JSON.
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag board parameters --port /dev/ttyUSB0\n  \
    sprag board parameters --port /dev/ttyUSB0 --get model.size --get law\n  \
    sprag board parameters --port /dev/ttyUSB0 --scene scenes/controller.toml --set law=sign-table --store\n  \
    sprag board parameters --port /dev/ttyUSB0 --out pier.toml\n  \
    sprag board parameters --port /dev/ttyUSB0 --file pier.toml --store\n\n\
    A block of another size, slenderness (rad), inertia ratio, mass ratio or restitution: frequency, uplift, coupling and the like follow.\n  \
    sprag board parameters --port /dev/ttyUSB0 --set model.size=2.5 --set model.slenderness=0.2\n  \
    sprag board parameters --port /dev/ttyUSB0 --set model.mass_ratio=0.8 --set model.inertia_ratio=1.4 --store\n\n\
    Changes are checked as a whole before any is sent: first those of --scene, then those of --file, then those of --set; values that \
    contradict each other are refused. Gains and limits that a scene's sensors decide stay: --scene designs them, too. The device takes \
    changes while nothing moves, and starts its controller anew. A scene says nothing of how the board is wired: board.* stays. What is set of board.* is in force from the next start on, and only with --store.")]
struct ParameterArguments {
    #[command(flatten)]
    line: LineArguments,
    /// Show the value of this one only, such as law or model.inertia_ratio.
    #[arg(long, value_name = "NAME")]
    get: Vec<String>,
    /// Change one, such as model.size=2.5, and those that follow from it.
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Take all from the controller of a scene.
    #[arg(long, value_name = "SCENE.toml")]
    scene: Option<PathBuf>,
    /// Take those in this file, as --out writes it.
    #[arg(long, value_name = "FILE.toml")]
    file: Option<PathBuf>,
    /// Also keep them in flash, for the next start.
    #[arg(long)]
    store: bool,
    /// Save all to this file.
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: OverwriteArguments,
    #[command(flatten)]
    json: JsonArguments,
}

#[derive(Args, Clone, Debug)]
struct LogArguments {
    #[command(flatten)]
    line: LineArguments,
    /// Write it to this file, as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    json: JsonArguments,
    #[command(flatten)]
    replace: OverwriteArguments,
}

pub(super) type Talk = Session<Box<dyn Line>>;

impl Run for BoardArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let interrupt = context.interrupt;
        interrupt.keep("what was changed in the device stays as it is");
        let out = &mut context.out;
        let ended = match &self.command {
            DeviceCommand::Info(info) => with_device(&info.line, out, |session, out| show(session, info.json.json, out)),
            DeviceCommand::Parameters(given) => change(given, context),
            DeviceCommand::SelfTest(info) => {
                with_device(&info.line, out, |session, out| self_test(session, info.json.json, out, interrupt))
            }
            DeviceCommand::Log(given) => log_to(given, out),
            DeviceCommand::Record(given) => board_record::run(given, out, interrupt),
            DeviceCommand::Clear(info) => with_device(&info.line, out, clear),
            DeviceCommand::Protect(info) => with_device(&info.line, out, protect),
            DeviceCommand::Detach(info) => with_device(&info.line, out, detach),
            DeviceCommand::Watch(given) => board_watch::run(given, out, interrupt),
        };
        match ended {
            // Reported where standard output is.
            Err(error) if error.is::<std::io::Error>() => Ok(Completion::Complete),
            // Watching ends so.
            Err(error) if error.is::<Interrupted>() && matches!(self.command, DeviceCommand::Watch(_)) => {
                Ok(Completion::Interrupted)
            }
            ended => ended.map(|()| Completion::Complete),
        }
    }
}

/// Finds the device and talks to it; then shows what it has logged beside.
pub(super) fn with_device<W: Write>(
    line: &LineArguments,
    out: &mut W,
    talk: impl FnOnce(&mut Talk, &mut W) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let Connected { line, log } = connect(line)?;
    let mut session = Session::new(line);
    let outcome = talk(&mut session, out);
    drop(session);
    if let Some(log) = log {
        for line in log.read()? {
            writeln!(out, "{line}")?;
        }
    }
    outcome
}

fn show(session: &mut Talk, json: bool, out: &mut impl Write) -> anyhow::Result<()> {
    let info = DeviceInfo::of(session)?;
    if json { print_json(&info, out) } else { Ok(write!(out, "{info}")?) }
}

pub(super) fn print_json(results: &impl Serialize, out: &mut impl Write) -> anyhow::Result<()> {
    Ok(write_json(&Versioned::new(results), out)?)
}

fn change(given: &ParameterArguments, context: &mut Context<'_>) -> anyhow::Result<()> {
    // Whatever can be wrong here is found before the device is looked for.
    for name in &given.get {
        setting_text::value(&Settings::default(), name).map_err(Error::msg)?;
    }
    let set: Vec<(&str, &str)> =
        given.set.iter().map(|text| setting_text::assignment(text)).collect::<Result<_, _>>().map_err(Error::msg)?;
    let scene = given.scene.as_ref().map(|path| of_scene(path, context)).transpose()?;
    let file = given.file.as_ref().map(|path| {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path).map_err(|error| anyhow!("{name}: {error}"))?;
        let assignments = setting_text::of_toml(&name, &text).map_err(Error::msg)?;
        anyhow::Ok((name, assignments))
    });
    let file = file.transpose()?;
    if let Some(path) = &given.out {
        let inputs: Vec<&Path> = given.scene.iter().chain(&given.file).map(PathBuf::as_path).collect();
        // What another device or another time had is not made again by the same command.
        claim_file(path, &inputs, given.replace.overwrite, |_| false)?;
    }
    with_device(&given.line, &mut context.out, |session, out| {
        let before = parameters::read(session)?;
        let mut wanted = scene.map_or(before, |scene| setting_text::with_board_of(&scene, &before));
        if let Some((name, assignments)) = &file {
            let each = assignments.iter().map(|(name, text)| (name.as_str(), text.as_str()));
            setting_text::assign(&mut wanted, each).map_err(|error| anyhow!("{name}: {error}"))?;
        }
        setting_text::assign(&mut wanted, set).map_err(Error::msg)?;
        let changes = given.store || wanted != before;
        if changes {
            setting_text::check(&wanted).map_err(Error::msg)?;
        }
        // A file that cannot be written is found out before the device is another.
        let mut results = Results::default();
        if let Some(path) = &given.out {
            results.add(path, |file| file.write_all(setting_text::to_toml(&wanted).as_bytes()))?;
        }
        if changes {
            parameters::write(session, &wanted, given.store)?;
        }
        results.commit()?;
        report(given, &before, &wanted, out)?;
        Ok(())
    })
}

/// What was asked for, or what has changed, or where neither is the case everything.
fn report(given: &ParameterArguments, before: &Settings, now: &Settings, out: &mut impl Write) -> anyhow::Result<()> {
    if given.json.json {
        return print_json(&setting_text::described(now, &given.get), out);
    }
    for name in &given.get {
        if let Ok(value) = setting_text::value(now, name) {
            writeln!(out, "{value}")?;
        }
    }
    let changed = given.store || given.scene.is_some() || given.file.is_some() || !given.set.is_empty();
    if changed {
        write!(out, "{}", setting_text::changed(before, now, given.store))?;
    }
    if let Some(path) = &given.out {
        // Not among the settings, if they are read from there.
        if !is_standard_output(path) {
            writeln!(out, "saved in {}", path.display())?;
        }
    }
    if !changed && given.get.is_empty() && given.out.is_none() {
        write!(out, "{}", setting_text::table(now))?;
    }
    Ok(())
}

fn of_scene(path: &Path, context: &mut Context<'_>) -> anyhow::Result<Settings> {
    let desk = loop_scene::load(path, &[], &SceneRecordArguments::default())?;
    context.warned(desk.scene.warnings());
    let Some(&index) = desk.pairs.first() else { return Err(anyhow!("{}: no clutched pair", path.display())) };
    let settings = desk.task(index, desk.controller.sensors.seed(), context.interrupt).settings();
    settings.map_err(|error| anyhow!("{}: {error}", path.display()))
}

/// For how long the outcome of a request is waited for between two questions.
pub(super) const PAUSE: Duration = Duration::from_millis(50);

fn self_test(session: &mut Talk, json: bool, out: &mut impl Write, interrupt: &Interrupt) -> anyhow::Result<()> {
    let settings = parameters::read(session)?;
    let before = session.state()?;
    session.self_test(before.phase)?;
    let time = |item: Item| settings.get(item.index()).map_or(0.0, f32::from_bits);
    // Each of its two parts may wait as long as this, and a device on a slow line more.
    let patience = time(Item::BootTime) + 2.0 * time(Item::CalibrationPatience) + 5.0;
    let begun = Instant::now();
    let state = loop {
        let state = session.state()?;
        if !matches!(state.phase, Phase::Boot | Phase::SelfTest | Phase::Calibrate) {
            break state;
        }
        if interrupt.is_set() {
            return Err(Interrupted.into());
        }
        if begun.elapsed().as_secs_f32() > patience {
            return Err(anyhow!("the self-test has not ended after {patience:.0} s: {:?}", state.phase));
        }
        std::thread::sleep(PAUSE);
    };
    let (entries, total) = session.log()?;
    let new = entries.len().min(total.saturating_sub(before.log_count) as usize);
    for entry in entries[entries.len() - new..].iter().filter(|_| !json) {
        writeln!(out, "{:9.3} s  {}", f64::from(entry.tick) * f64::from(settings.period()), what(entry.kind))?;
    }
    show(session, json, out)?;
    match state.fault {
        Some(fault) => Err(anyhow!("the self-test failed: {fault}")),
        None => Ok(()),
    }
}

fn log_to(given: &LogArguments, out: &mut impl Write) -> anyhow::Result<()> {
    if let Some(path) = &given.csv {
        // A log is of its time: the same command makes another.
        claim_file(path, &[], given.replace.overwrite, |_| false)?;
    }
    with_device(&given.line, out, |session, out| log(session, given, out))
}

fn log(session: &mut Talk, given: &LogArguments, out: &mut impl Write) -> anyhow::Result<()> {
    let period = parameters::read(session)?.period();
    let (entries, total) = session.log()?;
    if let Some(path) = &given.csv {
        let mut results = Results::default();
        results.add(path, |file| Ok(write_csv(&rows(&entries, period), file)?))?;
        results.commit()?;
        if !is_standard_output(path) {
            writeln!(out, "{} of {total} entries in {}", entries.len(), path.display())?;
        }
    } else if given.json.json {
        print_json(&LogDocument { total, entries: log_rows(&entries, period) }, out)?;
    } else {
        writeln!(out, "{}{} of {total} entries", table(&entries, period).for_terminal(), entries.len())?;
    }
    Ok(())
}

/// The newest entries of a device's event log, of all that it has ever had.
#[derive(Serialize)]
struct LogDocument {
    total: u32,
    entries: Vec<LogRow>,
}

fn detach<W: Write>(session: &mut Talk, out: &mut W) -> anyhow::Result<()> {
    let attached = session.state()?.attached.is_some();
    session.order(&Request::Detach)?;
    writeln!(out, "{}", if attached { "detached; it starts anew with its own sensors" } else { "it was not attached" })?;
    Ok(())
}

fn protect<W: Write>(session: &mut Talk, out: &mut W) -> anyhow::Result<()> {
    session.order(&Request::Protect)?;
    writeln!(out, "protected from the next power-on on; only erasing the whole chip with a probe undoes it")?;
    Ok(())
}

fn clear<W: Write>(session: &mut Talk, out: &mut W) -> anyhow::Result<()> {
    let before = session.state()?;
    if before.phase != Phase::Fault {
        writeln!(out, "it is not in Fault: {:?}", before.phase)?;
        return Ok(());
    }
    session.order(&Request::Clear)?;
    // The next tick takes it or does not.
    std::thread::sleep(PAUSE);
    let after = session.state()?;
    writeln!(out, "{} -> {}", phase_text(before.phase, before.fault), phase_text(after.phase, after.fault))?;
    after.fault.map_or(Ok(()), |fault| Err(anyhow!(stays(fault))))
}

/// That a device stays in Fault, and what ends it.
fn stays(fault: Fault) -> String {
    let end = match fault.recovery() {
        Recovery::ByStoring => ": sprag board parameters --scene SCENE.toml --store",
        Recovery::ByStart => "; only a new start that does not find it again ends it",
        Recovery::WhenGood | Recovery::OnRequest | Recovery::NotNeeded => "; it leaves only at rest, and while nothing is wrong",
    };
    format!("it stays in Fault: {fault}{end}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_only_a_start_ends_is_not_waited_for_at_rest() {
        for fault in Fault::ALL {
            let by_start = (65..=68).contains(&fault.code());
            assert_eq!(stays(fault).contains("a new start"), by_start, "{fault}");
            assert_eq!(stays(fault).contains("at rest, and while"), !by_start && ![63, 64].contains(&fault.code()), "{fault}");
        }
    }
}
