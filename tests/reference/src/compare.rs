//! Comparing a run of this program with one of another.

use std::path::Path;

use crate::generate::Generated;
use crate::scene::Scene;
use crate::simulate::{RESOLUTION, Run, run_at};

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

/// What a comparison comes to.
#[derive(Clone, Copy, Debug)]
pub enum Verdict {
    /// Outcome and history agree.
    Agree(Difference),
    /// They do not, and neither does this program with itself at half the step: rounding decides this motion.
    Chaotic(Difference),
    /// They do not.
    Differ(Difference),
}

/// Differences up to which runs agree.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// |Δθ|/α.
    pub history: f64,
    /// Residual of the ledger over what came in.
    pub residual: f64,
}

/// Writes a scene and its records into `folder`, lets `other` run it there, and compares. `other` gets the scene's path.
///
/// # Errors
/// What either program says when it cannot run the scene.
pub fn check(
    scene: &Generated,
    folder: &Path,
    tolerance: Tolerance,
    other: impl FnOnce(&Path) -> Result<Other, String>,
) -> Result<Verdict, String> {
    let path = folder.join("scene.toml");
    let write = |path: &Path, text: &str| std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()));
    write(&path, &scene.text)?;
    for (name, text) in &scene.files {
        write(&folder.join(name), text)?;
    }
    let parsed = Scene::parse(&scene.text)?;
    let theirs = other(&path).map_err(|error| format!("theirs: {error}"))?;
    let at = |resolution: f64| run_at(&parsed, 0, folder, resolution).map_err(|error| format!("ours: {error}"));
    let slenderness = parsed.block.slenderness_deg.to_radians();
    let ours = at(RESOLUTION)?;
    let difference = compare(&ours, &theirs, slenderness);
    if difference.same_outcome && difference.history <= tolerance.history && difference.residual <= tolerance.residual {
        return Ok(Verdict::Agree(difference));
    }
    let finer = at(RESOLUTION / 2.0)?;
    let own = compare(&ours, &Other::from(&finer), slenderness);
    // What one program loses to rounding, the other loses elsewhere: a tenth of the difference is enough to tell.
    let own_noise = own.history > 0.1 * difference.history || own.history > tolerance.history || !own.same_outcome;
    Ok(if own_noise && difference.residual <= tolerance.residual {
        Verdict::Chaotic(difference)
    } else {
        Verdict::Differ(difference)
    })
}

impl From<&Run> for Other {
    fn from(run: &Run) -> Other {
        let history = run.samples.iter().map(|[time, rotation, _]| [*time, *rotation]);
        Other { outcome: run.outcome.to_owned(), history: history.collect() }
    }
}
