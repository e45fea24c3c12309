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

/// Kinematics of a body: known when it is compiled, or [`RuntimeKinematics`] when it runs.
pub trait BodyKinematics: Copy {
    /// Kinematics with the θ̇² term or without; a type known at compile time ignores the argument.
    fn chosen(consistent: bool) -> Self;

    /// Whether the θ̇² term is there.
    fn consistent(self) -> bool;
}

impl<K: Kinematics> BodyKinematics for K {
    #[inline(always)]
    fn chosen(_consistent: bool) -> K {
        K::default()
    }

    #[inline(always)]
    fn consistent(self) -> bool {
        K::CONSISTENT
    }
}

/// Kinematics chosen at run time: one body for both where code is scarce, to the same bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RuntimeKinematics {
    consistent: bool,
}

impl BodyKinematics for RuntimeKinematics {
    #[inline]
    fn chosen(consistent: bool) -> RuntimeKinematics {
        RuntimeKinematics { consistent }
    }

    #[inline]
    fn consistent(self) -> bool {
        self.consistent
    }
}
