//! The chip around the processor, and the board around the chip: every address leads to a model, and time passes for all of them.

mod g4;

use std::collections::{BTreeMap, HashMap, VecDeque};

use crate::engine::{Guest, Memory, Processor, Register};
use crate::model::Model;
use crate::peripheral::backup::Backup;
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
use crate::peripheral::processor::{FIRST_INTERRUPT, IDLE, NMI, Private};
use crate::peripheral::rcc::{Cause, Rcc};
use crate::peripheral::registers::Registers;
use crate::peripheral::spi::Spi;
use crate::peripheral::supply::Supply;
use crate::peripheral::watchdog::Watchdog;
use crate::random::Random;
use crate::time::{SECOND, microseconds};

/// Half cycles that an instruction takes, as an estimate: most take one cycle, loads and taken branches two or three, divisions and
/// square roots fourteen.
const HALF_CYCLES_PER_INSTRUCTION: u64 = 3;

/// Blocks that the trail goes back.
const TRAIL: usize = 32;

/// Of the comparators on the board with an F4, A (docs/board.md).
const BREAK: f64 = 1.24;

/// Number of the voltage detector's interrupt.
const DETECTOR: u32 = FIRST_INTERRUPT + 1;

/// First address of the memory.
pub const RAM: u32 = 0x2000_0000;
const RAM_LENGTH: usize = 128 << 10;

