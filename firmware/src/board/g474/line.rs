//! The link: USART1, moved by channels 2 and 3 of DMA1.

use stm32g4::stm32g474 as pac;

use crate::board::parts::ring::{RING, RingLine, Streams, received};

/// Of the line, 1/s.
const BAUD: u32 = 921_600;
/// Clocks a bit, to the nearest: 182, within 0.2 %.
const DIVISOR: u32 = (super::clock::HZ + BAUD / 2) / BAUD;

/// Channel of DMA1 less 1, which is the channel of the multiplexer, that receives, …
const RECEIVER: usize = 1;
/// … and that sends.
const SENDER: usize = 2;
/// Their requests, of the multiplexer's (RM0440, table 91).
const RECEIVED: u8 = 24;
const SENT: u8 = 25;

/// The link.
pub type DmaLine = RingLine<Port>;

/// The channels of the port.
pub struct Port(());

fn dma() -> &'static pac::dma1::RegisterBlock {
    // SAFETY: the block lies at this address for ever, and nobody else uses the two channels of this module.
    unsafe { &*pac::DMA1::ptr() }
}

/// At its pins.
pub fn begin(chip: &pac::Peripherals) -> DmaLine {
    chip.RCC.apb2enr().modify(|_, w| w.usart1en().set_bit());
    chip.RCC.ahb1enr().modify(|_, w| w.dma1en().set_bit().dmamux1en().set_bit());
    let usart = &chip.USART1;
    usart.brr().write(|w| w.brr().set(DIVISOR as u16));
    // A byte that comes too late for its place is lost, as its neighbour would be, and the port continues.
    usart.cr3().write(|w| w.dmar().set_bit().dmat().set_bit().ovrdis().set_bit());
    usart.cr1().write(|w| w.ue().set_bit().te().set_bit().re().set_bit());
    let channel = dma().ch(RECEIVER);
    // SAFETY: the channel writes single bytes within the ring that is for it, and the other only reads.
    unsafe {
        chip.DMAMUX.ccr(RECEIVER).write(|w| w.dmareq_id().bits(RECEIVED));
        chip.DMAMUX.ccr(SENDER).write(|w| w.dmareq_id().bits(SENT));
        channel.par().write(|w| w.pa().bits(usart.rdr().as_ptr() as u32));
        channel.mar().write(|w| w.ma().bits(received()));
        dma().ch(SENDER).par().write(|w| w.pa().bits(usart.tdr().as_ptr() as u32));
    }
    channel.ndtr().write(|w| w.ndt().set(RING));
    channel.cr().write(|w| w.minc().set_bit().circ().set_bit().en().set_bit());
    RingLine::new(Port(()))
}

impl Streams for Port {
    fn left(&mut self) -> u16 {
        dma().ch(RECEIVER).ndtr().read().ndt().bits()
    }

    fn sends(&self) -> bool {
        dma().ch(SENDER).ndtr().read().ndt().bits() != 0
    }

    fn send(&mut self, first: u32, length: u16) {
        let channel = dma().ch(SENDER);
        // A channel stays on at its end, and takes another length only while it is off.
        channel.cr().write(|w| w.en().clear_bit());
        // SAFETY: the stretch is as `Streams` says.
        channel.mar().write(|w| unsafe { w.ma().bits(first) });
        channel.ndtr().write(|w| w.ndt().set(length));
        channel.cr().write(|w| w.minc().set_bit().dir().from_memory().en().set_bit());
    }
}
