//! A case: one scene as a flat row of 32-bit words, small and plain enough for a board to read from its host, and complete
//! enough for both to run it in single precision with fixed steps and compare every bit ([`sprag_shared::observers::digest`]).
//!
//! The words and their order are in [`words`]; this page is what they mean. Ideal devices over horizontal ground run in the loop
//! of [`sprag_shared::motion::ideal`], all others in that of [`sprag_shared::motion::hybrid`].

#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod codec;
mod drivetrain_words;
mod error;
mod ground;
mod ground_words;
mod hybrid;
mod ideal;
#[cfg(test)]
mod tests;
pub mod words;

pub use error::CaseError;
pub use ground::{Ground, GroundPiece, Shape};

use sprag_shared::motion::observer::Observer;
use sprag_shared::motion::state::BlockState;
use sprag_shared::observers::outcome::Outcome;
use sprag_shared::observers::peaks::Peaks;
use sprag_shared::structure::Structure;
use sprag_shared::structure::drivetrain::Drivetrain;
use sprag_shared::structure::error::require;

/// Most pieces of ground motion in a case without a record.
pub const MOST_PIECES: usize = 8;

/// Most steps of a case: what a host runs in a second and the emulator in a minute or two.
pub const MOST_STEPS: u32 = 1 << 22;

/// Coefficients of the Taylor method in a case.
pub const TERMS: usize = 12;

/// How the block starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Initially {
    /// On both toes.
    Rest,
    /// Tilted to θ (rad; not 0, |θ| ≤ π/2) and let go with θ̇ (rad/s).
    Released {
        /// θ.
        rotation: f32,
        /// θ̇.
        velocity: f32,
    },
}

/// The method, with fixed steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedMethod {
    /// [`sprag_shared::method::fixed::Scheme::SemiImplicitEuler`]; ideal devices only.
    SemiImplicitEuler,
    /// [`sprag_shared::method::fixed::Scheme::RungeKutta4`]; for everything.
    RungeKutta4,
    /// [`sprag_shared::method::taylor::Taylor`] with [`TERMS`] coefficients; ideal devices only.
    Taylor,
    /// [`sprag_shared::method::fixed::Scheme::ExponentialMidpoint`]; elastic clutches only.
    ExponentialMidpoint,
}

impl FixedMethod {
    /// As errors print it.
    pub fn name(self) -> &'static str {
        match self {
            FixedMethod::SemiImplicitEuler => "semi-implicit-euler",
            FixedMethod::RungeKutta4 => "runge-kutta-4",
            FixedMethod::Taylor => "taylor",
            FixedMethod::ExponentialMidpoint => "exponential-midpoint",
        }
    }
}

/// A scene that a board and its host can both run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case<'a> {
    /// The block and its device. The words hold its numbers in single precision.
    pub structure: Structure,
    /// What couples the flywheels to the rack. The words hold its numbers in single precision.
    pub drivetrain: Drivetrain,
    /// How it starts.
    pub initially: Initially,
    /// The method.
    pub method: FixedMethod,
    /// Its step, s; above 0.
    pub step: f32,
    /// What shakes it.
    pub ground: Ground<'a>,
    /// Time on quiet ground after that, s; 0 or more.
    pub free_time: f32,
}

/// What a run came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunEnd {
    /// How it ended.
    pub outcome: Outcome,
    /// The last state.
    pub state: BlockState<f32>,
    /// Largest rotation and acceleration.
    pub peaks: Peaks<f32>,
    /// Steps begun; an event that ends one early begins another.
    pub steps: u32,
    /// Commands to engage that the clutches missed.
    pub missed: u32,
}

/// Runs the case that `words` encode and reports it to `observer`. Never panics, always ends.
///
/// # Errors
/// [`CaseError`] names the word that is wrong, or why the run stopped.
pub fn run(words: &[u32], observer: &mut dyn Observer<f32>) -> Result<RunEnd, CaseError> {
    Case::decode(words)?.run(observer)
}

impl Case<'_> {
    /// Runs the case and reports it to `observer`, piece after piece; times start anew with each. Of a device that is not ideal, over ground that
    /// moves vertically too, or with impacts that differ, it is shown the device.
    ///
    /// # Errors
    /// [`CaseError::Parameter`] names the first parameter outside its range; [`CaseError::Method`] the method that does not
    /// run this device; [`CaseError::Stopped`].
    pub fn run(&self, observer: &mut dyn Observer<f32>) -> Result<RunEnd, CaseError> {
        self.check()?;
        if self.is_ideal() { ideal::run(self, observer) } else { hybrid::run(self, observer) }
    }

    /// The paper's device over ground that moves only horizontally, with impacts that are all alike.
    pub fn is_ideal(&self) -> bool {
        self.drivetrain == Drivetrain::default() && !self.ground.is_vertical() && !self.structure.restitution_scatter.is_on()
    }

    /// Everything that is not the structure's or the drivetrain's own to check.
    fn check(&self) -> Result<(), CaseError> {
        let number = |name, value: f32, allowed: bool, range| require(name, f64::from(value), allowed, range).map(|_| ());
        number("step", self.step, self.step > 0.0, "above 0 s")?;
        number("free_time", self.free_time, self.free_time >= 0.0, "0 s or more")?;
        if let Initially::Released { rotation, velocity } = self.initially {
            let bound = core::f32::consts::FRAC_PI_2;
            number("rotation", rotation, rotation != 0.0 && rotation.abs() <= bound, "from -π/2 to π/2 rad, and not 0")?;
            number("velocity", velocity, true, "finite")?;
        }
        let steps = self.free_time / self.step + self.ground.check(self.step)?;
        if steps <= MOST_STEPS as f32 { Ok(()) } else { Err(CaseError::TooManySteps) }
    }
}
