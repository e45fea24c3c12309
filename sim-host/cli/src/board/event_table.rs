//! A device's event log in words.

use serde::Serialize;
use sprag_report::text_table::TextTable;
use sprag_shared::control::supervisor::event_log::{Entry, Kind};
use sprag_shared::link::reset_cause::Cause;

/// What happened, in words; with the text of a fault where it is one.
pub fn what(kind: Kind) -> String {
    let fault = |code: u16| match kind.fault() {
        Some(fault) => format!("{code}, {fault}"),
        None => format!("{code}, which this program does not know"),
    };
    match kind {
        Kind::Engaged(wheel) => format!("engage {wheel}"),
        Kind::Released(wheel) => format!("release {wheel}"),
        Kind::Phase(phase) => format!("{phase:?}"),
        Kind::Fault(code) => format!("fault {}", fault(code)),
        Kind::Warning(code) => format!("warning {}", fault(code)),
        Kind::Calibrated => "calibrated".to_owned(),
        Kind::Started(cause) => match Cause::ALL.get(usize::from(cause)) {
            Some(cause) => format!("started anew ({cause:?}): what is above was before"),
            None => format!("started anew for a cause {cause}, which this program does not know"),
        },
        Kind::Tested => "proof test passed".to_owned(),
    }
}

/// As a table for people; `period` is from tick to tick, s.
pub fn table(entries: &[Entry], period: f32) -> TextTable {
    let mut table = TextTable::new(0, ["tick", "time s", "θ rad", "θ̇ rad/s", "what"]).ending_in_words();
    for entry in entries {
        table.row(vec![
            entry.tick.to_string(),
            format!("{:.4}", time(entry, period)),
            format!("{:.6}", entry.rotation),
            format!("{:.6}", entry.velocity),
            what(entry.kind),
        ]);
    }
    table
}

/// An entry, for programs.
#[derive(Debug, Serialize)]
pub struct LogRow {
    tick: u32,
    time_s: f64,
    rotation_rad: f32,
    velocity_rad_s: f32,
    what: String,
    /// Of a fault or warning.
    fault_code: Option<u16>,
}

/// Every entry, for programs; `period` is from tick to tick, s.
pub fn log_rows(entries: &[Entry], period: f32) -> Vec<LogRow> {
    let row = |entry: &Entry| LogRow {
        tick: entry.tick,
        time_s: time(entry, period),
        rotation_rad: entry.rotation,
        velocity_rad_s: entry.velocity,
        what: what(entry.kind),
        fault_code: match entry.kind {
            Kind::Fault(code) | Kind::Warning(code) => Some(code),
            _ => None,
        },
    };
    entries.iter().map(row).collect()
}

/// Table of the events for programs.
pub fn rows(entries: &[Entry], period: f32) -> TextTable {
    let mut table = TextTable::new(0, ["tick", "time_s", "rotation_rad", "velocity_rad_s", "what", "fault_code"]);
    for LogRow { tick, time_s, rotation_rad, velocity_rad_s, what, fault_code } in log_rows(entries, period) {
        let numbers = [tick.to_string(), time_s.to_string(), rotation_rad.to_string(), velocity_rad_s.to_string()];
        let code = fault_code.map_or_else(String::new, |code| code.to_string());
        table.row(numbers.into_iter().chain([what, code]).collect());
    }
    table
}

fn time(entry: &Entry, period: f32) -> f64 {
    f64::from(entry.tick) * f64::from(period)
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_report::columns::write_csv;
    use sprag_shared::control::monitor::fault::{Fault, Wheel};

    #[test]
    fn every_entry_is_a_line_with_its_time() {
        let entry = |tick, kind| Entry { tick, kind, rotation: 0.5, velocity: f32::NAN };
        let entries = [
            entry(1, Kind::Engaged(Wheel::Second)),
            entry(2000, Kind::Fault(Fault::Overrun.code())),
            entry(u32::MAX, Kind::Warning(999)),
        ];
        let mut csv = Vec::new();
        write_csv(&rows(&entries, 0.0005), &mut csv).unwrap();
        let (table, csv) = (table(&entries, 0.0005).plain(), String::from_utf8(csv).unwrap());
        assert!(table.contains("engage second") && table.contains(&Fault::Overrun.to_string()) && table.lines().count() == 4);
        let times: Vec<f64> = csv.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert!((times[1] - 1.0).abs() < 1e-6, "{times:?}");
        assert!(csv.lines().count() == 4 && csv.lines().nth(2).unwrap().ends_with(",61"));
    }
}
