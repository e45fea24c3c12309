//! Words one after the other: what reads them and what writes them.

use crate::CaseError;

/// Takes words from the front.
pub(super) struct Reader<'a>(pub &'a [u32]);

impl<'a> Reader<'a> {
    pub fn word(&mut self, what: &'static str) -> Result<u32, CaseError> {
        let (&word, rest) = self.0.split_first().ok_or(CaseError::Missing(what))?;
        self.0 = rest;
        Ok(word)
    }

    /// `count` of them.
    pub fn words(&mut self, count: u32, last: &'static str) -> Result<&'a [u32], CaseError> {
        let (words, rest) = self.0.split_at_checked(count as usize).ok_or(CaseError::Missing(last))?;
        self.0 = rest;
        Ok(words)
    }

    pub fn single(&mut self, what: &'static str) -> Result<f32, CaseError> {
        self.word(what).map(f32::from_bits)
    }

    pub fn number(&mut self, what: &'static str) -> Result<f64, CaseError> {
        self.single(what).map(f64::from)
    }

    pub fn kind<K: Copy>(&mut self, of: &'static str, kinds: &[K]) -> Result<K, CaseError> {
        let word = self.word(of)?;
        kinds.get(word as usize).copied().ok_or(CaseError::Kind { of, word })
    }
}

/// Puts words into a buffer.
pub(super) struct Writer<'a> {
    pub words: &'a mut [u32],
    pub count: usize,
}

impl Writer<'_> {
    pub fn word(&mut self, word: u32) -> Result<(), CaseError> {
        *self.words.get_mut(self.count).ok_or(CaseError::Full)? = word;
        self.count += 1;
        Ok(())
    }

    pub fn single(&mut self, number: f32) -> Result<(), CaseError> {
        self.word(number.to_bits())
    }

    pub fn number(&mut self, number: f64) -> Result<(), CaseError> {
        self.single(number as f32)
    }

    pub fn numbers(&mut self, numbers: &[f64]) -> Result<(), CaseError> {
        numbers.iter().try_for_each(|&number| self.number(number))
    }
}
