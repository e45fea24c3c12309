//! STM32G474RET6 with a crystal of 8 MHz, two ICM-42688-P, an encoder and two clutch coils: see `docs/porting.md` for the wiring.
//!
//! | part | peripherals |
//! | --- | --- |
//! | [`clock`]: 168 MHz, the counter of time, and the slow oscillator beside it | RCC, PWR, TIM5 |
//! | [`pins`] | GPIO A to C |
//! | [`encoder`]: its counter, which runs on through a reset | TIM4, TIM3, channel 1 of DMA1 |
//! | [`sensors`]: two inertial sensors | SPI1, SPI2 |
//! | [`coils`]: two coils and their currents | TIM8 with COMP1 and COMP3 at its break, DAC3, PC8, PC9, ADC1 |
//! | [`mod@line`]: the link | USART1, channels 2 and 3 of DMA1 |
//! | [`storage`]: the settings, which firmware has run, recordings of earthquakes | bank 2 of the flash |
//! | [`supply`]: what happens when it sags | PWR, EXTI line 16 |
//! | [`options`]: brown-out reset, protection | option bytes |
//! | the commissioning jumper | PC13 |
//! | the program's checksum | CRC |
//! | [`reset`]: why there was one | RCC, a backup register of TAMP |
//!
//! Interrupts: the supply's comes before everything but faults, then SysTick, the control task. Nothing else interrupts but the NMI.

mod clock;
mod coils;
mod encoder;
mod line;
mod nmi;
mod options;
mod pins;
mod reset;
mod sensors;
mod storage;
mod supply;

use sprag_shared::device::clock_check::ClockCheck;
use sprag_shared::link::Protection;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::settings::Settings;
use sprag_shared::settings::wiring::Wiring;
use stm32g4::stm32g474 as pac;

use super::parts;
use super::parts::inertial::MountedSensors;
use super::parts::light::PinLight;
use super::{Board, Edge, Parts, Watchdog};
use pins::OutputPin;

pub use stm32g4::stm32g474 as chip;

/// The board, with its clocks running.
pub struct G474 {
    chip: pac::Peripherals,
    crystal: bool,
    check: ClockCheck,
}

/// Of the watchdog, 1/s, nominal; 29.5 to 34 kHz over temperature and supply (DS12288, table 43).
const WATCHDOG_HZ: u32 = 32_000;

/// After so long without being fed the watchdog resets the chip: 19 to 22 ms.
const WATCHDOG_MILLISECONDS: u32 = 20;

/// The most that it can count: half a second, while option bytes of bank 1 are programmed.
const MOST_COUNTS: u16 = 0x1000;

/// The watchdog's clock is divided by four.
const WATCHDOG_COUNTS: u16 = (WATCHDOG_HZ / 4 * WATCHDOG_MILLISECONDS / 1000) as u16;

impl Board for G474 {
    const NAME: &'static str = "g474";

    const COUNTER_HZ: u32 = clock::HZ;

    const CORE_HZ: u32 = clock::HZ;

    /// As on the F405, with buses and a processor of the same rates.
    const LEAST_PERIOD: f32 = 250e-6;

    /// Erasing in bank 2 leaves the processor alone, which runs from bank 1.
    const ERASING_STALLS: bool = false;

    /// Nor does programming.
    const PROGRAMMING_STALL: u32 = 0;

    type Chip = pac::Peripherals;
    type Sensors = sensors::BoardSensors;
    type Coils = coils::BoardCoils;
    type Watchdog = BoardWatchdog;
    type Line = line::DmaLine;
    type Flash = storage::Storage;
    type Recordings = storage::Recordings;
    type Light = PinLight<OutputPin>;

    fn wake(_core: cortex_m::Peripherals, chip: pac::Peripherals) -> (G474, Cause) {
        let cause = reset::cause(&chip);
        let (crystal, check) = clock::start(&chip);
        chip.RCC.ahb1enr().modify(|_, w| w.crcen().set_bit());
        (G474 { chip, crystal, check }, cause)
    }

    fn flash(&mut self) -> storage::Storage {
        supply::set_brown_out(&self.chip);
        storage::Storage::new()
    }

    fn recordings(&mut self) -> storage::Recordings {
        storage::Recordings::new()
    }

    fn begin(self, settings: &Settings, counts: Option<i32>) -> Parts<G474> {
        let wiring = Wiring::of(settings);
        let G474 { chip, crystal, check } = self;
        pins::begin(&chip.RCC);
        let coils = coils::begin(&chip, wiring, settings.period());
        supply::watch(&chip);
        let last = counts.map(|counts| wiring.travel(counts));
        let encoder = encoder::Encoder::new(&chip, last);
        let line = line::begin(&chip);
        let light = PinLight::new(pins::LIGHT, crystal);
        chip.DBGMCU.apb1l_fz().modify(|_, w| w.dbg_iwdg_stop().set_bit());
        let (block, ground) = (sensors::block(chip.SPI1, &chip.RCC), sensors::ground(chip.SPI2, &chip.RCC));
        let watchdog = BoardWatchdog(chip.IWDG);
        watchdog.start(WATCHDOG_COUNTS);
        Parts { sensors: MountedSensors::new(block, ground, encoder, wiring), coils, watchdog, line, light, clock: Some(check) }
    }

    #[inline(always)]
    fn now() -> u32 {
        clock::now()
    }

    fn force_coils(engaged: [bool; 2]) {
        coils::force(engaged);
    }

    fn jumper_is_closed() -> bool {
        pins::jumper_is_closed()
    }

    fn crc(before: u32, words: &[u32]) -> u32 {
        parts::crc::crc(before, words)
    }

    fn slow_edge() -> Edge {
        clock::SLOW.take()
    }

    fn moves_by_itself(place: u32) -> bool {
        parts::moves_by_itself(place)
    }

    fn protection(end: u32) -> Protection {
        options::protection(end)
    }

    fn protect(end: u32) -> bool {
        // SAFETY: the control task, which has the watchdog, is held off.
        let watchdog = BoardWatchdog(unsafe { pac::IWDG::steal() });
        watchdog.start(MOST_COUNTS);
        let done = options::protect(end);
        watchdog.start(WATCHDOG_COUNTS);
        done
    }
}

/// The independent watchdog of the chip, on an oscillator of its own.
pub struct BoardWatchdog(pac::IWDG);

impl BoardWatchdog {
    const START: u16 = 0xCCCC;
    const UNLOCK: u16 = 0x5555;
    const FEED: u16 = 0xAAAA;

    fn key(&self, key: u16) {
        // SAFETY: the three keys are what the register takes.
        self.0.kr().write(|w| unsafe { w.key().bits(key) });
    }

    /// RM0440, 42.3.2.
    fn start(&self, counts: u16) {
        self.key(BoardWatchdog::START);
        self.key(BoardWatchdog::UNLOCK);
        // SAFETY: every value of these fields is a divider and a count.
        unsafe {
            self.0.pr().write(|w| w.bits(0));
            self.0.rlr().write(|w| w.bits(counts - 1));
        }
        // Some 0.2 ms.
        let _ = (0..clock::HZ / 1000).find(|_| self.0.sr().read().bits() == 0);
        self.key(BoardWatchdog::FEED);
    }
}

impl Watchdog for BoardWatchdog {
    fn feed(&mut self) {
        self.key(BoardWatchdog::FEED);
    }
}
