//! What an impact leaves of the velocity: the restitution η = θ̇⁺/θ̇⁻ at θ = 0, without bouncing or sliding.

use super::block::{Block, Geometry};
use super::device::{Device, DeviceKind};
use super::error::{ParameterError, require};
use super::mount::Mount;

/// Source of the coefficient of restitution η.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restitution {
    /// η as given, 0 to 1.
    Constant(f64),
    /// The bare block's moment of momentum, whatever its device: η = 1 − 2 sin²α/λ ([`Block::geometric_restitution`]).
    Geometric,
    /// The moment of momentum of the block and of what stays engaged through the impact ([`momentum_balance`]).
    ///
    /// An inerter without a clutch is always engaged. An ideal clutched pair never counts: the impact decelerates the
    /// terminals of a horizontal mount, so that by Eq. 10 the clutch has let go, and an ideal clutch engages a flywheel
    /// without a loss of momentum, so that the inerter of a corner that rises after the impact takes none either.
    MomentumBalance,
}

impl Restitution {
    /// η of `block` with `device`.
    ///
    /// # Errors
    /// [`ParameterError`] when it is not within 0 to 1: a computed η below 0 belongs to a block too stocky to rock on. With
    /// [`Restitution::MomentumBalance`] also as [`momentum_balance`].
    pub fn evaluate(&self, block: &Block, geometry: Geometry, device: &Device) -> Result<f64, ParameterError> {
        match (*self, device.kind) {
            (Restitution::Constant(eta), _) => require("restitution", eta, (0.0..=1.0).contains(&eta), "from 0 to 1"),
            (Restitution::MomentumBalance, DeviceKind::Inerter) => {
                momentum_balance(block, geometry, &device.mount, device.mass_ratio)
            }
            _ => {
                let eta = block.geometric_restitution();
                require("geometric restitution", eta, eta >= 0.0, "0 or more (a less stocky block)")
            }
        }
    }
}

