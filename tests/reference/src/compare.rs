//! Comparing a run of this program with one of another.

use std::path::Path;

use crate::generate::Generated;
use crate::scene::Scene;
use crate::simulate::{Run, run};

/// What another program says of a scene's only device.
#[derive(Clone, Debug, Default)]
pub struct Other {
    /// In the words of `summary.json`.
    pub outcome: String,
    /// Times (s) and rotations (rad); of two rows at one time either will do.
    pub history: Vec<[f64; 2]>,
}

/// How far two runs are apart.
#[derive(Clone, Copy, Debug)]
pub struct Difference {
    /// The outcomes are the same.
    pub same_outcome: bool,
    /// Largest |Δθ|/α.
    pub history: f64,
    /// When it was first beyond a thousandth of that, s.
    pub since: f64,
    /// Residual of this program's ledger over what came in.
    pub residual: f64,
}

/// Rotations (over α) beyond which a fall is not compared: nothing comes back from there, and differences grow without bound.
const FALLEN: f64 = 1.5;

/// Compares histories at the samples that both have.
pub fn compare(ours: &Run, theirs: &Other, slenderness: f64) -> Difference {
    let mut pairs = Vec::new();
    let mut row = 0;
    for [time, rotation, _] in &ours.samples {
        while row < theirs.history.len() && theirs.history[row][0] < time - 1e-9 {
            row += 1;
        }
        let falls = ours.outcome.starts_with("overturned") && rotation.abs() > FALLEN * slenderness;
        match theirs.history.get(row) {
            Some([at, other]) if (at - time).abs() < 1e-9 && !falls => {
                pairs.push((*time, (other - rotation).abs() / slenderness));
            }
            _ => {}
        }
    }
    let history = pairs.iter().fold(0.0_f64, |most, (_, apart)| most.max(*apart));
    let since = pairs.iter().find(|(_, apart)| *apart > 1e-3 * history).map_or(0.0, |(time, _)| *time);
    let income = ours.ledger.income().max(f64::MIN_POSITIVE);
    let residual = ours.ledger.residual().abs() / income;
    Difference { same_outcome: ours.outcome == theirs.outcome, history, since, residual }
}

/// Writes a scene and its records into `folder`, lets `other` run it there, and compares. `other` gets the scene's path.
///
/// # Errors
/// What either program says when it cannot run the scene.
pub fn check(
    scene: &Generated,
    folder: &Path,
    other: impl FnOnce(&Path) -> Result<Other, String>,
) -> Result<Difference, String> {
    let path = folder.join("scene.toml");
    let write = |path: &Path, text: &str| std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()));
    write(&path, &scene.text)?;
    for (name, text) in &scene.files {
        write(&folder.join(name), text)?;
    }
    let parsed = Scene::parse(&scene.text)?;
    let theirs = other(&path).map_err(|error| format!("theirs: {error}"))?;
    let ours = run(&parsed, 0, folder).map_err(|error| format!("ours: {error}"))?;
    Ok(compare(&ours, &theirs, parsed.block.slenderness_deg.to_radians()))
}
