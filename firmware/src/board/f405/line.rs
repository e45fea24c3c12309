//! The link: USART1, moved by streams 2 and 7 of DMA2.

use stm32f4xx_hal::gpio::{Pin, Pull};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc, Reset};

use crate::board::parts::ring::{RING, RingLine, Streams, received};

/// Of the line, 1/s.
const BAUD: u32 = 921_600;
/// Of the peripheral's clock, 1/s.
const CLOCK: u32 = super::clock::HZ / 2;
/// Clocks a bit, to the nearest: 91, within 0.2 %.
const DIVISOR: u32 = (CLOCK + BAUD / 2) / BAUD;

/// Stream of DMA2 that receives, …
const RECEIVER: usize = 2;
/// … and that sends.
const SENDER: usize = 7;
/// Channel of both.
const CHANNEL: u8 = 4;

/// The link.
pub type DmaLine = RingLine<Port>;

/// The port and its streams.
pub struct Port {
    dma: pac::DMA2,
    usart: pac::USART1,
}

impl DmaLine {
    /// With its pins: out, in.
    pub fn at(usart: pac::USART1, dma: pac::DMA2, (out, into): (Pin<'A', 9>, Pin<'A', 10>), rcc: &mut Rcc) -> DmaLine {
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
        // SAFETY: the stream writes single bytes within the ring that is for it, and the other only reads.
        unsafe {
            stream.par().write(|w| w.pa().bits(port));
            stream.m0ar().write(|w| w.m0a().bits(received()));
            dma.st(SENDER).par().write(|w| w.pa().bits(port));
        }
        stream.ndtr().write(|w| w.ndt().set(RING));
        stream.cr().write(|w| w.chsel().set(CHANNEL).minc().set_bit().circ().set_bit().en().set_bit());
        RingLine::new(Port { dma, usart })
    }
}

impl Streams for Port {
    fn left(&mut self) -> u16 {
        // These two readings clear an overrun. They may take a byte from the stream, where one was lost anyway.
        if self.usart.sr().read().ore().bit_is_set() {
            let _ = self.usart.dr().read();
        }
        self.dma.st(RECEIVER).ndtr().read().ndt().bits()
    }

    fn sends(&self) -> bool {
        self.dma.st(SENDER).cr().read().en().bit_is_set()
    }

    fn send(&mut self, first: u32, length: u16) {
        let stream = self.dma.st(SENDER);
        self.dma
            .hifcr()
            .write(|w| w.ctcif7().set_bit().chtif7().set_bit().cteif7().set_bit().cdmeif7().set_bit().cfeif7().set_bit());
        // SAFETY: the stretch is as `Streams` says.
        stream.m0ar().write(|w| unsafe { w.m0a().bits(first) });
        stream.ndtr().write(|w| w.ndt().set(length));
        stream.cr().write(|w| w.chsel().set(CHANNEL).minc().set_bit().dir().memory_to_peripheral().en().set_bit());
    }
}
