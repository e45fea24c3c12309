//! Running one case: words in, lines out.

use core::fmt;

/// Why a case could not be run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CaseError {
    /// The case holds no words.
    Empty,
    /// A line could not be written.
    Output,
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Empty => "the case is empty",
            Self::Output => "a line of the answer could not be written",
        })
    }
}

impl From<fmt::Error> for CaseError {
    fn from(_: fmt::Error) -> Self {
        Self::Output
    }
}

/// Runs the case that `words` describe and writes its answer to `out`, line by line.
///
/// `counter` counts instructions: the wrapping difference of two calls is what was executed between them (always 0 on
/// the host, which has no such counter).
///
/// # Errors
/// If the words are no case, or `out` refuses a line.
pub fn run_case(words: &[u32], counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> Result<(), CaseError> {
    if words.is_empty() {
        return Err(CaseError::Empty);
    }
    let before = counter();
    let digest = digest(words);
    let instructions = counter().wrapping_sub(before);
    writeln!(out, "words {}", words.len())?;
    writeln!(out, "digest {digest:016x}")?;
    writeln!(out, "instructions {instructions}")?;
    Ok(())
}

/// FNV-1a, 64 bits, over the words' little-endian bytes.
fn digest(words: &[u32]) -> u64 {
    words
        .iter()
        .flat_map(|word| word.to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_digest_is_fnv_1a() {
        // A test vector of the hash's authors.
        assert_eq!(digest(&[u32::from_le_bytes(*b"foob")]), 0xdd12_0e79_0c25_12af);
    }

    #[test]
    fn an_empty_case_is_an_error() {
        assert_eq!(run_case(&[], &mut || 0, &mut String::new()), Err(CaseError::Empty));
    }
}
