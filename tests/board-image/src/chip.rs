//! The chip around the processor, and the board around the chip: every address leads to a model, and time passes for all of them.

mod coils;
mod f4;
mod g4;
mod power;
mod program;

use std::collections::{BTreeMap, HashMap, VecDeque};

use crate::engine::{Memory, Processor, Register};
use crate::model::Model;
use crate::peripheral::backup::Backup;
use crate::peripheral::capture::Capture;
use crate::peripheral::coil::Coil;
use crate::peripheral::comparators::Comparators;
use crate::peripheral::converter::Converter;
use crate::peripheral::copier::Copier;
use crate::peripheral::counter::Counter;
use crate::peripheral::crc::CrcUnit;
use crate::peripheral::encoder::Encoder;
use crate::peripheral::flash::{Flash, Work};
use crate::peripheral::line::Line;
use crate::peripheral::modulation::Modulation;
use crate::peripheral::port::Port;
use crate::peripheral::processor::{IDLE, Private};
use crate::peripheral::rcc::{Cause, Rcc};
use crate::peripheral::registers::Registers;
use crate::peripheral::spi::Spi;
use crate::peripheral::supply::Supply;
use crate::peripheral::watchdog::Watchdog;
use crate::time::SECOND;

/// First address of the memory.
pub const RAM: u32 = 0x2000_0000;
const RAM_LENGTH: usize = 128 << 10;
/// Places for the lengths of blocks: few of a program share one.
const LENGTHS: usize = 1 << 14;

/// Pin of port C that the commissioning jumper takes to ground.
pub const JUMPER: usize = 13;

/// A bit of the memory that does not change any more.
#[derive(Clone, Copy, Debug)]
pub struct StuckBit {
    /// Of its byte.
    pub address: u32,
    /// Its place in it.
    pub bit: u32,
    /// What it always is.
    pub set: bool,
}

/// Everything but the processor.
#[derive(Clone, Debug)]
pub struct Chip {
    /// Which one.
    pub model: Model,
    /// Now.
    pub now: u64,
    /// Cycles of the core's clock so far, by the half.
    pub half_cycles: u64,
    /// Instructions so far.
    pub instructions: u64,
    /// Counts of time in half a cycle.
    half_cycle: u64,
    /// Rates of the timers' clocks, 1/s.
    timer_hz: [u64; 2],
    /// Rates of the peripherals' clocks, 1/s.
    peripheral_hz: [u64; 2],
    /// When something happens by itself that the processor must see.
    event: u64,
    /// When the bench wants the processor back.
    pub until: u64,
    /// The processor continues, from where it stopped.
    pub continues: bool,
    /// 128 KiB.
    pub ram: Memory,
    /// A bit of it that is stuck, from before the first start on.
    pub stuck_bit: Option<StuckBit>,
    /// The page that returns from exceptions lead to.
    pub returns: Memory,
    /// 64 KiB of core-coupled memory.
    pub core_coupled: Memory,
    /// Flash.
    pub flash: Flash,
    /// Clocks.
    pub rcc: Rcc,
    /// Ports A to I.
    pub ports: Vec<Port>,
    /// SPI1 with the block's sensor, SPI2 with the ground's.
    pub buses: [Spi; 2],
    /// TIM4.
    pub encoder: Encoder,
    /// TIM8.
    pub modulation: Modulation,
    /// Coils.
    pub coils: [Coil; 2],
    /// ADC1.
    pub converter: Converter,
    /// Of a G4.
    comparators: Comparators,
    /// What was last read of each coil.
    pub converted: [u32; 2],
    /// Of all three converters.
    converters: Registers,
    /// TIM2, TIM3, TIM5.
    counters: [Counter; 3],
    capture: Capture,
    copier: Copier,
    /// USART1 and DMA2.
    pub line: Line,
    /// PWR and EXTI.
    pub supply: Supply,
    /// IWDG.
    pub watchdog: Watchdog,
    /// The processor's own.
    pub private: Private,
    /// Backup domain.
    pub backup: Backup,
    crc: CrcUnit,
    debug: Registers,
    /// Loads and stores that no model answers, by address.
    pub unknown: BTreeMap<u32, u32>,
    /// A reset that is due.
    pub reset: Option<Cause>,
    /// The processor cannot continue, and has not yet been reported so.
    pub stuck: Option<Option<u32>>,
    /// The last blocks of instructions, for those who look for what went wrong.
    pub trail: VecDeque<u32>,
    /// Every time that it could not, and at which address.
    pub faults: Vec<Option<u32>>,
    /// A handler has returned.
    pub returned: bool,
    /// How often a block of instructions ran in a handler, by its address and length, where that is asked for.
    pub profile: Option<HashMap<(u32, u32), u64>>,
    /// Instructions of a block: its address, its length and how many, at the place that its address gives.
    lengths: Vec<(u32, u32, u32)>,
    active: i32,
    powered: bool,
    /// Until when the coils' currents are known, and whether they asked for a break then.
    coils_at: u64,
    broken: bool,
}

