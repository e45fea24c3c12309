//! The encoder's counter, TIM4, which runs on through a reset.
//!
//! Its count is [kept](crate::board::parts::kept_count) by channel 1 of DMA1, paced by TIM3.

use sprag_shared::device::counter::Extended;
use stm32g4::stm32g474 as pac;

use crate::board::parts::inertial::Counter;
use crate::board::parts::kept_count::{COUNT, count_on};

/// Copies of the count in a second.
const COPIES: u32 = 20_000;
/// Channel of DMA1 less 1, which is the channel of the multiplexer.
const CHANNEL: usize = 0;
/// TIM3's update, among the multiplexer's requests (RM0440, table 91).
const TIM3_UPDATE: u8 = 65;

/// What makes TIM4 count right after a reset, when every register holds its reset value: address and value.
static FIRST_STEPS: [[u32; 2]; 11] = [
    // RCC_AHB2ENR: port B.
    [0x4002_104C, 1 << 1],
    // RCC_APB1ENR1: PWR and TIM4 beside the clock of the RTC's registers.
    [0x4002_1058, 1 << 28 | 1 << 10 | 1 << 2],
    // PWR_CR3: no pull-down of a dead battery's USB-C port at PB4 and PB6, while PA9 and PA10 are high.
    [0x4000_7008, 1 << 15 | 1 << 14],
    // GPIOB_AFRL: AF2 at PB6 and PB7.
    [0x4800_0420, 0x2200_0000],
    // GPIOB_PUPDR: both pulled up, and PB4 as it was.
    [0x4800_040C, 0x0000_5100],
    // GPIOB_MODER: both alternate, the others as they were.
    [0x4800_0400, 0xFFFF_AEBF],
    // TIM4_CCMR1: inputs 1 and 2, each after eight samples at half the timer's clock alike: 95 ns, to ignore the edges of the coils'
    // drivers.
    [0x4000_0818, 0x5151],
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
    travel: Extended,
}

fn timer() -> &'static pac::tim3::RegisterBlock {
    // SAFETY: the block lies at this address for ever, and only the one encoder uses it.
    unsafe { &*pac::TIM4::ptr() }
}

impl Encoder {
    /// An encoder that continues from the count that was read last before a reset, or else from 0. The count is copied from now on.
    pub fn new(chip: &pac::Peripherals, last: Option<i32>) -> Encoder {
        if last.is_none() {
            timer().cnt().write(|w| w.cnt().set(0));
        }
        chip.RCC.apb1enr1().modify(|_, w| w.tim3en().set_bit());
        chip.RCC.ahb1enr().modify(|_, w| w.dma1en().set_bit().dmamux1en().set_bit());
        let channel = chip.DMA1.ch(CHANNEL);
        // SAFETY: the channel writes the low half of one word that lasts for ever, which nobody else writes, when that request comes.
        unsafe {
            chip.DMAMUX.ccr(CHANNEL).write(|w| w.dmareq_id().bits(TIM3_UPDATE));
            channel.par().write(|w| w.pa().bits(timer().cnt().as_ptr() as u32));
            channel.mar().write(|w| w.ma().bits(COUNT.address() as u32));
        }
        channel.ndtr().write(|w| w.ndt().set(1));
        channel.cr().write(|w| w.psize().bits16().msize().bits16().circ().set_bit().en().set_bit());
        // SAFETY: the value is a period of 16 bits.
        chip.TIM3.arr().write(|w| unsafe { w.bits(super::clock::HZ / COPIES - 1) });
        chip.TIM3.dier().write(|w| w.ude().set_bit());
        chip.TIM3.cr1().write(|w| w.cen().set_bit());
        Encoder { travel: last.map_or_else(Extended::default, Extended::going_on) }
    }
}

impl Counter for Encoder {
    fn read(&mut self) -> i32 {
        self.travel.read(timer().cnt().read().cnt().bits())
    }
}
