//! The hash of Fowler, Noll and Vo (1991), FNV-1a, over the bits of numbers: of 64 bits by [`Fnv`], of 32 bits by `fold`.

use super::scalar::Real;

/// The offset basis of 64 bits.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// The prime of 64 bits.
const PRIME: u64 = 0x0100_0000_01b3;

/// What is hashed for any NaN: its sign and payload are the machine's choice.
const NAN: u64 = 0x7ff8;

/// FNV-1a, 64 bits, a byte at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fnv {
    hash: u64,
}

impl Default for Fnv {
    fn default() -> Fnv {
        Fnv { hash: OFFSET }
    }
}

impl Fnv {
    /// The hash so far.
    pub fn value(&self) -> u64 {
        self.hash
    }

    /// Hashes a byte.
    #[inline]
    pub fn byte(&mut self, byte: u8) {
        self.hash = (self.hash ^ u64::from(byte)).wrapping_mul(PRIME);
    }

    /// Hashes the bytes of a number, lowest first; every NaN counts as one.
    #[inline]
    pub fn number<S: Real>(&mut self, x: S) {
        let bits = if x.partial_cmp(&x).is_some() { x.bits() } else { NAN };
        for &byte in bits.to_le_bytes().iter().take(size_of::<S>()) {
            self.byte(byte);
        }
    }
}

/// FNV-1a of 32 bits, a word at a time, from [`FOLD_BASIS`] on. Every step can be undone, so a change of one word
/// never hides.
pub(crate) const fn fold(digest: u32, word: u32) -> u32 {
    (digest ^ word).wrapping_mul(0x0100_0193)
}

/// Where [`fold`] begins.
pub(crate) const FOLD_BASIS: u32 = 0x811C_9DC5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_fnv_1a() {
        // A test vector of the hash's authors.
        let mut hash = Fnv::default();
        b"foobar".iter().for_each(|&byte| hash.byte(byte));
        assert_eq!(hash.value(), 0x8594_4171_f739_67e8);
    }
}
