//! The link: USART1, moved by streams 2 and 7 of DMA2. No interrupt.
//!
//! What comes is written by the stream into a ring that it goes round for ever; reading follows its position. A reader that is late by
//! more than the ring loses bytes, which the link's checksums show. What goes is copied into a ring whose longest stretch in one piece is
//! handed to the stream whenever the last one is out; both calls see to that.

use core::sync::atomic::{AtomicU8, Ordering, compiler_fence};

use stm32f4xx_hal::gpio::{Pin, Pull};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};

use crate::board::Line;

/// Of the line, 1/s.
const BAUD: u32 = 921_600;
/// Of the peripheral's clock, 1/s.
const CLOCK: u32 = super::clock::HZ / 2;
/// Clocks a bit, to the nearest: 91, within 0.2 %.
const DIVISOR: u32 = (CLOCK + BAUD / 2) / BAUD;

/// Bytes of a ring: 11 ms.
const RING: u16 = 1024;
/// Stream of DMA2 that receives, …
const RECEIVER: usize = 2;
/// … and that sends.
const SENDER: usize = 7;
/// Channel of both.
const CHANNEL: u8 = 4;

static RECEIVED: [AtomicU8; RING as usize] = [const { AtomicU8::new(0) }; RING as usize];
static SENT: [AtomicU8; RING as usize] = [const { AtomicU8::new(0) }; RING as usize];

/// The link.
pub struct DmaLine {
    dma: pac::DMA2,
    usart: pac::USART1,
    /// Next byte to read.
    read: u16,
    /// Next byte to write, …
    written: u16,
    /// … first one not yet handed to the stream, …
    handed: u16,
    /// … and first one that may still be on its way.
    gone: u16,
}

impl DmaLine {
    /// With its pins: out, in.
    pub fn new(usart: pac::USART1, dma: pac::DMA2, (out, into): (Pin<'A', 9>, Pin<'A', 10>), rcc: &mut Rcc) -> DmaLine {
        let _: Pin<'A', 9, _> = out.into_alternate::<7>();
        let _: Pin<'A', 10, _> = into.into_alternate::<7>().internal_resistor(Pull::Up);
        pac::USART1::enable(rcc);
        pac::USART1::reset(rcc);
        pac::DMA2::enable(rcc);
        pac::DMA2::reset(rcc);
        usart.brr().write(|w| w.div_mantissa().set((DIVISOR / 16) as u16).div_fraction().set((DIVISOR % 16) as u8));
        usart.cr3().write(|w| w.dmar().set_bit().dmat().set_bit());
        usart.cr1().write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
        let port = usart.dr().as_ptr() as u32;
        let stream = dma.st(RECEIVER);
        // SAFETY: the stream writes single bytes within the ring, whose bytes are atomic and live for ever, and the other only reads them.
        unsafe {
            stream.par().write(|w| w.pa().bits(port));
            stream.m0ar().write(|w| w.m0a().bits(RECEIVED.as_ptr() as u32));
            dma.st(SENDER).par().write(|w| w.pa().bits(port));
        }
        stream.ndtr().write(|w| w.ndt().set(RING));
        stream.cr().write(|w| w.chsel().set(CHANNEL).minc().set_bit().circ().set_bit().en().set_bit());
        DmaLine { dma, usart, read: 0, written: 0, handed: 0, gone: 0 }
    }

    /// Hands the next stretch to the sending stream once the last one is out.
    fn send_on(&mut self) {
        let stream = self.dma.st(SENDER);
        if stream.cr().read().en().bit_is_set() {
            return;
        }
        self.gone = self.handed;
        let end = if self.handed <= self.written { self.written } else { RING };
        let length = end - self.handed;
        let Some(first) = SENT.get(usize::from(self.handed)..) else { return };
        if length == 0 {
            return;
        }
        self.handed = end % RING;
        self.dma
            .hifcr()
            .write(|w| w.ctcif7().set_bit().chtif7().set_bit().cteif7().set_bit().cdmeif7().set_bit().cfeif7().set_bit());
        // SAFETY: the stretch lies within the ring, which lives for ever, and is not written to before it is gone.
        stream.m0ar().write(|w| unsafe { w.m0a().bits(first.as_ptr() as u32) });
        stream.ndtr().write(|w| w.ndt().set(length));
        // The bytes must be in memory before the stream looks.
        compiler_fence(Ordering::Release);
        stream.cr().write(|w| w.chsel().set(CHANNEL).minc().set_bit().dir().memory_to_peripheral().en().set_bit());
    }
}

impl Line for DmaLine {
    fn read(&mut self, bytes: &mut [u8]) -> usize {
        self.send_on();
        // These two readings clear an overrun. They may take a byte from the stream, where one was lost anyway.
        if self.usart.sr().read().ore().bit_is_set() {
            let _ = self.usart.dr().read();
        }
        let position = RING.saturating_sub(self.dma.st(RECEIVER).ndtr().read().ndt().bits()) % RING;
        compiler_fence(Ordering::Acquire);
        let mut count = 0;
        for to in bytes {
            if self.read == position {
                break;
            }
            *to = RECEIVED.get(usize::from(self.read)).map_or(0, |byte| byte.load(Ordering::Relaxed));
            self.read = (self.read + 1) % RING;
            count += 1;
        }
        count
    }

    fn write(&mut self, bytes: &[u8]) -> usize {
        self.send_on();
        let mut count = 0;
        for byte in bytes {
            let next = (self.written + 1) % RING;
            if next == self.gone {
                break;
            }
            if let Some(place) = SENT.get(usize::from(self.written)) {
                place.store(*byte, Ordering::Relaxed);
            }
            self.written = next;
            count += 1;
        }
        self.send_on();
        count
    }
}
