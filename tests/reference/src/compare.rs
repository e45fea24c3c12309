//! Comparing a run of this program with one of another.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use crate::effort::Effort;
use crate::ledger::Shares;
use crate::scene::Scene;
use crate::simulate::{Run, run_with};

/// What another program says of a scene's only device.
#[derive(Clone, Debug, Default)]
pub struct Other {
    /// In the words of `summary.json`.
    pub outcome: String,
    /// Times (s) and rotations (rad); of two rows at one time either will do.
    pub history: Vec<[f64; 2]>,
    /// Its ledger, if it keeps one.
    pub ledger: Option<Shares>,
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
    /// Residuals of both ledgers over what came in, this program's first.
    pub residuals: [f64; 2],
    /// Largest difference of their entries, over what came in; 0 of a block that stands, and of one that falls, whose runs end at
    /// different angles.
    pub entries: f64,
}

/// Rotations (over α) beyond which a fall is not compared: nothing comes back from there, and differences grow without bound.
const FALLEN: f64 = 1.5;

/// The outcome of a block that does not move.
const STANDS: &str = "no-rocking";
/// Residual of this program's ledger, over what came in, up to which it closes …
pub const CLOSES: f64 = 1e-9;
/// … and how often its steps are halved until it does.
const MOST_HALVINGS: usize = 2;

/// Compares histories at the samples that both have.
pub fn compare(ours: &Run, theirs: &Other, slenderness: f64) -> Difference {
    let overturned = ours.outcome.starts_with("overturned");
    let mut pairs = Vec::new();
    let mut row = 0;
    for [time, rotation, _] in &ours.samples {
        while row < theirs.history.len() && theirs.history[row][0] < time - 1e-9 {
            row += 1;
        }
        let falls = overturned && rotation.abs() > FALLEN * slenderness;
        match theirs.history.get(row) {
            Some([at, other]) if (at - time).abs() < 1e-9 && !falls => {
                pairs.push((*time, (other - rotation).abs() / slenderness));
            }
            _ => {}
        }
    }
    let history = pairs.iter().fold(0.0_f64, |most, (_, apart)| most.max(*apart));
    let since = pairs.iter().find(|(_, apart)| *apart > 1e-3 * history).map_or(0.0, |(time, _)| *time);
    let shares = ours.ledger.shares();
    let others = theirs.ledger.unwrap_or(shares);
    let stands = ours.outcome == STANDS;
    let residuals = if stands { [0.0; 2] } else { [shares.residual, others.residual] };
    let entries = if overturned || stands { 0.0 } else { shares.apart(&others) };
    Difference { same_outcome: ours.outcome == theirs.outcome, history, since, residuals, entries }
}

/// What a comparison comes to.
#[derive(Clone, Copy, Debug)]
pub enum Verdict {
    /// Outcomes, histories and ledgers agree.
    Agree(Difference),
    /// They do not, and neither does this program with itself at half the step and with a block less slender by four roundings: rounding
    /// decides this motion.
    Chaotic(Difference),
    /// They do not.
    Differ(Difference),
}

/// Differences up to which runs agree.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// |Δθ|/α, and entries of ledgers over what came in.
    pub history: f64,
    /// Residuals of ledgers over what came in: this program's, and the other's.
    pub residuals: [f64; 2],
}

impl Tolerance {
    fn ledgers_close(self, difference: &Difference) -> bool {
        self.residuals.iter().zip(difference.residuals).all(|(most, residual)| residual <= *most)
    }
}

/// A scene and what this program makes of it.
#[derive(Debug)]
pub struct Subject {
    scene: Scene,
    folder: PathBuf,
    effort: Effort,
    ours: Run,
    finer: OnceCell<Result<Run, String>>,
}

impl Subject {
    /// Runs the scene in `text`, whose records lie in `folder`.
    ///
    /// # Errors
    /// What this program says when it cannot run the scene.
    pub fn of(text: &str, folder: &Path) -> Result<Subject, String> {
        let scene = Scene::parse(text)?;
        let run = |effort| run_with(&scene, 0, folder, effort).map_err(|error| format!("ours: {error}"));
        let mut effort = Effort::default();
        let mut ours = run(effort)?;
        // Of a motion that is small beside what the ground asks for, the ledger needs shorter steps.
        for _ in 0..MOST_HALVINGS {
            if ours.outcome == STANDS || ours.ledger.shares().residual <= CLOSES {
                break;
            }
            effort = effort.finer();
            ours = run(effort)?;
        }
        Ok(Subject { scene, folder: folder.to_owned(), effort, ours, finer: OnceCell::new() })
    }

    /// The step of this program (s), which resolves the fastest rate.
    pub fn step(&self) -> f64 {
        self.ours.step
    }

    /// Compares with the run of another program.
    ///
    /// # Errors
    /// What this program says when it cannot run the scene with half the step.
    pub fn against(&self, theirs: &Other, tolerance: Tolerance) -> Result<Verdict, String> {
        let slenderness = self.scene.block.slenderness_deg.to_radians();
        let difference = compare(&self.ours, theirs, slenderness);
        let closes = tolerance.ledgers_close(&difference);
        let apart = difference.history.max(difference.entries);
        if difference.same_outcome && apart <= tolerance.history && closes {
            return Ok(Verdict::Agree(difference));
        }
        let finer = || run_with(&self.scene.nudged(), 0, &self.folder, self.effort.finer());
        let finer = self.finer.get_or_init(finer).as_ref().map_err(|error| format!("ours: {error}"))?;
        let own = compare(&self.ours, &Other::from(finer), slenderness);
        // What one program loses to rounding, the other loses elsewhere: a tenth of the difference is enough to decide.
        let decisive = if apart > tolerance.history { (0.1 * apart).min(tolerance.history) } else { tolerance.history };
        let own_noise = own.history.max(own.entries) > decisive || !own.same_outcome;
        Ok(if own_noise && closes { Verdict::Chaotic(difference) } else { Verdict::Differ(difference) })
    }
}

impl From<&Run> for Other {
    fn from(run: &Run) -> Other {
        let history = run.samples.iter().map(|[time, rotation, _]| [*time, *rotation]);
        Other { outcome: run.outcome.to_owned(), history: history.collect(), ledger: Some(run.ledger.shares()) }
    }
}
