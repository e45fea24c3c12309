//! The maps behind Figures 8, 11 and 12, and what may be asked of them.

use std::sync::LazyLock;

use rayon::prelude::*;
use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::PulseResult;
use sprag_shared::observers::outcome::Outcome;
use sprag_studies::statistics::quantile;
use sprag_tests::shipped::grid;

/// Places of the devices in the scenes.
pub const NONE: usize = 0;
pub const INERTER: usize = 1;
pub const PAIR: usize = 2;
pub const DEVICES: [(usize, &str); 3] = [(NONE, "none"), (INERTER, "inerter"), (PAIR, "pair")];

/// Region 1 and Region 2 of the paper.
pub const REGION_1: Outcome = Outcome::OverturnedWithoutImpact;
pub const REGION_2: Outcome = Outcome::OverturnedAfterImpact;

/// Both models under both pulses: what the paper's figures show of a scene of its own each.
pub const KINDS: [(&str, &str); 4] = [("slender", "sine"), ("slender", "cosine"), ("full", "sine"), ("full", "cosine")];

/// One cell: a pulse, and what becomes of the block with each device.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// ω_g/p.
    pub frequency: f64,
    /// a_g/(g tan α).
    pub amplitude: f64,
    /// Of none, the inerter and the pair.
    pub results: [PulseResult; 3],
}

impl Cell {
    pub fn outcome(&self, device: usize) -> Outcome {
        self.results[device].outcome
    }

    pub fn overturns(&self, device: usize) -> bool {
        self.outcome(device).overturned()
    }

    pub fn stands(&self, device: usize) -> bool {
        self.outcome(device) == Outcome::Safe
    }
}

/// A map or a cut with every device.
pub struct Spectra {
    /// Such as "full sine".
    pub name: String,
    /// Cells row by row, amplitudes upwards.
    pub cells: Vec<Cell>,
    /// Cells of a row.
    pub columns: usize,
}

/// The four maps of σ = 0.5, ω_g/p from 0.2 to 8 and amplitudes from 1 to 10 times the threshold.
pub static SPECTRA: LazyLock<Vec<Spectra>> = LazyLock::new(|| KINDS.map(|kind| Spectra::of(kind, &[])).into_iter().collect());

impl Spectra {
    /// Figure 11 or 12 with `changes`.
    pub fn of((geometry, pulse): (&str, &str), changes: &[&str]) -> Spectra {
        let scene = if pulse == "sine" { "figure12.toml" } else { "figure11.toml" };
        let geometry_key = format!("block.geometry=\"{geometry}\"");
        Spectra::of_scene(&format!("{geometry} {pulse}"), scene, &[&[geometry_key.as_str()], changes].concat())
    }

    /// A panel of Figure 13.
    pub fn cut((geometry, pulse): (&str, &str), amplitude: f64) -> Spectra {
        let changes = [
            format!("block.geometry=\"{geometry}\""),
            format!("ground.0.motion=\"{pulse}\""),
            format!("ground.0.amplitude_ratio={amplitude:?}"),
        ];
        Spectra::of_scene(&format!("{geometry} {pulse} {amplitude}"), "figure13.toml", &changes.each_ref().map(String::as_str))
    }

    fn of_scene(name: &str, scene: &str, changes: &[&str]) -> Spectra {
        let grid = grid(scene, changes);
        let columns = grid.columns();
        let row = |row: usize| {
            let of = |device: usize| {
                let block = |column| grid.pulsed(device, column, row).expect("a value within range").expect("a pulse");
                let blocks: Vec<_> = (0..columns).map(block).collect();
                let results = run(&blocks, Registers::Widest).expect("blocks that can be followed");
                (blocks, results)
            };
            let (blocks, none) = of(NONE);
            let (inerter, pair) = (of(INERTER).1, of(PAIR).1);
            let cell = |column: usize| Cell {
                frequency: blocks[column].frequency_ratio,
                amplitude: blocks[column].amplitude_ratio,
                results: [none[column], inerter[column], pair[column]],
            };
            (0..columns).map(cell).collect::<Vec<Cell>>()
        };
        let rows: Vec<Vec<Cell>> = (0..grid.rows()).into_par_iter().map(row).collect();
        Spectra { name: name.to_owned(), cells: rows.concat(), columns }
    }

