//! Comparisons with packages of Python.

mod statistics;
mod tables;

use std::path::Path;
use std::process::Command;

/// What `script` of this folder prints.
fn printed(script: &str, arguments: &[&Path]) -> Vec<u8> {
    let python = std::env::var_os("SPRAG_PYTHON");
    let python =
        python.expect("SPRAG_PYTHON names no Python with the packages of requirements.txt; `cargo xtask test` makes one");
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command_line/needs_python").join(script);
    let output = Command::new(&python).env("PYTHONDONTWRITEBYTECODE", "1").arg(&script).args(arguments).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}", python.display()));
    assert!(output.status.success(), "{}: {}", script.display(), String::from_utf8_lossy(&output.stderr));
    output.stdout
}
