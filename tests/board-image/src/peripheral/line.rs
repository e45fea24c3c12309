//! USART1 and the two streams of DMA2 that move its bytes (RM0090 sections 30 and 10), and the wires to the host.

use std::collections::VecDeque;

use super::registers::Registers;
use crate::engine::Memory;
use crate::time::SECOND;

const STATUS: u32 = 0x00;
const BRR: u32 = 0x08;
const CR1: u32 = 0x0C;
/// Offsets of stream 2's registers in DMA2, which receives.
const RECEIVER: u32 = 0x10 + 0x18 * 2;
/// Offsets of stream 7's, which sends.
const SENDER: u32 = 0x10 + 0x18 * 7;
const NDTR: u32 = 0x04;
const M0AR: u32 = 0x0C;
const ENABLED: u32 = 1;
const CIRCULAR: u32 = 1 << 8;
/// Bits of a byte with its start and its stop.
const BITS: u64 = 10;

/// The line.
#[derive(Clone, Debug, Default)]
pub struct Line {
    usart: Registers,
    dma: Registers,
    incoming: VecDeque<(u64, u8)>,
    outgoing: VecDeque<(u64, u8)>,
    /// Of the ring that receives: bytes, and where the next goes.
    ring: (u32, u32),
    sent_at: u64,
    /// How many times faster than its registers say the line is, to see more of the device than 921,600 bit/s let through.
    pub haste: u64,
}

impl Line {
    /// Registers of the USART as after a reset.
    pub fn reset(&mut self) {
        self.usart = Registers::of(&[(STATUS, 0xC0)]);
    }

    /// Registers of the streams as after a reset.
    pub fn reset_streams(&mut self) {
        self.dma = Registers::default();
        self.ring = (0, 0);
        self.sent_at = 0;
    }

    fn byte_time(&self, clock: u64) -> u64 {
        BITS * u64::from(self.usart.get(BRR)).max(1) * SECOND / clock / self.haste.max(1)
    }

    /// The host sends; bytes go one after the other.
    pub fn send(&mut self, bytes: &[u8], clock: u64, now: u64) {
        let time = self.byte_time(clock);
        let mut at = self.incoming.back().map_or(now, |&(at, _)| at.max(now));
        for &byte in bytes {
            at += time;
            self.incoming.push_back((at, byte));
        }
    }

    /// What has come to the host.
    pub fn take(&mut self, now: u64) -> Vec<u8> {
        let whole = self.outgoing.iter().take_while(|(at, _)| *at <= now).count();
        self.outgoing.drain(..whole).map(|(_, byte)| byte).collect()
    }

    /// Moves what has come over the wire into the memory.
    fn receive(&mut self, memory: &Memory, now: u64) {
        while let Some(&(at, byte)) = self.incoming.front() {
            if at > now {
                break;
            }
            self.incoming.pop_front();
            if !self.dma.has(RECEIVER, ENABLED) || !self.usart.has(CR1, 1 << 13 | 1 << 2) {
                continue;
            }
            let (length, place) = self.ring;
            memory.write(self.dma.get(RECEIVER + M0AR) + place, &[byte]);
            self.ring.1 = (place + 1) % length.max(1);
            if self.ring.1 == 0 && !self.dma.has(RECEIVER, CIRCULAR) {
                self.dma.set(RECEIVER, self.dma.get(RECEIVER) & !ENABLED);
            }
        }
    }

    /// A load from the USART.
    pub fn read(&self, offset: u32) -> u32 {
        if offset == STATUS { 0xC0 } else { self.usart.get(offset) }
    }

    /// A store to the USART.
    pub fn write(&mut self, offset: u32, value: u32) {
        self.usart.set(offset, value);
    }

    /// A load from DMA2.
    pub fn read_stream(&mut self, offset: u32, memory: &Memory, now: u64) -> u32 {
        const LEFT: u32 = RECEIVER + NDTR;
        match offset {
            LEFT if self.dma.has(RECEIVER, ENABLED) => {
                self.receive(memory, now);
                self.ring.0 - self.ring.1
            }
            SENDER if now < self.sent_at => self.dma.get(SENDER),
            SENDER => self.dma.get(SENDER) & !ENABLED,
            _ => self.dma.get(offset),
        }
    }

    /// A store to DMA2.
    pub fn write_stream(&mut self, offset: u32, value: u32, memory: &Memory, clock: u64, now: u64) {
        self.dma.set(offset, value);
        if offset == RECEIVER && value & ENABLED != 0 {
            self.ring = (self.dma.get(RECEIVER + NDTR), 0);
        }
        if offset == SENDER && value & ENABLED != 0 {
            let mut bytes = vec![0; self.dma.get(SENDER + NDTR) as usize];
            memory.read(self.dma.get(SENDER + M0AR), &mut bytes);
            let time = self.byte_time(clock);
            let mut at = now;
            for byte in bytes {
                at += time;
                self.outgoing.push_back((at, byte));
            }
            self.sent_at = at;
        }
    }
}
