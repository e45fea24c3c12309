//! The command `sprag`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(u8::try_from(sprag_cli::run(std::env::args_os())).unwrap_or(1))
}
