//! Hands the memory map and the linker script to the linker when the board is the target; does nothing for the host.

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    let package = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets CARGO_MANIFEST_DIR"));
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let memory = package.join("../../memory.x");
    fs::copy(&memory, out.join("memory.x")).expect("memory.x stands at the root of the workspace");
    println!("cargo:rerun-if-changed={}", memory.display());
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    // Without page alignment the sections lie in flash as they will be written.
    println!("cargo:rustc-link-arg-bins=--nmagic");
}
