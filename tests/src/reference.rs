//! The reference cells: 1,260 cases and their results in 113-bit arithmetic.

use std::fs::{File, read_to_string};

use sprag_sim::batch::case::Case;
use sprag_sim::batch::table::read_cases;

use crate::shared_file;

/// A reference cell.
pub struct Cell {
    /// Its number.
    pub id: String,
    /// The case.
    pub case: Case,
    /// Its outcome.
    pub outcome: String,
    /// max |θ|/α, of a block that rocks and stands.
    pub peak_rotation: Option<f64>,
    /// max |θ̈|/(p²α), likewise.
    pub peak_acceleration: Option<f64>,
    /// The first impact, in 1/p from the pulse's start.
    pub first_impact_time: Option<f64>,
}

/// All cells.
///
/// # Panics
/// If they are absent.
pub fn cells() -> Vec<Cell> {
    let [cases, answers] = ["reference/cases.csv", "reference/expected.csv"].map(shared_file);
    let cases = read_cases(File::open(cases).expect("a readable file")).expect("a table of cases");
    let text = read_to_string(answers).expect("a readable file");
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().expect("a header").split(',').collect();
    let column = |name: &str| header.iter().position(|known| *known == name).expect("a known column");
    let (id, outcome) = (column("id"), column("outcome"));
    let numbers = ["peak_rotation", "peak_acceleration", "first_impact_time"].map(column);
    let cells: Vec<Cell> = cases
        .into_iter()
        .zip(lines)
        .map(|((own_id, case), line)| {
            let fields: Vec<&str> = line.split(',').collect();
            assert_eq!(own_id, fields[id], "cells and their results are in one order");
            let [peak_rotation, peak_acceleration, first_impact_time] =
                numbers.map(|at| (!fields[at].is_empty()).then(|| fields[at].parse().expect("a number")));
            Cell { id: own_id, case, outcome: fields[outcome].to_owned(), peak_rotation, peak_acceleration, first_impact_time }
        })
        .collect();
    assert_eq!(cells.len(), 1260);
    cells
}

/// Limits of the relative error over the cells that stand: median, 95th percentile and maximum.
const LIMITS: [f64; 3] = [1e-13, 1e-11, 1e-6];

/// Relative errors of one quantity and the cells that they belong to.
#[derive(Debug, Default)]
pub struct RelativeErrors(Vec<(f64, String)>);

impl RelativeErrors {
    /// That of `found` in cell `id`.
    pub fn add(&mut self, found: f64, exact: f64, id: &str) {
        self.0.push(((found / exact - 1.0).abs(), id.to_owned()));
    }

    /// Asserts that there are `count` of them and that they are within what the project promises; prints them.
    ///
    /// # Panics
    /// If not.
    pub fn hold(&mut self, name: &str, count: usize) {
        assert_eq!(self.0.len(), count, "cells with a {name}");
        assert!(self.0.iter().all(|(error, _)| error.is_finite()));
        self.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        let at = |share: f64| self.0[((share * count as f64) as usize).min(count - 1)].0;
        let figures = [at(0.5), at(0.95), at(1.0)];
        let [p50, p95, maximum] = figures;
        println!("{name}: p50 {p50:.1e}, p95 {p95:.1e}, max {maximum:.1e} (cell {})", self.0[count - 1].1);
        for (figure, limit) in figures.into_iter().zip(LIMITS) {
            assert!(figure <= limit, "{name}: {figure:e} is above {limit:e}");
        }
    }
}