/// Everything but the processor.
#[derive(Debug)]
pub struct Chip {
    model: Model,
    /// Now.
    pub now: u64,
    /// Cycles of the core's clock so far, by the half.
    pub half_cycles: u64,
    /// Instructions so far.
    pub instructions: u64,
    /// Counts of time in half a cycle.
    half_cycle: u64,
    /// When something happens by itself that the processor must see.
    event: u64,
    /// When the bench wants the processor back.
    pub until: u64,
    /// The processor goes on, from where it stopped.
    pub goes_on: bool,
    /// 128 KiB.
    pub ram: Memory,
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
    /// The processor cannot go on, and since when it has not been told.
    pub stuck: Option<Option<u32>>,
    /// The last blocks of instructions, for those who look for what went wrong.
    pub trail: VecDeque<u32>,
    /// Every time that it could not, and at which address.
    pub faults: Vec<Option<u32>>,
    /// A handler has returned.
    pub returned: bool,
    /// How often a block of instructions ran in a handler, by its address and length, where that is asked for.
    pub profile: Option<HashMap<(u32, u32), u64>>,
    /// Instructions of a block, by its address.
    lengths: HashMap<(u32, u32), u32>,
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
            half_cycle: 21,
            event: 0,
            until: 0,
            goes_on: false,
            ram: Memory::new(RAM, RAM_LENGTH, 0),
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
            lengths: HashMap::new(),
            active: IDLE,
            powered: true,
            coils_at: 0,
            broken: false,
        };
        chip.resets(Cause::Power);
        chip
    }

    /// Everything as after a reset for that cause. What is outside of the chip stays as it is.
    pub fn resets(&mut self, cause: Cause) {
        if cause == Cause::Power {
            let mut random = Random::new(self.now ^ 0x5EED);
            for memory in [&self.ram, &self.core_coupled] {
                let start = if memory.contains(RAM) { RAM } else { 0x1000_0000 };
                for place in 0..(if start == RAM { RAM_LENGTH } else { 64 << 10 }) as u32 / 8 {
                    memory.write(start + 8 * place, &random.number().to_le_bytes());
                }
            }
            for bus in &mut self.buses {
                bus.sensor.brown_out(self.now);
            }
        }
        self.rcc = Rcc::reset(self.model, Some(&self.rcc), cause);
        self.flash.reset();
        self.ports.iter_mut().zip(0..).for_each(|(port, index)| port.reset(self.model, index));
        self.buses.iter_mut().for_each(Spi::reset);
        self.encoder.reset();
        self.modulation.reset();
        self.converter.reset(self.model);
        self.comparators.reset();
        self.converters = Registers::default();
        self.counters.iter_mut().for_each(Counter::reset);
        self.copier.reset();
        self.line.reset();
        self.line.reset_streams();
        self.supply.reset();
        self.watchdog.reset();
        self.private = Private::default();
        self.crc = CrcUnit::default();
        if cause == Cause::Power {
            self.debug = Registers::default();
            if self.model == Model::G474 {
                // VBAT is the supply.
                self.backup = Backup::default();
            }
        }
        (self.reset, self.stuck, self.powered) = (None, None, true);
        self.clock_changed();
        self.select_sensors();
        self.advance_coils();
    }

    fn clock_changed(&mut self) {
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

    /// The supply of 3.3 V becomes `volts`.
    pub fn set_volts(&mut self, volts: f64) {
        self.supply.set_volts(volts);
        self.pend_detector();
        if self.flash.brown_out().is_some_and(|level| volts < level) || volts < 1.7 {
            let cause = if volts < 1.7 { Cause::Power } else { Cause::BrownOut };
            self.resets(cause);
            (self.reset, self.powered) = (Some(cause), false);
        }
    }

    /// Whether the supply lets the chip run.
    pub fn powered(&self) -> bool {
        self.powered || self.supply.volts() > self.flash.brown_out().map_or(1.75, |level| level + 0.1)
    }

    fn pend_detector(&mut self) {
        if self.supply.interrupts() {
            self.private.pend(DETECTOR);
        }
    }

    /// The crystal stops.
    pub fn crystal_stops(&mut self) {
        if self.rcc.crystal_stops() {
            self.private.pend(NMI);
            self.clock_changed();
        }
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

    /// Whether the high side of a coil is commanded on, and for which share of the time its low side.
    pub fn drive(&self, coil: usize) -> (bool, f64) {
        let port = &self.ports[2];
        let high = port.output(8 + coil as u32).unwrap_or(false);
        let function = if self.model == Model::G474 { 4 } else { 3 };
        let modulated = port.function(6 + coil as u32) == Some(function);
        (high, if modulated { self.modulation.duty(coil as u32) } else { 0.0 })
    }

    /// Whether a coil's current asks the timer for a break: by the comparators on an F4's board, at pin PA6, or by those of a G4.
    fn asks_for_break(&self) -> bool {
        let mut currents = self.coils.iter().map(|coil| coil.current).enumerate();
        match self.model {
            Model::F405 => {
                let wired = self.ports[0].function(6) == Some(3) && self.modulation.breaks_at(false);
                wired && currents.any(|(_, current)| current > BREAK)
            }
            Model::G474 => currents.any(|(coil, current)| {
                let level = self.comparators.level(coil).filter(|(number, _)| self.modulation.has_comparator(*number));
                self.modulation.breaks_at(true) && level.is_some_and(|(_, level)| current > level)
            }),
        }
    }

    /// Brings the coils' currents up to now.
    pub fn advance_coils(&mut self) {
        self.modulation.advance(self.now);
        let before = self.coils.clone();
        let from = std::mem::replace(&mut self.coils_at, self.now);
        self.let_flow(self.now);
        let mut asks = self.asks_for_break();
        if asks && !self.broken {
            // Closer, when.
            self.coils = before;
            asks = false;
            for at in (from..self.now).step_by(microseconds(1) as usize).skip(1) {
                self.let_flow(at);
                if self.asks_for_break() {
                    self.modulation.set_break(true);
                    self.let_flow(self.now);
                    break;
                }
            }
            self.let_flow(self.now);
            asks |= self.asks_for_break();
        }
        self.broken = asks;
        self.modulation.set_break(asks);
    }

    fn let_flow(&mut self, until: u64) {
        for index in 0..2 {
            let (high, duty) = self.drive(index);
            self.coils[index].advance(high, duty, until);
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
        if self.model == Model::G474 {
            return self.load_g4(address);
        }
        match address {
            // Number of the chip, and its flash in KiB.
            0x1FFF_7A10..0x1FFF_7A1C => return 0x0042_0000 | address & 15,
            0x1FFF_7A20 => return 1024 << 16,
            _ => {}
        }
        if !self.rcc.clocks(base) {
            return 0;
        }
        let [slow, _] = self.rcc.timer_hz();
        match base {
            0x4000_0000 | 0x4000_0400 => self.counters[(base >> 10 & 1) as usize].read(offset, slow, self.now),
            0x4000_0C00 => self.counters[2].read(offset, slow, self.now),
            0x4000_0800 => self.encoder.read(offset),
            0x4000_2800 => self.backup.read(offset),
            0x4000_3000 => self.watchdog.read(offset),
            0x4000_3800 => self.buses[1].read(offset),
            0x4000_7000 => self.supply.read_power(offset),
            0x4001_0400 => {
                self.advance_coils();
                self.modulation.read(offset)
            }
            0x4001_1000 => self.line.read(offset),
            0x4001_2000 if offset >= 0x300 => self.converters.get(offset),
            0x4001_2000 => {
                self.advance_coils();
                let value = self.converter.read(offset, [self.coils[0].current, self.coils[1].current]);
                if let Some(coil) = self.converter.coil(offset) {
                    self.converted[coil] = value;
                }
                value
            }
            0x4001_3000 => self.buses[0].read(offset),
            0x4001_3C00 => self.supply.read_lines(offset),
            0x4002_0000..=0x4002_2000 => self.ports[(base >> 10 & 15) as usize].read(offset),
            0x4002_3000 => self.crc.read(offset),
            0x4002_3800 => self.rcc.read(offset, self.now),
            0x4002_3C00 => self.flash.read(offset),
            0x4002_4000..0x4002_5000 => self.backup.load(address & 0xFFC),
            0x4002_6000 => self.copier.read(offset),
            0x4002_6400 => self.line.read_stream(offset, &self.ram, self.now),
            _ => self.nobody(address),
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
        if self.model == Model::G474 {
            return self.store_g4(address, value);
        }
        if !self.rcc.clocks(base) {
            return;
        }
        let [slow, fast] = self.rcc.peripheral_hz();
        match base {
            0x4000_0000 | 0x4000_0400 => self.counters[(base >> 10 & 1) as usize].write(offset, value, self.now),
            0x4000_0C00 => self.counters[2].write(offset, value, self.now),
            0x4000_0800 => self.encoder.write(offset, value),
            0x4000_2800 => self.backup.write(offset, value, self.supply.backup_writable()),
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
            0x4001_0400 => {
                self.advance_coils();
                let clock = self.rcc.timer_hz()[1];
                self.modulation.write(offset, value, clock, self.now);
            }
            0x4001_1000 => self.line.write(offset, value),
            0x4001_2000 if offset >= 0x300 => self.converters.set(offset, value),
            0x4001_2000 => self.converter.write(offset, value),
            0x4001_3000 => {
                let busy = self.buses[0].write(offset, value, fast, self.now);
                self.pass(busy);
            }
            0x4001_3C00 => {
                self.supply.write_lines(offset, value);
                self.pend_detector();
            }
            0x4002_0000..=0x4002_2000 => {
                self.advance_coils();
                self.ports[(base >> 10 & 15) as usize].write(offset, value);
                self.select_sensors();
            }
            0x4002_3000 => self.crc.write(offset, value),
            0x4002_3800 => {
                if let Some(base) = self.rcc.write(offset, value, self.now) {
                    self.reset_peripheral(base);
                }
                self.clock_changed();
            }
            0x4002_3C00 => {
                let work = self.flash.write(offset, value);
                self.work(work);
            }
            0x4002_4000..0x4002_5000 => self.backup.store(address & 0xFFC, value, self.supply.backup_writable()),
            0x4002_6000 => self.copier.write(offset, value),
            0x4002_6400 => self.line.write_stream(offset, value, &self.ram, fast, self.now),
            _ => _ = self.nobody(address),
        }
    }

    fn reset_peripheral(&mut self, base: u32) {
        match base {
            0x4000_0000 => self.counters[0].reset(),
            0x4000_0400 => self.counters[1].reset(),
            0x4000_0C00 => self.counters[2].reset(),
            0x4000_0800 => self.encoder.reset(),
            0x4000_3800 => self.buses[1].reset(),
            0x4001_0400 => self.modulation.reset(),
            0x4001_1000 => self.line.reset(),
            0x4001_2000 => self.converter.reset(self.model),
            0x4001_3000 => self.buses[0].reset(),
            0x4002_6000 => self.copier.reset(),
            0x4002_6400 => self.line.reset_streams(),
            0x4002_0000..=0x4002_2000 => {
                let index = base >> 10 & 15;
                self.ports[index as usize].reset(self.model, index);
            }
            _ => {}
        }
    }

    /// Whether the processor shall stop before the next block.
    fn stops(&self, processor: &Processor) -> bool {
        if self.reset.is_some() || self.now >= self.until {
            return true;
        }
        self.private.waits() && self.private.next(self.active).is_some() && self.private.next(self.threshold(processor)).is_some()
    }

    fn nobody(&mut self, address: u32) -> u32 {
        *self.unknown.entry(address).or_default() += 1;
        0
    }

    /// Instructions between `address` and `address + size`.
    fn length(&mut self, address: u32, size: u32) -> u64 {
        if let Some(count) = self.lengths.get(&(address, size)) {
            return (*count).into();
        }
        let count = self.instructions_of(address, size).count() as u32;
        self.lengths.insert((address, size), count);
        count.into()
    }

    /// Addresses of the instructions of a block: those that begin with 0b11101 to 0b11111 have two half words.
    pub fn instructions_of(&self, address: u32, size: u32) -> impl Iterator<Item = u32> {
        let memory = if self.ram.contains(address) { &self.ram } else { &self.flash.memory };
        let within = move |place: &u32| place.wrapping_sub(address) < size && memory.contains(*place);
        let next = move |place: &u32| {
            let mut half = [0; 2];
            memory.read(*place, &mut half);
            Some(place + if half[1] >> 3 >= 0b11101 { 4 } else { 2 }).filter(within)
        };
        std::iter::successors(Some(address).filter(within), next)
    }
}

/// The address and bit behind an address at which single bits of registers can be reached.
fn bit_band(address: u32) -> Option<(u32, u32)> {
    (0x4200_0000..0x4400_0000).contains(&address).then(|| {
        let offset = address - 0x4200_0000;
        (0x4000_0000 + (offset >> 7 << 2), offset >> 2 & 31)
    })
}

impl Guest for Chip {
    fn read(&mut self, address: u32, size: u32) -> u32 {
        if let Some((word, bit)) = bit_band(address) {
            return self.load(word) >> bit & 1;
        }
        if self.flash.memory.contains(address) {
            let mut bytes = [0; 4];
            match self.model {
                Model::F405 => self.flash.memory.read(address, &mut bytes[..size as usize]),
                Model::G474 => self.load_checked(address, &mut bytes[..size as usize]),
            }
            return u32::from_le_bytes(bytes);
        }
        let word = self.load(address & !3) >> (8 * (address & 3));
        if size == 4 { word } else { word & ((1 << (8 * size)) - 1) }
    }

    fn write(&mut self, address: u32, size: u32, value: u32) {
        if let Some((word, bit)) = bit_band(address) {
            let old = self.load(word);
            return self.store(word, old & !(1 << bit) | (value & 1) << bit);
        }
        if self.flash.memory.contains(address) {
            let work = self.flash.store(address, size, value);
            return self.work(work);
        }
        // Data registers and the watchdog's keys take what is written as it is; of others the rest of the word stays.
        let whole = size == 4 || matches!(address & !3, 0x4001_300C | 0x4000_380C);
        if whole {
            return self.store(address & !3, value);
        }
        let shift = 8 * (address & 3);
        let mask = ((1 << (8 * size)) - 1) << shift;
        let old = self.load(address & !3);
        self.store(address & !3, old & !mask | value << shift & mask);
    }

    fn block(&mut self, processor: &Processor, address: u32, size: u32) -> bool {
        // The first block since the processor went on is carried out in any case: whoever asks for steps gets on.
        if !std::mem::take(&mut self.goes_on) && self.stops(processor) {
            return true;
        }
        if self.trail.len() == TRAIL {
            self.trail.pop_front();
        }
        self.trail.push_back(address);
        let instructions = self.length(address, size);
        self.instructions += instructions;
        if let Some(profile) = self.profile.as_mut().filter(|_| self.active != IDLE) {
            *profile.entry((address, size)).or_default() += 1;
        }
        self.pass_cycles(HALF_CYCLES_PER_INSTRUCTION * instructions);
        false
    }

    fn returned(&mut self) {
        self.returned = true;
    }

    fn stuck(&mut self, address: Option<u32>) {
        self.stuck = Some(address);
        self.faults.push(address);
        self.private.fault(address);
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
