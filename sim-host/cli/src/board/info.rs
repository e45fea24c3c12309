//! Who a device is and how it is, as text and as JSON.

use std::fmt::{Display, Formatter, Result as Written};

use serde::Serialize;
use sprag_shared::control::monitor::fault::Fault;
use sprag_shared::control::supervisor::Phase;
use sprag_shared::link::{Identity, RecorderState, State};

use super::line::{DeviceError, Line};
use super::session::Session;
use super::{parameters, recordings};

/// Who a device is and how it is.
#[derive(Debug, Serialize)]
pub struct DeviceInfo {
    board: String,
    version: String,
    build: String,
    /// A test build that takes orders to fail on purpose.
    rehearsal: bool,
    /// The phase, and in Fault why.
    state: String,
    fault_code: Option<u16>,
    /// Control ticks since the start.
    ticks: u32,
    /// A host says what its sensors read.
    attached: bool,
    reset_cause: String,
    sealed: bool,
    protected_against_reading: bool,
    protected_against_writing: bool,
    /// The highest version that has run on it.
    highest_version: String,
    older_than_before: bool,
    jumper_closed: bool,
    parameters: u16,
    parameters_check: String,
    gyroscope_bias_rad_s: f32,
    /// Along the base and up.
    block_accelerometer_bias_m_s2: [f32; 2],
    ground_accelerometer_bias_m_s2: [f32; 2],
    encoder_zero_counts: i32,
    counter_hz: u32,
    worst_tick_counts: u32,
    worst_delay_counts: u32,
    stack_bytes: u32,
    bad_frames: u32,
    lost_reports: u32,
    log_entries: u32,
    /// Room for recordings, in words.
    recordings: String,
}

impl DeviceInfo {
    /// Asks a device.
    pub fn of<L: Line>(session: &mut Session<L>) -> Result<DeviceInfo, DeviceError> {
        let (identity, state) = (session.identify()?, session.state()?);
        let period = f64::from(parameters::read(session)?.period());
        Ok(DeviceInfo::new(&identity, &state, &recordings::state(session)?, period))
    }

    /// From what a device has answered; `period` is from tick to tick, s.
    fn new(identity: &Identity, state: &State, recorder: &RecorderState, period: f64) -> DeviceInfo {
        DeviceInfo {
            board: text(&identity.board),
            version: dotted(identity.version),
            build: text(&identity.build),
            rehearsal: identity.rehearsal,
            state: phase_text(state.phase, state.fault),
            fault_code: state.fault.map(Fault::code),
            ticks: state.ticks,
            attached: state.attached.is_some(),
            reset_cause: format!("{:?}", state.cause),
            sealed: identity.sealed,
            protected_against_reading: identity.protection.reading,
            protected_against_writing: identity.protection.writing,
            highest_version: dotted(identity.highest),
            older_than_before: identity.highest > identity.version,
            jumper_closed: identity.jumper,
            parameters: identity.settings,
            parameters_check: format!("{:08x}", identity.check),
            gyroscope_bias_rad_s: state.calibration.gyroscope,
            block_accelerometer_bias_m_s2: state.calibration.block,
            ground_accelerometer_bias_m_s2: state.calibration.ground,
            encoder_zero_counts: state.calibration.encoder_zero,
            counter_hz: identity.counter_hz,
            worst_tick_counts: state.worst_cost,
            worst_delay_counts: state.worst_lateness,
            stack_bytes: state.stack,
            bad_frames: state.bad_frames,
            lost_reports: state.lost_reports,
            log_entries: state.log_count,
            recordings: recordings::room(recorder, period),
        }
    }

    fn duration(&self, counts: u32) -> String {
        format!("{counts} counts, {:.1} µs", f64::from(counts) * 1e6 / f64::from(self.counter_hz.max(1)))
    }

    /// Whether the program is whole, protected and the newest.
    fn program(&self) -> String {
        let seal = if self.sealed { "sealed" } else { "without a seal: damage to it would not be found" };
        let protection = match (self.protected_against_reading, self.protected_against_writing) {
            (true, true) => "protected against reading and writing",
            (true, false) => "protected against reading only",
            (false, true) => "protected against writing only",
            (false, false) => "not protected",
        };
        let older =
            if self.older_than_before { format!("; version {} has run before", self.highest_version) } else { String::new() };
        format!("{seal}, {protection}{older}")
    }
}

