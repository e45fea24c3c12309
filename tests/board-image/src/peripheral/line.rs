//! USART1 and the two streams of DMA2 that move its bytes (RM0090 sections 30 and 10), and the wires to the host.

use std::collections::VecDeque;

use super::registers::Registers;
use crate::engine::Memory;
use crate::model::Model;
use crate::time::SECOND;

/// Where what is.
#[derive(Clone, Copy, Debug)]
struct Layout {
    status: u32,
    rate: u32,
    control: u32,
    /// Bits of the control register that have it receive.
    receives: u32,
    /// Offsets of the registers of the stream that receives and of the one that sends.
    receiver: u32,
    sender: u32,
    length: u32,
    memory: u32,
    circular: u32,
    /// Offset in the multiplexer, the same divided by four, and what is asked for there.
    requests: [(u32, u32); 2],
}

/// Streams 2 and 7 of DMA2.
const F405: Layout = Layout {
    status: 0x00,
    rate: 0x08,
    control: 0x0C,
    receives: 1 << 13 | 1 << 2,
    receiver: 0x10 + 0x18 * 2,
    sender: 0x10 + 0x18 * 7,
    length: 0x04,
    memory: 0x0C,
    circular: 1 << 8,
    requests: [(0, 0); 2],
};

/// Channels 2 and 3 of DMA1, by the multiplexer's requests 24 and 25 (RM0440, DMA, DMAMUX, USART).
const G474: Layout = Layout {
    status: 0x1C,
    rate: 0x0C,
    control: 0x00,
    receives: 1 << 2 | 1,
    receiver: 0x08 + 0x14,
    sender: 0x08 + 2 * 0x14,
    length: 0x04,
    memory: 0x0C,
    circular: 1 << 5,
    requests: [(4, 24), (8, 25)],
};

const ENABLED: u32 = 1;
/// Bits of a byte with its start and its stop.
const BITS: u64 = 10;

/// The line.
#[derive(Clone, Debug)]
pub struct Line {
    layout: Layout,
    /// The multiplexer of a G4.
    pub multiplexer: Registers,
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
    /// Of a chip.
    pub fn new(model: Model) -> Line {
        Line {
            layout: if model == Model::G474 { G474 } else { F405 },
            multiplexer: Registers::default(),
            usart: Registers::default(),
            dma: Registers::default(),
            incoming: VecDeque::new(),
            outgoing: VecDeque::new(),
            ring: (0, 0),
            sent_at: 0,
            haste: 0,
        }
    }

    /// Whether the multiplexer leads its requests to the stream that receives, or to that which sends.
    fn asked(&self, stream: usize) -> bool {
        let (offset, request) = self.layout.requests[stream];
        self.multiplexer.get(offset) == request
    }

    /// Registers of the USART as after a reset.
    pub fn reset(&mut self) {
        self.usart = Registers::default();
    }

    /// Registers of the streams as after a reset.
    pub fn reset_streams(&mut self) {
        self.dma = Registers::default();
        self.multiplexer = Registers::default();
        self.ring = (0, 0);
        self.sent_at = 0;
    }

    fn byte_time(&self, clock: u64) -> u64 {
        BITS * u64::from(self.usart.get(self.layout.rate)).max(1) * SECOND / clock / self.haste.max(1)
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
        let Layout { receiver, control, receives, memory: first, circular, .. } = self.layout;
        while let Some(&(at, byte)) = self.incoming.front() {
            if at > now {
                break;
            }
            self.incoming.pop_front();
            let on = self.dma.has(receiver, ENABLED) && self.usart.has(control, receives);
            if !on || !self.asked(0) {
                continue;
            }
            let (length, place) = self.ring;
            memory.write(self.dma.get(receiver + first) + place, &[byte]);
            self.ring.1 = (place + 1) % length.max(1);
            if self.ring.1 == 0 && !self.dma.has(receiver, circular) {
                self.dma.set(receiver, self.dma.get(receiver) & !ENABLED);
            }
        }
    }

    /// A load from the USART.
    pub fn read(&self, offset: u32) -> u32 {
        if offset == self.layout.status { 0xC0 } else { self.usart.get(offset) }
    }

    /// A store to the USART.
    pub fn write(&mut self, offset: u32, value: u32) {
        self.usart.set(offset, value);
    }

    /// A load from the streams' controller.
    pub fn read_stream(&mut self, offset: u32, memory: &Memory, now: u64) -> u32 {
        let Layout { receiver, sender, length, .. } = self.layout;
        let sends = now < self.sent_at;
        match offset {
            _ if offset == receiver + length && self.dma.has(receiver, ENABLED) => {
                self.receive(memory, now);
                self.ring.0 - self.ring.1
            }
            // A channel of a G4 stays on at its end.
            _ if offset == sender && !sends && self.layout.sender == F405.sender => self.dma.get(sender) & !ENABLED,
            _ if offset == sender + length && !sends && self.dma.has(sender, ENABLED) => 0,
            _ => self.dma.get(offset),
        }
    }

    /// A store to the streams' controller.
    pub fn write_stream(&mut self, offset: u32, value: u32, memory: &Memory, clock: u64, now: u64) {
        let Layout { receiver, sender, length, memory: first, .. } = self.layout;
        let begins = value & !self.dma.get(offset) & ENABLED != 0;
        // Address and length are taken while a stream is off only.
        let on = |stream: u32| self.dma.has(stream, ENABLED) && offset > stream && offset <= stream + 0x0C;
        if self.layout.sender == G474.sender && (on(receiver) || on(sender)) {
            return;
        }
        self.dma.set(offset, value);
        if offset == receiver && value & ENABLED != 0 {
            self.ring = (self.dma.get(receiver + length), 0);
        }
        if offset == sender && value & ENABLED != 0 && (begins || self.layout.sender == F405.sender) && self.asked(1) {
            let mut bytes = vec![0; self.dma.get(sender + length) as usize];
            memory.read(self.dma.get(sender + first), &mut bytes);
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
