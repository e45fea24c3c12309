//! A device of one size, and what it comes to over all motions.

use sprag_shared::math;
use sprag_shared::observers::outcome::Outcome;

use super::limit::{Limits, Quantity};
use super::objective::Objective;
use super::response::Response;
use crate::statistics::{order_statistic, quantile};

/// A device to be tried.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Number of its law and mount.
    pub curve: usize,
    /// σ.
    pub mass_ratio: f64,
    /// By how much its clutches are later than its law says, s.
    pub delay_s: f64,
}

impl Candidate {
    /// The one of the same law and mount halfway to `other`, by factors.
    pub fn halfway(self, other: Candidate) -> Candidate {
        Candidate { mass_ratio: math::square_root(self.mass_ratio * other.mass_ratio), ..self }
    }
}

/// The responses of one design, motion by motion; in words why there is none.
pub type Responses = Vec<Result<Response, String>>;

/// A device that was tried, or the bare block.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The device; `None` is the bare block.
    pub candidate: Option<Candidate>,
    /// What the block does under each motion.
    pub responses: Responses,
    /// What that comes to.
    pub score: Score,
}

/// What a design comes to over all motions.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Score {
    /// Motions with a response.
    pub motions: usize,
    /// Number of motions that overturn the block; each counts once a specimen.
    pub overturned: usize,
    /// What is made small: the mean of that over the specimens, or a quantile.
    pub objective: f64,
    /// Motions without a response.
    pub failed: usize,
    /// Those that overturn the bare block, and not this one.
    pub saved: usize,
    /// Those that overturn this one, and not the bare block.
    pub newly_overturned: usize,
    /// Quantile of max |F|/(mg) over the motions whose force counts; `None` where none does.
    pub force_ratio: Option<f64>,
    /// Quantile of the stroke over the motions in which the block stands, m; `None` where it never does.
    pub stroke_m: Option<f64>,
    /// Quantile of the bending stress of gear teeth over the motions whose force counts, MPa; `None` where the scene has no gear.
    pub tooth_stress_mpa: Option<f64>,
    /// Quantile of the energy of the coils over the motions whose force counts, J; `None` where the device has none.
    pub coil_energy_j: Option<f64>,
    /// Median of max |θ|/α over the motions that rock the bare block, where overturning counts as infinite.
    pub median_rotation: f64,
}

impl Score {
    /// Of `responses`, beside those of the `bare` block under the same motions; `limits` say of what quantile.
    ///
    /// The force on a block that overturns counts unless it is set not to: its support has to bear it as long as there is something to
    /// save, and a design must not respect a limit by losing the block. The travel does not count there: a block that lies down takes
    /// the terminals farther than any stroke that could be meant.
    ///
    /// Rotations are compared over the same motions for every design. Leaving out those that overturn the block would compare each
    /// design over motions of its own, and reward the one that overturns under the strong ones.
    pub fn of(responses: &Responses, bare: &Responses, limits: &Limits, objective: Objective) -> Score {
        let mut score = Score::default();
        let (mut forces, mut strokes, mut rotations) = (Vec::new(), Vec::new(), Vec::new());
        let (mut stresses, mut energies) = (Vec::new(), Vec::new());
        let each = (responses.len() / objective.specimens.max(1)).max(1);
        let overturned =
            |response: &&Result<Response, String>| response.as_ref().is_ok_and(|response| response.outcome.overturned());
        let counts = responses.chunks(each).map(|specimen| specimen.iter().filter(overturned).count() as u64);
        score.objective = objective.of(&counts.collect::<Vec<u64>>());
        for (response, bare) in responses.iter().zip(bare) {
            let Ok(response) = response else {
                score.failed += 1;
                continue;
            };
            let overturned = response.outcome.overturned();
            score.motions += 1;
            score.overturned += usize::from(overturned);
            if !overturned || limits.force_of_overturned {
                forces.push(response.force_ratio);
                stresses.extend(response.tooth_stress_mpa);
                energies.extend(response.coil_energy_j);
            }
            if !overturned {
                strokes.push(response.stroke_m);
            }
            let Ok(bare) = bare else { continue };
            score.saved += usize::from(bare.outcome.overturned() && !overturned);
            score.newly_overturned += usize::from(!bare.outcome.overturned() && overturned);
            if bare.outcome != Outcome::NoRocking {
                rotations.push(response.peak_rotation.unwrap_or(f64::INFINITY));
            }
        }
        // At least the share must respect a limit, which what lies between two motions would not say.
        let held = |values: &[f64]| order_statistic(values, limits.quantile);
        score.force_ratio = held(&forces);
        score.stroke_m = held(&strokes);
        score.tooth_stress_mpa = held(&stresses);
        score.coil_energy_j = held(&energies);
        score.median_rotation = quantile(&rotations, 0.5).unwrap_or(0.0);
        score
    }

