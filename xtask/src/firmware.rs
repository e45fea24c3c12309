//! The images for the board: what there is, and how they are built.

use crate::{
    process::{cargo_in, executables, run as done},
    seal::seal,
    stop::Stop,
    tools,
};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The board's target.
pub const TARGET: &str = "thumbv7em-none-eabihf";

/// How the emulator runs an image, as in `.cargo/config.toml`; the image follows.
pub const EMULATOR: [&str; 8] = [
    "-machine",
    "netduinoplus2",
    "-nographic",
    "-semihosting-config",
    "enable=on,target=native",
    "-icount",
    "shift=0",
    "-kernel",
];

/// A program for the board.
#[derive(Debug)]
pub struct Image {
    /// What it is called here, and its file in `images` below the target folder.
    pub name: &'static str,
    /// The folder of its workspace, from the root; empty for the root's own.
    pub workspace: &'static str,
    /// Its package.
    pub package: &'static str,
    /// The profile of its release.
    pub profile: &'static str,
    /// Its features, in place of the default ones.
    pub features: &'static [&'static str],
    /// The file with what it may occupy, from the root, if that is limited.
    pub budget: Option<&'static str>,
    /// The environment variable through which tests find it, if they need it.
    pub variable: Option<&'static str>,
    /// Its log, from this level on.
    pub log: Option<&'static str>,
}

/// The core and its own checks, for the emulator.
pub const CORE: Image = Image {
    name: "core",
    workspace: "",
    package: "sprag-emulated-core",
    profile: "image",
    features: &[],
    budget: Some("tests/emulated-core/size.budget"),
    variable: Some("SPRAG_EMULATED_CORE_ELF"),
    log: None,
};

/// The firmware as it goes to the board.
pub const BOARD: Image = Image {
    name: "board",
    workspace: "firmware",
    package: "sprag-firmware",
    profile: "release",
    features: &["board-f405"],
    budget: Some("firmware/size.budget"),
    variable: Some("SPRAG_BOARD_ELF"),
    log: None,
};

/// The firmware as it goes to the board with an STM32G474.
pub const BOARD_G474: Image = Image {
    name: "g474",
    features: &["board-g474"],
    budget: Some("firmware/size-g474.budget"),
    variable: Some("SPRAG_G474_ELF"),
    ..BOARD
};

/// The firmware for the emulator.
const IN_EMULATOR: Image =
    Image { name: "emulator", features: &["board-qemu"], budget: None, variable: Some("SPRAG_FIRMWARE_ELF"), ..BOARD };

/// The firmware for the emulator, with its log.
const LOGGING: Image =
    Image { name: "logging", features: &["board-qemu", "log"], budget: None, variable: None, log: Some("info"), ..BOARD };

/// The firmware for the board with a panic in its control tick, which must not go unseen.
pub const PANICKING: Image =
    Image { name: "panicking", features: &["board-f405", "deliberate-panic"], budget: None, variable: None, ..BOARD };

/// Every image that is checked or tested.
pub const IMAGES: &[Image] = &[CORE, BOARD, BOARD_G474, IN_EMULATOR, LOGGING];

/// Those of them whose lints cover the code of all.
pub const LINTED: &[Image] = &[CORE, BOARD, BOARD_G474, LOGGING];

impl Image {
    /// A command of cargo on this image, for the board. Lints and documents go by the profile of the build too, so that they share its
    /// procedural macros.
    pub fn cargo(&self, root: &Path, subcommand: &str) -> Command {
        let mut command = cargo_in(root, self.workspace, &[subcommand, "--package", self.package, "--target", TARGET]);
        command.args(["--profile", self.profile]);
        if !self.features.is_empty() {
            command.args(["--no-default-features", "--features", &self.features.join(",")]);
        }
        if let Some(level) = self.log {
            command.env("DEFMT_LOG", level);
        }
        command
    }

    /// The object that an image of the firmware is linked from, after all optimisation, once it is built.
    pub fn object(&self, root: &Path) -> PathBuf {
        root.join(self.workspace).join("target/images").join(self.name).with_extension("o")
    }

    /// Builds it with optimisation and gives the path of its ELF file, which other features do not overwrite.
    ///
    /// # Errors
    /// If the build fails.
    pub fn build(&self, root: &Path) -> Result<PathBuf, Stop> {
        let is_firmware = self.workspace == BOARD.workspace;
        let mut command = self.cargo(root, if is_firmware { "rustc" } else { "build" });
        let mut to_compiler = Vec::new();
        if is_firmware {
            let object = self.object(root);
            let folder = object.parent().unwrap_or(root);
            fs::create_dir_all(folder).map_err(|error| Stop::failed(format!("{}: {error}", folder.display())))?;
            to_compiler.push(format!("--emit=link,obj={}", object.display()));
        }
        let named = executables(&mut command, &to_compiler)?.pop();
        let built = named.ok_or_else(|| Stop::failed(format!("cargo built {} but named no executable", self.package)))?;
        // Below the target folder: the target's name, the profile, the file.
        let target = built.ancestors().nth(3).ok_or_else(|| Stop::failed(format!("{}: too short a path", built.display())))?;
        let folder = target.join("images");
        let elf = folder.join(self.name).with_extension("elf");
        fs::create_dir_all(&folder)
            .and_then(|()| fs::copy(&built, &elf))
            .map_err(|error| Stop::failed(format!("{}: {error}", elf.display())))?;
        if self.workspace == BOARD.workspace {
            seal(&elf)?;
        }
        println!("{:<10} {}", self.name, elf.display());
        Ok(elf)
    }

    /// Builds it, and has probe-rs write it to a board with that `chip`.
    ///
    /// # Errors
    /// If the build fails, or probe-rs is missing or fails.
    pub fn flash(&self, root: &Path, chip: &str) -> Result<(), Stop> {
        tools::need_target(root, TARGET)?;
        let elf = self.build(root)?;
        done(Command::new("probe-rs").args(["run", "--chip", chip]).arg(elf))
    }
}

/// The ELF files of all images.
#[derive(Debug)]
pub struct Built(Vec<(&'static Image, PathBuf)>);

impl Built {
    /// Builds every image.
    ///
    /// # Errors
    /// If a build fails.
    pub fn all(root: &Path) -> Result<Self, Stop> {
        IMAGES.iter().map(|image| Ok((image, image.build(root)?))).collect::<Result<_, Stop>>().map(Self)
    }

    /// The images with a budget, and that.
    pub fn budgets(&self) -> impl Iterator<Item = (&Image, &Path, &str)> {
        self.0.iter().filter_map(|(image, elf)| Some((*image, elf.as_path(), image.budget?)))
    }

    /// The environment variables through which tests find the images.
    pub fn variables(&self) -> impl Iterator<Item = (&str, &Path)> {
        self.0.iter().filter_map(|(image, elf)| Some((image.variable?, elf.as_path())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_images_share_a_file_or_a_variable() {
        let all: Vec<_> = IMAGES.iter().chain([&PANICKING]).collect();
        for (index, one) in all.iter().enumerate() {
            for other in &all[index + 1..] {
                assert_ne!(one.name, other.name);
                assert!(one.variable.is_none() || one.variable != other.variable);
                assert!(one.budget.is_none() || one.budget != other.budget);
            }
        }
    }
}
