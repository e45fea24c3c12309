//! Cargo on a workspace for another target.

use std::{env, path::Path, process::Command};

/// What is set for the build of the host, or by it for a build script: how the names of such variables begin.
const OF_HOST: [&str; 6] = ["CARGO_BUILD_", "CARGO_CFG_", "CARGO_FEATURE_", "CARGO_PROFILE_", "CARGO_TARGET_DIR", "RUSTC_"];

/// `cargo build` in the workspace at `folder`, without the flags, profiles, features and target folder of the build of the host.
pub fn cargo_build(folder: &Path) -> Command {
    let mut cargo = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder).arg("build");
    for (name, _) in env::vars_os() {
        let text = name.to_string_lossy();
        if OF_HOST.iter().any(|prefix| text.starts_with(prefix)) || text.contains("RUSTFLAGS") {
            cargo.env_remove(&name);
        }
    }
    cargo
}
