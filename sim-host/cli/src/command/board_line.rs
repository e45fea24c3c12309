//! Where a device is: in the emulator, which is built and started, or on a port.

use std::path::PathBuf;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args};

use crate::board::emulator::{Emulator, Way};
use crate::board::image::{self, Image};
use crate::board::line::{DeviceError, Line};
use crate::board::log::Log;
use crate::board::serial;
use crate::part::{DEFMT, SERIAL};

/// Where the device is.
#[derive(Args, Clone, Debug)]
#[command(group = ArgGroup::new("device").args(["port", "qemu", "board_image"]).required(true))]
pub struct LineArguments {
    /// On a serial port.
    #[arg(long, value_name = "DEV", value_parser = |port: &str| SERIAL.allow(port.to_owned()))]
    pub port: Option<String>,
    /// In the emulator: runs the firmware in QEMU.
    #[arg(long)]
    pub qemu: bool,
    /// The board's own image, unmodified, between models of the board's parts: builds both. Needs libunicorn-dev.
    #[arg(long)]
    pub board_image: bool,
    /// Do not build: run this image in the emulator, or between the models.
    #[arg(long, value_name = "ELF", conflicts_with = "port")]
    pub firmware: Option<PathBuf>,
    /// How bytes get into the emulator; by usart a loop takes some 20 times as long as by streams.
    #[arg(long, value_enum, default_value_t, requires = "qemu")]
    pub way: Way,
    /// Build the firmware with logs from this level on, from the clone that this program was built from, and show them.
    #[arg(long, value_name = "LEVEL", value_parser = level(), requires = "qemu")]
    pub log: Option<String>,
}

/// Takes a level of logs.
fn level() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(["trace", "debug", "info", "warn", "error"]).try_map(|level| DEFMT.allow(level))
}

/// A device that has been found.
pub struct Connected {
    /// The way to it.
    pub line: Box<dyn Line>,
    /// What it logs, once it has stopped.
    pub log: Option<Log>,
}

/// Finds the device, or builds and starts one.
pub fn connect(arguments: &LineArguments) -> Result<Connected, DeviceError> {
    if let Some(port) = &arguments.port {
        return Ok(Connected { line: serial::open(port)?, log: None });
    }
    if arguments.board_image {
        if let Some(image) = &arguments.firmware {
            image::check(image)?;
        }
        let bench = image::build_bench()?;
        let image = arguments.firmware.clone().map_or_else(image::build_board, Ok)?;
        return Ok(Connected { line: Box::new(Emulator::between_models(&bench, &image)?), log: None });
    }
    let image = match &arguments.firmware {
        Some(image) => {
            image::check(image)?;
            Image::File(image.clone())
        }
        None => image::for_emulator(arguments.log.as_deref())?,
    };
    let log = arguments.log.as_ref().map(|_| Log::new(image.path())).transpose()?;
    let emulator = Emulator::start(image, arguments.way, log.as_ref().map(Log::path).as_deref())?;
    Ok(Connected { line: Box::new(emulator), log })
}
