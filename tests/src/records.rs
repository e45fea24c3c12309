//! The recorded motions beside the repository, as their index describes them.

use std::collections::BTreeSet;
use std::fs::read_to_string;
use std::path::PathBuf;

use crate::shared_file;

/// A recorded motion.
#[derive(Clone, Debug)]
pub struct RecordedMotion {
    /// The name of its file.
    pub name: String,
    /// That file.
    pub path: PathBuf,
    /// The layout of the file, in the words of the index.
    pub format: String,
    /// Time between its samples, s.
    pub time_step_s: f64,
    /// Their number.
    pub samples: usize,
    /// Its peak acceleration, g.
    pub pga_g: f64,
    /// Its peak velocity, m/s.
    pub pgv_m_s: f64,
    /// Whether it is an unscaled pulse-like horizontal motion of an earthquake of the paper's Table 1, and no second copy of one.
    pub pulse_like: bool,
}

impl RecordedMotion {
    /// The units of a file that says neither them nor its time step.
    pub fn unsaid_units(&self) -> Option<&'static str> {
        match self.format.as_str() {
            "g3" => Some("g"),
            "6col" => Some("cm/s2"),
            _ => None,
        }
    }
}

/// All of them.
///
/// # Panics
/// If they are absent.
pub fn recorded_motions() -> Vec<RecordedMotion> {
    let index = read_to_string(shared_file("records/INDEX.tsv")).expect("a readable file");
    let mut lines = index.lines();
    let header: Vec<&str> = lines.next().expect("a header").split('\t').collect();
    let mut counted = BTreeSet::new();
    let motions: Vec<RecordedMotion> = lines
        .map(|line| {
            let fields: Vec<&str> = line.split('\t').collect();
            let field = |title: &str| fields[header.iter().position(|known| *known == title).expect("a known column")];
            let number = |title: &str| field(title).parse().expect("a number");
            let name = field("file");
            let pulse = field("pulse_baker2007") == "yes"
                || field("pulse_shahi_baker_unverified") == "yes"
                || field("fema_p695") == "NF-pulse";
            let horizontal = !field("component").to_ascii_uppercase().contains(['U', 'V']);
            let of_the_paper = field("table1_event") == "yes" && field("scaled") == "no";
            let copies = match field("RSN") {
                "" => name.to_owned(),
                earthquake => format!("{earthquake} {}", field("component")),
            };
            RecordedMotion {
                path: shared_file("records").join(name),
                name: name.to_owned(),
                format: field("format").to_owned(),
                time_step_s: number("dt_s"),
                samples: field("npts").parse().expect("a count"),
                pga_g: number("PGA_g"),
                pgv_m_s: number("PGV_m_s"),
                pulse_like: pulse && horizontal && of_the_paper && counted.insert(copies),
            }
        })
        .collect();
    assert_eq!(motions.len(), 228);
    motions
}
