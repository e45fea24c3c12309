//! Mounts of an inerter (Figure 3), and the constants of their levers ([`crate::equation::lever`]).

use super::block::{Block, Geometry};
use super::error::{ParameterError, require};
use crate::equation::lever::{Lever, TyingPoint};
use crate::math;

/// Where the inerter is attached (Figure 3) and through what pulley ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mount {
    /// Horizontal, at the centre of mass (Figure 3b, Figure 4).
    CentreOfMass,
    /// Horizontal, at a point on the block's centre line, `height` (m) above the base, through a pulley that lets the
    /// terminal travel `pulley_ratio` times as far as the point (Figure 3b-c).
    TyingPoint {
        /// m, above 0.
        height: f64,
        /// n, above 0; 1 without a pulley.
        pulley_ratio: f64,
    },
    /// A pair of vertical inerters at the base corners (Figure 3a), each working while its corner is up.
    BaseCorners {
        /// n, above 0; 1 without a pulley.
        pulley_ratio: f64,
    },
}

impl Mount {
    /// The constants of ℓ = A cos δ + s B sin δ for a block with half width R sin α and centre of mass at R cos α.
    ///
    /// A point (0, z) of the centre line lies at (−s R sin α, z) from the toe, so its horizontal travel per radian is
    /// z cos θ + R sin α |sin θ|; a raised corner lies 2 R sin α from the toe and rises by 2 R sin α cos θ per radian.
    /// With θ = αs − δ both take the form above.
    ///
    /// # Errors
    /// [`ParameterError`] for a height or a ratio not above 0.
    pub fn lever(&self, block: &Block) -> Result<TyingPoint<f64>, ParameterError> {
        let (sin, cos) = math::sin_cos(block.slenderness());
        match *self {
            Mount::CentreOfMass => Ok(TyingPoint { along: 1.0, across: 0.0 }),
            Mount::TyingPoint { height, pulley_ratio } => {
                require("height", height, height > 0.0, "above 0 m")?;
                let n = ratio(pulley_ratio)?;
                let z = height / block.size();
                Ok(TyingPoint { along: n * (z * cos + sin * sin), across: n * (z * sin - sin * cos) })
            }
            Mount::BaseCorners { pulley_ratio } => {
                let n = ratio(pulley_ratio)?;
                Ok(TyingPoint { along: n * 2.0 * sin * cos, across: n * 2.0 * sin * sin })
            }
        }
    }

    /// ℓ² of the slender model, where ℓ is a constant: 1, n z/R, or 2 n α.
    ///
    /// # Errors
    /// The errors of [`Mount::lever`].
    pub fn slender_lever_squared(&self, block: &Block) -> Result<f64, ParameterError> {
        self.lever(block)?;
        let lever = match *self {
            Mount::CentreOfMass => 1.0,
            Mount::TyingPoint { height, pulley_ratio } => pulley_ratio * height / block.size(),
            Mount::BaseCorners { pulley_ratio } => 2.0 * pulley_ratio * block.slenderness(),
        };
        Ok(lever * lever)
    }

    /// Travel of the terminals over a horizontal travel of the support; none of a vertical device.
    pub fn support_ratio(&self) -> Option<f64> {
        match *self {
            Mount::CentreOfMass => Some(1.0),
            Mount::TyingPoint { pulley_ratio, .. } => Some(pulley_ratio),
            Mount::BaseCorners { .. } => None,
        }
    }

    /// ℓ at θ (rad), per R.
    ///
    /// # Errors
    /// The errors of [`Mount::lever`].
    pub fn lever_at(&self, block: &Block, geometry: Geometry, rotation: f64) -> Result<f64, ParameterError> {
        if geometry == Geometry::Slender {
            return Ok(math::square_root(self.slender_lever_squared(block)?));
        }
        let lever = self.lever(block)?;
        let side = if rotation < 0.0 { -1.0 } else { 1.0 };
        let (sin, cos) = math::sin_cos(block.slenderness() * side - rotation);
        Ok(lever.arm(side, sin, cos))
    }
}

fn ratio(pulley_ratio: f64) -> Result<f64, ParameterError> {
    require("pulley_ratio", pulley_ratio, pulley_ratio > 0.0, "above 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Horizontal travel of the point (0, z) and rise of the free corner, by turning the block as a drawing.
    fn travel(mount: &Mount, block: &Block, rotation: f64) -> f64 {
        let half_width = block.size() * math::sin(block.slenderness());
        let side = if rotation < 0.0 { -1.0 } else { 1.0 };
        let (sin, cos) = math::sin_cos(rotation);
        // Clockwise for positive rotation, about the toe at side · half_width.
        match *mount {
            Mount::CentreOfMass => -side * half_width * cos + block.size() * math::cos(block.slenderness()) * sin,
            Mount::TyingPoint { height, pulley_ratio } => pulley_ratio * (-side * half_width * cos + height * sin),
            Mount::BaseCorners { pulley_ratio } => pulley_ratio * 2.0 * half_width * sin,
        }
    }

    #[test]
    fn the_lever_is_the_derivative_of_the_terminals_travel() {
        let block = Block::new(2.0, 0.35, 4.0 / 3.0).unwrap();
        let mounts = [
            Mount::CentreOfMass,
            Mount::TyingPoint { height: 3.1, pulley_ratio: 1.0 },
            Mount::TyingPoint { height: 0.4, pulley_ratio: 2.5 },
            Mount::BaseCorners { pulley_ratio: 1.0 },
            Mount::BaseCorners { pulley_ratio: 4.0 },
        ];
        for mount in mounts {
            for rotation in [-1.2, -0.3, -0.01, 0.02, 0.35, 1.1] {
                let step = 1e-5;
                let slope = (travel(&mount, &block, rotation + step) - travel(&mount, &block, rotation - step)) / (2.0 * step);
                let lever = mount.lever_at(&block, Geometry::Full, rotation).unwrap() * block.size();
                assert!((slope.abs() - lever.abs()).abs() < 1e-9, "{mount:?} at {rotation}: {slope} and {lever}");
            }
        }
    }

    #[test]
    fn the_centre_of_mass_is_a_tying_point_at_its_own_height() {
        let block = Block::new(2.0, 0.35, 4.0 / 3.0).unwrap();
        let height = block.size() * math::cos(block.slenderness());
        let constants = Mount::TyingPoint { height, pulley_ratio: 1.0 }.lever(&block).unwrap();
        assert!((constants.along - 1.0).abs() < 1e-15 && constants.across.abs() < 1e-15);
    }

    #[test]
    fn the_slender_lever_is_the_limit_of_the_full_one() {
        let block = Block::new(2.0, 1e-6, 4.0 / 3.0).unwrap();
        for mount in
            [Mount::CentreOfMass, Mount::TyingPoint { height: 1.5, pulley_ratio: 3.0 }, Mount::BaseCorners { pulley_ratio: 2.0 }]
        {
            let full = mount.lever_at(&block, Geometry::Full, 0.5e-6).unwrap();
            let slender = mount.lever_at(&block, Geometry::Slender, 0.5e-6).unwrap();
            assert!((full / slender - 1.0).abs() < 1e-6, "{mount:?}");
        }
    }
}