/// η by moment of momentum about the new toe, divided by mR², with an inerter of σ = `engaged_mass_ratio` (0 or more; the
/// sum, if several flywheels of one rack are engaged) that stays engaged through the impact:
///
/// (λ + σ ℓ₊²) θ̇⁺ = (λ η_g + σ ℓ₊ ℓ₋) θ̇⁻
///
/// with η_g of [`Block::geometric_restitution`] and ℓ of [`Mount::lever_at`] θ = 0. A horizontal inerter keeps its lever when
/// the toes change, ℓ₊ = ℓ₋: the heavier it is, the more of the velocity survives. Of a pair at the base corners, the one
/// under the landing corner is stopped by the ground, through the new toe and so without a moment, and the one at the old toe
/// starts from rest, ℓ₋ = 0. The slender model takes its own constant ℓ, and η_g as it is.
///
/// The kinetic energy never grows: λ η_g ≤ λ, so η is at most 1.
///
/// # Errors
/// [`ParameterError`] for a mount outside its range ([`Mount::lever`]), an `engaged_mass_ratio` below 0, or a negative η, of a
/// block too stocky to rock on.
pub fn momentum_balance(
    block: &Block,
    geometry: Geometry,
    mount: &Mount,
    engaged_mass_ratio: f64,
) -> Result<f64, ParameterError> {
    let sigma = require("engaged mass_ratio", engaged_mass_ratio, engaged_mass_ratio >= 0.0, "0 or more")?;
    let lever = mount.lever_at(block, geometry, 0.0)?;
    // The inerter's part of the inertia about the new toe. Written with it, σ = 0 gives η_g to the bit.
    let part = 1.0 / (1.0 + block.inertia_ratio() / (sigma * lever * lever));
    let bare = block.geometric_restitution();
    let eta = match mount {
        Mount::BaseCorners { .. } => bare * (1.0 - part),
        Mount::CentreOfMass | Mount::TyingPoint { .. } => bare + (1.0 - bare) * part,
    };
    require("momentum-balance restitution", eta, eta >= 0.0, "0 or more (a less stocky block)")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;
    use crate::structure::block::RECTANGLE_INERTIA_RATIO;

    const MASS_RATIOS: [f64; 7] = [0.0, 1e-9, 0.05, 0.5, 1.0, 20.0, 1e4];

    fn blocks() -> [Block; 4] {
        [(1.0, 0.05, RECTANGLE_INERTIA_RATIO), (2.0, 0.175, RECTANGLE_INERTIA_RATIO), (0.7, 0.6, 1.2), (6.0, 0.35, 2.5)]
            .map(|(size, slenderness, ratio)| Block::new(size, slenderness, ratio).unwrap())
    }

    fn mounts(block: &Block) -> [Mount; 6] {
        let tied = |height: f64, pulley_ratio| Mount::TyingPoint { height: height * block.size(), pulley_ratio };
        let corners = |pulley_ratio| Mount::BaseCorners { pulley_ratio };
        [Mount::CentreOfMass, tied(1.9, 1.0), tied(0.05, 1.0), tied(0.8, 3.0), corners(1.0), corners(4.0)]
    }

    /// A block of mass 1 as four masses on a cross about its centre of mass, with its inerters (inertance `sigma`) tied to
    /// points (m, from the middle of the base) along directions, through a pulley.
    struct Body {
        masses: [([f64; 2], f64); 4],
        half_width: f64,
        terminals: std::vec::Vec<([f64; 2], [f64; 2])>,
        pulley_ratio: f64,
        sigma: f64,
    }

    impl Body {
        fn of(block: &Block, mount: &Mount, sigma: f64) -> Body {
            let (sin, cos) = math::sin_cos(block.slenderness());
            let (half_width, height) = (block.size() * sin, block.size() * cos);
            // Each pair at distance d adds d²/2 to λR² − R²; one pair lies twice as far out as the other.
            let out = block.size() * (2.0 * (block.inertia_ratio() - 1.0) / 5.0).sqrt();
            let masses = [
                ([2.0 * out, height], 0.25),
                ([-2.0 * out, height], 0.25),
                ([0.0, height + out], 0.25),
                ([0.0, height - out], 0.25),
            ];
            let (terminals, pulley_ratio) = match *mount {
                Mount::CentreOfMass => (std::vec![([0.0, height], [1.0, 0.0])], 1.0),
                Mount::TyingPoint { height, pulley_ratio } => (std::vec![([0.0, height], [1.0, 0.0])], pulley_ratio),
                Mount::BaseCorners { pulley_ratio } => {
                    (std::vec![([half_width, 0.0], [0.0, 1.0]), ([-half_width, 0.0], [0.0, 1.0])], pulley_ratio)
                }
            };
            Body { masses, half_width, terminals, pulley_ratio, sigma }
        }

        /// Velocity of `point` while the body turns at `rate`, anticlockwise, about the toe at x = `toe`.
        fn velocity(point: [f64; 2], toe: f64, rate: f64) -> [f64; 2] {
            [-rate * point[1], rate * (point[0] - toe)]
        }

        fn terminal(&self, index: usize, toe: f64, rate: f64) -> f64 {
            let (point, direction) = self.terminals[index];
            let [x, y] = Body::velocity(point, toe, rate);
            self.pulley_ratio * (x * direction[0] + y * direction[1])
        }

        /// Moment about the new toe (left) by which momentum `after` exceeds that `before` and the inerters' impulses.
        fn excess(&self, before: f64, after: f64) -> f64 {
            let (old, new) = (self.half_width, -self.half_width);
            let moment = |toe: f64, rate: f64| -> f64 {
                let of = |(point, mass): &([f64; 2], f64)| {
                    let [x, y] = Body::velocity(*point, toe, rate);
                    mass * ((point[0] - new) * y - point[1] * x)
                };
                self.masses.iter().map(of).sum()
            };
            let impulses = (0..self.terminals.len()).map(|index| {
                let (point, direction) = self.terminals[index];
                let change = self.terminal(index, new, after) - self.terminal(index, old, before);
                let impulse = -self.pulley_ratio * self.sigma * change;
                impulse * ((point[0] - new) * direction[1] - point[1] * direction[0])
            });
            moment(new, after) - moment(old, before) - impulses.sum::<f64>()
        }

        fn energy(&self, toe: f64, rate: f64) -> f64 {
            let of = |(point, mass): &([f64; 2], f64)| {
                let [x, y] = Body::velocity(*point, toe, rate);
                0.5 * mass * (x * x + y * y)
            };
            let terminals = (0..self.terminals.len()).map(|index| self.terminal(index, toe, rate));
            self.masses.iter().map(of).sum::<f64>() + terminals.map(|speed| 0.5 * self.sigma * speed * speed).sum::<f64>()
        }
    }

    #[test]
    fn momentum_of_point_masses_and_impulses_of_inerters_give_the_same() {
        for block in blocks() {
            for mount in mounts(&block) {
                for sigma in MASS_RATIOS {
                    let body = Body::of(&block, &mount, sigma);
                    // The balance is linear in the rate after, so two looks at it solve it.
                    let (at_zero, at_one) = (body.excess(1.0, 0.0), body.excess(1.0, 1.0));
                    let expected = -at_zero / (at_one - at_zero);
                    let eta = momentum_balance(&block, Geometry::Full, &mount, sigma).unwrap();
                    assert!((eta - expected).abs() < 1e-12, "{block:?} {mount:?} {sigma}: {eta} and {expected}");
                    let (before, after) = (body.energy(body.half_width, 1.0), body.energy(-body.half_width, eta));
                    assert!(after <= before * (1.0 + 1e-15), "{block:?} {mount:?} {sigma}: {before} to {after}");
                }
            }
        }
    }

    #[test]
    fn a_rectangle_has_its_closed_form() {
        let (alpha, sigma) = (0.2_f64, 0.5);
        let block = Block::new(3.0, alpha, RECTANGLE_INERTIA_RATIO).unwrap();
        let (sine, cosine) = (math::sin(alpha), math::cos(alpha));
        let corner = 4.0 * sine * sine;
        let bare = 4.0 / 3.0 - 2.0 * sine * sine;
        let arm = cosine * cosine;
        let eta = |geometry, mount: Mount| momentum_balance(&block, geometry, &mount, sigma).unwrap();
        let full = eta(Geometry::Full, Mount::CentreOfMass);
        assert!((full - (bare + sigma * arm) / (4.0 / 3.0 + sigma * arm)).abs() < 1e-15);
        let full = eta(Geometry::Full, Mount::BaseCorners { pulley_ratio: 2.0 });
        assert!((full - bare / (4.0 / 3.0 + sigma * 4.0 * corner)).abs() < 1e-15);
        let slender = eta(Geometry::Slender, Mount::CentreOfMass);
        assert!((slender - (bare + sigma) / (4.0 / 3.0 + sigma)).abs() < 1e-15);
        let slender = eta(Geometry::Slender, Mount::TyingPoint { height: 1.5, pulley_ratio: 3.0 });
        assert!((slender - (bare + sigma * 2.25) / (4.0 / 3.0 + sigma * 2.25)).abs() < 1e-15);
        let slender = eta(Geometry::Slender, Mount::BaseCorners { pulley_ratio: 1.0 });
        assert!((slender - bare / (4.0 / 3.0 + sigma * 4.0 * alpha * alpha)).abs() < 1e-15);
    }

    #[test]
    fn the_limits_are_the_bare_block_no_loss_and_a_dead_stop() {
        for block in blocks() {
            for geometry in [Geometry::Full, Geometry::Slender] {
                for mount in mounts(&block) {
                    let eta = |sigma| momentum_balance(&block, geometry, &mount, sigma).unwrap();
                    assert_eq!(eta(0.0).to_bits(), block.geometric_restitution().to_bits());
                    let heavy = if matches!(mount, Mount::BaseCorners { .. }) { 0.0 } else { 1.0 };
                    assert!((eta(1e18) - heavy).abs() < 1e-12, "{mount:?} {geometry:?}");
                    assert!((0.0..=1.0).contains(&eta(f64::MAX)));
                }
            }
        }
    }

    #[test]
    fn an_ideal_clutch_takes_no_momentum_and_a_single_inerter_does() {
        let block = Block::new(2.0, 0.3, RECTANGLE_INERTIA_RATIO).unwrap();
        let bare = block.geometric_restitution();
        for mount in [Mount::CentreOfMass, Mount::BaseCorners { pulley_ratio: 1.0 }] {
            let eta = |kind, restitution: Restitution| {
                let device = Device { kind, mass_ratio: 0.5, mount, ..Device::NONE };
                restitution.evaluate(&block, Geometry::Full, &device).unwrap()
            };
            for kind in [DeviceKind::None, DeviceKind::ClutchedPair] {
                assert_eq!(eta(kind, Restitution::MomentumBalance), bare);
            }
            assert_eq!(eta(DeviceKind::Inerter, Restitution::Geometric), bare);
            let single = momentum_balance(&block, Geometry::Full, &mount, 0.5).unwrap();
            assert_eq!(eta(DeviceKind::Inerter, Restitution::MomentumBalance), single);
            assert!(single != bare);
        }
    }

    #[test]
    fn what_cannot_be_is_refused_by_name() {
        let stocky = Block::new(1.0, 1.2, 1.0).unwrap();
        let error = |mount: Mount, sigma| momentum_balance(&stocky, Geometry::Full, &mount, sigma).unwrap_err().parameter;
        assert_eq!(error(Mount::CentreOfMass, 0.1), "momentum-balance restitution");
        assert_eq!(error(Mount::BaseCorners { pulley_ratio: 1.0 }, 5.0), "momentum-balance restitution");
        assert_eq!(error(Mount::CentreOfMass, -0.1), "engaged mass_ratio");
        assert_eq!(error(Mount::CentreOfMass, f64::INFINITY), "engaged mass_ratio");
        assert_eq!(error(Mount::TyingPoint { height: 0.0, pulley_ratio: 1.0 }, 0.1), "height");
        let eta = |restitution: Restitution| restitution.evaluate(&stocky, Geometry::Full, &Device::NONE).unwrap_err().parameter;
        assert_eq!(eta(Restitution::Geometric), "geometric restitution");
        assert_eq!(eta(Restitution::MomentumBalance), "geometric restitution");
        assert_eq!(eta(Restitution::Constant(1.01)), "restitution");
    }
}
