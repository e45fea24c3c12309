//! Random ground motions: every family of pulses, and short records of straight lines.

use std::f64::consts::TAU;
use std::fmt::Write;

use crate::random::Random;

/// One or two motions, the second later than the first.
pub fn horizontal(text: &mut String, files: &mut Vec<(String, String)>, random: &mut Random, threshold: f64, p: f64) {
    let count = if random.chance(0.35) { 2 } else { 1 };
    for index in 0..count {
        let _ = writeln!(text, "\n[[ground]]");
        let start = if index == 0 { 0.0 } else { random.between(0.3, 4.0) };
        let amplitude = random.between(1.05, 3.5);
        let sign = random.pick(&[1.0, -1.0]);
        let ratio = random.logarithmic(1.5, 7.0);
        match random.next_u64() % 8 {
            0 => drop(writeln!(text, "motion = \"half-sine\"\namplitude_ratio = {amplitude}\nfrequency_ratio = {ratio}")),
            1 => drop(writeln!(text, "motion = \"cosine\"\namplitude_ratio = {amplitude}\nfrequency_ratio = {ratio}")),
            2 => drop(writeln!(
                text,
                "motion = \"rectangular\"\namplitude_ratio = {amplitude}\nduration_ratio = {}",
                random.between(0.1, 0.7)
            )),
            3 => drop(writeln!(
                text,
                "motion = \"ricker\"\namplitude_g = {}\nfrequency_hz = {}",
                amplitude * threshold / 9.8,
                random.between(0.8, 3.0)
            )),
            4 => drop(writeln!(
                text,
                "motion = \"mavroeidis-papageorgiou\"\nvelocity_amplitude_m_s = {}\nfrequency_ratio = {ratio}\n\
                 oscillations = {}\nphase_deg = {}",
                amplitude * threshold / (ratio * p),
                random.between(1.1, 3.0),
                random.between(-180.0, 180.0)
            )),
            5 | 6 => {
                let name = format!("record{index}.csv");
                files.push((name.clone(), record(random, amplitude * threshold)));
                let _ = writeln!(text, "motion = \"record\"\nfile = \"{name}\"");
            }
            _ => drop(writeln!(
                text,
                "motion = \"sine\"\namplitude_m_s2 = {}\nfrequency_hz = {}",
                amplitude * threshold,
                ratio * p / TAU
            )),
        }
        let _ = writeln!(text, "start_s = {start}\nscale = {sign}");
    }
}

/// Some of the supports that move by a factor get an oscillator, or a record beside the only motion of the ground, in its place. A wavelet
/// whose response Sprag follows by chords has none, and a guided rack behind a pulley rides on none.
pub fn support(text: &mut String, files: &mut Vec<(String, String)>, random: &Random, threshold: f64) {
    let Some(line) = text.lines().find(|line| line.starts_with("support_amplification")).map(str::to_owned) else { return };
    let guided =
        text.lines().any(|line| line.starts_with("weight") && line.contains("rack_") && !line.contains("rack_on = \"block\""));
    if guided && text.contains("pulley_ratio") {
        return;
    }
    // Draws of its own, so that all others stay what they were.
    let mut own = *random;
    own = Random::new(own.next_u64() ^ 1);
    let grounds = text.split("[[vertical]]").next().unwrap_or_default();
    let (single, closed) = (grounds.matches("[[ground]]").count() == 1, !grounds.contains("ricker"));
    let keys = match own.next_u64() % 3 {
        0 if closed => format!(
            "support_frequency_hz = {}\nsupport_damping_ratio = {}",
            own.logarithmic(1.5, 15.0),
            own.logarithmic(0.05, 0.4)
        ),
        1 if single => {
            files.push(("support.csv".to_owned(), record(&mut own, 1.5 * threshold)));
            format!("support_record = {{ file = \"support.csv\", scale = {} }}", own.between(-1.5, 1.5))
        }
        _ => return,
    };
    *text = text.replacen(&line, &keys, 1);
}

/// A vertical motion that leaves the block on the ground.
pub fn vertical(text: &mut String, random: &mut Random) {
    let kind = random.pick(&["sine", "cosine", "ricker", "half-sine"]);
    let _ = writeln!(
        text,
        "\n[[vertical]]\nmotion = \"{kind}\"\namplitude_g = {}\nfrequency_hz = {}\nstart_s = {}",
        random.between(-0.4, 0.4),
        random.between(0.8, 5.0),
        random.between(0.0, 0.5)
    );
}

/// A sum of sines under an envelope that begins and ends at zero, at a time step that resolves none too well.
fn record(random: &mut Random, peak: f64) -> String {
    let step = random.pick(&[0.01, 0.02]);
    let duration = random.between(2.0, 4.0);
    let waves: Vec<[f64; 3]> =
        (0..5).map(|_| [random.between(0.2, 1.0), random.logarithmic(0.5, 6.0), random.between(0.0, TAU)]).collect();
    let samples = (duration / step) as usize;
    let mut values: Vec<f64> = (0..=samples)
        .map(|i| {
            let t = i as f64 * step;
            let envelope = (std::f64::consts::PI * t / duration).sin().max(0.0);
            envelope * waves.iter().map(|[size, hertz, phase]| size * (TAU * hertz * t + phase).sin()).sum::<f64>()
        })
        .collect();
    let largest = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
    values.iter_mut().for_each(|value| *value *= peak / largest);
    let mut text = String::from("time_s,acc_m_s2\n");
    for (i, value) in values.iter().enumerate() {
        let _ = writeln!(text, "{:.2},{value}", i as f64 * step);
    }
    text
}
