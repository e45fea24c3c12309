//! `sprag board record`: the earthquakes that a device has recorded.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::anyhow;
use clap::Args;
use serde::Serialize;
use sprag_report::columns::write_csv;
use sprag_report::output::{Results, claim_file, is_standard_output};
use sprag_report::plot::{FigureTitle, RecordingTrace, recording_figure};
use sprag_report::text_table::TextTable;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::{RecorderActivity, RecorderState, Request};
use sprag_sim::interrupt::Interrupt;

use super::board::{JsonArguments, Talk, print_json, with_device};
use super::board_line::LineArguments;
use super::context::Interrupted;
use super::out_arguments::OverwriteArguments;
use crate::board::line::DeviceError;
use crate::board::parameters;
use crate::board::recordings::{self, Part, PartNumbers, Parts, Recording};

#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag board record --port /dev/ttyUSB0\n  \
    sprag board record --port /dev/ttyUSB0 --out earthquake.csv --svg earthquake.svg\n  \
    sprag board record --port /dev/ttyUSB0 --earthquake 3 --part 1 --svg part1.svg\n  \
    sprag board record --port /dev/ttyUSB0 --erase\n\n\
    A reset in mid-motion begins another part, whose ticks count from the start of the device again. What is recorded while a host says \
    what the sensors read (sprag hil) is marked so.")]
pub struct RecordArguments {
    #[command(flatten)]
    line: LineArguments,
    /// The earthquake of this number; without, the newest is saved or drawn, and all are listed.
    #[arg(long, value_name = "N")]
    earthquake: Option<u16>,
    /// This part of it only.
    #[arg(long, value_name = "N")]
    part: Option<u8>,
    /// Write every tick of it to this file, as CSV.
    #[arg(long, value_name = "FILE.csv")]
    out: Option<PathBuf>,
    /// Draw it to this file.
    #[arg(long, value_name = "FILE.svg")]
    svg: Option<PathBuf>,
    /// Erase all recordings; nothing may move. On some boards this takes seconds, in which nothing is protected.
    #[arg(long, conflicts_with_all = ["earthquake", "part", "out", "svg"])]
    erase: bool,
    #[command(flatten)]
    replace: OverwriteArguments,
    #[command(flatten)]
    json: JsonArguments,
}

/// The parts of recordings that a device has, and its room.
#[derive(Serialize)]
struct RecordingsDocument {
    recordings: Vec<RecordingRow>,
    /// In words.
    room: String,
}

/// A part of a recording.
#[derive(Serialize)]
struct RecordingRow {
    earthquake: u16,
    part: u8,
    ticks: u32,
    time_s: f64,
    pages: usize,
    unfinished_pages: usize,
    /// A host said what the sensors read.
    attached: bool,
    ended: bool,
}

impl RecordingsDocument {
    fn new(state: &RecorderState, parts: &[(PartNumbers, &Part)], period: f64) -> RecordingsDocument {
        let row = |&((earthquake, part), of): &(PartNumbers, &Part)| {
            let (_, header) = of.pages.first()?;
            Some(RecordingRow {
                earthquake,
                part,
                ticks: of.ticks,
                time_s: f64::from(of.ticks) * f64::from(header.period),
                pages: of.pages.len(),
                unfinished_pages: of.unfinished,
                attached: header.attached,
                ended: of.ends,
            })
        };
        RecordingsDocument { recordings: parts.iter().filter_map(row).collect(), room: recordings::room(state, period) }
    }

    fn show(&self, out: &mut impl Write) -> anyhow::Result<()> {
        let mut table = TextTable::new(0, ["earthquake", "part", "ticks", "time s", "pages", "what"]).ending_in_words();
        for row in &self.recordings {
            let mut notes = Vec::new();
            if row.attached {
                notes.push("of what a host said".to_owned());
            }
            if row.unfinished_pages > 0 {
                notes.push(format!("{} of its pages not finished", row.unfinished_pages));
            }
            if !row.ended {
                notes.push("no end: a reset, no more room, or it continues".to_owned());
            }
            let numbers = [row.earthquake.to_string(), row.part.to_string(), row.ticks.to_string(), format!("{:.3}", row.time_s)];
            table.row(numbers.into_iter().chain([row.pages.to_string(), notes.join(", ")]).collect());
        }
        if !self.recordings.is_empty() {
            write!(out, "{}", table.for_terminal())?;
        }
        Ok(writeln!(out, "{}", self.room)?)
    }
}

