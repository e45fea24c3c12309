//! Comparisons with packages of Python, which a machine may lack.

mod statistics;

use std::path::Path;
use std::process::Command;

/// What `script` of this folder prints, with its packages in the virtual environment `venv`; `None`, with a line that says so,
/// where there is no Python or its packages cannot be had. `what` is what is compared then.
pub fn printed(script: &str, venv: &str, arguments: &[&Path], what: &str) -> Option<Vec<u8>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/command_line/needs_python").join(script);
    let venv = Path::new(env!("CARGO_TARGET_TMPDIR")).join(venv);
    let skipped = |why: &str| eprintln!("SKIPPED: comparison of {what}: {why}");
    let output = match Command::new("python3")
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .arg(&script)
        .arg("--venv")
        .arg(&venv)
        .args(arguments)
        .output()
    {
        Ok(output) => output,
        Err(error) => {
            skipped(&format!("python3: {error}"));
            return None;
        }
    };
    let errors = String::from_utf8_lossy(&output.stderr);
    if output.status.code() == Some(3) {
        skipped(errors.trim().lines().last().unwrap_or_default());
        return None;
    }
    assert!(output.status.success(), "{}: {errors}", script.display());
    Some(output.stdout)
}
