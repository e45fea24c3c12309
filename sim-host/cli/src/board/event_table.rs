//! A device's event log in words.

use std::io::{self, Write};

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

/// As a table; `period` is from tick to tick, s.
///
/// # Errors
/// As the writer.
pub fn write_table(entries: &[Entry], total: u32, period: f32, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{:>10} {:>12} {:>12} {:>12}  what", "tick", "time s", "θ rad", "θ̇ rad/s")?;
    for entry in entries {
        let seconds = f64::from(entry.tick) * f64::from(period);
        writeln!(
            out,
            "{:>10} {seconds:>12.4} {:>12.6} {:>12.6}  {}",
            entry.tick,
            entry.rotation,
            entry.velocity,
            what(entry.kind)
        )?;
    }
    writeln!(out, "{} of {total} entries", entries.len())
}

/// As CSV.
///
/// # Errors
/// As the writer.
pub fn write_csv(entries: &[Entry], period: f32, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "tick,time_s,rotation_rad,velocity_rad_s,what,fault_code")?;
    for entry in entries {
        let code = match entry.kind {
            Kind::Fault(code) | Kind::Warning(code) => code.to_string(),
            _ => String::new(),
        };
        let seconds = f64::from(entry.tick) * f64::from(period);
        let what = what(entry.kind).replace('"', "\"\"");
        writeln!(out, "{},{seconds},{},{},\"{what}\",{code}", entry.tick, entry.rotation, entry.velocity)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use sprag_shared::control::monitor::fault::{Fault, Wheel};

    #[test]
    fn every_entry_is_a_line_with_its_time() {
        let entry = |tick, kind| Entry { tick, kind, rotation: 0.5, velocity: f32::NAN };
        let entries = [
            entry(1, Kind::Engaged(Wheel::Second)),
            entry(2000, Kind::Fault(Fault::Overrun.code())),
            entry(u32::MAX, Kind::Warning(999)),
        ];
        let (mut table, mut csv) = (Vec::new(), Vec::new());
        write_table(&entries, 70, 0.0005, &mut table).unwrap();
        write_csv(&entries, 0.0005, &mut csv).unwrap();
        let (table, csv) = (String::from_utf8(table).unwrap(), String::from_utf8(csv).unwrap());
        assert!(table.contains("engage second") && table.contains(&Fault::Overrun.to_string()) && table.contains("3 of 70"));
        let times: Vec<f64> = csv.lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
        assert!((times[1] - 1.0).abs() < 1e-6, "{times:?}");
        assert!(csv.lines().count() == 4 && csv.lines().nth(2).unwrap().ends_with(",61"));
    }
}
