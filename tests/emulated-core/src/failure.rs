//! Why the program ends with something else than 0.

use crate::{case::RunError, case_file::LoadError, self_check::SelfCheckError};
use core::fmt;

/// Everything that can go wrong short of a panic.
#[derive(Debug)]
pub enum Failure<'a> {
    /// The command line cannot be read.
    CommandLine,
    /// The case file at this path cannot be read.
    Load(&'a str, LoadError),
    /// The case file at this path holds no case, or one that cannot be run to its end.
    Case(&'a str, RunError),
    /// The self check found something.
    SelfCheck(SelfCheckError),
}

impl Failure<'_> {
    /// The exit code that belongs to this failure.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::SelfCheck(_) => 1,
            Self::CommandLine | Self::Load(..) | Self::Case(..) => 2,
        }
    }
}

impl fmt::Display for Failure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::CommandLine => f.write_str("the command line cannot be read"),
            Self::Load(path, error) => write!(f, "{path}: {error}"),
            Self::Case(path, error) => write!(f, "{path}: {error}"),
            Self::SelfCheck(error) => write!(f, "self check: {error}"),
        }
    }
}
