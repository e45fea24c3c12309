//! STM32F405RGT6 with a crystal of 8 MHz, two ICM-42688-P, an encoder and two clutch coils: see `docs/board.md` for the wiring.
//!
//! | part | peripherals |
//! | --- | --- |
//! | [`clock`]: 168 MHz, and the counter | RCC, DWT |
//! | [`sensors`]: two inertial sensors, the encoder | SPI1, SPI2, TIM4 |
//! | [`coils`]: two coils and their currents | TIM8 with its break input PA6, PC8, PC9, ADC1 |
//! | [`mod@line`]: the link | USART1, streams 2 and 7 of DMA2 |
//! | [`storage`]: the settings | sectors 1 and 2 of the flash |
//! | [`supply`]: what happens when it sags | PWR, EXTI line 16, option bytes |
//! | [`light`] | PC12 |
//!
//! Interrupts: the supply's comes before everything but faults, then SysTick, the control task. Nothing else interrupts.

mod clock;
mod coils;
mod light;
mod line;
mod reset;
mod sensors;
mod storage;
mod supply;

use cortex_m::peripheral::DWT;
use sprag_shared::device::coil::PeakHold;
use sprag_shared::device::coil_test::CoilDesign;
use sprag_shared::link::reset_cause::Cause;
use sprag_shared::settings::Settings;
use sprag_shared::settings::wiring::Wiring;
use stm32f4xx_hal::gpio::GpioExt;
use stm32f4xx_hal::pac;
use stm32f4xx_hal::prelude::_fugit_ExtU32;
use stm32f4xx_hal::watchdog::IndependentWatchdog;

use super::{Board, Parts, Watchdog};

/// The board.
pub struct F405;

/// After so long without being fed the watchdog resets the chip, by steps of 4 ms of its own oscillator: 11 to 38 ms (47 to 17 kHz).
const WATCHDOG_MILLISECONDS: u32 = 20;

impl Board for F405 {
    const NAME: &'static str = "f405";

    const COUNTER_HZ: u32 = clock::HZ;

    const CORE_HZ: u32 = clock::HZ;

    type Sensors = sensors::BoardSensors;
    type Coils = coils::BoardCoils;
    type Watchdog = BoardWatchdog;
    type Line = line::DmaLine;
    type Flash = storage::Storage;
    type Light = light::BoardLight;

    fn cause(device: &mut pac::Peripherals) -> Cause {
        reset::cause(&device.RCC)
    }

    fn flash(device: &mut pac::Peripherals) -> storage::Storage {
        supply::set_brown_out(&device.RCC, &device.PWR, &device.FLASH);
        storage::Storage::new()
    }

    fn begin(core: cortex_m::Peripherals, device: pac::Peripherals, settings: &Settings) -> Parts<F405> {
        let wiring = Wiring::of(settings);
        let (mut rcc, crystal) = clock::start(core, device.RCC, &device.DBGMCU);
        let a = device.GPIOA.split(&mut rcc);
        let b = device.GPIOB.split(&mut rcc);
        let c = device.GPIOC.split(&mut rcc);
        let outputs = coils::Outputs { low: (c.pc6, c.pc7), high: (c.pc8, c.pc9), trip: a.pa6 };
        let currents = coils::Currents::new(device.ADC1, &device.ADC_COMMON, (c.pc0, c.pc1), &mut rcc);
        let peak_hold = PeakHold::new(wiring.coil_pull_in_time, wiring.coil_hold_share, settings.period());
        let design = CoilDesign { peak_hold, threshold: wiring.coil_engaged_current, full: wiring.coil_full_current };
        let coils = coils::begin(device.TIM8, outputs, currents, design, &mut rcc);
        supply::watch(device.PWR, &device.EXTI, &mut rcc);
        let block = sensors::block(device.SPI1, a.pa5, b.pb4, a.pa7, a.pa4, &mut rcc);
        let ground = sensors::ground(device.SPI2, b.pb13, b.pb14, b.pb15, b.pb12, &mut rcc);
        let encoder = sensors::encoder(device.TIM4, b.pb6, b.pb7, &mut rcc);
        let line = line::DmaLine::new(device.USART1, device.DMA2, (a.pa9, a.pa10), &mut rcc);
        let light = light::BoardLight::new(c.pc12, crystal);
        let mut watchdog = IndependentWatchdog::new(device.IWDG);
        watchdog.stop_on_debug(&device.DBGMCU, true);
        watchdog.start(WATCHDOG_MILLISECONDS.millis());
        Parts {
            sensors: sensors::BoardSensors::new(block, ground, encoder, wiring),
            coils,
            watchdog: BoardWatchdog(watchdog),
            line,
            light,
        }
    }

    fn now() -> u32 {
        DWT::cycle_count()
    }

    fn force_coils(engaged: [bool; 2]) {
        coils::force(engaged);
    }
}

/// The independent watchdog of the chip, on an oscillator of its own.
pub struct BoardWatchdog(IndependentWatchdog);

impl Watchdog for BoardWatchdog {
    fn feed(&mut self) {
        self.0.feed();
    }
}