impl Chip {
    /// A new board without supply.
    pub fn new(model: Model) -> Chip {
        let mut chip = Chip {
            model,
            now: 0,
            half_cycles: 0,
            instructions: 0,
            half_cycle: 525,
            timer_hz: [16_000_000; 2],
            peripheral_hz: [16_000_000; 2],
            event: 0,
            until: 0,
            continues: false,
            ram: Memory::new(RAM, RAM_LENGTH, 0),
            stuck_bit: None,
            returns: Memory::new(0xFFFF_F000, 0x1000, 0xBF),
            core_coupled: Memory::new(0x1000_0000, 64 << 10, 0),
            flash: Flash::new(model),
            rcc: Rcc::reset(model, None, Cause::Power),
            ports: (0..9).map(|index| Port::new(model, index)).collect(),
            buses: [Spi::new(model, 1), Spi::new(model, 2)],
            encoder: Encoder::default(),
            modulation: Modulation::default(),
            coils: Default::default(),
            converter: Converter::default(),
            comparators: Comparators::default(),
            converted: [0; 2],
            converters: Registers::default(),
            counters: Default::default(),
            capture: Capture::new(model),
            copier: Copier::default(),
            line: Line::new(model),
            supply: Supply::new(model),
            watchdog: Watchdog::default(),
            private: Private::default(),
            backup: Backup::default(),
            crc: CrcUnit::default(),
            debug: Registers::default(),
            unknown: BTreeMap::new(),
            reset: None,
            stuck: None,
            trail: VecDeque::new(),
            faults: Vec::new(),
            returned: false,
            profile: None,
            lengths: vec![(0, 0, 0); LENGTHS],
            active: IDLE,
            powered: true,
            coils_at: 0,
            broken: false,
        };
        // The commissioning jumper is closed.
        chip.ports[2].outside[JUMPER] = Some(false);
        chip.resets(Cause::Power);
        chip
    }

    /// Everything as `kept` has it; the processor goes on seeing the memories of this one.
    pub fn restore(&mut self, kept: &Chip) {
        let before = std::mem::replace(self, kept.clone());
        let mapped = [before.ram, before.returns, before.core_coupled, before.flash.memory];
        let copies = [&mut self.ram, &mut self.returns, &mut self.core_coupled, &mut self.flash.memory];
        for (mapped, copy) in mapped.into_iter().zip(copies) {
            mapped.restore(copy);
            *copy = mapped;
        }
    }

    /// The crystal changes to another rate, 1/s.
    pub fn set_crystal(&mut self, hz: u64) {
        self.rcc.crystal_hz = hz;
        self.clock_changed();
    }

