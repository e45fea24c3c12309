//! Examples that the tests beside the controller's parts share.

mod estimators;
mod horizons;

use super::model::Model;
use crate::control::estimation::estimate::Estimate;
use crate::control::law::Situation;
use crate::control::law::signs::Signs;
use crate::math::sign::Sign;
use crate::structure::block::Block;
use crate::structure::device::{Device, DeviceKind};
use crate::structure::drivetrain::{Drivetrain, Engagement, FlywheelLosses};
use crate::structure::{Restitution, Structure};

/// R = 2 m, α = 10°, σ = 0.5.
pub fn structure() -> Structure {
    Structure {
        device: Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, ..Device::NONE },
        ..Structure::new(Block::new(2.0, 10_f64.to_radians(), 4.0 / 3.0).unwrap(), Restitution::Constant(0.85))
    }
}

/// The block of [`structure`] with an ideal pair.
pub fn example_model() -> Model {
    Model::new(&structure(), &Drivetrain::default()).unwrap()
}

/// With flywheels that spin down slowly.
pub fn spinning_model() -> Model {
    let flywheel = FlywheelLosses { viscous_rate: 0.4, dry_deceleration: 0.2, brake_deceleration: 0.0, drag_rate: 0.0 };
    Model::new(&structure(), &Drivetrain { engagement: Engagement::Rigid, flywheel, ..Drivetrain::default() }).unwrap()
}

/// A situation with the signs of the four `bits`.
pub fn situation(model: &Model, bits: u8) -> Situation<'_> {
    let sign = |bit: u8| if bits >> bit & 1 == 1 { Sign::Positive } else { Sign::Negative };
    let signs = Signs { rotation: sign(0), velocity: sign(1), push: sign(2), ground: sign(3), quiet: false };
    Situation { model, estimate: Estimate::default(), signs, engaged: [false; 2], spins: [0.0; 2], ground_drift: 0.0 }
}
