//! The board of QEMU's machine `netduinoplus2`: an STM32F405 without clocks, sensors, coils, watchdog or flash controller.
//!
//! Sensors and clutches are at the other end of the link. It has two ways: the host's standard streams by semihosting, a chunk each way for
//! every control period, or USART1, byte by byte (with `usart` on the command line). TIM2 counts virtual nanoseconds, which under
//! `-icount shift=0` are instructions. A watchdog and a flash that can lose power in the middle of a write are played by TIM4 and by memory
//! that a reset does not clear.
//!
//! QEMU's timers raise their interrupt later than they should, by the time at which their count would have been 0. So the count of TIM4
//! follows virtual time from its beginning, over resets, and the watchdog is fed by setting its period anew instead of its count to 0.

mod flash;
mod line;
#[cfg(feature = "log")]
mod log;

use core::sync::atomic::{AtomicBool, AtomicU8, AtomicU32, Ordering};

use super::{Board, Coils, Light, Parts, Sensors, Watchdog};
use crate::last_words;
use crate::memory::{self, Lasting};
use cortex_m::peripheral::NVIC;
use sprag_shared::control::monitor::coil::CoilReading;
use sprag_shared::control::sensing::sample::Sample;
use sprag_shared::device::light::Shown;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::settings::Settings;
use stm32f4xx_hal::pac::{self, Interrupt, interrupt};

pub use stm32f4xx_hal::pac as chip;

pub use flash::cut_power_after;
pub use line::Line;

/// Counts of the timers in a second: QEMU clocks them so, whatever the program sets.
const COUNTER_HZ: u32 = 1_000_000_000;

/// Counts of the board's counter in one of the watchdog's, which is a microsecond.
const PRESCALER: u32 = COUNTER_HZ / 1_000_000;

/// For how long the watchdog waits, µs.
const WATCHDOG: u32 = 20_000;

/// Memory holds this from the first start on.
const ALIVE: u32 = 0xA11F_E000;

#[unsafe(link_section = ".uninit.ALIVE")]
static MARK: Lasting<u32> = Lasting::new();

/// Virtual time since its beginning, ns: memory begins as zeros here.
#[unsafe(link_section = ".uninit.ELAPSED")]
static ELAPSED: Lasting<u64> = Lasting::new();

/// The counter when that was noted.
static NOTED: AtomicU32 = AtomicU32::new(0);

/// Adds to [`ELAPSED`] what has elapsed. Often enough: the counter wraps after 4 s.
fn note_time() -> u64 {
    let now = Qemu::now();
    let more = now.wrapping_sub(NOTED.swap(now, Ordering::Relaxed));
    // SAFETY: a number holds any bits.
    let elapsed = unsafe { ELAPSED.read() }.wrapping_add(more.into());
    ELAPSED.write(elapsed);
    elapsed
}

/// A control period has passed: the line may exchange a chunk.
static TICKED: AtomicBool = AtomicBool::new(false);

/// The last command to the coils.
static COILS: AtomicU8 = AtomicU8::new(0);

/// The board.
pub struct Qemu(pac::Peripherals);

impl Board for Qemu {
    const NAME: &'static str = "qemu";
    const COUNTER_HZ: u32 = COUNTER_HZ;
    const CORE_HZ: u32 = 84_000_000;
    /// A look through the settings takes more than 45 µs here, where no unit makes checksums, and holds a tick up for as long.
    const LEAST_PERIOD: f32 = 60e-6;
    /// As on the board that it stands for, though nothing stalls here.
    const ERASING_STALLS: bool = true;
    const PROGRAMMING_STALL: u32 = 0;
    type Chip = pac::Peripherals;
    type Sensors = Elsewhere;
    type Coils = Elsewhere;
    type Watchdog = Elsewhere;
    type Line = Line;
    type Flash = flash::Settings;
    type Recordings = flash::Recordings;
    type Light = Elsewhere;

