//! The program as it is installed: tried without the sources, and as a Debian package.

use crate::{
    process::{answers, cargo, output, run as done, target_folder},
    scratch::empty,
    stop::Stop,
    tools,
};
use std::{fs, path::Path, process::Command};

/// Installs the program by the README's first command, with all features, and runs the README's other ones in an empty folder, without cargo.
///
/// # Errors
/// If a command does not end well.
pub fn try_installed(root: &Path) -> Result<(), Stop> {
    tools::need_emulator()?;
    let (place, folder) = (root.join("target/installed"), root.join("target/installed-try"));
    let mut install = cargo(root, &["install", "--locked", "--force", "--path", "sim-host/cli", "--features", "full", "--root"]);
    // Built where everything else is.
    done(install.arg(&place).arg("--target-dir").arg(target_folder(root)))?;
    empty(&folder)?;
    let readme = fs::read_to_string(root.join("README.md")).map_err(|error| Stop::failed(format!("README.md: {error}")))?;
    let commands = commands(&readme);
    let sprag = place.join("bin/sprag");
    let program = || {
        let mut program = Command::new(&sprag);
        program.current_dir(&folder).env("PATH", "/usr/bin:/bin").env_remove("CARGO");
        program
    };
    for words in &commands {
        println!("-- sprag {}", words.join(" "));
        for scene in words.iter().filter_map(|word| word.strip_prefix("scenes/")?.strip_suffix(".toml")) {
            done(program().args(["example", scene, "--out", "scenes", "--overwrite", "--quiet"]))?;
        }
        done(program().args(words))?;
    }
    if commands.is_empty() { Err(Stop::failed("README.md has no command of sprag")) } else { Ok(()) }
}

/// The commands of `sprag` in a page's blocks of code, word by word; not those on a user's own files.
fn commands(page: &str) -> Vec<Vec<&str>> {
    let lines = page.lines().filter_map(|line| line.strip_prefix("    sprag "));
    lines.filter(|line| !line.contains("YOUR_")).map(|line| line.split_whitespace().collect()).collect()
}

/// Builds the Debian package of the program, with its pages for `man` and its completions, and gives its path.
///
/// # Errors
/// If a build fails, or cargo-deb is missing.
pub fn deb(root: &Path) -> Result<(), Stop> {
    if !answers("cargo-deb", &["--version"]) {
        return Err(Stop::usage("cargo-deb is missing: cargo install --locked cargo-deb"));
    }
    done(&mut cargo(root, &["build", "--locked", "--profile", "dist", "--package", "sprag-cli", "--features", "full"]))?;
    let (sprag, folder) = (target_folder(root).join("dist/sprag"), root.join("target/deb"));
    empty(&folder)?;
    done(Command::new(&sprag).args(["manual", "--quiet"]).arg(folder.join("man")))?;
    for shell in ["bash", "fish", "zsh"] {
        let text = output(Command::new(&sprag).args(["completions", shell]))?;
        let file = folder.join(shell);
        fs::write(&file, text).map_err(|error| Stop::failed(format!("{}: {error}", file.display())))?;
    }
    done(&mut cargo(root, &["deb", "--no-build", "--package", "sprag-cli", "--profile", "dist"]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_s_commands_are_those_in_its_blocks() {
        let page = "text\n\n    sprag map a.toml --threads 2\n    sprag record YOUR_RECORD\n    cargo test\n\nsprag is a wedge\n";
        assert_eq!(commands(page), [["map", "a.toml", "--threads", "2"]]);
    }
}
