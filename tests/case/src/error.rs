//! Why words are no case, or why a case cannot be run.

use core::fmt;

use crate::words::VERSION;
use crate::{FixedMethod, MOST_PIECES, MOST_STEPS};
use sprag_shared::motion::state::Stopped;
use sprag_shared::structure::error::ParameterError;

/// Why words are no case, or a case could not be run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CaseError {
    /// The first word is not [`super::words::MAGIC`].
    Magic(u32),
    /// The second is not [`VERSION`].
    Version(u32),
    /// The words end before what stands here.
    Missing(&'static str),
    /// So many words follow the case.
    Trailing(u32),
    /// No such kind.
    Kind {
        /// Of what.
        of: &'static str,
        /// The word.
        word: u32,
    },
    /// More pieces of ground motion than fit.
    TooManyPieces(u32),
    /// So many vertical samples beside so many horizontal ones.
    Uneven {
        /// Horizontal.
        horizontal: u32,
        /// Vertical.
        vertical: u32,
    },
    /// More steps than [`MOST_STEPS`].
    TooManySteps,
    /// The words do not fit the buffer.
    Full,
    /// A number outside its range.
    Parameter(ParameterError),
    /// A method that does not run such a case.
    Method {
        /// The method.
        method: FixedMethod,
        /// What it runs, and why nothing else.
        runs: &'static str,
    },
    /// The run came to a stop.
    Stopped(Stopped),
}

impl fmt::Display for CaseError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CaseError::Magic(word) => write!(formatter, "the first word is {word:#010x}, so this is no case"),
            CaseError::Version(version) => write!(formatter, "version {version}, but only {VERSION} is known"),
            CaseError::Missing(what) => write!(formatter, "the words end before {what}"),
            CaseError::Trailing(count) => write!(formatter, "{count} words follow the end of the case"),
            CaseError::Kind { of, word } => write!(formatter, "there is no {of} of kind {word}"),
            CaseError::TooManyPieces(count) => write!(formatter, "{count} pieces of ground motion; at most {MOST_PIECES} fit"),
            CaseError::Uneven { horizontal, vertical } => {
                write!(formatter, "{vertical} vertical samples, but {horizontal} horizontal ones")
            }
            CaseError::TooManySteps => write!(formatter, "more than {MOST_STEPS} steps"),
            CaseError::Full => formatter.write_str("the case does not fit the buffer"),
            CaseError::Parameter(error) => error.fmt(formatter),
            CaseError::Method { method, runs } => write!(formatter, "the method {} runs {runs}", method.name()),
            CaseError::Stopped(stopped) => stopped.fmt(formatter),
        }
    }
}

impl core::error::Error for CaseError {}

impl From<ParameterError> for CaseError {
    fn from(error: ParameterError) -> CaseError {
        CaseError::Parameter(error)
    }
}

impl From<Stopped> for CaseError {
    fn from(stopped: Stopped) -> CaseError {
        CaseError::Stopped(stopped)
    }
}
