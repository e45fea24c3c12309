//! Bytes to and from a device.

use std::path::PathBuf;
use std::time::Duration;

use sprag_shared::link::{FrameError, Pace, Refusal};

/// Why a device cannot be talked to.
#[derive(Debug, thiserror::Error)]
pub enum DeviceError {
    /// It could not be built.
    #[error("the firmware cannot be built: {0}")]
    Build(String),
    /// It could not be started.
    #[error("the emulator cannot be started: {0}")]
    Emulator(String),
    /// It cannot be run in the emulator.
    #[error("{}: {reason}", path.display())]
    Image {
        /// File of the image.
        path: PathBuf,
        /// Reason, in words.
        reason: String,
    },
    /// There is no such port.
    #[error("port {port}: {reason}")]
    Port {
        /// Name of the port.
        port: String,
        /// Reason, in words.
        reason: String,
    },
    /// It says nothing.
    #[error("the device does not answer{0}")]
    Silent(String),
    /// It answers, but reports no tick.
    #[error("the device answers but has reported no tick in {0} exchanges")]
    Unreported(u32),
    /// It is gone.
    #[error("the device has gone{0}")]
    Gone(String),
    /// A frame that cannot be sent or understood.
    #[error("the device sends {0}")]
    Frame(#[from] FrameError),
    /// It answers, but with something else.
    #[error("the device gives an answer to something else than {0}")]
    Confused(&'static str),
    /// It does not want to.
    #[error("the device refuses: {0}")]
    Refused(RefusalText),
    /// Its firmware has other settings.
    #[error("the device has {device} settings and this program {own}: use firmware and sprag of one build")]
    Settings {
        /// The device's.
        device: u16,
        /// This program's.
        own: usize,
    },
    /// Its firmware has as many, but others.
    #[error(
        "the device's settings mean something else than this program's (layout {device:08x}, own {own:08x}): use firmware and sprag of one build"
    )]
    Layout {
        /// The device's.
        device: u32,
        /// This program's.
        own: u32,
    },
    /// A setting that a device cannot have.
    #[error("{0}")]
    Setting(String),
}

/// A refusal in words.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefusalText(pub Refusal);

impl std::fmt::Display for RefusalText {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        use sprag_shared::settings::Item;
        use sprag_shared::settings::kind::Description;
        let name =
            |index: u16| Description::at(index).map_or_else(|| format!("setting {index}"), |parameter| parameter.name.to_owned());
        match self.0 {
            Refusal::Busy(phase) => write!(out, "not while its controller is in {phase:?}"),
            Refusal::NoSuchSetting(index) => write!(out, "it has no setting {index}"),
            Refusal::OutOfRange(index) => match Description::at(index) {
                Some(parameter) => write!(out, "{} must be {}", parameter.name, parameter.range()),
                None => write!(out, "setting {index} is outside its range"),
            },
            Refusal::Contradiction(index, other) => write!(out, "{} does not go together with {}", name(index), name(other)),
            Refusal::Check(_) => write!(out, "the settings were changed by somebody else, or on the way"),
            Refusal::FlashFull => write!(out, "its flash takes no more until it has been restarted"),
            Refusal::FlashFailed => write!(out, "its flash does not take them"),
            Refusal::TooFast { period, least } => {
                write!(out, "{} is {period} s, and must be at least {least} s on this board", name(Item::Period.index()))
            }
            Refusal::NoJumper => write!(out, "its commissioning jumper (JP1) is open: close it, and open it again when done"),
            Refusal::NotSealed => write!(out, "its program has no seal: flash it by cargo xtask flash"),
            Refusal::NotHere => write!(out, "not this firmware, or not in this mode"),
        }
    }
}

/// A way to a device.
pub trait Line {
    /// Hands over bytes; they may wait until the next [`Line::receive`].
    ///
    /// # Errors
    /// [`DeviceError::Gone`].
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError>;

    /// What has come, after at most `patience`; nothing is not an error. On a line that is paced by the device's timer this waits for the end
    /// of exactly one control period.
    ///
    /// # Errors
    /// [`DeviceError::Gone`].
    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError>;

    /// Who says when a tick is.
    fn pace(&self) -> Pace;
}

impl Line for Box<dyn Line> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
        (**self).send(bytes)
    }

    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        (**self).receive(patience)
    }

    fn pace(&self) -> Pace {
        (**self).pace()
    }
}
