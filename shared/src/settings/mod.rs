//! All settings of a controller, as one flat table of 32-bit words: to be sent over a serial link, kept in flash, and made into the
//! very controller, bit for bit, that the host simulates.
//!
//! - [`table`]: the parameters; [`kind`]: what each may be; [`describe`]: in words, for the host;
//! - [`assemble`]: from words to a controller, and back; [`wiring`]: what only a board needs to know;
//! - [`store`]: in flash.
//!
//! A new parameter of the controller goes into [`table`] and `parts`; one of a board's wiring into [`table`] and [`wiring`].
//!
//! Names, units and everything that prints stand in [`kind::Description`]s only, which firmware does not contain.
//!
//! The room imports `math`, `equation` and `control`.

pub mod assemble;
pub mod describe;
pub mod kind;
mod limits;
mod parts;
mod stability;
pub mod store;
pub mod table;
#[cfg(test)]
mod tests;
pub mod wiring;

pub use limits::LAYOUT;
pub use table::{COUNT, Item};

/// The words of a controller, each within its range; [`Controller::of`](crate::control::controller::Controller::of) says whether they go together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    words: [u32; COUNT],
}

/// Why settings cannot be had. Small and without words; [`SettingError::describe`] has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SettingError {
    /// There is no parameter at this index.
    NoSuch {
        /// Index that was asked for.
        index: u16,
    },
    /// A word is outside the range of its parameter.
    OutOfRange {
        /// Index of the parameter.
        index: u16,
        /// Word that was refused.
        word: u32,
    },
    /// Two parameters that do not go together.
    Contradiction {
        /// Of the one that is bound by the other.
        index: u16,
        /// Index of the other parameter.
        other: u16,
    },
    /// A controller that no words describe: its parts have different periods or beliefs, or it is supervised in another way than was said.
    NotRepresentable,
}

impl SettingError {
    /// `item` does not go together with `other`.
    pub(crate) const fn contradiction(item: Item, other: Item) -> SettingError {
        SettingError::Contradiction { index: item.index(), other: other.index() }
    }
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { words: limits::DEFAULTS }
    }
}

impl Settings {
    /// The word at `index`.
    pub fn get(&self, index: u16) -> Option<u32> {
        self.words.get(usize::from(index)).copied()
    }

    /// Changes the word at `index`.
    ///
    /// # Errors
    /// [`SettingError`] where there is none, or where it is not allowed to be `word`; then nothing changes.
    pub fn set(&mut self, index: u16, word: u32) -> Result<(), SettingError> {
        check(index, word)?;
        let place = self.words.get_mut(usize::from(index)).ok_or(SettingError::NoSuch { index })?;
        *place = word;
        Ok(())
    }

    /// CRC-32 of the words, by which two ends of a link know that they mean the same settings.
    pub fn check(&self) -> u32 {
        store::checksum(&self.words)
    }

    /// Clutches engaged in the safe state.
    pub fn safe_command(&self) -> [bool; 2] {
        let choice = self.whole(Item::SafeState);
        [choice == 1, choice == 2]
    }

    /// From tick to tick, s.
    pub fn period(&self) -> f32 {
        self.real(Item::Period)
    }

    /// All words, in the order of [`Item::ALL`].
    pub fn words(&self) -> &[u32; COUNT] {
        &self.words
    }

    /// Settings of words in that order.
    ///
    /// # Errors
    /// [`SettingError`] names the first word outside its range.
    pub fn from_words(words: &[u32; COUNT]) -> Result<Settings, SettingError> {
        for (index, &word) in (0..).zip(words) {
            check(index, word)?;
        }
        Ok(Settings { words: *words })
    }

    pub(crate) fn whole(&self, item: Item) -> u32 {
        self.get(item.index()).unwrap_or(0)
    }

    pub(crate) fn real(&self, item: Item) -> f32 {
        f32::from_bits(self.whole(item))
    }

    pub(crate) fn switch(&self, item: Item) -> bool {
        self.whole(item) != 0
    }
}

fn check(index: u16, word: u32) -> Result<(), SettingError> {
    match limits::allows(usize::from(index), word) {
        Some(true) => Ok(()),
        Some(false) => Err(SettingError::OutOfRange { index, word }),
        None => Err(SettingError::NoSuch { index }),
    }
}
