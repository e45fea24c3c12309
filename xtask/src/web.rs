//! The page: its core as WebAssembly, its files, and its tests in a browser.

use crate::{
    process::{cargo, run as done},
    scratch::empty,
    steps::Steps,
    stop::Stop,
    tools,
};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// Folder of the page.
pub const FOLDER: &str = "web";

/// The target of programs in a browser.
const TARGET: &str = "wasm32-unknown-unknown";

/// What a browser's registers of 128 bits are called.
const SIMD: &str = "target.wasm32-unknown-unknown.rustflags=[\"-Ctarget-feature=+simd128\"]";

/// Modules: folder of the page's sources, package, file, further words of cargo. The lanes are built twice, for browsers without SIMD too.
const MODULES: [(&str, &str, &str, &[&str]); 3] = [
    ("page", "sprag-page", "sprag_page", &[]),
    ("lanes", "sprag-page-lanes", "sprag_lanes", &[]),
    ("lanes-simd", "sprag-page-lanes", "sprag_lanes", &["--config", SIMD]),
];

/// Builds the page into web/dist, and tests it in a browser.
///
/// # Errors
/// At the first check that fails, or if there is no Node, no browser or no package index.
pub fn run(root: &Path, steps: &mut Steps) -> Result<(), Stop> {
    let folder = root.join(FOLDER);
    let path = steps.step("tools, page", || {
        tools::need_target(root, TARGET)?;
        tools::need_browser()?;
        tools::path_with_node(root)
    })?;
    steps.step("lints, page", || {
        done(&mut cargo(&folder, &["fmt", "--all", "--check"]))?;
        let args = ["clippy", "--locked", "--package", "sprag-page", "--package", "sprag-page-lanes", "--target", TARGET];
        done(cargo(&folder, &args).args(["--", "-D", "warnings"]))?;
        done(&mut cargo(&folder, &["clippy", "--locked", "--package", "sprag-page-bindings", "--", "-D", "warnings"]))
    })?;
    steps.step("core of the page", || {
        empty(&folder.join("src/core"))?;
        MODULES.iter().try_for_each(|module| build(&folder, module))
    })?;
    let npm = |words: &[&str]| done(Command::new("npm").current_dir(&folder).env("PATH", &path).args(words));
    steps.step("page", || {
        npm(&["ci", "--no-audit", "--no-fund"])?;
        npm(&["run", "check"])?;
        npm(&["run", "types"])?;
        npm(&["run", "build"])
    })?;
    steps.step("tests, page", || npm(&["test"]))
}

/// Builds a module, and writes its JavaScript beside it.
fn build(folder: &Path, (name, package, file, words): &(&str, &str, &str, &[&str])) -> Result<(), Stop> {
    done(cargo(folder, &["build", "--locked", "--release", "--package", package, "--target", TARGET]).args(*words))?;
    let module = target(folder).join(TARGET).join("release").join(file).with_extension("wasm");
    let place = folder.join("src/core").join(name);
    fs::create_dir_all(&place).map_err(|error| Stop::failed(format!("{}: {error}", place.display())))?;
    done(cargo(folder, &["run", "--locked", "--quiet", "--package", "sprag-page-bindings", "--"]).arg(module).arg(place))
}

/// The folder that the page's workspace is built in.
fn target(folder: &Path) -> PathBuf {
    folder.join(std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into()))
}
