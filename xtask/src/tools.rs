//! The tools that the checks need besides cargo: found, else installed where that is possible without asking, else named.

use crate::{
    process::{answers, output, run},
    stop::Stop,
};
use std::{
    ffi::OsString,
    path::{Path, PathBuf},
    process::Command,
};

/// Makes sure that the standard library for `target` is installed.
///
/// # Errors
/// If it is not and cannot be.
pub fn need_target(root: &Path, target: &str) -> Result<(), Stop> {
    // Asking the compiler works without rustup too.
    let mut ask = Command::new("rustc");
    let libraries = output(ask.current_dir(root).args(["--print", "target-libdir", "--target", target]))?;
    if PathBuf::from(libraries.trim()).is_dir() {
        return Ok(());
    }
    run(Command::new("rustup").current_dir(root).args(["target", "add", target]))
        .map_err(|_| Stop::usage(format!("the target is missing: rustup target add {target}")))
}

/// Makes sure that the emulator is installed.
///
/// # Errors
/// If it is not and cannot be.
pub fn need_emulator() -> Result<(), Stop> {
    need("qemu-system-arm", &["qemu-system-arm"])
}

/// Makes sure that the circuit simulator is installed.
///
/// # Errors
/// If it is not and cannot be.
pub fn need_circuit_simulator() -> Result<(), Stop> {
    need("ngspice", &["ngspice"])
}

/// Makes sure that the library is installed which executes the board's image: Debian's package, 20 MB, where building it from source
/// takes 40 s of processor time, CMake and libclang. `UNICORN_LIB_DIR` names a folder with another one.
///
/// # Errors
/// If it is not and cannot be.
pub fn need_unicorn() -> Result<(), Stop> {
    if std::env::var_os("UNICORN_LIB_DIR").is_some() {
        return Ok(());
    }
    // A linker that is asked for it, as a build is.
    let found = || answers("cc", &["-shared", "-o", "/dev/null", "-lunicorn"]);
    need_by("libunicorn-dev", "libunicorn", found)
}

/// Makes sure that callgrind is installed.
///
/// # Errors
/// If it is not and cannot be.
pub fn need_valgrind() -> Result<(), Stop> {
    need("valgrind", &["valgrind"])
}

/// Makes sure that Slurm is installed.
///
/// # Errors
/// If it is not and cannot be.
pub fn need_slurm() -> Result<(), Stop> {
    need_by("slurm-wlm", "slurmctld", || answers("slurmctld", &["-V"]) && answers("slurmd", &["-V"]))
}

/// Makes sure that there is a C++ compiler, which libFuzzer is built with.
///
/// # Errors
/// If there is none and none can be installed.
pub fn need_cxx() -> Result<(), Stop> {
    let own = std::env::var("CXX").unwrap_or_default();
    let candidates: &[&str] = if own.is_empty() { &["c++"] } else { &[&own] };
    need("g++", candidates)
}

/// Makes sure that there is a browser, which `SPRAG_CHROMIUM` names where it is not Debian's Chromium.
///
/// # Errors
/// If there is none and none can be installed.
pub fn need_browser() -> Result<(), Stop> {
    let own = std::env::var("SPRAG_CHROMIUM").unwrap_or_default();
    let candidates: &[&str] = if own.is_empty() { &["chromium"] } else { &[&own] };
    need("chromium", candidates)
}

/// The search path of programs with a Node that the page's tools run on: this machine's, or where that is older, one of the package index.
///
/// # Errors
/// If there is neither.
pub fn path_with_node(root: &Path) -> Result<OsString, Stop> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    // The oldest one that Vite runs on.
    const NEW_ENOUGH: &str =
        "const [a, b] = process.versions.node.split('.').map(Number); process.exit(a > 20 || a == 20 && b >= 19 ? 0 : 1)";
    if answers("node", &["-e", NEW_ENOUGH]) && answers("npm", &["--version"]) {
        return Ok(path);
    }
    let python = python_of(root, "target/page-node", "web/requirements.txt", &[])?;
    let folders = python.parent().into_iter().map(Path::to_owned).chain(std::env::split_paths(&path));
    std::env::join_paths(folders).map_err(|error| Stop::usage(format!("PATH: {error}")))
}

/// A Python with the packages that the file `requirements` lists, in a virtual environment of its own.
///
/// # Errors
/// If there is no Python, or the packages cannot be had.
pub fn python(root: &Path, requirements: &str) -> Result<PathBuf, Stop> {
    python_of(root, "target/python", requirements, &[])
}

/// The same in an environment at `place`, with more options of the installer.
///
/// # Errors
/// Likewise.
pub fn python_of(root: &Path, place: &str, requirements: &str, options: &[&str]) -> Result<PathBuf, Stop> {
    let folder = root.join(place);
    let python = folder.join("bin/python");
    // Again over one that is there: a few seconds, and one that was left half made is whole.
    run(Command::new("python3").args(["-m", "venv"]).arg(&folder))?;
    run(pip_install(&python).args(options).arg("--requirement").arg(root.join(requirements)))?;
    Ok(python)
}

/// The command that installs packages into the environment of `python`. Their modules are compiled: where Python may write none, each process
/// would do so anew.
pub fn pip_install(python: &Path) -> Command {
    let mut install = Command::new(python);
    install.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
    install
}

/// Looks for one of the programs, installs the package if none answers, and looks again.
fn need(package: &str, programs: &[&str]) -> Result<(), Stop> {
    need_by(package, &programs.join(" or "), || programs.iter().any(|program| answers(program, &["--version"])))
}

/// Looks for something, installs the package if it is not found, and looks again.
fn need_by(package: &str, what: &str, found: impl Fn() -> bool) -> Result<(), Stop> {
    if found() {
        return Ok(());
    }
    if is_root() && answers("apt-get", &["--version"]) {
        println!("installing {package}");
        // A fresh container has no package lists; elsewhere fetching them again would be a waste.
        let _ = apt_get(&["install", "--yes", "--no-install-recommends", package]).or_else(|_| {
            apt_get(&["update"])?;
            apt_get(&["install", "--yes", "--no-install-recommends", package])
        });
        if found() {
            return Ok(());
        }
    }
    Err(Stop::usage(format!("{what} is missing: sudo apt-get install {package}")))
}

fn apt_get(args: &[&str]) -> Result<(), Stop> {
    run(Command::new("apt-get").env("DEBIAN_FRONTEND", "noninteractive").arg("--quiet").args(args))
}

fn is_root() -> bool {
    output(Command::new("id").arg("-u")).is_ok_and(|id| id.trim() == "0")
}
