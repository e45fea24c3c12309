//! Running one case: words in, lines out.

use crate::watcher::Watcher;
use core::fmt;
use sprag_case::CaseError;
use sprag_shared::observers::digest::Digest;

/// Why a case could not be run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RunError {
    /// The words are no case, or it stopped.
    Case(CaseError),
    /// A line could not be written.
    Output,
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Case(error) => error.fmt(f),
            Self::Output => f.write_str("a line of the answer could not be written"),
        }
    }
}

impl From<CaseError> for RunError {
    fn from(error: CaseError) -> Self {
        Self::Case(error)
    }
}

impl From<fmt::Error> for RunError {
    fn from(_: fmt::Error) -> Self {
        Self::Output
    }
}

/// Runs the case that `words` describe and writes its answer to `out`, one `name value` a line.
///
/// `counter` counts instructions: the wrapping difference of two calls is what was executed between them (always 0 on
/// the host, which has no such counter). They are those of the whole run: decoding, resolving, every step and event, the
/// peaks and the digest, which alone takes a few hundred a step.
///
/// # Errors
/// If the words are no case, or `out` refuses a line.
pub fn run_case(words: &[u32], counter: &mut impl FnMut() -> u32, out: &mut impl fmt::Write) -> Result<(), RunError> {
    let mut watcher = Watcher { digest: Some(Digest::default()) };
    let before = counter();
    let end = sprag_case::run(words, &mut watcher)?;
    let instructions = counter().wrapping_sub(before);
    let digest = watcher.digest.unwrap_or_default();
    writeln!(out, "outcome {}", end.outcome.name())?;
    writeln!(out, "impacts {}", end.state.impacts)?;
    writeln!(out, "peak_rotation_rad {}", end.peaks.rotation)?;
    writeln!(out, "missed_engagements {}", end.missed)?;
    writeln!(out, "stretches {}", digest.stretches)?;
    writeln!(out, "events {}", digest.events)?;
    writeln!(out, "digest {:016x}", digest.hash())?;
    writeln!(out, "steps {}", end.steps)?;
    writeln!(out, "instructions {instructions}")?;
    writeln!(out, "instructions_per_step {}", instructions.checked_div(end.steps).unwrap_or(0))?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_case_is_an_error() {
        let error = CaseError::Missing("the first word");
        assert_eq!(run_case(&[], &mut || 0, &mut String::new()), Err(RunError::Case(error)));
    }
}
