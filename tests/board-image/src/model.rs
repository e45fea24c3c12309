//! Which chip the bench is.

use crate::time::{microseconds, milliseconds};

/// A chip, and the board around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Model {
    /// STM32F405RG: RM0090 rev. 21, DS8626.
    #[default]
    F405,
    /// STM32G474RE: RM0440, DS12288.
    G474,
}

impl Model {
    /// Every one.
    pub const ALL: [Model; 2] = [Model::F405, Model::G474];

    /// Its name, as the program reports it.
    pub fn name(self) -> &'static str {
        match self {
            Model::F405 => "f405",
            Model::G474 => "g474",
        }
    }

    /// The environment variable that names the image for it.
    pub fn variable(self) -> &'static str {
        match self {
            Model::F405 => "SPRAG_BOARD_ELF",
            Model::G474 => "SPRAG_G474_ELF",
        }
    }

    /// Bytes of its flash.
    pub fn flash_length(self) -> u32 {
        match self {
            Model::F405 => 1 << 20,
            Model::G474 => 512 << 10,
        }
    }

    /// How long a G4's flash takes for a double word, for a page, and for the options: at most, or typically (DS12288).
    pub(crate) fn g4_flash_times(slow: bool) -> [u64; 3] {
        if slow {
            [microseconds(125), microseconds(24_500), milliseconds(25)]
        } else {
            [microseconds(82), milliseconds(22), milliseconds(22)]
        }
    }
}
