//! What a step costs on the microcontroller, measured in the emulator.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use sprag_studies::accuracy_study::board::Board;

/// Reasons why nothing was measured.
#[derive(Debug, thiserror::Error)]
pub enum BoardError {
    /// No image.
    #[error("the image for the emulator cannot be built: {0}")]
    Build(String),
    /// No emulator.
    #[error("qemu-system-arm: {0}; on Debian: sudo apt-get install qemu-system-arm")]
    Emulator(std::io::Error),
    /// It ended otherwise.
    #[error("the emulator ended with {0}")]
    Ended(String),
}

/// Measures in the emulator, with the image at `image` or with one built for it.
pub fn measure(image: Option<&Path>) -> Result<Board, BoardError> {
    let image = match image {
        Some(image) => image.to_owned(),
        None => build()?,
    };
    let mut emulator = Command::new("qemu-system-arm");
    emulator.args(["-machine", "netduinoplus2", "-nographic", "-icount", "shift=0"]);
    emulator.args(["-semihosting-config", "enable=on,target=native", "-kernel"]).arg(image).stdin(Stdio::null());
    let output = emulator.output().map_err(BoardError::Emulator)?;
    if !output.status.success() {
        return Err(BoardError::Ended(output.status.to_string()));
    }
    Ok(Board::read(&String::from_utf8_lossy(&output.stdout)))
}

/// Builds the image from the sources that this program was built from.
fn build() -> Result<PathBuf, BoardError> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let arguments = ["--profile", "image", "--package", "sprag-emulated-core", "--target", "thumbv7em-none-eabihf"];
    super::image::build_in(&root, &arguments, None).map_err(|error| BoardError::Build(error.to_string()))
}