    fn clock_changed(&mut self) {
        let [before, _] = std::mem::replace(&mut self.timer_hz, self.rcc.timer_hz());
        let [timers, _] = self.timer_hz;
        self.peripheral_hz = self.rcc.peripheral_hz();
        if before != timers {
            self.counters.iter_mut().for_each(|counter| counter.clocked(before, timers, self.now));
        }
        self.half_cycle = SECOND / self.rcc.core_hz() / 2;
        self.event = self.now;
    }

    /// Counts of time in half a cycle of the core's clock.
    pub fn half_cycle(&self) -> u64 {
        self.half_cycle
    }

    /// When the next thing happens by itself.
    pub fn next_event(&self) -> u64 {
        let systick = self.private.wraps.map(|at| self.now + at.saturating_sub(self.half_cycles) * self.half_cycle);
        [systick, self.watchdog.bites, self.flash.ends()].into_iter().flatten().min().unwrap_or(u64::MAX)
    }

    /// Lets so many half cycles pass.
    pub fn pass_cycles(&mut self, half_cycles: u64) {
        self.half_cycles += half_cycles;
        self.now += half_cycles * self.half_cycle;
        self.look();
    }

    /// Lets so much time pass, in whole half cycles.
    pub fn pass(&mut self, time: u64) {
        self.pass_cycles(time.div_ceil(self.half_cycle));
    }

    fn look(&mut self) {
        if self.now < self.event {
            return;
        }
        self.private.advance(self.half_cycles);
        if self.watchdog.bites.is_some_and(|at| self.now >= at) {
            self.reset = Some(Cause::Watchdog);
            self.watchdog.bites = None;
        }
        if self.flash.advance(self.now) {
            self.reset = Some(Cause::Power);
        }
        self.event = self.next_event();
    }

    /// Priority that an exception must come before: of what runs, and of the masks.
    pub fn threshold(&self, processor: &Processor) -> i32 {
        let masked = |register: Register| processor.get(register) & 1 != 0;
        if self.active <= -1 || masked(Register::FaultMask) {
            return -1;
        }
        if masked(Register::PriorityMask) {
            return self.active.min(0);
        }
        match processor.get(Register::BasePriority) & 0xF0 {
            0 => self.active,
            base => self.active.min(base as i32),
        }
    }

    /// What runs now has this priority.
    pub fn set_active(&mut self, priority: i32) {
        self.active = priority;
    }

    /// The rack goes to `position`, counts of the encoder.
    pub fn move_rack(&mut self, position: i64) {
        self.encoder.move_to(position);
        let (count, asked) = (self.encoder.count(), self.counters[1].asks());
        match self.model {
            Model::F405 => self.copier.changed(0x4000_0824, count, asked, &self.ram),
            Model::G474 => self.copier.changed_g4(0x4000_0824, count, asked, self.line.multiplexer.get(0), &self.ram),
        }
    }

    fn select_sensors(&mut self) {
        let low = |port: &Port, pin: u32| port.output(pin) == Some(false);
        let selected = [low(&self.ports[0], 4), low(&self.ports[1], 12)];
        for (bus, low) in self.buses.iter_mut().zip(selected) {
            bus.sensor.select(low);
        }
    }

    fn work(&mut self, work: Option<Work>) {
        let Some(work) = work else { return };
        if self.model == Model::G474 {
            self.flash.start(work, self.now);
            self.event = self.next_event();
            return;
        }
        let cut = self.flash.begin(work);
        let time = self.flash.duration(work);
        let before = self.now;
        self.pass(if cut { time / 2 } else { time });
        // A watchdog that bites meanwhile cuts the work short as the supply does.
        let bitten = self.reset.is_some() && self.now > before;
        self.flash.finish(work, cut || bitten);
        if cut {
            self.reset = Some(Cause::Power);
        }
    }

