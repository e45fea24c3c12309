//! The circuits of a folder, simulated by ngspice, and what each asserts.
//!
//! A circuit is a file `*.cir` that measures (`.meas`) and says in comments what the measures must be: `* assert NAME < VALUE  why`.

use crate::{process::captured, stop::Stop};
use std::{
    fmt, fs,
    path::{Path, PathBuf},
    process::Command,
};

/// What a measure must be.
#[derive(Debug, PartialEq)]
struct Assert {
    name: String,
    less: bool,
    limit: f64,
}

/// An assert with what was measured; nothing where the simulator has no such measure or it failed.
struct Finding {
    assert: Assert,
    value: Option<f64>,
}

impl Finding {
    fn holds(&self) -> bool {
        self.value.is_some_and(|value| if self.assert.less { value < self.assert.limit } else { value > self.assert.limit })
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Finding { assert: Assert { name, less, limit }, value } = self;
        let value = value.map_or("not measured".to_owned(), |value| format!("{value:.4e}"));
        let verdict = if self.holds() { "" } else { "  FAILS" };
        write!(f, "   {name:<12} {value:>12} {} {limit:<9.3e}{verdict}", if *less { '<' } else { '>' })
    }
}

/// Simulates every circuit of a folder.
///
/// # Errors
/// If an assert fails, a circuit asserts nothing, or the simulator does not run.
pub fn check(folder: &Path) -> Result<(), Stop> {
    let mut failed = Vec::new();
    for circuit in circuits(folder)? {
        let name = circuit.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        println!("-- {name}");
        for finding in simulate(&circuit)? {
            println!("{finding}");
            if !finding.holds() {
                failed.push(format!("{name}: {}", finding.assert.name));
            }
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(Stop::failed(format!("the coil driver fails: {}", failed.join(", ")))) }
}

fn circuits(folder: &Path) -> Result<Vec<PathBuf>, Stop> {
    let cannot = |error| Stop::failed(format!("{}: {error}", folder.display()));
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        if path.extension().is_some_and(|extension| extension == "cir") {
            found.push(path);
        }
    }
    found.sort();
    if found.is_empty() { Err(Stop::failed(format!("{}: no circuits", folder.display()))) } else { Ok(found) }
}

fn simulate(circuit: &Path) -> Result<Vec<Finding>, Stop> {
    let text = fs::read_to_string(circuit).map_err(|error| Stop::failed(format!("{}: {error}", circuit.display())))?;
    let asserts = asserts(&text).map_err(|why| Stop::failed(format!("{}: {why}", circuit.display())))?;
    let folder = circuit.parent().unwrap_or(Path::new("."));
    // Its exit code says little: a measure that failed is no error to it.
    let said = captured(Command::new("ngspice").current_dir(folder).arg("-b").args(circuit.file_name()))?;
    Ok(asserts.into_iter().map(|assert| Finding { value: measure(&said, &assert.name), assert }).collect())
}

/// The asserts in the comments of a circuit.
fn asserts(text: &str) -> Result<Vec<Assert>, String> {
    let found: Vec<Assert> = text
        .lines()
        .filter_map(|line| line.strip_prefix("* assert "))
        .map(|line| {
            let mut words = line.split_whitespace();
            let (name, relation, limit) = (words.next(), words.next(), words.next().and_then(number));
            match (name, relation, limit) {
                (Some(name), Some(relation @ ("<" | ">")), Some(limit)) => {
                    Ok(Assert { name: name.to_owned(), less: relation == "<", limit })
                }
                _ => Err(format!("not NAME < VALUE: {line}")),
            }
        })
        .collect::<Result<_, _>>()?;
    if found.is_empty() { Err("asserts nothing".to_owned()) } else { Ok(found) }
}

/// A number with the simulator's suffix for thousandths and less.
pub fn number(word: &str) -> Option<f64> {
    let scale = match word.chars().last()? {
        'k' => 1e3,
        'm' => 1e-3,
        'u' => 1e-6,
        'n' => 1e-9,
        _ => return word.parse().ok(),
    };
    word[..word.len() - 1].parse::<f64>().ok().map(|value| value * scale)
}

