//! What the program does without a case: it shows that its counter counts and that its arithmetic is IEEE 754's, and
//! prints what the core's kernels cost.

use crate::kernels;
use core::{fmt, hint::black_box};

/// What the self check found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SelfCheckError {
    /// So many `nop` instructions were counted as so many.
    Count(u32, u32),
    /// The sum has these bits.
    Sum(u32),
    /// A line could not be written.
    Output,
}

impl fmt::Display for SelfCheckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Count(made, counted) => {
                write!(f, "{made} instructions counted as {counted}; does the emulator run with -icount shift=0?")
            }
            Self::Sum(bits) => write!(f, "the sum is {bits:08x}, not {HARMONIC_SUM:08x}"),
            Self::Output => f.write_str("a line could not be written"),
        }
    }
}

impl From<fmt::Error> for SelfCheckError {
    fn from(_: fmt::Error) -> Self {
        Self::Output
    }
}

/// The bits of 1/1 + 1/2 + … + 1/1000, added from the left with every operation rounded to nearest in `f32`.
const HARMONIC_SUM: u32 = 0x40ef_890a;

/// Counts known work, adds up a known sum and reports the kernels.
///
/// # Errors
/// If a result is not the expected one, or `out` refuses a line.
pub fn run(counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> Result<(), SelfCheckError> {
    writeln!(out, "sprag-emulated-core {}: self check", env!("CARGO_PKG_VERSION"))?;
    check_count::<0>(counter)?;
    check_count::<1>(counter)?;
    check_count::<10>(counter)?;
    check_count::<1000>(counter)?;
    writeln!(out, "counter ok")?;
    let sum = (1..=1000_u16).fold(0.0, |sum, n| sum + 1.0 / f32::from(black_box(n)));
    if sum.to_bits() != HARMONIC_SUM {
        return Err(SelfCheckError::Sum(sum.to_bits()));
    }
    writeln!(out, "arithmetic ok")?;
    kernels::report(counter, out)?;
    Ok(())
}

/// Counts `N` instructions that do nothing.
// Never inlined: the compiler does not know how long the assembly is, and would put constants out of its own reach.
#[inline(never)]
fn check_count<const N: u32>(counter: &mut impl FnMut() -> u32) -> Result<(), SelfCheckError> {
    let before = counter();
    #[cfg(target_os = "none")]
    // SAFETY: `nop` touches nothing.
    unsafe {
        core::arch::asm!(".rept {n}", "nop", ".endr", n = const N, options(nomem, nostack, preserves_flags));
    }
    let counted = counter().wrapping_sub(before);
    let expected = if cfg!(target_os = "none") { N } else { 0 };
    if counted == expected { Ok(()) } else { Err(SelfCheckError::Count(expected, counted)) }
}

#[cfg(test)]
mod tests {
    #[test]
    fn passes_on_the_host() {
        let mut lines = String::new();
        assert_eq!(super::run(&mut || 0, &mut lines), Ok(()));
        assert!(lines.contains("counter ok") && lines.contains("arithmetic ok"));
        assert_eq!(lines.matches("kernel ").count(), 90);
    }
}
