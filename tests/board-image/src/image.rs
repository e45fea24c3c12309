//! The part of an ELF file that goes into the flash.

use crate::model::Model;
use std::path::{Path, PathBuf};

/// A program for the board.
#[derive(Clone, Debug)]
pub struct Image {
    /// Address and bytes of what is loaded.
    pub segments: Vec<(u32, Vec<u8>)>,
    /// The chip that it is for.
    pub model: Model,
}

/// Why a file is no program for the board.
#[derive(Debug)]
pub enum ImageError {
    /// It cannot be read.
    Unreadable(PathBuf, std::io::Error),
    /// It is no ELF file of 32 bits for ARM.
    NoElf(PathBuf),
}

impl std::fmt::Display for ImageError {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ImageError::Unreadable(path, error) => write!(out, "{}: {error}", path.display()),
            ImageError::NoElf(path) => write!(out, "{}: is no ELF file of 32 bits for ARM", path.display()),
        }
    }
}

impl std::error::Error for ImageError {}

/// Bytes of a header of a segment.
const HEADER: usize = 32;
/// Its type, where it is loaded.
const LOADED: u32 = 1;

impl Image {
    /// Reads the file at `path`.
    pub fn load(path: &Path) -> Result<Image, ImageError> {
        let bytes = std::fs::read(path).map_err(|error| ImageError::Unreadable(path.to_owned(), error))?;
        Image::of(&bytes).ok_or_else(|| ImageError::NoElf(path.to_owned()))
    }

    /// The same for another chip than the first.
    pub fn on(self, model: Model) -> Image {
        Image { model, ..self }
    }

    fn of(bytes: &[u8]) -> Option<Image> {
        let word = |place: usize| Some(u32::from_le_bytes(bytes.get(place..place + 4)?.try_into().ok()?));
        let half = |place: usize| Some(u16::from_le_bytes(bytes.get(place..place + 2)?.try_into().ok()?));
        if !bytes.starts_with(b"\x7fELF\x01\x01") || half(18)? != 40 {
            return None;
        }
        let (first, count) = (word(28)? as usize, usize::from(half(44)?));
        let mut segments = Vec::new();
        for place in (0..count).map(|index| first + HEADER * index) {
            let (start, address, length) = (word(place + 4)? as usize, word(place + 12)?, word(place + 16)? as usize);
            if word(place)? == LOADED && length > 0 {
                segments.push((address, bytes.get(start..start + length)?.to_vec()));
            }
        }
        Some(Image { segments, model: Model::default() })
    }

    /// The last address of the program, and one.
    pub fn end(&self) -> u32 {
        self.segments.iter().map(|(address, bytes)| address + bytes.len() as u32).max().unwrap_or(0)
    }
}
