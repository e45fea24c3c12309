//! Hands the memory map and the linker scripts to the linker, and the program its build's name.

use std::{env, fs, path::PathBuf, process::Command};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../.git/HEAD");
    let package = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    // The F405's is at the root, for the emulated images there are of its chip, too.
    let board = if env::var_os("CARGO_FEATURE_BOARD_G474").is_some() { "src/board/g474/memory.x" } else { "../memory.x" };
    let memory = package.join(board);
    fs::copy(&memory, out.join("memory.x")).expect("the memory map of the board is there");
    println!("cargo:rerun-if-changed={}", memory.display());
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    if env::var_os("CARGO_FEATURE_LOG").is_some() {
        println!("cargo:rustc-link-arg-bins=-Tdefmt.x");
    }
    // Without page alignment the sections lie in flash as they will be written.
    println!("cargo:rustc-link-arg-bins=--nmagic");
    let build = Command::new("git").args(["rev-parse", "--short=8", "HEAD"]).output();
    let build = build.ok().filter(|build| build.status.success()).and_then(|build| String::from_utf8(build.stdout).ok());
    println!("cargo:rustc-env=SPRAG_BUILD={}", build.as_deref().map_or("unknown", str::trim));
}
