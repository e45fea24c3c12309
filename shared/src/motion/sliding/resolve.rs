//! Resolution of a structure's parameters into the equations of a block that may slide.

use super::SlidingSystem;
use crate::math;
use crate::math::scalar::Real;
use crate::structure::block::Geometry;
use crate::structure::device::DeviceKind;
use crate::structure::error::{ParameterError, require};
use crate::structure::{Base, COUNTED_SPEED, Structure};

/// By which a restitution given in a few digits may exceed that of the block's momentum.
const ROUNDING: f64 = 1e-9;

impl Structure {
    /// The equations of the structure with its added mass, where it has a coefficient of friction; also what the ground's vertical motion asks.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter outside its range, or what a block that slides cannot be followed with.
    pub fn resolve_sliding<S: Real>(&self) -> Result<SlidingSystem<S>, ParameterError> {
        let loaded = self.loaded()?;
        let Structure { block, geometry, device, restitution, rest_speed, .. } = &loaded;
        let friction = if let Base::Friction(friction) = self.base { friction } else { f64::INFINITY };
        let fits = |fits: bool, range: &'static str| require("friction_coefficient", friction, fits, range);
        fits(friction > 0.0, "above 0")?;
        fits(*geometry == Geometry::Full, "absent for the slender block, whose toe has no reactions of its own")?;
        fits(device.kind == DeviceKind::None, "absent for a block with a device, whose support does not slide with it")?;
        fits(!self.restitution_scatter.is_on(), "absent where impacts scatter")?;
        let (lambda, alpha) = (block.inertia_ratio(), block.slenderness());
        let paradox = 4.0 * lambda * (lambda - 1.0);
        fits(
            friction * friction < paradox,
            "below 2√(λ(λ − 1)), 1.333 for a rectangle: above it a toe that slides may have no motion that rigid bodies can have",
        )?;
        let rest = require("rest_speed", *rest_speed, (1e-12..=1e-2).contains(rest_speed), "from 1e-12 to 1e-2")?;
        let eta = restitution.evaluate(block, *geometry, device)?;
        let own = block.geometric_restitution();
        let range = "at most that of the block's momentum, 1 − 2 sin²α/λ, beside a coefficient of friction";
        require("restitution", eta, eta <= own + ROUNDING, range)?;
        let (sin, cos) = math::sin_cos(alpha);
        let speed = block.frequency_parameter() * alpha;
        Ok(SlidingSystem {
            friction: S::of(friction),
            frequency_squared: S::of(block.frequency_parameter_squared()),
            inertia: S::of(lambda),
            slenderness: S::of(alpha),
            size: S::of(block.size()),
            restitution: S::of(eta),
            uplift: S::of(geometry.uplift_threshold(alpha)),
            rest_speed: S::of(rest * speed),
            counted_speed: S::of(COUNTED_SPEED * speed),
            sin_slenderness: S::of(sin),
            cos_slenderness: S::of(cos),
            eccentricity: S::of((lambda - sin * sin) * (1.0 - eta) / ((1.0 + eta) * sin * sin)),
        })
    }
}
