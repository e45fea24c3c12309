//! The site of documents: docs by Sphinx, with the gallery run anew, and the Rust packages beside it.

use crate::{
    process::{cargo, run as done, target_folder},
    python,
    scratch::empty,
    steps::Steps,
    stop::Stop,
    tools,
};
use std::{fs, path::Path, process::Command};

/// Folder of the sources.
const SOURCES: &str = "docs";

/// Folder of the sources that the build makes: pages of commands, and of examples with their pictures.
const MADE: &str = "docs/made";

/// Folder of the site.
const SITE: &str = "target/site";

/// Pictures that are committed, since a page shows them where nothing is built: each with the command that draws it.
const PICTURES: [(&str, [&str; 2], &str); 2] = [
    ("docs/readme/history.svg", ["simulate", "scenes/near_fault.toml"], "history.svg"),
    ("docs/readme/map.svg", ["map", "scenes/figure08.toml"], "map.svg"),
];

/// All features of the command, in the words of a build of the workspace.
pub const FULL: &str = "sprag-cli/full";

/// Documents the Rust packages, every warning an error.
pub fn rust_documents(root: &Path) -> Command {
    let mut document = cargo(root, &["doc", "--workspace", "--no-deps", "--features", FULL]);
    document.env("RUSTDOCFLAGS", "-D warnings");
    document
}

/// Builds the site, every warning an error, draws the committed pictures anew to compare them, and follows all links within the site.
///
/// # Errors
/// If an example fails, a picture is another one, a page has a mistake or a link leads nowhere; if there is no Python or no package index.
pub fn run(root: &Path, steps: &mut Steps) -> Result<(), Stop> {
    let python = steps.step("environment, site", || {
        let python = tools::python_of(root, "target/site-python", "docs/requirements.txt", &[])?;
        let wheel = python::last_wheel(root)?;
        done(tools::pip_install(&python).args(["--force-reinstall", "--no-deps"]).arg(wheel))?;
        Ok(python)
    })?;
    steps.step("pictures", || {
        let program = python.with_file_name("sprag");
        PICTURES.iter().try_for_each(|picture| compare(root, &program, picture))
    })?;
    let site = root.join(SITE);
    steps.step("site", || {
        empty(&root.join(MADE))?;
        empty(&site)?;
        let mut build = Command::new(python.with_file_name("sphinx-build"));
        build.current_dir(root).args(["--nitpicky", "--fail-on-warning", "--keep-going", "--quiet", "--fresh-env"]);
        done(build.args(["--doctree-dir", "target/site-pages", SOURCES, SITE]))
    })?;
    steps.step("site, Rust packages", || {
        // Not made anew where the documentation was checked before.
        done(&mut rust_documents(root))?;
        done(Command::new("cp").arg("-R").arg(target_folder(root).join("doc")).arg(site.join("rust")))
    })?;
    steps.step("links of the site", || {
        let mut follow = Command::new(python.with_file_name("linkchecker"));
        // Rustdoc checks its own links.
        done(follow.current_dir(&site).args(["--no-status", "--no-warnings", "--no-follow-url", "/rust/", "index.html"]))
    })
}

/// Holds a committed picture against the one that its command draws.
fn compare(root: &Path, program: &Path, (picture, words, file): &(&str, [&str; 2], &str)) -> Result<(), Stop> {
    let folder = root.join("target/site-pictures").join(words[0]);
    let mut draw = Command::new(program);
    done(draw.current_dir(root).args(words).args(["--quiet", "--overwrite", "--out"]).arg(&folder))?;
    let drawn = folder.join(file);
    let same = matches!((fs::read(root.join(picture)), fs::read(&drawn)), (Ok(one), Ok(two)) if one == two);
    if same { Ok(()) } else { Err(Stop::failed(format!("{picture} is not {}", drawn.display()))) }
}
