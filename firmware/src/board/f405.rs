//! STM32F405RGT6 with a crystal of 8 MHz, two ICM-42688-P, an encoder and two clutch coils: see `docs/board.md` for the wiring.
//!
//! | part | peripherals |
//! | --- | --- |
//! | [`clock`]: 168 MHz, the counter of time, and the slow oscillator beside it | RCC, TIM5 |
//! | [`encoder`]: its counter, which runs on through a reset | TIM4, TIM3, stream 2 of DMA1 |
//! | [`sensors`]: two inertial sensors, each on a [`mod@bus`] | SPI1, SPI2 |
//! | [`coils`]: two coils, their currents and their supply | TIM8 with its break input PA6, PC8, PC9, ADC1 |
//! | [`mod@line`]: the link | USART1, streams 2 and 7 of DMA2 |
//! | [`storage`]: the settings, which firmware has run, recordings of earthquakes | sectors 1 to 3 and 6 to 11 of the flash |
//! | [`supply`]: what happens when it sags | PWR, EXTI line 16 |
//! | [`options`]: brown-out reset, protection | option bytes |
//! | the light | PC12 |
//! | the commissioning jumper | PC13 |
//! | the program's checksum | CRC |
//!
//! Interrupts: the supply's comes before everything but faults, then SysTick, the control task. Nothing else interrupts.

mod bus;
mod clock;
mod coils;
mod encoder;
mod line;
mod options;
mod reset;
mod sensors;
mod storage;
mod supply;

use sprag_shared::device::clock_check::ClockCheck;
use sprag_shared::link::Protection;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::settings::Settings;
use sprag_shared::settings::wiring::Wiring;
use stm32f4xx_hal::gpio::{GpioExt, Input, Output, Pin, PinState};
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::_fugit_ExtU32;
use stm32f4xx_hal::rcc::{Enable, Rcc};
use stm32f4xx_hal::watchdog::IndependentWatchdog;

use super::parts;
use super::parts::inertial::MountedSensors;
use super::parts::light::PinLight;
use super::{Board, Edge, Parts, Watchdog};

pub use stm32f4xx_hal::pac as chip;

/// The board, with its clocks running.
pub struct F405 {
    chip: pac::Peripherals,
    rcc: Rcc,
    crystal: bool,
    check: ClockCheck,
}

/// The commissioning jumper's pin in port C, which it takes to ground.
const JUMPER: u8 = 13;

/// After so long without being fed the watchdog resets the chip, by steps of 4 ms of its own oscillator: 11 to 38 ms (47 to 17 kHz).
const WATCHDOG_MILLISECONDS: u32 = 20;

/// The same while the processor may stall: 2.7 to 7.5 s, for two sectors of at most 0.8 s each, or one of at most 2.6 s.
const STALLED_MILLISECONDS: u32 = 4000;

impl Board for F405 {
    const NAME: &'static str = "f405";

    const COUNTER_HZ: u32 = clock::COUNTER_HZ;

    const CORE_HZ: u32 = clock::HZ;

    /// A tick takes some 60 µs, of which the sensors' wires 36, at most 80, and up to 150 by the look-ahead law.
    const LEAST_PERIOD: f32 = 250e-6;

    const ERASING_STALLS: bool = true;

    /// A word takes 16 µs, at most 100 (DS8626, table 45).
    const PROGRAMMING_STALL: u32 = 100;

    type Chip = pac::Peripherals;
    type Sensors = sensors::BoardSensors;
    type Coils = coils::BoardCoils;
    type Watchdog = BoardWatchdog;
    type Line = line::DmaLine;
    type Flash = storage::Settings;
    type Recordings = storage::Recordings;
    type Light = PinLight<Pin<'C', 12, Output>>;

    fn wake(_core: cortex_m::Peripherals, chip: pac::Peripherals) -> (F405, Cause) {
        let cause = reset::cause(&chip.RCC);
        // SAFETY: the peripherals' own is not used from here on.
        let (mut rcc, crystal, check) = clock::start(unsafe { pac::RCC::steal() }, &chip.TIM5);
        pac::CRC::enable(&mut rcc);
        (F405 { chip, rcc, crystal, check }, cause)
    }

