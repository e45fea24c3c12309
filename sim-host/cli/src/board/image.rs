//! The firmware for the emulator: inside this program, or built.

use std::fs::File;
use std::io::{ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use tempfile::TempPath;

use super::line::DeviceError;

/// The firmware's folder, where this program was built.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../firmware")
}

/// Whether `path` can be an image for the emulator: an ELF file for ARM.
///
/// # Errors
/// [`DeviceError::Image`] where it is not.
pub fn check(path: &Path) -> Result<(), DeviceError> {
    let failed = |reason: String| DeviceError::Image { path: path.to_owned(), reason };
    if !path.is_file() {
        return Err(failed("there is no such file".to_owned()));
    }
    let mut header = [0; 20];
    let read = File::open(path).and_then(|mut file| file.read_exact(&mut header));
    if let Err(error) = read
        && error.kind() != ErrorKind::UnexpectedEof
    {
        return Err(failed(error.to_string()));
    }
    if header.starts_with(ELF_32_LITTLE_ENDIAN) && header[MACHINE..] == ARM {
        Ok(())
    } else {
        Err(failed("is not a firmware for the emulator: it must be an ELF file for ARM".to_owned()))
    }
}

/// How an ELF file of 32 bits begins, least significant byte first.
const ELF_32_LITTLE_ENDIAN: &[u8] = b"\x7fELF\x01\x01";
/// Where it has the machine that it is for, and what that is for ARM.
const MACHINE: usize = 18;
const ARM: [u8; 2] = [40, 0];

/// The firmware for the emulator: the one inside this program, or one that is built, as it is where logs from `log` on are asked for (`trace`,
/// `debug`, `info`, `warn`, `error`). Cargo's own progress goes to the standard error stream.
///
/// # Errors
/// [`DeviceError::Build`] where there is no source, no cargo, or the build fails; [`DeviceError::Emulator`] where no file can be written.
pub fn for_emulator(log: Option<&str>) -> Result<Image, DeviceError> {
    if log.is_none() && !sprag_images::EMULATOR.is_empty() {
        let failed = |error: std::io::Error| DeviceError::Emulator(format!("no file for the firmware: {error}"));
        let mut file = tempfile::Builder::new().prefix("sprag-").suffix(".elf").tempfile().map_err(failed)?;
        file.write_all(sprag_images::EMULATOR).map_err(failed)?;
        return Ok(Image::Inside(file.into_temp_path()));
    }
    let features = if log.is_some() { "board-qemu,log" } else { "board-qemu" };
    let built = build_in(&folder(), &["--release", "--no-default-features", "--features", features], log);
    built.map(Image::File).map_err(|error| match (error, log) {
        (DeviceError::Build(reason), None) => {
            DeviceError::Build(format!("{reason}; with the feature `images` it is inside sprag"))
        }
        (error, _) => error,
    })
}

/// A firmware's ELF file.
pub enum Image {
    /// A user's, or one that has been built.
    File(PathBuf),
    /// Of the firmware inside this program; it is gone with this value.
    Inside(TempPath),
}

impl Image {
    /// Where it is.
    pub fn path(&self) -> &Path {
        match self {
            Image::File(path) => path,
            Image::Inside(path) => path,
        }
    }
}

/// Builds the firmware for the board and gives the path of its ELF file.
///
/// # Errors
/// The errors of [`for_emulator`].
pub fn build_board() -> Result<PathBuf, DeviceError> {
    build_in(&folder(), &["--release"], None)
}

/// Whether the linker finds Unicorn, as the build of the bench asks it to.
fn has_unicorn() -> bool {
    let mut linker = Command::new("cc");
    linker.args(["-shared", "-o", "/dev/null", "-lunicorn"]).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    std::env::var_os("UNICORN_LIB_DIR").is_some() || linker.status().is_ok_and(|status| status.success())
}

/// Builds the program that runs the board's image between models of the board's parts, and gives its path.
///
/// # Errors
/// As [`for_emulator`]; [`DeviceError::Emulator`] where Unicorn is not installed.
pub fn build_bench() -> Result<PathBuf, DeviceError> {
    if !has_unicorn() {
        return Err(DeviceError::Emulator("Unicorn is not installed; on Debian: sudo apt-get install libunicorn-dev".to_owned()));
    }
    build_in(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/board-image"), &["--bins"], None)
}

/// Builds a program for the emulator in the workspace at `folder`, by `cargo build` with `arguments`; else as [`for_emulator`].
///
/// # Errors
/// The build fails.
pub fn build_in(folder: &Path, arguments: &[&str], log: Option<&str>) -> Result<PathBuf, DeviceError> {
    let failed = |reason: String| DeviceError::Build(reason);
    if !folder.join("Cargo.toml").is_file() {
        return Err(failed(format!("{} is not there; name an image by --firmware", folder.display())));
    }
    let mut cargo = sprag_images::cargo_build(folder);
    cargo.args(arguments);
    cargo.arg("--message-format=json-render-diagnostics").stdin(Stdio::null()).stderr(Stdio::inherit());
    if let Some(target) = std::env::var_os("CARGO_TARGET_DIR") {
        let name = if folder.ends_with("board-image") { "tests/board-image" } else { "firmware" };
        cargo.env("CARGO_TARGET_DIR", PathBuf::from(target).join(name));
    }
    if let Some(level) = log {
        cargo.env("DEFMT_LOG", level);
    }
    let output = cargo.output().map_err(|error| failed(format!("cargo: {error}")))?;
    if !output.status.success() {
        return Err(failed(format!("cargo ended with {}", output.status)));
    }
    let messages = String::from_utf8_lossy(&output.stdout);
    let mut executable = messages.lines().filter_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        Some(PathBuf::from(message.get("executable")?.as_str()?))
    });
    executable.next_back().ok_or_else(|| failed("cargo named no executable".to_owned()))
}