    fn wake(mut core: cortex_m::Peripherals, chip: pac::Peripherals) -> (Qemu, Cause) {
        // SAFETY: a word holds any bits.
        let alive = unsafe { MARK.read() } == ALIVE;
        MARK.write(ALIVE);
        chip.RCC.apb1enr().modify(|_, w| w.tim2en().enabled().tim4en().enabled());
        // SAFETY: every value of these registers is a period.
        unsafe {
            chip.TIM2.arr().write(|w| w.bits(u32::MAX));
            chip.TIM2.cr1().write(|w| w.cen().set_bit());
            // The watchdog is above everything.
            core.NVIC.set_priority(Interrupt::TIM4, 0);
        }
        (Qemu(chip), if alive { Cause::Pin } else { Cause::PowerOn })
    }

    fn flash(&mut self) -> flash::Settings {
        flash::settings()
    }

    fn recordings(&mut self) -> flash::Recordings {
        flash::recordings()
    }

    fn begin(self, _settings: &Settings, _counts: Option<i32>) -> Parts<Qemu> {
        let Qemu(chip) = self;
        // SAFETY: every value of these registers is a period, and nothing is shared with the handler but what may be.
        unsafe {
            chip.TIM4.psc().write(|w| w.bits(PRESCALER - 1));
            chip.TIM4.cnt().write(|w| w.bits((note_time() / u64::from(PRESCALER)) as u32));
            chip.TIM4.arr().write(|w| w.bits(WATCHDOG));
            NVIC::unmask(Interrupt::TIM4);
        }
        chip.TIM4.dier().write(|w| w.uie().set_bit());
        chip.TIM4.cr1().write(|w| w.cen().set_bit());
        Parts {
            sensors: Elsewhere,
            coils: Elsewhere,
            watchdog: Elsewhere,
            line: Line::new(chip.USART1),
            light: Elsewhere,
            clock: None,
        }
    }

    #[inline(always)]
    fn now() -> u32 {
        // SAFETY: reading a counter has no side effect.
        unsafe { (*pac::TIM2::ptr()).cnt().read().bits() }
    }

    fn ticked() {
        note_time();
        TICKED.store(true, Ordering::Relaxed);
    }

    fn crc(before: u32, words: &[u32]) -> u32 {
        /// By the half byte.
        const TABLE: [u32; 16] = {
            let (mut table, mut half) = ([0; 16], 0);
            while half < 16 {
                let (mut crc, mut bit) = ((half as u32) << 28, 0);
                while bit < 4 {
                    crc = crc << 1 ^ if crc >> 31 == 1 { 0x04C1_1DB7 } else { 0 };
                    bit += 1;
                }
                table[half] = crc;
                half += 1;
            }
            table
        };
        words.iter().fold(before, |crc, word| (0..8).fold(crc ^ word, |crc, _| crc << 4 ^ TABLE[(crc >> 28) as usize]))
    }

    fn force_coils(engaged: [bool; 2]) {
        COILS.store(u8::from(engaged[0]) | u8::from(engaged[1]) << 1, Ordering::Relaxed);
    }
}

/// What a real board has and this one finds at the other end of the link.
pub struct Elsewhere;

impl Sensors for Elsewhere {
    fn read(&mut self, _sample: &mut Sample) {}
}

impl Coils for Elsewhere {
    fn read(&mut self) -> [CoilReading; 2] {
        let coils = COILS.load(Ordering::Relaxed);
        [1, 2].map(|bit| CoilReading { engaged: coils & bit != 0, ..CoilReading::default() })
    }

    fn drive(&mut self, command: [bool; 2], _tested: bool) {
        Qemu::force_coils(command);
    }
}

impl Watchdog for Elsewhere {
    fn feed(&mut self) {
        // SAFETY: nobody else uses this register after the start, and it holds what it held.
        unsafe { (*pac::TIM4::ptr()).arr().write(|w| w.bits(WATCHDOG)) };
    }
}

impl Light for Elsewhere {
    fn show(&mut self, _shown: Shown, _slot: u32) {}
}

/// The watchdog has not been fed.
#[interrupt]
fn TIM4() {
    note_time();
    last_words::leave(Cause::Watchdog, 0, &[]);
}

/// As the supply fails: memory is lost, flash is not.
fn lose_power() -> ! {
    memory::forget();
    MARK.write(0);
    cortex_m::peripheral::SCB::sys_reset()
}
