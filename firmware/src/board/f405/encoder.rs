//! The encoder's counter, TIM4, which runs on through a reset.
//!
//! Its count is [kept](crate::board::parts::kept_count) by a stream of DMA1, paced by TIM3.

use sprag_shared::device::counter::Extended;
use stm32f4xx_hal::gpio::{Pin, Pull};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::rcc::{Enable, Rcc};

use crate::board::parts::inertial::Counter;
use crate::board::parts::kept_count::{COUNT, count_on};

/// Copies of the count in a second.
const COPIES: u32 = 20_000;
/// Of the timer that paces them, 1/s.
const CLOCK: u32 = super::clock::HZ / 2;
/// Stream of DMA1 that TIM3's update asks, …
const STREAM: usize = 2;
/// … on this channel.
const CHANNEL: u8 = 5;

/// What makes TIM4 count right after a reset, when every register holds its reset value: address and value.
static FIRST_STEPS: [[u32; 2]; 10] = [
    // RCC_AHB1ENR: port B beside the core-coupled memory.
    [0x4002_3830, 1 << 20 | 1 << 1],
    // RCC_APB1ENR: TIM4.
    [0x4002_3840, 1 << 2],
    // GPIOB_AFRL: AF2 at PB6 and PB7.
    [0x4002_0420, 0x2200_0000],
    // GPIOB_PUPDR: both pulled up, and PB4 as it was.
    [0x4002_040C, 0x0000_5100],
    // GPIOB_MODER: both alternate, and PB3 and PB4 as they were.
    [0x4002_0400, 0x0000_A280],
    // TIM4_CCMR1: inputs 1 and 2, each after eight samples at the timer's clock alike: at 84 MHz 95 ns, to ignore the edges of the coils'
    // drivers.
    [0x4000_0818, 0x3131],
    // TIM4_CCER: both.
    [0x4000_0820, 0x0011],
    // TIM4_SMCR: counts at the edges of both.
    [0x4000_0808, 0x0003],
    // TIM4_ARR.
    [0x4000_082C, 0xFFFF],
    [0, 0],
];

count_on!(FIRST_STEPS, 0x4000_0800);

/// The counter.
pub struct Encoder {
    timer: pac::TIM4,
    travel: Extended,
}

/// Lets it miss what the pins do while their port is reset, which are no edges of the encoder's.
pub fn pause(timer: &pac::TIM4) {
    timer.cr1().modify(|_, w| w.cen().clear_bit());
}

impl Encoder {
    /// At its pins, A and B, continuing after a [`pause`]: from the count that was read last before a reset, or else from 0.
    pub fn new(timer: pac::TIM4, (a, b): (Pin<'B', 6>, Pin<'B', 7>), last: Option<i32>) -> Encoder {
        let _: Pin<'B', 6, _> = a.into_alternate::<2>().internal_resistor(Pull::Up);
        let _: Pin<'B', 7, _> = b.into_alternate::<2>().internal_resistor(Pull::Up);
        if last.is_none() {
            timer.cnt().write(|w| w.cnt().set(0));
        }
        timer.cr1().modify(|_, w| w.cen().set_bit());
        Encoder { timer, travel: last.map_or_else(Extended::default, Extended::going_on) }
    }

    /// Lets the count be copied on and on.
    pub fn copy(&self, pacer: pac::TIM3, dma: &pac::DMA1, rcc: &mut Rcc) {
        pac::TIM3::enable(rcc);
        pac::DMA1::enable(rcc);
        let stream = dma.st(STREAM);
        // SAFETY: the stream writes the low half of one word that lasts for ever, which nobody else writes.
        unsafe {
            stream.par().write(|w| w.pa().bits(self.timer.cnt().as_ptr() as u32));
            stream.m0ar().write(|w| w.m0a().bits(COUNT.address() as u32));
        }
        stream.ndtr().write(|w| w.ndt().set(1));
        stream.cr().write(|w| w.chsel().set(CHANNEL).psize().bits16().msize().bits16().circ().set_bit().en().set_bit());
        pacer.arr().write(|w| w.arr().set((CLOCK / COPIES - 1) as u16));
        pacer.dier().write(|w| w.ude().set_bit());
        pacer.cr1().write(|w| w.cen().set_bit());
    }
}

impl Counter for Encoder {
    fn read(&mut self) -> i32 {
        self.travel.read(self.timer.cnt().read().cnt().bits())
    }
}
