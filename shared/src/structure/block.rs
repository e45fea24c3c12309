//! The rigid block of Figure 1.

use super::error::{ParameterError, require};
use crate::math;
use crate::math::scalar::Real;

/// Standard acceleration of gravity, m/s².
pub const GRAVITY: f64 = 9.806_65;

/// λ of a rectangular block: I_O = (4/3) m R².
pub const RECTANGLE_INERTIA_RATIO: f64 = 4.0 / 3.0;

/// A rigid block on two toes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    size: f64,
    slenderness: f64,
    inertia_ratio: f64,
}

impl Block {
    /// A block of `size` R (m, pivot to centre of mass; above 0), `slenderness` α (rad, angle of that line from the
    /// vertical; 0 < α < π/2) and `inertia_ratio` λ = I_O/(mR²) (1 to 4; 4/3 for a rectangle, and never below 1
    /// because the mass is at R on the average).
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range.
    pub fn new(size: f64, slenderness: f64, inertia_ratio: f64) -> Result<Block, ParameterError> {
        Block::within(size, slenderness, inertia_ratio, 4.0, "from 1 to 4")
    }

    /// A block that is more than one body: their centres lie apart, so λ may be any from 1 up.
    pub(crate) fn composite(size: f64, slenderness: f64, inertia_ratio: f64) -> Result<Block, ParameterError> {
        Block::within(size, slenderness, inertia_ratio, f64::MAX, "1 or more, and finite")
    }

    fn within(size: f64, slenderness: f64, inertia_ratio: f64, most: f64, range: &'static str) -> Result<Block, ParameterError> {
        Ok(Block {
            size: require("size", size, size > 0.0, "above 0 m")?,
            slenderness: require(
                "slenderness",
                slenderness,
                slenderness > 0.0 && slenderness < core::f64::consts::FRAC_PI_2,
                "above 0 and below 90 degrees (in rad)",
            )?,
            inertia_ratio: require("inertia_ratio", inertia_ratio, (1.0..=most).contains(&inertia_ratio), range)?,
        })
    }

    /// A block whose frequency parameter p is 1/s, so that seconds read as times 1/p.
    ///
    /// # Errors
    /// The errors of [`Block::new`].
    pub fn of_unit_frequency(slenderness: f64, inertia_ratio: f64) -> Result<Block, ParameterError> {
        Block::new(GRAVITY / inertia_ratio, slenderness, inertia_ratio)
    }

    /// R, m.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// α, rad.
    pub fn slenderness(&self) -> f64 {
        self.slenderness
    }

    /// λ = I_O/(mR²).
    pub fn inertia_ratio(&self) -> f64 {
        self.inertia_ratio
    }

    /// p² = g/(λR), 1/s²; for a rectangle 3g/(4R) (after Eq. 2).
    pub fn frequency_parameter_squared(&self) -> f64 {
        GRAVITY / (self.inertia_ratio * self.size)
    }

    /// p, 1/s.
    pub fn frequency_parameter(&self) -> f64 {
        math::square_root(self.frequency_parameter_squared())
    }

    /// Restitution of an impact without bouncing, by moment of momentum about the new toe (Housner 1963):
    /// η = 1 − 2 sin²α / λ, which is 1 − (3/2) sin²α for a rectangle. Negative when the block is too stocky to rock on.
    pub fn geometric_restitution(&self) -> f64 {
        let sine = math::sin(self.slenderness);
        1.0 - 2.0 * sine * sine / self.inertia_ratio
    }
}

/// Which equation of motion: the exact one or its linearisation for a slender block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Geometry {
    /// Eq. 15-16.
    #[default]
    Full,
    /// Eq. 17-18: sin δ → δ, cos δ → 1, ℓ constant.
    Slender,
}

impl Geometry {
    /// Ground acceleration, in g, above which a block of this `slenderness` (rad) uplifts from rest: tan α (Eq. 1), or α for the slender model.
    pub fn uplift_threshold(self, slenderness: f64) -> f64 {
        match self {
            Geometry::Full => math::tan(slenderness),
            Geometry::Slender => slenderness,
        }
    }

    /// |θ| (rad) beyond which an outward motion never returns under a ground acceleration that stays within
    /// ±`ground_bound` (in g): there the weight's overturning moment outweighs any push. Full: α + atan(bound), at most
    /// π/2, where the block lies on the ground; slender: α + bound.
    pub fn point_of_no_return(self, slenderness: f64, ground_bound: f64) -> f64 {
        match self {
            Geometry::Full => (slenderness + math::atan(ground_bound)).min(core::f64::consts::FRAC_PI_2),
            Geometry::Slender => slenderness + ground_bound,
        }
    }

    /// Sine and cosine of an angle δ (rad) of the geometry.
    pub fn sin_cos<S: Real>(self, delta: S) -> (S, S) {
        match self {
            Geometry::Full => delta.sin_cos(),
            Geometry::Slender => (delta, S::ONE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_has_the_papers_frequency_parameter_and_housners_restitution() {
        let block = Block::new(2.0, 10.0_f64.to_radians(), RECTANGLE_INERTIA_RATIO).unwrap();
        assert!((block.frequency_parameter() - (3.0 * GRAVITY / 8.0).sqrt()).abs() < 1e-15);
        assert!((block.geometric_restitution() - 0.9548).abs() < 5e-5);
        let unit = Block::of_unit_frequency(0.3, 1.7).unwrap();
        assert!((unit.frequency_parameter() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_parameter_outside_its_range_is_named() {
        let error = |size, slenderness, ratio| Block::new(size, slenderness, ratio).unwrap_err().parameter;
        assert_eq!(error(0.0, 0.2, 1.3), "size");
        assert_eq!(error(f64::INFINITY, 0.2, 1.3), "size");
        assert_eq!(error(1.0, 1.6, 1.3), "slenderness");
        assert_eq!(error(1.0, f64::NAN, 1.3), "slenderness");
        assert_eq!(error(1.0, 0.2, 0.9), "inertia_ratio");
    }

    #[test]
    fn beyond_the_point_of_no_return_the_bracket_pushes_outward() {
        let block = Block::new(1.0, 0.2, RECTANGLE_INERTIA_RATIO).unwrap();
        for bound in [0.0, 0.3, 2.0] {
            let angle = Geometry::Full.point_of_no_return(block.slenderness(), bound);
            if angle < 1.57 {
                let delta = 0.2 - (angle + 1e-9);
                assert!(math::sin(delta) + bound * math::cos(delta) < 0.0);
            }
        }
    }
}
