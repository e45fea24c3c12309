//! Ground motions in files, for studies over records.

use std::fmt::Write as _;

use sprag_shared::math;

/// A folder of one-cycle sine pulses, amplitude (g) by period (s), every 0.01 s for 4 s.
///
/// # Panics
/// When the folder cannot be written.
pub fn sine_pulses(amplitudes: &[f64], periods: &[f64]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for amplitude in amplitudes {
        for period in periods {
            let mut text = "time_s,acc_g\n".to_owned();
            let at = |time: f64| match (time - 0.5) / period {
                cycle @ 0.0..1.0 => amplitude * math::sin(core::f64::consts::TAU * cycle),
                _ => 0.0,
            };
            for sample in 0..400 {
                let time = 0.01 * f64::from(sample);
                let _ = writeln!(text, "{time:.2},{:.8}", at(time));
            }
            std::fs::write(folder.path().join(format!("a{amplitude}_t{period}.csv")), text).expect("a file");
        }
    }
    folder
}
