//! Why there is no parts list.

use sprag_sim::scene::SceneError;

/// Why a device cannot be designed.
#[derive(Debug, thiserror::Error)]
pub enum DesignError {
    /// An assumption outside its range.
    #[error("--{option} is {value}, but must be {range}")]
    Range {
        /// Option of the command.
        option: &'static str,
        /// Value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// The scene.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// Nothing to design.
    #[error(
        "{origin}: no device has a flywheel: a parts list needs a device of kind \"inerter\" or \"clutched-pair\" with a mass ratio above 0"
    )]
    NoDevice {
        /// Scene.
        origin: String,
    },
    /// A device that the scene does not have, or that has no flywheel.
    #[error("--device {name:?}: the devices with a flywheel are {known}")]
    UnknownDevice {
        /// Name that was asked for.
        name: String,
        /// Names of those that there are.
        known: String,
    },
    /// No run.
    #[error("{device}: no motion could be followed; {first}")]
    NoRun {
        /// Device.
        device: String,
        /// The first reason.
        first: String,
    },
    /// Nothing moves.
    #[error("{device}: no motion lifts the block, so nothing asks for a size: scale the motions, or take stronger ones")]
    NeverRocks {
        /// Device.
        device: String,
    },
    /// No gear.
    #[error(
        "{device}: a load of {load_n:.4e} N at the rack ({load}) is more than a pinion of {teeth} teeth up to module 50 mm bears at \
         {allowable_mpa} MPa: --teeth, --face-width or --allowable-stress has to be larger"
    )]
    NoGear {
        /// Device.
        device: String,
        /// The load of its teeth at the largest module, N.
        load_n: f64,
        /// What load that is, in words.
        load: &'static str,
        /// Teeth.
        teeth: u32,
        /// Allowable stress, MPa.
        allowable_mpa: f64,
    },
    /// Ctrl-C.
    #[error("interrupted")]
    Interrupted,
}

impl DesignError {
    /// Whether it is the matter of one device, beside which others may have lists.
    pub(super) fn is_of_one_device(&self) -> bool {
        matches!(self, DesignError::NoRun { .. } | DesignError::NeverRocks { .. } | DesignError::NoGear { .. })
    }
}