    /// The word of a peripheral's register, as a load of the processor's would give it.
    pub fn load(&mut self, address: u32) -> u32 {
        let (base, offset) = (address & !0x3FF, address & 0x3FC);
        if address >= 0xE000_0000 {
            return if base == 0xE004_2000 {
                self.debug.get(offset) | if offset == 0 { 0x1007_6413 } else { 0 }
            } else {
                self.private.read(address, self.half_cycles)
            };
        }
        if !self.rcc.clocks(base) {
            return 0;
        }
        let [slow, _] = self.timer_hz;
        // Where both models have the same.
        match base {
            0x4000_0000 | 0x4000_0400 => self.counters[(base >> 10 & 1) as usize].read(offset, slow, self.now),
            0x4000_0C00 => self.load_time(offset, slow),
            0x4000_0800 => self.encoder.read(offset),
            0x4000_3000 => self.watchdog.read(offset),
            0x4000_3800 => self.buses[1].read(offset),
            0x4000_7000 => self.supply.read_power(offset),
            0x4001_3000 => self.buses[0].read(offset),
            0x4002_3000 => self.crc.read(offset),
            _ if self.model == Model::G474 => self.load_g4(address),
            _ => self.load_f4(address),
        }
    }

    /// A store of a word to a peripheral's register, as the processor's.
    pub fn store(&mut self, address: u32, value: u32) {
        let (base, offset) = (address & !0x3FF, address & 0x3FC);
        if address >= 0xE000_0000 {
            if base == 0xE004_2000 {
                self.debug.set(offset, value);
            } else {
                self.private.write(address, value, self.half_cycles);
                self.event = self.next_event();
                if std::mem::take(&mut self.private.reset_asked) {
                    self.reset = Some(Cause::Software);
                }
            }
            return;
        }
        if !self.rcc.clocks(base) {
            return;
        }
        let [slow, fast] = self.peripheral_hz;
        match base {
            0x4000_0000 | 0x4000_0400 => self.counters[(base >> 10 & 1) as usize].write(offset, value, self.now),
            0x4000_0C00 => self.store_time(offset, value),
            0x4000_0800 => self.encoder.write(offset, value),
            0x4000_3000 => {
                self.watchdog.write(offset, value, self.now);
                self.event = self.next_event();
            }
            0x4000_3800 => {
                let busy = self.buses[1].write(offset, value, slow, self.now);
                self.pass(busy);
            }
            0x4000_7000 => {
                self.supply.write_power(offset, value);
                self.pend_detector();
            }
            0x4001_3000 => {
                let busy = self.buses[0].write(offset, value, fast, self.now);
                self.pass(busy);
            }
            0x4002_3000 => self.crc.write(offset, value),
            _ if self.model == Model::G474 => self.store_g4(address, value),
            _ => self.store_f4(address, value),
        }
    }

    /// Rate of the slow internal oscillator, 1/s, if it runs: the watchdog switches it on, too.
    fn slow_hz(&self) -> Option<u64> {
        (self.rcc.slow_runs() || self.watchdog.bites.is_some()).then_some(self.watchdog.hz)
    }

    /// A load from TIM5.
    fn load_time(&mut self, offset: u32, clock: u64) -> u32 {
        let captured = self.capture.read(offset, &self.counters[2], self.slow_hz(), clock, self.now);
        captured.unwrap_or_else(|| self.counters[2].read(offset, clock, self.now))
    }

    fn store_time(&mut self, offset: u32, value: u32) {
        self.counters[2].write(offset, value, self.now);
        self.capture.written(offset, value, &self.counters[2], self.slow_hz(), self.now);
    }

    fn nobody(&mut self, address: u32) -> u32 {
        *self.unknown.entry(address).or_default() += 1;
        0
    }
}

/// Where the registers of the chip are, for the engine.
pub const REGISTERS: [std::ops::Range<u32>; 7] = [
    0x1FFF_0000..0x1FFF_8000,
    0x1FFF_C000..0x1FFF_D000,
    0x4000_0000..0x4008_0000,
    0x4200_0000..0x4400_0000,
    0x4800_0000..0x4800_2000,
    0x5000_0000..0x5000_2000,
    0xE000_0000..0xE010_0000,
];