    /// Share of the motions that overturn the block, in the mean over the specimens.
    pub fn share(&self) -> f64 {
        self.overturned as f64 / (self.motions as f64).max(1.0)
    }

    /// What it asks for of `quantity`; nothing where no motion counts, and of what the scene or the device does not have.
    pub fn asks(&self, quantity: Quantity) -> f64 {
        match quantity {
            Quantity::Force => self.force_ratio.unwrap_or(0.0),
            Quantity::Stroke => self.stroke_m.unwrap_or(0.0),
            Quantity::ToothStress => self.tooth_stress_mpa.unwrap_or(0.0),
            Quantity::CoilEnergy => self.coil_energy_j.unwrap_or(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits::NONE;

    fn stands(peak: f64, force_ratio: f64, stroke_m: f64) -> Result<Response, String> {
        let outcome = if peak > 0.0 { Outcome::Safe } else { Outcome::NoRocking };
        Ok(Response {
            outcome,
            peak_rotation: Some(peak),
            force_ratio,
            stroke_m,
            tooth_stress_mpa: Some(100.0 * force_ratio),
            coil_energy_j: None,
            error: None,
        })
    }

    fn falls(force_ratio: f64, stroke_m: f64) -> Result<Response, String> {
        let outcome = Outcome::OverturnedAfterImpact;
        Ok(Response {
            outcome,
            peak_rotation: None,
            force_ratio,
            stroke_m,
            tooth_stress_mpa: Some(100.0 * force_ratio),
            coil_energy_j: None,
            error: None,
        })
    }

    fn bare() -> Responses {
        vec![stands(0.0, 0.0, 0.0), stands(0.4, 0.0, 0.1), falls(0.0, 2.0), falls(0.0, 2.0), stands(0.6, 0.0, 0.2)]
    }

    #[test]
    fn motions_are_counted_beside_the_bare_block() {
        let responses =
            vec![stands(0.0, 0.0, 0.0), falls(0.5, 1.9), stands(0.8, 0.2, 0.3), falls(0.6, 1.9), stands(0.2, 0.1, 0.1)];
        let score = Score::of(&responses, &bare(), &LIMITS, Objective::NOMINAL);
        assert_eq!((score.motions, score.overturned, score.saved, score.newly_overturned), (5, 2, 1, 1));
        // The force on a falling block counts, and the stress that it means; its travel does not.
        assert_eq!((score.force_ratio, score.stroke_m), (Some(0.6), Some(0.3)));
        assert_eq!((score.tooth_stress_mpa, score.coil_energy_j, score.asks(Quantity::CoilEnergy)), (Some(60.0), None, 0.0));
        let standing = Score::of(&responses, &bare(), &Limits { force_of_overturned: false, ..LIMITS }, Objective::NOMINAL);
        assert_eq!((standing.force_ratio, standing.stroke_m), (Some(0.2), Some(0.3)));
        let fallen = vec![falls(0.5, 1.9); 5];
        let of_none = Score::of(&fallen, &bare(), &Limits { force_of_overturned: false, ..LIMITS }, Objective::NOMINAL);
        assert_eq!((of_none.force_ratio, of_none.asks(Quantity::Force)), (None, 0.0));
        // The median of 0.2, 0.8 and twice infinite.
        assert_eq!(score.median_rotation, f64::INFINITY);
    }

    #[test]
    fn quantiles_relax_a_limit() {
        let responses: Responses = (0..=10).map(|k| stands(0.1, 0.1 * f64::from(k), f64::from(k))).collect();
        let bare = responses.clone();
        let of = |quantile: f64| Score::of(&responses, &bare, &Limits { quantile, ..LIMITS }, Objective::NOMINAL);
        assert_eq!((of(1.0).force_ratio, of(1.0).stroke_m), (Some(1.0), Some(10.0)));
        assert!((of(0.9).force_ratio.unwrap() - 0.9).abs() < 1e-15 && (of(0.5).stroke_m.unwrap() - 5.0).abs() < 1e-15);
    }

    #[test]
    fn the_share_of_a_limit_is_kept_by_whole_motions() {
        // 0.9 of 4 motions are all of them, of 28 motions 26.
        for (motions, quantile, respect) in [(4, 0.9, 4), (28, 0.9, 26), (10, 0.5, 5), (3, 0.0, 1)] {
            let responses: Responses = (1..=motions).map(|k| stands(0.1, 0.1 * f64::from(k), 0.1)).collect();
            for held in 1..=motions {
                let limits = Limits { force: Some(0.1 * f64::from(held)), quantile, ..LIMITS };
                let score = Score::of(&responses, &responses, &limits, Objective::NOMINAL);
                assert_eq!(limits.allow(&score), held >= respect, "{held} of {motions} at {quantile}");
            }
        }
    }

    #[test]
    fn motions_that_do_not_rock_the_bare_block_do_not_hide_the_others() {
        let quiet = || stands(0.0, 0.0, 0.0);
        let [bare, design] = [0.8, 0.3].map(|peak| -> Responses { vec![quiet(), quiet(), quiet(), stands(peak, 0.1, 0.1)] });
        assert_eq!(Score::of(&design, &bare, &LIMITS, Objective::NOMINAL).median_rotation, 0.3);
        assert_eq!(Score::of(&bare, &bare, &LIMITS, Objective::NOMINAL).median_rotation, 0.8);
    }

    #[test]
    fn specimens_are_averaged_or_the_worst_of_them_counts() {
        let one = [falls(0.1, 1.0), stands(0.3, 0.1, 0.1), stands(0.3, 0.1, 0.1)];
        let other = [falls(0.1, 1.0), falls(0.1, 1.0), falls(0.1, 1.0)];
        let responses: Responses = one.into_iter().chain(other).collect();
        let of = |quantile| Score::of(&responses, &responses, &LIMITS, Objective { specimens: 2, quantile }).objective;
        assert_eq!([of(None), of(Some(0.0)), of(Some(0.5)), of(Some(1.0))], [2.0, 1.0, 2.0, 3.0]);
        // The same specimen twice is the specimen.
        let twice: Responses = responses[..3].iter().chain(&responses[..3]).cloned().collect();
        let nominal = Score::of(&responses[..3].to_vec(), &responses[..3].to_vec(), &LIMITS, Objective::NOMINAL);
        let doubled = Score::of(&twice, &twice, &LIMITS, Objective { specimens: 2, quantile: None });
        assert_eq!((doubled.objective, doubled.median_rotation), (nominal.objective, nominal.median_rotation));
    }

    #[test]
    fn a_run_that_failed_is_no_motion() {
        let mut responses = bare();
        responses[2] = Err("stopped".to_owned());
        let score = Score::of(&responses, &bare(), &LIMITS, Objective::NOMINAL);
        assert_eq!((score.motions, score.failed, score.overturned, score.saved), (4, 1, 1, 0));
    }
}