/// Lists, saves, draws or erases.
pub fn run(given: &RecordArguments, out: &mut impl Write, interrupt: &Interrupt) -> anyhow::Result<()> {
    let files: Vec<&Path> = given.out.iter().chain(&given.svg).map(PathBuf::as_path).collect();
    for (place, path) in files.iter().enumerate() {
        // What a device had at another time is not made again by the same command.
        claim_file(path, &files[..place], given.replace.overwrite, |_| false)?;
    }
    with_device(&given.line, out, |session, out| {
        if given.erase {
            return erase(session, out, interrupt);
        }
        let parts = recordings::list(session)?;
        if files.is_empty() {
            let listed = listed(given, &parts)?;
            let period = f64::from(parameters::read(session)?.period());
            let document = RecordingsDocument::new(&recordings::state(session)?, &listed, period);
            return if given.json.json { print_json(&document, out) } else { document.show(out) };
        }
        let recordings = chosen(given, &parts)?
            .into_iter()
            .map(|(key, part)| {
                recordings::read(session, key, &part.pages, |_| {})
                    .map_err(anyhow::Error::from)
                    .and_then(|recording| if interrupt.is_set() { Err(Interrupted.into()) } else { Ok(recording) })
            })
            .collect::<anyhow::Result<Vec<Recording>>>()?;
        save(given, &recordings, out)
    })
}

/// Parts that are listed: those that are asked for, or all.
fn listed<'a>(given: &RecordArguments, parts: &'a Parts) -> anyhow::Result<Vec<(PartNumbers, &'a Part)>> {
    match (given.earthquake, given.part) {
        (None, None) => Ok(parts.iter().map(|(key, part)| (*key, part)).collect()),
        _ => chosen(given, parts),
    }
}

/// Parts that are saved or drawn.
fn chosen<'a>(given: &RecordArguments, parts: &'a Parts) -> anyhow::Result<Vec<(PartNumbers, &'a Part)>> {
    let Some(newest) = parts.iter().max_by_key(|(_, part)| part.pages.last().map(|(_, header)| header.sequence)) else {
        return Err(anyhow!("it has recorded no earthquake"));
    };
    let number = given.earthquake.unwrap_or(newest.0.0);
    let of_number: Vec<_> = parts.iter().filter(|((of, _), _)| *of == number).map(|(key, part)| (*key, part)).collect();
    if of_number.is_empty() {
        let mut numbers: Vec<String> = parts.keys().map(|(number, _)| number.to_string()).collect();
        numbers.dedup();
        return Err(anyhow!("it has no recording of an earthquake {number}; it has {}", numbers.join(", ")));
    }
    let count = of_number.len();
    let chosen: Vec<_> = of_number.into_iter().filter(|((_, part), _)| given.part.is_none_or(|wanted| wanted == *part)).collect();
    match (chosen.len(), given.part) {
        (0, Some(part)) => Err(anyhow!("the recording of earthquake {number} has no part {part}")),
        (2.., _) if given.svg.is_some() => {
            Err(anyhow!("the recording of earthquake {number} has {count} parts: --part says which one to draw"))
        }
        _ => Ok(chosen),
    }
}

fn save(given: &RecordArguments, recordings: &[Recording], out: &mut impl Write) -> anyhow::Result<()> {
    let mut results = Results::default();
    if let Some(path) = &given.out {
        results.add(path, |file| Ok(write_csv(&recordings::table(recordings), file)?))?;
    }
    if let (Some(path), [recording]) = (&given.svg, recordings) {
        let name = format!("earthquake {}, part {}", recording.number, recording.part);
        let figure = recording_figure(FigureTitle::from(name.as_str()), &trace(recording))
            .map_err(|error| anyhow!("{name} cannot be drawn: {error}"))?;
        results.add(path, |file| file.write_all(figure.as_bytes()))?;
    }
    results.commit()?;
    if given.out.iter().chain(&given.svg).any(|path| is_standard_output(path)) {
        return Ok(());
    }
    for Recording { number, part, moments, torn, .. } in recordings {
        let torn = if *torn > 0 { format!(", {torn} pages that are not whole left out") } else { String::new() };
        writeln!(out, "earthquake {number}, part {part}: {} ticks{torn}", moments.len())?;
    }
    for path in given.out.iter().chain(&given.svg) {
        writeln!(out, "saved in {}", path.display())?;
    }
    Ok(())
}

