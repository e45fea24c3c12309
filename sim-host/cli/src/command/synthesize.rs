//! `sprag synthesize`: writes a synthetic near-fault ground motion.

use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;

use clap::Args;
use sprag_report::output::{Results, claim_file, is_standard_output};
use sprag_sim::record::{Intensity, ReadOptions, Record, STANDARD_GRAVITY_M_S2};
use sprag_sim::synthesis::NearFaultMotion;

use super::context::{Completion, Context, Run};
use super::out_arguments::OverwriteArguments;

const DEFAULT: NearFaultMotion = NearFaultMotion::DEFAULT;

/// Make a synthetic near-fault ground motion.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  sprag synthesize --out near_fault.csv --seed 7 --pulse-period 1.5\n\n\
    The pulse is the one of Mavroeidis and Papageorgiou (2003). The same flags give the same bytes on every machine.")]
pub struct SynthesizeArguments {
    /// CSV file to write: time (s) and ground acceleration (g).
    #[arg(long, value_name = "FILE.csv")]
    pub out: PathBuf,
    #[command(flatten)]
    pub replace: OverwriteArguments,
    /// Seed of the noise.
    #[arg(long, default_value_t = DEFAULT.seed, value_parser = super::whole_number(0..=u64::MAX))]
    pub seed: u64,
    /// Duration in s, 5 to 120.
    #[arg(long, default_value_t = DEFAULT.duration_s, value_name = "S", value_parser = super::any_number)]
    pub duration: f64,
    /// Samples per second, 50 to 1000.
    #[arg(long, default_value_t = DEFAULT.rate_hz, value_name = "HZ", value_parser = super::any_number)]
    pub rate: f64,
    /// Velocity amplitude A of the pulse in m/s, 0 to 5.
    #[arg(long, default_value_t = DEFAULT.pulse_velocity_m_s, value_name = "M/S", value_parser = super::any_number)]
    pub pulse_velocity: f64,
    /// Period of the pulse in s, 0.3 to 15.
    #[arg(long, default_value_t = DEFAULT.pulse_period_s, value_name = "S", value_parser = super::any_number)]
    pub pulse_period: f64,
    /// Cycles under the envelope of the pulse (gamma), above 1 and up to 10.
    #[arg(long, default_value_t = DEFAULT.pulse_cycles, value_name = "CYCLES", value_parser = super::any_number)]
    pub pulse_cycles: f64,
    /// Phase of the pulse (nu) in degrees, -360 to 360.
    #[arg(long, default_value_t = DEFAULT.pulse_phase_deg, value_name = "DEG", value_parser = super::any_number, allow_negative_numbers = true)]
    pub pulse_phase_deg: f64,
    /// Middle of the pulse in s; the whole pulse must lie within the duration.
    #[arg(long, default_value_t = DEFAULT.pulse_time_s, value_name = "S", value_parser = super::any_number)]
    pub pulse_time: f64,
    /// Peak acceleration of the noise in g, 0 to 2.
    #[arg(long, default_value_t = DEFAULT.noise_peak_g, value_name = "G", value_parser = super::any_number)]
    pub noise_peak: f64,
    /// Lower end of the noise band in Hz, 0.1 or more.
    #[arg(long, default_value_t = DEFAULT.lowest_frequency_hz, value_name = "HZ", value_parser = super::any_number)]
    pub lowest_frequency: f64,
    /// Upper end of the noise band in Hz, up to a quarter of the sampling rate.
    #[arg(long, default_value_t = DEFAULT.highest_frequency_hz, value_name = "HZ", value_parser = super::any_number)]
    pub highest_frequency: f64,
}

impl SynthesizeArguments {
    /// The parameters of the motion.
    pub fn motion(&self) -> NearFaultMotion {
        NearFaultMotion {
            seed: self.seed,
            duration_s: self.duration,
            rate_hz: self.rate,
            pulse_velocity_m_s: self.pulse_velocity,
            pulse_period_s: self.pulse_period,
            pulse_cycles: self.pulse_cycles,
            pulse_phase_deg: self.pulse_phase_deg,
            pulse_time_s: self.pulse_time,
            noise_peak_g: self.noise_peak,
            lowest_frequency_hz: self.lowest_frequency,
            highest_frequency_hz: self.highest_frequency,
        }
    }
}

impl Run for SynthesizeArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let csv = self.motion().csv()?;
        let name = self.out.display().to_string();
        // The first line is the command that makes the same bytes.
        let same =
            |file| BufReader::lines(file).next().is_some_and(|line| line.is_ok_and(|line| csv.lines().next() == Some(&line)));
        claim_file(&self.out, &[], self.replace.overwrite, same)?;
        let mut results = Results::default();
        results.add(&self.out, |file| file.write_all(csv.as_bytes()))?;
        results.commit()?;
        let record = Record::parse(&name, csv.as_bytes(), &ReadOptions::default())?;
        let intensity = Intensity::of(&record);
        let line = format!(
            "{name}: {} samples at {} s, PGA {:.3} g, PGV {:.3} m/s",
            record.acceleration_m_s2.len(),
            record.time_step_s,
            intensity.pga_m_s2 / STANDARD_GRAVITY_M_S2,
            intensity.pgv_m_s
        );
        if !is_standard_output(&self.out) {
            context.print(line + "\n");
        } else if !context.quiet {
            context.note(line);
        }
        Ok(Completion::Complete)
    }
}

#[cfg(test)]
mod tests {
    fn run_line(line: &[&str]) -> (i32, String, String) {
        crate::line::run(&[&["synthesize"], line].concat())
    }

    #[test]
    fn the_header_states_the_command_that_makes_the_same_bytes_again() {
        let folder = tempfile::tempdir().unwrap();
        let (first, second) = (folder.path().join("first.csv"), folder.path().join("second.csv"));
        let (status, out, err) = run_line(&["--out", first.to_str().unwrap(), "--seed", "9", "--pulse-phase-deg", "-30.5"]);
        assert_eq!((status, err.as_str()), (0, ""));
        assert!(out.contains("5001 samples at 0.005 s"), "{out}");
        let text = std::fs::read_to_string(&first).unwrap();
        let command = text.lines().next().unwrap().strip_prefix("# sprag synthesize ").unwrap();
        let again: Vec<&str> = ["--out", second.to_str().unwrap()].into_iter().chain(command.split(' ')).collect();
        assert_eq!(run_line(&again).0, 0);
        assert_eq!(text, std::fs::read_to_string(&second).unwrap());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "nothing else is left behind");
    }

    #[test]
    fn what_cannot_be_written_is_one_clear_line() {
        let folder = tempfile::tempdir().unwrap();
        for path in [folder.path().join("missing").join("a.csv"), folder.path().to_path_buf()] {
            let (status, out, err) = run_line(&["--out", path.to_str().unwrap()]);
            assert_eq!((status, out.as_str(), err.lines().count()), (2, "", 1));
            assert!(err.contains(path.to_str().unwrap()) && err.contains("cannot be written"), "{err}");
        }
        let (status, _, err) = run_line(&["--out", folder.path().join("a.csv").to_str().unwrap(), "--rate", "10"]);
        assert_eq!((status, err.as_str()), (2, "sprag: --rate 10: allowed are 50 to 1000\n"));
    }
}
