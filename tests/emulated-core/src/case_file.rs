//! A case file: little-endian 32-bit words and nothing else.

use core::fmt;

/// The most words a case may have: what the board's static buffer holds.
pub const MAX_WORDS: usize = 16_384;

/// Why a case file could not be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadError {
    /// The file cannot be opened or its length cannot be asked for.
    Open,
    /// The length in bytes is no multiple of four.
    Ragged(u64),
    /// More bytes than the buffer holds.
    TooLong(u64),
    /// Reading failed or ended early.
    Read,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Open => f.write_str("the file cannot be opened"),
            Self::Ragged(bytes) => write!(f, "{bytes} bytes are no whole number of 32-bit words"),
            Self::TooLong(bytes) => write!(f, "{bytes} bytes are more than the {} that fit", 4 * MAX_WORDS),
            Self::Read => f.write_str("the file cannot be read to its end"),
        }
    }
}

/// Reads `byte_count` bytes into the front of `words`. `fill` fills the slice it is given and says whether it could.
///
/// # Errors
/// If the length is not that of a case, or `fill` says no.
pub fn load(byte_count: u64, mut fill: impl FnMut(&mut [u8]) -> bool, words: &mut [u32; MAX_WORDS]) -> Result<&[u32], LoadError> {
    if !byte_count.is_multiple_of(4) {
        return Err(LoadError::Ragged(byte_count));
    }
    let used =
        usize::try_from(byte_count / 4).ok().and_then(|count| words.get_mut(..count)).ok_or(LoadError::TooLong(byte_count))?;
    // A request to a semihosting host is slow, so words come in blocks; the block is small enough for the stack.
    let mut block = [0; 1024];
    for part in used.chunks_mut(block.len() / 4) {
        let bytes = &mut block[..4 * part.len()];
        if !fill(bytes) {
            return Err(LoadError::Read);
        }
        for (word, four) in part.iter_mut().zip(bytes.as_chunks().0) {
            *word = u32::from_le_bytes(*four);
        }
    }
    Ok(used)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read as _;

    fn load_bytes(bytes: &[u8]) -> Result<Vec<u32>, LoadError> {
        let mut rest = bytes;
        let mut words = Box::new([0; MAX_WORDS]);
        load(bytes.len() as u64, |part| rest.read_exact(part).is_ok(), &mut words).map(<[u32]>::to_vec)
    }

    #[test]
    fn words_come_in_order_and_little_endian() {
        let words: Vec<u32> = (0..MAX_WORDS as u32).map(|i| i.wrapping_mul(0x9e37_79b9)).collect();
        for count in [0, 1, 255, 256, 257, MAX_WORDS] {
            let bytes: Vec<u8> = words[..count].iter().flat_map(|word| word.to_le_bytes()).collect();
            assert_eq!(load_bytes(&bytes).as_deref(), Ok(&words[..count]));
        }
    }

    #[test]
    fn wrong_lengths_are_errors() {
        assert_eq!(load_bytes(&[0; 7]), Err(LoadError::Ragged(7)));
        assert_eq!(load_bytes(&vec![0; 4 * MAX_WORDS + 4]), Err(LoadError::TooLong(4 * MAX_WORDS as u64 + 4)));
        let mut words = Box::new([0; MAX_WORDS]);
        assert_eq!(load(8, |_| false, &mut words), Err(LoadError::Read));
    }
}