/// The value of a measure in what the simulator wrote.
fn measure(said: &str, name: &str) -> Option<f64> {
    said.lines().find_map(|line| {
        let (left, right) = line.split_once('=')?;
        if left.trim() != name {
            return None;
        }
        right.split_whitespace().next()?.parse().ok()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(super::super::COIL)
    }

    /// What fails in a circuit after one change of the driver or of itself.
    fn failing(circuit: &str, from: &str, to: &str) -> Vec<String> {
        let place = std::env::temp_dir().join(format!("sprag-coil-{}-{circuit}", std::process::id()));
        fs::create_dir_all(&place).unwrap();
        let mut changes = 0;
        for file in ["driver.inc", circuit] {
            let text = fs::read_to_string(folder().join(file)).unwrap();
            changes += text.matches(from).count();
            fs::write(place.join(file), text.replace(from, to)).unwrap();
        }
        assert_eq!(changes, 1, "{from}");
        let findings = simulate(&place.join(circuit)).unwrap();
        fs::remove_dir_all(&place).unwrap();
        findings.iter().filter(|finding| !finding.holds()).map(|finding| finding.assert.name.clone()).collect()
    }

    #[test]
    fn asserts_are_read() {
        let read = asserts("* title\n* assert release < 5m  in time\n.end\n* assert hold > 0.26\n").unwrap();
        assert_eq!(read[0], Assert { name: "release".into(), less: true, limit: 5e-3 });
        assert_eq!(read[1], Assert { name: "hold".into(), less: false, limit: 0.26 });
        assert!(asserts("* nothing\n").is_err());
        assert!(asserts("* assert release = 5m\n").is_err());
        assert!(asserts("* assert release < soon\n").is_err());
    }

    #[test]
    fn a_measure_that_failed_does_not_hold() {
        let said = "peak =  1.5e+00 at=  2e-3\nrelease   =   failed\n";
        assert_eq!((measure(said, "peak"), measure(said, "release"), measure(said, "hold")), (Some(1.5), None, None));
        let assert = |less| Assert { name: "x".into(), less, limit: 1.0 };
        let holds = |less, value| Finding { assert: assert(less), value }.holds();
        assert_eq!([holds(true, Some(0.9)), holds(true, Some(1.1)), holds(false, Some(1.1))], [true, false, true]);
        assert_eq!([holds(true, None), holds(false, None), holds(true, Some(f64::NAN))], [false; 3]);
    }

    mod needs_ngspice {
        use super::*;

        #[test]
        #[ignore = "needs ngspice"]
        fn the_driver_is_as_it_must_be() {
            check(&folder()).unwrap();
        }

        #[test]
        #[ignore = "needs ngspice"]
        fn each_part_is_missed_where_it_is_taken_away() {
            assert_eq!(failing("release_dry.cir", "Dclamp 0 rail SMBJ26A", ""), ["rail_peak", "low_peak"]);
            // The clamp of 28 V at the upper end of its tolerance.
            assert_eq!(failing("release_dry.cir", "Bv=31.9", "Bv=34.4"), ["rail_peak"]);
            assert!(failing("release_at_worst.cir", "D2 bottom fused SS56", "").contains(&"low_peak".to_owned()));
            assert_eq!(failing("short_break.cir", "V(amplified)>3.1", "V(amplified)>31"), ["trip", "gone", "fuse"]);
            assert_eq!(failing("short_fuse.cir", "fuse_i2t=1.5", "fuse_i2t=1500"), ["gone", "rest"]);
            assert_eq!(failing("hot_and_weak.cir", "hold_share=0.35", "hold_share=0.25"), ["hold_least"]);
            assert_eq!(failing("rise_hold_release.cir", "l_coil=0.15", "l_coil=1.5").first().unwrap(), "engaged");
            assert!(failing("rise_hold_release.cir", "modulation=20k", "modulation=1k").contains(&"ripple".to_owned()));
        }
    }
}
