//! What scatters of block and controller: the specimens under which every design of a robust study is tried.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde::Serialize;
use sprag_shared::structure::Restitution;
use sprag_shared::structure::error::ParameterError;
use sprag_sim::scene::Scene;
use sprag_sim::scene::controller::BeliefTable;
use sprag_sim::scene::schema::RestitutionValue;

use super::table::RobustTable;
use crate::statistics::resample::below;

/// Number of the first stream. Lower ones of the same seed belong to ground motions, sensors and resamples.
const FIRST_STREAM: u64 = 1 << 56;

/// What scatters, as factors on what the scene says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Specimen {
    /// On the restitution η, as drawn. Where η(1 + width) is above 1, η lies at the same part of the range up to 1.
    pub restitution: f64,
    /// Half-width within which that was drawn.
    #[serde(skip)]
    pub restitution_width: f64,
    /// On the slenderness α that a controller believes in.
    pub slenderness_belief: f64,
    /// On the size R that a controller believes in.
    pub size_belief: f64,
    /// On the mass ratio σ that a controller believes in.
    pub mass_ratio_belief: f64,
    /// On the restitution η that a controller believes in.
    pub restitution_belief: f64,
    /// Seed of the sensors.
    pub sensors: u64,
}

/// Block and controller as the scene says.
pub const NOMINAL: Specimen = Specimen {
    restitution: 1.0,
    restitution_width: 0.0,
    slenderness_belief: 1.0,
    size_belief: 1.0,
    mass_ratio_belief: 1.0,
    restitution_belief: 1.0,
    sensors: 1,
};

/// The specimens of `table`, the same for every design: a Latin hypercube (McKay, Beckman and Conover 1979, Technometrics 21(2)), so that
/// few cover the whole width of each quantity. The nominal one without a table.
pub fn specimens(table: Option<&RobustTable>) -> Vec<Specimen> {
    let Some(table) = table else { return vec![NOMINAL] };
    let number = table.samples as usize;
    let widths =
        [table.restitution, table.slenderness_belief, table.size_belief, table.mass_ratio_belief, table.restitution_belief];
    let factors: Vec<Vec<f64>> = widths
        .into_iter()
        .enumerate()
        .map(|(quantity, width)| {
            let mut words = ChaCha8Rng::seed_from_u64(table.seed);
            words.set_stream(FIRST_STREAM + quantity as u64);
            let mut below = |most: u64| below(words.next_u64(), most) as usize;
            let mut strata: Vec<usize> = (0..number).collect();
            (1..number).rev().for_each(|last| strata.swap(last, below(last as u64 + 1)));
            let steps = 1 << 20;
            let place = |stratum: usize, part: usize| (stratum as f64 + part as f64 / f64::from(steps)) / number as f64;
            strata.into_iter().map(|stratum| 1.0 + width * (2.0 * place(stratum, below(steps as u64)) - 1.0)).collect()
        })
        .collect();
    let specimen = |index: usize| Specimen {
        restitution: factors[0][index],
        restitution_width: table.restitution,
        slenderness_belief: factors[1][index],
        size_belief: factors[2][index],
        mass_ratio_belief: factors[3][index],
        restitution_belief: factors[4][index],
        sensors: 1 + index as u64,
    };
    (0..number).map(specimen).collect()
}

impl Specimen {
    /// `scene`, of one device, with the restitution of this specimen.
    ///
    /// # Errors
    /// [`ParameterError`] where the scene has no restitution of its own.
    pub fn of(&self, mut scene: Scene) -> Result<Scene, ParameterError> {
        if self.restitution_width > 0.0 {
            let eta = self.scattered(scene.structure(0).loaded()?.restitution()?);
            scene.restitution = Restitution::Constant(eta);
            scene.file.block.restitution = RestitutionValue::Number(eta);
        }
        Ok(scene)
    }

    /// The restitution of this specimen of a block whose own is `eta`: uniform between η(1 − w) and the smaller of η(1 + w) and 1.
    fn scattered(&self, eta: f64) -> f64 {
        let width = self.restitution_width;
        if (1.0 + width) * eta <= 1.0 {
            return self.restitution * eta;
        }
        let least = (1.0 - width) * eta;
        let place = (self.restitution - (1.0 - width)) / (2.0 * width);
        least + place * (1.0 - least)
    }

    /// What a controller believes that by itself believes in `belief`.
    pub fn belief(&self, belief: BeliefTable) -> BeliefTable {
        BeliefTable {
            slenderness_factor: self.slenderness_belief * belief.slenderness_factor,
            size_factor: self.size_belief * belief.size_factor,
            mass_ratio_factor: self.mass_ratio_belief * belief.mass_ratio_factor,
            restitution_factor: self.restitution_belief * belief.restitution_factor,
            ..belief
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(samples: u32, seed: u64) -> RobustTable {
        RobustTable { samples, seed, restitution: 0.2, slenderness_belief: 0.05, ..RobustTable::default() }
    }

    #[test]
    fn each_stratum_of_each_quantity_is_there_once() {
        let all = specimens(Some(&table(10, 3)));
        for (value, width) in [(|one: &Specimen| one.restitution) as fn(&Specimen) -> f64, |one| one.slenderness_belief]
            .into_iter()
            .zip([0.2, 0.05])
        {
            let mut strata: Vec<usize> = all.iter().map(|one| (5.0 * ((value(one) - 1.0) / width + 1.0)) as usize).collect();
            assert_ne!(strata, (0..10).collect::<Vec<usize>>(), "in no order");
            strata.sort_unstable();
            assert_eq!(strata, (0..10).collect::<Vec<usize>>());
        }
        assert!(all.iter().all(|one| one.size_belief == 1.0));
        assert_eq!(all, specimens(Some(&table(10, 3))));
        assert_ne!(all, specimens(Some(&table(10, 4))));
    }

    /// A specimen in each tenth of a range that 1 ends, as in each of one that stays below.
    #[test]
    fn restitutions_up_to_1_are_as_uniform_as_those_below() {
        let all = specimens(Some(&table(10, 3)));
        for (eta, most) in [(0.8, 0.96), (0.95, 1.0), (1.0, 1.0)] {
            let least = 0.8 * eta;
            let stratum = |one: &Specimen| (10.0 * (one.scattered(eta) - least) / (most - least)) as usize;
            let mut strata: Vec<usize> = all.iter().map(stratum).collect();
            strata.sort_unstable();
            assert_eq!(strata, (0..10).collect::<Vec<usize>>(), "{eta}");
        }
        assert!(all.iter().all(|one| one.scattered(0.8) == one.restitution * 0.8), "the bits of a plain factor");
    }

    #[test]
    fn without_scatter_a_specimen_is_the_nominal_one() {
        assert_eq!(specimens(None), [NOMINAL]);
        let still = RobustTable { samples: 3, restitution: 0.0, ..RobustTable::default() };
        let all = specimens(Some(&still));
        assert!(all.len() == 3 && all.iter().all(|one| Specimen { sensors: 1, ..*one } == NOMINAL));
    }
}