impl Display for DeviceInfo {
    fn fmt(&self, f: &mut Formatter<'_>) -> Written {
        let rehearsal = if self.rehearsal { ", a test build that takes orders to fail on purpose" } else { "" };
        let sensors = match self.attached {
            false => "its own",
            true => "those of a host: it does not protect the structure (sprag board detach)",
        };
        let jumper = if self.jumper_closed { "closed: it may be changed; open it when done" } else { "open" };
        let [block_along, block_up] = self.block_accelerometer_bias_m_s2;
        let [ground_along, ground_up] = self.ground_accelerometer_bias_m_s2;
        writeln!(f, "device        {} {} ({}){rehearsal}", self.board, self.version, self.build)?;
        writeln!(f, "state         {}, {} ticks after its start", self.state, self.ticks)?;
        writeln!(f, "sensors       {sensors}")?;
        writeln!(f, "start         {}", self.reset_cause)?;
        writeln!(f, "program       {}", self.program())?;
        writeln!(f, "jumper        {jumper}")?;
        writeln!(f, "parameters    {}, check {}", self.parameters, self.parameters_check)?;
        writeln!(f, "calibration   gyroscope {:+.6} rad/s", self.gyroscope_bias_rad_s)?;
        writeln!(f, "              block accelerometer {block_along:+.4}, {block_up:+.4} m/s²")?;
        writeln!(f, "              ground accelerometer {ground_along:+.4}, {ground_up:+.4} m/s²")?;
        writeln!(f, "              encoder {} counts", self.encoder_zero_counts)?;
        writeln!(f, "worst tick    {}", self.duration(self.worst_tick_counts))?;
        writeln!(f, "worst delay   {}", self.duration(self.worst_delay_counts))?;
        writeln!(f, "stack         {} bytes at most", self.stack_bytes)?;
        writeln!(f, "link          {} bad frames, {} reports lost", self.bad_frames, self.lost_reports)?;
        writeln!(f, "event log     {} entries", self.log_entries)?;
        writeln!(f, "recordings    {}", self.recordings)
    }
}

/// Board, version and build of a firmware.
pub fn firmware(identity: &Identity) -> String {
    format!("{} {} ({})", text(&identity.board), dotted(identity.version), text(&identity.build))
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_end_matches('\0').to_owned()
}

fn dotted([major, minor, patch]: [u8; 3]) -> String {
    format!("{major}.{minor}.{patch}")
}

/// A phase, and in Fault why.
pub fn phase_text(phase: Phase, fault: Option<Fault>) -> String {
    match fault {
        Some(fault) => format!("{phase:?} ({}, {fault})", fault.code()),
        None => format!("{phase:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::control::sensing::calibration::Calibration;
    use sprag_shared::link::reset_cause::Cause;
    use sprag_shared::link::{Pace, Protection, RecorderActivity};

    #[test]
    fn text_and_json_say_the_same() {
        let identity = Identity {
            version: [1, 2, 3],
            build: *b"0badcafe",
            board: *b"f405\0\0\0\0\0\0\0\0",
            counter_hz: 168_000_000,
            settings: 77,
            layout: 5,
            check: 0xabc,
            rehearsal: false,
            highest: [1, 3, 0],
            sealed: true,
            jumper: true,
            protection: Protection { reading: true, writing: false },
        };
        let state = State {
            phase: Phase::Fault,
            fault: Some(Fault::Overrun),
            ticks: 4321,
            calibration: Calibration { gyroscope: 0.25, block: [0.5, -0.125], ground: [1.5, 2.5], encoder_zero: -17 },
            log_count: 19,
            worst_cost: 168,
            worst_lateness: 336,
            bad_frames: 23,
            lost_reports: 29,
            stack: 1234,
            cause: Cause::PowerOn,
            attached: Some(Pace::Timer),
        };
        let recorder =
            RecorderState { pages: 8, next: 8, goes_round: false, activity: RecorderActivity::Ready, lost: 31, refused: 0 };
        let info = DeviceInfo::new(&identity, &state, &recorder, 5e-4);
        let text = info.to_string();
        let json = serde_json::to_value(&info).unwrap();
        // Independent of both: what the device has answered.
        for part in
            ["f405 1.2.3 (0badcafe)", "Fault (61", "4321 ticks", "those of a host", "sealed, protected against reading only"]
        {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(
            text.contains("168 counts, 1.0 µs") && text.contains("version 1.3.0 has run before") && text.contains("full"),
            "{text}"
        );
        for (key, value) in
            [("board", "f405"), ("build", "0badcafe"), ("reset_cause", "PowerOn"), ("parameters_check", "00000abc")]
        {
            assert_eq!(json[key], value);
        }
        for (key, value) in
            [("fault_code", 61), ("ticks", 4321), ("encoder_zero_counts", -17), ("stack_bytes", 1234), ("lost_reports", 29)]
        {
            assert_eq!(json[key], value);
        }
        assert_eq!(json["block_accelerometer_bias_m_s2"], serde_json::json!([0.5, -0.125]));
        assert!(json["attached"] == true && json["older_than_before"] == true && json["protected_against_writing"] == false);
    }
}
