//! Builds the firmware for the emulator with a program that is built with optimisation.

#[path = "src/cargo.rs"]
mod cargo;

use std::{
    env, fs,
    path::{Path, PathBuf},
    process::Stdio,
};

/// The board's target.
const TARGET: &str = "thumbv7em-none-eabihf";

fn main() {
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    for source in ["build.rs", "src/cargo.rs"] {
        println!("cargo:rerun-if-changed={source}");
    }
    for source in [
        "firmware/Cargo.lock",
        "firmware/Cargo.toml",
        "firmware/build.rs",
        "firmware/src",
        "memory.x",
        "shared/Cargo.toml",
        "shared/src",
    ] {
        println!("cargo:rerun-if-changed={}", root.join(source).display());
    }
    // In a program for tests it would cost more than it serves: they are handed their images.
    let optimised = env::var("PROFILE").is_ok_and(|profile| profile == "release");
    let wanted = optimised && env::var_os("CARGO_FEATURE_INSIDE").is_some();
    let image = if wanted { build(&root, &out) } else { Ok(Vec::new()) };
    let image = image.unwrap_or_else(|reason| {
        println!(
            "cargo:warning=the firmware for the emulator is not inside this program, `sprag hil --qemu` will build it: {reason}"
        );
        Vec::new()
    });
    fs::write(out.join("emulator.elf"), image).expect("OUT_DIR can be written to");
}

/// The firmware for the emulator, or why it cannot be built.
fn build(root: &Path, out: &Path) -> Result<Vec<u8>, String> {
    let target = out.join("firmware");
    let mut command = cargo::cargo_build(&root.join("firmware"));
    command.args(["--locked", "--release", "--no-default-features", "--features", "board-qemu", "--target-dir"]).arg(&target);
    // Nobody debugs it.
    command.env("CARGO_PROFILE_RELEASE_DEBUG", "0").env("CARGO_PROFILE_RELEASE_STRIP", "symbols");
    let output = command.stdin(Stdio::null()).output();
    let output = output.map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        return Err(errors.lines().find(|line| line.starts_with("error")).unwrap_or("cargo failed").to_owned());
    }
    let elf = target.join(TARGET).join("release/sprag-firmware");
    fs::read(&elf).map_err(|error| format!("{}: {error}", elf.display()))
}
