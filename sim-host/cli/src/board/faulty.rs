//! A line that loses, doubles, reorders, cuts and damages frames, for tests of what a device makes of that.

use std::time::Duration;

use sprag_shared::link::Pace;

use super::line::{DeviceError, Line};

/// Where a frame goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// To the device.
    ToDevice,
    /// From it.
    FromDevice,
}

/// What becomes of a frame, given its number in its direction and its bytes with the zero that ends it: the bytes that arrive.
pub trait Fate: FnMut(Direction, u64, &[u8]) -> Vec<u8> {}

impl<F: FnMut(Direction, u64, &[u8]) -> Vec<u8>> Fate for F {}

/// A line with a fate.
pub struct FaultyLine<L, F> {
    line: L,
    fate: F,
    numbers: [u64; 2],
    unfinished: [Vec<u8>; 2],
}

impl<L: Line, F: Fate> FaultyLine<L, F> {
    /// Over `line`.
    pub fn new(line: L, fate: F) -> FaultyLine<L, F> {
        FaultyLine { line, fate, numbers: [0; 2], unfinished: Default::default() }
    }

    fn pass(&mut self, direction: Direction, bytes: &[u8]) -> Vec<u8> {
        let side = direction as usize;
        let mut arrived = Vec::new();
        for &byte in bytes {
            self.unfinished[side].push(byte);
            if byte == 0 {
                let frame = std::mem::take(&mut self.unfinished[side]);
                arrived.extend((self.fate)(direction, self.numbers[side], &frame));
                self.numbers[side] += 1;
            }
        }
        arrived
    }
}

impl<L: Line, F: Fate> Line for FaultyLine<L, F> {
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
        let arrived = self.pass(Direction::ToDevice, bytes);
        if arrived.is_empty() { Ok(()) } else { self.line.send(&arrived) }
    }

    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        let bytes = self.line.receive(patience)?;
        Ok(self.pass(Direction::FromDevice, &bytes))
    }

    fn pace(&self) -> Pace {
        self.line.pace()
    }
}
