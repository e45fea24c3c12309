//! Why a task ends early.

use std::{fmt, process::ExitCode};

/// A task's end before its time: one line for people and an exit code for machines.
#[derive(Debug)]
pub struct Stop {
    line: String,
    code: u8,
}

impl Stop {
    /// A check failed.
    pub fn failed(line: impl Into<String>) -> Self {
        Self { line: line.into(), code: 1 }
    }

    /// The task cannot be done: wrong usage or a missing tool.
    pub fn usage(line: impl Into<String>) -> Self {
        Self { line: line.into(), code: 2 }
    }

    /// The code that the program ends with.
    pub fn exit_code(&self) -> ExitCode {
        self.code.into()
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.line)
    }
}