    fn flash(&mut self) -> storage::Settings {
        supply::set_brown_out(&self.chip.PWR, &mut self.rcc);
        storage::Settings::new()
    }

    fn recordings(&mut self) -> storage::Recordings {
        storage::Recordings::new()
    }

    fn begin(self, settings: &Settings, counts: Option<i32>) -> Parts<F405> {
        let wiring = Wiring::of(settings);
        let F405 { chip, mut rcc, crystal, check } = self;
        let a = chip.GPIOA.split(&mut rcc);
        let c = chip.GPIOC.split(&mut rcc);
        let outputs = coils::Outputs { low: (c.pc6, c.pc7), high: (c.pc8, c.pc9), trip: a.pa6 };
        let currents = coils::Currents::new(chip.ADC1, &chip.ADC_COMMON, (c.pc0, c.pc1, c.pc2), &mut rcc);
        let coils = coils::begin(chip.TIM8, outputs, currents, wiring, settings.period(), &mut rcc);
        supply::watch(chip.PWR, &chip.EXTI, &mut rcc);
        encoder::pause(&chip.TIM4);
        let b = chip.GPIOB.split(&mut rcc);
        let last = counts.map(|counts| wiring.travel(counts));
        let encoder = encoder::Encoder::new(chip.TIM4, (b.pb6, b.pb7), last);
        encoder.copy(chip.TIM3, &chip.DMA1, &mut rcc);
        let block = sensors::block(chip.SPI1, a.pa5, b.pb4, a.pa7, a.pa4, &mut rcc);
        let ground = sensors::ground(chip.SPI2, b.pb13, b.pb14, b.pb15, b.pb12, &mut rcc);
        let line = line::DmaLine::at(chip.USART1, chip.DMA2, (a.pa9, a.pa10), &mut rcc);
        let lamp = c.pc12;
        let _: Pin<'C', JUMPER, Input> = c.pc13.into_pull_up_input();
        let light = PinLight::new(lamp.into_push_pull_output_in_state(PinState::High), crystal);
        let mut watchdog = IndependentWatchdog::new(chip.IWDG);
        watchdog.stop_on_debug(&chip.DBGMCU, true);
        watchdog.start(WATCHDOG_MILLISECONDS.millis());
        Parts {
            sensors: MountedSensors::new(block, ground, encoder, wiring),
            coils,
            watchdog: BoardWatchdog(watchdog),
            line,
            light,
            clock: Some(check),
        }
    }

    fn now() -> u32 {
        clock::now()
    }

    fn stall<T>(work: impl FnOnce() -> T) -> T {
        // SAFETY: the control task, which has the watchdog, is held off.
        let registers = unsafe { pac::IWDG::steal() };
        let mut watchdog = IndependentWatchdog::new(unsafe { pac::IWDG::steal() });
        watchdog.start(STALLED_MILLISECONDS.millis());
        let done = work();
        // The last change takes the watchdog some 0.2 ms, and until then it takes no other.
        let _ = (0..clock::HZ / 1000).find(|_| registers.sr().read().bits() == 0);
        watchdog.start(WATCHDOG_MILLISECONDS.millis());
        done
    }

    fn force_coils(engaged: [bool; 2]) {
        coils::force(engaged);
    }

    fn jumper_is_closed() -> bool {
        // SAFETY: reading the pins has no side effect.
        unsafe { &*pac::GPIOC::ptr() }.idr().read().bits() & 1 << JUMPER == 0
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
        F405::stall(|| options::protect(end))
    }
}

/// The independent watchdog of the chip, on an oscillator of its own.
pub struct BoardWatchdog(IndependentWatchdog);

impl Watchdog for BoardWatchdog {
    fn feed(&mut self) {
        self.0.feed();
    }
}
