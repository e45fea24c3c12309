//! Kinematics of the inerter's terminals: the paper's (Eq. 11) and the consistent ones.

/// Kinematics of the terminals as a type: with or without the θ̇² term.
pub trait Kinematics: Copy + Default {
    /// Whether the θ̇² term is there.
    const CONSISTENT: bool;
}

/// Kinematics of the paper, Eq. 11 as printed: ü = ℓ R θ̈.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Paper;

/// Consistent kinematics, the full derivative of the terminals' travel: ü = R (ℓ θ̈ + ℓ' θ̇²). Conserves energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Consistent;

impl Kinematics for Paper {
    const CONSISTENT: bool = false;
}

impl Kinematics for Consistent {
    const CONSISTENT: bool = true;
}
