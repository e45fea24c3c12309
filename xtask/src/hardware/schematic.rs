//! The schematic as code: its electrical rules, and the netlist, parts list and sheets that it makes.

use crate::{process::run, stop::Stop, tools};
use std::{fs, path::Path};

/// Folder of the schematic.
pub const FOLDER: &str = "docs/hardware/schematic";

/// Checks the rules and that what is in the repository is what the schematic makes. Where this machine cannot have the packages, it
/// says so and gives `false`.
///
/// # Errors
/// If a rule is violated or a file is another.
pub fn check(root: &Path) -> Result<bool, Stop> {
    let source = root.join(FOLDER);
    let python = match tools::python_of(root, "target/python-schematic", &format!("{FOLDER}/requirements.txt"), &["--no-deps"]) {
        Ok(python) => python,
        Err(stop) => {
            println!("-- schematic not checked: {stop}");
            return Ok(false);
        }
    };
    let made = root.join("target/schematic");
    let cannot = |error| Stop::failed(format!("{}: {error}", made.display()));
    fs::create_dir_all(&made).map_err(cannot)?;
    // Its logs go where it runs.
    let mut command = std::process::Command::new(python);
    run(command.current_dir(&made).env("PYTHONDONTWRITEBYTECODE", "1").arg(source.join("board.py")).arg(&made))?;
    for entry in fs::read_dir(&source).map_err(cannot)? {
        let path = entry.map_err(cannot)?.path();
        let name = path.file_name().unwrap_or_default();
        let generated =
            name == "netlist.csv" || name == "parts.csv" || path.extension().is_some_and(|extension| extension == "svg");
        if generated && fs::read(&path).ok() != fs::read(made.join(name)).ok() {
            return Err(Stop::failed(format!("{} is not what board.py makes: copy it from {}", path.display(), made.display())));
        }
    }
    Ok(true)
}
