//! The host's world: arguments, files and lines are the standard library's.

use crate::{
    case::run_case,
    case_file::{self, LoadError, MAX_WORDS},
    failure::Failure,
    instruction_counter::InstructionCounter,
    self_check,
};
use std::{
    fmt,
    fs::File,
    io::{self, Read as _, Write as _},
    process::ExitCode,
};

/// Runs the program and gives its exit code.
pub fn main() -> ExitCode {
    let path = std::env::args_os().nth(1).map(|path| path.into_string());
    let outcome = match &path {
        None => run(None),
        Some(Ok(path)) => run(Some(path)),
        Some(Err(_)) => Err(Failure::CommandLine),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("error: {failure}");
            failure.exit_code().into()
        }
    }
}

fn run(path: Option<&str>) -> Result<(), Failure<'_>> {
    let mut counter = InstructionCounter::start();
    let mut counter = || counter.read();
    let mut console = Console(io::stdout().lock());
    let Some(path) = path else {
        return self_check::run(&mut counter, &mut console).map_err(Failure::SelfCheck);
    };
    let mut words = Box::new([0; MAX_WORDS]);
    let words = read(path, &mut words).map_err(|error| Failure::Load(path, error))?;
    run_case(words, &mut counter, &mut console).map_err(|error| Failure::Case(path, error))
}

fn read<'w>(path: &str, words: &'w mut [u32; MAX_WORDS]) -> Result<&'w [u32], LoadError> {
    let mut file = File::open(path).map_err(|_| LoadError::Open)?;
    let byte_count = file.metadata().map_err(|_| LoadError::Open)?.len();
    case_file::load(byte_count, |part| file.read_exact(part).is_ok(), words)
}

/// Standard output as the core writes to it.
struct Console(io::StdoutLock<'static>);

impl fmt::Write for Console {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.write_all(text.as_bytes()).map_err(|_| fmt::Error)
    }
}