/// As it is drawn: time from its first tick on.
fn trace(recording: &Recording) -> RecordingTrace {
    let first = recording.moments.first().map_or(0, |(tick, _)| *tick);
    let both = |[first, second]: [bool; 2]| u8::from(first) + 2 * u8::from(second);
    let (mut trace, mut before) = (RecordingTrace::default(), None);
    for (tick, moment) in &recording.moments {
        let time = f64::from(tick.wrapping_sub(first)) * recording.period;
        trace.time.push(time);
        trace.ground_g.push(moment.ground.into());
        trace.rotation.push(moment.rotation.into());
        trace.velocity.push(moment.velocity.into());
        trace.commanded.push(both(moment.command));
        trace.engaged.push(both(moment.engaged));
        trace.state.push(match moment.phase {
            Phase::Rocking => 1,
            Phase::Fault => 2,
            _ => 0,
        });
        if let Some(fault) = moment.fault.filter(|_| before != moment.fault).and_then(Fault::from_code) {
            trace.faults.push((time, format!("{}, {fault}", fault.code())));
        }
        before = moment.fault;
    }
    trace
}

/// How often it is asked whether it has been done, and for how long a device that erases may be silent: six sectors of at most 2.6 s, between
/// which it may answer what was asked long ago.
const PAUSE: Duration = Duration::from_millis(50);
const SILENCE: Duration = Duration::from_secs(20);

fn erase(session: &mut Talk, out: &mut impl Write, interrupt: &Interrupt) -> anyhow::Result<()> {
    let mut heard = Instant::now();
    // Asked once more it erases nothing once more: what is blank is left alone.
    while let Err(error) = session.order(&Request::EraseRecordings) {
        if !matches!(error, DeviceError::Silent(_)) || heard.elapsed() >= SILENCE {
            return Err(error.into());
        }
        if interrupt.is_set() {
            return Err(Interrupted.into());
        }
    }
    heard = Instant::now();
    loop {
        match recordings::state(session) {
            Ok(state) if state.activity == RecorderActivity::Erasing => heard = Instant::now(),
            Ok(_) => break,
            Err(DeviceError::Silent(_)) if heard.elapsed() < SILENCE => {}
            Err(error) => return Err(error.into()),
        }
        if interrupt.is_set() {
            return Err(Interrupted.into());
        }
        std::thread::sleep(PAUSE);
    }
    match recordings::list(session)?.len() {
        0 => writeln!(out, "erased")?,
        _ => return Err(anyhow!("not all is erased: something began to move; ask again at rest")),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        record: RecordArguments,
    }

    #[test]
    fn a_list_is_of_what_is_asked_for() {
        let parts: Parts = [((1, 1), Part::default()), ((2, 1), Part::default()), ((2, 2), Part::default())].into();
        let listed = |options: &[&str]| {
            let given = Line::parse_from([&["record", "--qemu"], options].concat()).record;
            listed(&given, &parts).map(|parts| parts.iter().map(|(numbers, _)| *numbers).collect::<Vec<_>>())
        };
        assert_eq!(listed(&[]).unwrap(), [(1, 1), (2, 1), (2, 2)]);
        assert_eq!(listed(&["--earthquake", "2"]).unwrap(), [(2, 1), (2, 2)]);
        assert_eq!(listed(&["--earthquake", "2", "--part", "2"]).unwrap(), [(2, 2)]);
        let error = listed(&["--earthquake", "3"]).unwrap_err().to_string();
        assert_eq!(error, "it has no recording of an earthquake 3; it has 1, 2");
    }
}
