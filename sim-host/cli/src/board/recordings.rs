//! What a device's flight recorder holds: which recordings, and every tick of one.

use std::collections::BTreeMap;

use sprag_report::text_table::TextTable;
use sprag_shared::device::recorder::page::{HEADER_BYTES, TRAILER_BYTES, words};
use sprag_shared::device::recorder::{CAPACITY, Header, Moment, PAGE_BYTES, Page, PageError};
use sprag_shared::link::{RecorderActivity, RecorderState, Reply, Request};

use super::line::{DeviceError, Line, RefusalText};
use super::session::Session;

/// Parts of recordings, as their pages say.
pub type Parts = BTreeMap<PartNumbers, Part>;

/// Number of an earthquake, and of a part of its recording.
pub type PartNumbers = (u16, u8);

/// Pages of a part, without their records.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Where they are, in their order, with what they say of themselves.
    pub pages: Vec<(u32, Header)>,
    /// Ticks of those that are finished.
    pub ticks: u32,
    /// Pages that are not finished: the supply was cut, or they are being written.
    pub unfinished: usize,
    /// The recording ends with it.
    pub ends: bool,
}

/// Every tick of a part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// Number of the earthquake.
    pub number: u16,
    /// Number of the part.
    pub part: u8,
    /// From tick to tick, s.
    pub period: f64,
    /// Ticks, counted from the start of the device, and what was recorded of them.
    pub moments: Vec<(u32, Moment)>,
    /// Pages that were not whole, and are left out.
    pub torn: usize,
}

/// State of the flight recorder.
///
/// # Errors
/// The errors of [`Session::ask`].
pub fn state<L: Line>(session: &mut Session<L>) -> Result<RecorderState, DeviceError> {
    session.ask(&Request::Recorder, |reply| if let Reply::Recorder(state) = reply { Some(state) } else { None })
}

/// So many bytes from an offset on; nothing where the flash cannot be read, as after a cut of the supply.
fn bytes<L: Line>(session: &mut Session<L>, offset: u32, length: usize) -> Result<Option<Vec<u8>>, DeviceError> {
    let mut bytes = Vec::new();
    while bytes.len() < length {
        let wanted = |reply| if let Reply::Recorded(recorded) = reply { Some(recorded) } else { None };
        let recorded = match session.ask(&Request::Recorded { offset: offset + bytes.len() as u32 }, wanted) {
            Err(DeviceError::Refused(RefusalText(sprag_shared::link::Refusal::FlashFailed))) => return Ok(None),
            recorded => recorded?,
        };
        let count = usize::from(recorded.count).min(recorded.bytes.as_flattened().len());
        if count == 0 || recorded.offset != offset + bytes.len() as u32 {
            return Err(DeviceError::Confused("its recordings"));
        }
        bytes.extend(&recorded.bytes.as_flattened()[..count]);
    }
    bytes.truncate(length);
    Ok(Some(bytes))
}

/// Recordings in flash, by number and part.
///
/// # Errors
/// The errors of [`Session::ask`].
pub fn list<L: Line>(session: &mut Session<L>) -> Result<Parts, DeviceError> {
    let state = state(session)?;
    let end = if state.goes_round { state.pages } else { state.pages.min(state.next.saturating_add(1)) };
    let mut parts = Parts::new();
    for page in 0..u32::from(end) {
        let offset = page * PAGE_BYTES;
        let head = bytes(session, offset, HEADER_BYTES)?;
        let Some(header) = head.and_then(|head| Header::of(&words(&head))) else { continue };
        let trailer = bytes(session, offset + PAGE_BYTES - TRAILER_BYTES as u32, TRAILER_BYTES)?;
        let [count, _] = trailer.map_or([u32::MAX; 2], |trailer| words(&trailer));
        let part = parts.entry((header.number, header.part)).or_default();
        part.pages.push((offset, header));
        if (count & 0xFFFF) as usize <= CAPACITY {
            part.ticks += count & 0xFFFF;
            part.ends |= count >> 16 == 1;
        } else {
            part.unfinished += 1;
        }
    }
    parts.values_mut().for_each(|part| part.pages.sort_by_key(|(_, header)| header.sequence));
    Ok(parts)
}

/// Every tick of a part. `progress` is given how many of its pages have come.
///
/// # Errors
/// The errors of [`Session::ask`].
pub fn read<L: Line>(
    session: &mut Session<L>,
    (number, part): PartNumbers,
    pages: &[(u32, Header)],
    mut progress: impl FnMut(usize),
) -> Result<Recording, DeviceError> {
    let period = pages.first().map_or(0.0, |(_, header)| f64::from(header.period));
    let mut recording = Recording { number, part, period, ..Recording::default() };
    for (come, (offset, header)) in pages.iter().enumerate() {
        progress(come);
        let bytes = bytes(session, *offset, PAGE_BYTES as usize)?;
        match bytes.as_deref().map(Page::of) {
            Some(Ok(page)) if page.header == *header => recording.moments.extend(page.moments()),
            None | Some(Ok(_) | Err(PageError::Torn(_) | PageError::Foreign | PageError::Blank)) => recording.torn += 1,
        }
    }
    Ok(recording)
}

/// Columns of a recording.
const COLUMNS: [&str; 14] = [
    "earthquake",
    "part",
    "tick",
    "time_s",
    "rotation_rad",
    "velocity_rad_s",
    "ground_g",
    "engage_first",
    "engage_second",
    "engaged_first",
    "engaged_second",
    "standing",
    "state",
    "fault_code",
];

/// A row a tick.
pub fn table(recordings: &[Recording]) -> TextTable {
    let mut table = TextTable::new(0, COLUMNS);
    for recording in recordings {
        for (tick, moment) in &recording.moments {
            let Moment { rotation, velocity, ground, command, engaged, phase, standing, fault } = moment;
            let clutches = [*command, *engaged].concat().into_iter().map(|clutch| u8::from(clutch).to_string());
            let before = [recording.number.to_string(), recording.part.to_string(), tick.to_string()];
            let time = (f64::from(*tick) * recording.period).to_string();
            let motion = [time, rotation.to_string(), velocity.to_string(), ground.to_string()];
            let state = format!("{phase:?}").to_lowercase();
            let after = [u8::from(*standing).to_string(), state, fault.unwrap_or(0).to_string()];
            table.row(before.into_iter().chain(motion).chain(clutches).chain(after).collect());
        }
    }
    table
}
/// What room there is, in words.
pub fn room(state: &RecorderState, period: f64) -> String {
    let seconds = |pages: u16| f64::from(pages) * CAPACITY as f64 * period;
    let left = state.pages.saturating_sub(state.next);
    let mut text = match (state.goes_round, state.activity) {
        (_, RecorderActivity::Looking) => "it has just started, and looks for its last page".to_owned(),
        (_, RecorderActivity::Erasing) => "it is being erased".to_owned(),
        (true, _) => format!("room for the last {:.1} s", seconds(state.pages)),
        (false, _) if left == 0 => {
            "full: what is there is kept, and nothing new recorded (sprag board record --erase)".to_owned()
        }
        (false, _) => format!("room for another {:.1} s of {:.1}", seconds(left), seconds(state.pages)),
    };
    if state.activity == RecorderActivity::Writing {
        text += ", an earthquake is being recorded";
    }
    if state.lost > 0 {
        text += &format!(", {} ticks found no room since the start", state.lost);
    }
    if state.refused > 0 {
        text += &format!(", {} pages were refused by the flash", state.refused);
    }
    text
}
