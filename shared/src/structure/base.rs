//! What the block stands on.

use super::error::ParameterError;
use super::foundation::Foundation;

/// What the block stands on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Base {
    /// Rigid ground on which it cannot slide.
    #[default]
    Rigid,
    /// Rigid ground with this coefficient of friction μ; for [`crate::motion::sliding`] only.
    Friction(f64),
    /// A spring and a dashpot under each toe, which do not slide; for [`crate::motion::compliant`] only.
    Compliant(Foundation),
}

impl Base {
    /// Refuses all but rigid ground without sliding, for loops that know no other.
    ///
    /// # Errors
    /// [`ParameterError`] names what the ground has beyond that.
    pub fn is_rigid(&self) -> Result<(), ParameterError> {
        let (parameter, value, range) = match *self {
            Base::Rigid => return Ok(()),
            Base::Friction(friction) => ("friction_coefficient", friction, "absent where the base of the block cannot slide"),
            Base::Compliant(foundation) => {
                ("vertical_frequency", foundation.vertical_frequency, "absent where the ground is rigid")
            }
        };
        Err(ParameterError { parameter, value, range })
    }
}