    /// Cells that are `such`.
    pub fn count(&self, such: impl Fn(&Cell) -> bool) -> usize {
        self.cells.iter().filter(|cell| such(cell)).count()
    }

    /// Of all cells, those that are `such`, in per cent.
    pub fn share(&self, such: impl Fn(&Cell) -> bool) -> f64 {
        100.0 * self.count(such) as f64 / self.cells.len() as f64
    }

    /// Cells of a region, in per cent of all.
    pub fn region(&self, device: usize, region: Outcome) -> f64 {
        self.share(|cell| cell.outcome(device) == region)
    }

    /// Cells that overturn, in per cent of all.
    pub fn overturned(&self, device: usize) -> f64 {
        self.share(|cell| cell.overturns(device))
    }

    fn frequencies(&self, device: usize, region: Outcome) -> Vec<f64> {
        self.cells.iter().filter(|cell| cell.outcome(device) == region).map(|cell| cell.frequency).collect()
    }

    /// Mean and highest ω_g/p of a region.
    pub fn reach(&self, device: usize, region: Outcome) -> (f64, f64) {
        let found = self.frequencies(device, region);
        (found.iter().sum::<f64>() / found.len() as f64, found.iter().copied().fold(0.0, f64::max))
    }

    /// Peaks of `device` over those of `reference` in the cells that are `such` and in which both rock and stand.
    pub fn ratios(&self, device: usize, reference: usize, such: impl Fn(&Cell) -> bool) -> Ratios {
        let both = |cell: &&Cell| such(cell) && cell.stands(device) && cell.stands(reference);
        let cells: Vec<&Cell> = self.cells.iter().filter(both).collect();
        let of = |peak: fn(&PulseResult) -> f64| {
            Sample(cells.iter().map(|cell| peak(&cell.results[device]) / peak(&cell.results[reference])).collect())
        };
        Ratios { rotation: of(|result| result.peak_rotation), acceleration: of(|result| result.peak_acceleration) }
    }

    /// What `device` takes off the peak acceleration of `reference`, over the same cells.
    pub fn taken_off(&self, device: usize, reference: usize, such: impl Fn(&Cell) -> bool) -> Sample {
        let both = |cell: &&Cell| such(cell) && cell.stands(device) && cell.stands(reference);
        let peak = |cell: &Cell, device: usize| cell.results[device].peak_acceleration;
        Sample(self.cells.iter().filter(both).map(|cell| peak(cell, reference) - peak(cell, device)).collect())
    }
}

/// Ratios of peaks, a value a cell.
pub struct Ratios {
    pub rotation: Sample,
    pub acceleration: Sample,
}

impl std::fmt::Display for Ratios {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "rotation {}; acceleration {}; {} cells", self.rotation, self.acceleration, self.rotation.0.len())
    }
}

/// Values of cells.
pub struct Sample(pub Vec<f64>);

impl Sample {
    pub fn median(&self) -> f64 {
        self.quantile(0.5)
    }

    pub fn quantile(&self, share: f64) -> f64 {
        quantile(&self.0, share).expect("cells")
    }

    /// Values below `limit`, in per cent.
    pub fn below(&self, limit: f64) -> f64 {
        100.0 * self.0.iter().filter(|value| **value < limit).count() as f64 / self.0.len() as f64
    }
}

impl std::fmt::Display for Sample {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [low, median, high] = [0.05, 0.5, 0.95].map(|share| self.quantile(share));
        write!(formatter, "x {median:.3} ({low:.3} to {high:.3}), lower in {:.1} %", self.below(1.0))
    }
}
