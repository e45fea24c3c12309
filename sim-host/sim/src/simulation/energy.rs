//! The energy ledger in results: shares of the barrier mgR(1 − cos α) that a block must pass to overturn by itself (slender:
//! mgRα²/2).

use serde::Serialize;
use sprag_shared::observers::ledger::Entries;

use super::DeviceRun;
use crate::history::HistoryError;

/// Where the energy of a run went.
#[derive(Clone, Debug, Serialize)]
pub struct EnergyReport {
    /// At the end.
    #[serde(flatten)]
    pub entries: Shares,
    /// Over time, s.
    #[serde(skip)]
    pub history: Vec<(f64, Shares)>,
}

/// [`Entries`] over the barrier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shares {
    /// What was there at the start.
    pub initial: f64,
    /// Work of the ground.
    pub input: f64,
    /// Created by ideal clutches.
    pub created: f64,
    /// Kinetic energy of the block.
    pub kinetic: f64,
    /// Its potential energy.
    pub potential: f64,
    /// Flywheels, rack and springs.
    pub stored: f64,
    /// Gone in impacts.
    pub impact: f64,
    /// In clutches.
    pub clutch: f64,
    /// In brakes.
    pub brake: f64,
    /// In bearings.
    pub bearing: f64,
    /// In the rack.
    pub rack: f64,
    /// Taken without a cause by the paper's kinematics.
    pub kinematics: f64,
    /// What does not add up.
    pub residual: f64,
}

impl From<Entries<f64>> for Shares {
    fn from(entries: Entries<f64>) -> Shares {
        let residual = entries.residual();
        let Entries { initial, input, created, kinetic, potential, stored, impact, clutch, brake, bearing, rack, kinematics } =
            entries;
        Shares { initial, input, created, kinetic, potential, stored, impact, clutch, brake, bearing, rack, kinematics, residual }
    }
}

/// The columns of the energy table, after the device and the time.
pub const COLUMNS: [&str; 13] = [
    "initial",
    "input",
    "created",
    "kinetic",
    "potential",
    "stored",
    "impact",
    "clutch",
    "brake",
    "bearing",
    "rack",
    "kinematics",
    "residual",
];

impl Shares {
    /// In the order of [`COLUMNS`].
    pub fn row(&self) -> [f64; 13] {
        [
            self.initial,
            self.input,
            self.created,
            self.kinetic,
            self.potential,
            self.stored,
            self.impact,
            self.clutch,
            self.brake,
            self.bearing,
            self.rack,
            self.kinematics,
            self.residual,
        ]
    }
}

/// Writes the ledgers of `runs` as one long-form CSV table: device, time (s) and [`COLUMNS`].
///
/// # Errors
/// When `out` does not take the bytes.
pub fn write_energy(runs: &[DeviceRun], out: &mut impl std::io::Write) -> Result<(), HistoryError> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["device", "time_s"].into_iter().chain(COLUMNS))?;
    for run in runs {
        for (time, shares) in run.energy.iter().flat_map(|energy| &energy.history) {
            table.write_field(&run.device)?;
            table.write_field(format!("{time:?}"))?;
            for share in shares.row() {
                table.write_field(format!("{share:?}"))?;
            }
            table.write_record(None::<&[u8]>)?;
        }
    }
    table.flush()?;
    Ok(())
}
