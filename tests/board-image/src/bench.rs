//! The board under test: the processor, the chip around it, and a host that watches.
//!
//! Exceptions are carried out here, as the processor does it (ARMv7-M, B1.5): registers go to the stack, the handler runs, and its return
//! brings them back.

use std::rc::Rc;

use crate::chip::{Chip, REGISTERS, StuckBit};
use crate::engine::{Context, Engine, Register};
use crate::image::Image;
use crate::model::Model;
use crate::peripheral::flash::g4::BANK_2;
use crate::peripheral::flash::{self, sector_of, sector_range};
use crate::peripheral::processor::{HARD_FAULT, IDLE, SYSTICK};
use crate::peripheral::rcc::Cause;

/// EXC_RETURN for a return to thread mode; bit 4 is clear where floating-point registers were stacked too.
const RETURN: u32 = 0xFFFF_FFF9;
/// The page with those addresses, for Unicorn.
const RETURNS: u32 = 0xFFFF_F000;
/// The instruction that waits for an interrupt.
const WFI: [u8; 2] = [0x30, 0xBF];
/// Half cycles to enter an exception or to leave it.
const ENTRY: u64 = 24;
/// FPCA of CONTROL.
const FLOATING_POINT: u32 = 4;

/// Bits of the status that have what is left of an IT block, of which a handler knows nothing.
const IF_THEN: u32 = 0x0600_FC00;

/// An exception that runs.
#[derive(Clone, Debug)]
struct Running {
    number: u32,
    priority: i32,
    before: Rc<Context>,
    /// Instructions and half cycles until it began.
    begun: (u64, u64),
}

/// A control tick, as the processor saw it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TickCost {
    /// Instructions from the entry to the return.
    pub instructions: u64,
    /// Cycles of the core's clock, waiting for the buses included.
    pub cycles: u64,
    /// When it began.
    pub at: u64,
}

/// Why the bench came back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The time was up.
    Time,
    /// A handler of SysTick has returned.
    Tick,
    /// The next instruction is the one to stop before.
    Place,
    /// The processor sleeps until the next interrupt, where that was asked for.
    Asleep,
    /// The chip was reset; the program begins anew.
    Reset(Cause),
}

/// The bench.
pub struct Bench {
    engine: Engine<Chip>,
    running: Vec<Running>,
    program: u32,
    asleep: bool,
    sleeps: Vec<u32>,
    stops_before: Option<u32>,
    /// The processor is in lockup: nothing but a reset helps.
    pub lockup: bool,
    /// Come back when the processor falls asleep.
    pub until_asleep: bool,
    /// Of the last handler of SysTick that returned.
    pub last_tick: Option<TickCost>,
    /// Resets so far, and when.
    pub resets: Vec<(u64, Cause)>,
}

/// A board at one time, to come back to.
pub struct Snapshot {
    chip: Chip,
    registers: Context,
    running: Vec<Running>,
    program: u32,
    asleep: bool,
    lockup: bool,
    last_tick: Option<TickCost>,
    resets: Vec<(u64, Cause)>,
}

impl Bench {
    /// A new chip with `image`, just powered.
    pub fn new(image: &Image) -> Bench {
        Bench::with(image, None)
    }

    /// The same with a bit of its memory `stuck`.
    pub fn with(image: &Image, stuck: Option<StuckBit>) -> Bench {
        let mut engine = Engine::new(Chip::new(image.model));
        let chip = engine.guest_mut();
        chip.stuck_bit = stuck;
        for (address, bytes) in &image.segments {
            chip.flash.memory.write(*address, bytes);
        }
        // What runs must be mapped; what is programmed and erased must not be, so that the models see it.
        let flash_end = flash::START + image.model.flash_length();
        let seen = match image.model {
            Model::F405 => {
                let (start, length) = sector_range(sector_of(image.end() - 1));
                let (vectors, program) = (sector_range(0), sector_range(4));
                engine.map(|chip| &chip.flash.memory, vectors.0, vectors.1, false);
                engine.map_registers(vectors.0 + vectors.1..program.0);
                engine.map(|chip| &chip.flash.memory, program.0, start + length - program.0, false);
                start + length
            }
            Model::G474 => {
                engine.map(|chip| &chip.flash.memory, flash::START, BANK_2 - flash::START, false);
                BANK_2
            }
        };
        engine.map_registers(seen..flash_end);
        // The page of a stuck bit is not mapped, so that each store to it is seen.
        let (ram, ram_end) = (crate::chip::RAM, crate::chip::RAM + (128 << 10));
        let page = stuck.map_or(ram_end..ram_end, |stuck| stuck.address & !0xFFF..(stuck.address & !0xFFF) + 0x1000);
        if !page.is_empty() {
            engine.map_registers(page.clone());
        }
        for part in [ram..page.start, page.end..ram_end].into_iter().filter(|part| !part.is_empty()) {
            engine.map(|chip| &chip.ram, part.start, part.end - part.start, true);
        }
        engine.map(|chip| &chip.core_coupled, 0x1000_0000, 64 << 10, true);
        for range in REGISTERS {
            engine.map_registers(range);
        }
        engine.map(|chip| &chip.returns, RETURNS, 0x1000, false);
        // Where the processor may fall asleep: every half word that reads as WFI; most are data.
        let halves = image.segments.iter().flat_map(|(address, bytes)| (*address..).step_by(2).zip(bytes.chunks_exact(2)));
        let sleeps: Vec<u32> = halves.filter(|(_, half)| *half == WFI).map(|(address, _)| address).collect();
        engine.stop_at(&sleeps);
        let (running, asleep) = (Vec::new(), false);
        let mut bench = Bench {
            engine,
            running,
            program: 0,
            asleep,
            sleeps,
            stops_before: None,
            lockup: false,
            until_asleep: false,
            last_tick: None,
            resets: Vec::new(),
        };
        bench.start();
        bench
    }

    /// The chip and the board.
    pub fn chip(&self) -> &Chip {
        self.engine.guest()
    }

    /// The chip and the board, to be changed.
    pub fn chip_mut(&mut self) -> &mut Chip {
        self.engine.guest_mut()
    }

    /// Now.
    pub fn now(&self) -> u64 {
        self.chip().now
    }

    /// Processor, chip and board as they are now.
    pub fn snapshot(&self) -> Snapshot {
        Snapshot {
            chip: self.chip().clone(),
            registers: self.engine.save(),
            running: self.running.clone(),
            program: self.program,
            asleep: self.asleep,
            lockup: self.lockup,
            last_tick: self.last_tick,
            resets: self.resets.clone(),
        }
    }

    /// As they were. What this bench has translated of the program serves on, which a new bench begins with.
    pub fn restore(&mut self, then: &Snapshot) {
        self.chip_mut().restore(&then.chip);
        self.engine.restore(&then.registers);
        self.running.clone_from(&then.running);
        self.resets.clone_from(&then.resets);
        (self.program, self.asleep, self.lockup, self.last_tick) = (then.program, then.asleep, then.lockup, then.last_tick);
    }

    /// Wakes the processor, as an event may at any time.
    pub fn wake(&mut self) {
        self.asleep = self.lockup;
    }

    /// Has the stack end `bytes` above the end of its memory from now on, as if it had grown so deep.
    pub fn deepen_stack(&mut self, bytes: u32) {
        self.engine.processor().set(Register::Stack, crate::chip::RAM + bytes);
    }

    /// Has the program continue at `address`, as if a call had gone astray.
    pub fn stray(&mut self, address: u32) {
        self.engine.processor().set(Register::Link, self.program | 1);
        (self.program, self.asleep) = (address, false);
    }

    /// Comes back with [`Stop::Place`] before the instruction at `address`, where there is one.
    pub fn stop_before(&mut self, address: Option<u32>) {
        let addresses: Vec<u32> = self.sleeps.iter().copied().chain(address).collect();
        self.engine.stop_at(&addresses);
        self.stops_before = address;
    }

    /// A reset.
    pub fn reset(&mut self, cause: Cause) {
        let now = self.now();
        self.resets.push((now, cause));
        self.chip_mut().resets(cause);
        self.start();
    }

    /// The processor begins at the reset vector.
    fn start(&mut self) {
        let memory = &self.chip().flash.memory;
        let (stack, program) = (memory.word(flash::START), memory.word(flash::START + 4));
        self.running.clear();
        (self.asleep, self.lockup, self.last_tick) = (false, false, None);
        self.chip_mut().set_active(IDLE);
        let processor = self.engine.processor();
        for register in [Register::PriorityMask, Register::BasePriority, Register::FaultMask, Register::Control] {
            processor.set(register, 0);
        }
        processor.set(Register::Stack, stack);
        processor.set(Register::Link, u32::MAX);
        self.program = program & !1;
    }

    /// Runs until something happens, at the latest until `until`.
    pub fn run(&mut self, until: u64) -> Stop {
        self.chip_mut().until = until;
        loop {
            if let Some(cause) = self.chip_mut().reset.take() {
                // Below the brown-out reset's level the chip waits.
                if !self.chip().powered() {
                    let chip = self.chip_mut();
                    chip.reset = Some(cause);
                    chip.pass(until.saturating_sub(chip.now).max(1));
                    return Stop::Time;
                }
                self.reset(cause);
                return Stop::Reset(cause);
            }
            let threshold = self.chip().threshold(self.engine.processor());
            if let Some(exception) = self.chip().private.next(threshold) {
                self.enter(exception);
            } else if self.chip().stuck.is_some() {
                (self.lockup, self.asleep) = (true, true);
                self.chip_mut().stuck = None;
            }
            if self.now() >= until {
                return Stop::Time;
            }
            if self.asleep && self.until_asleep {
                return Stop::Asleep;
            }
            if self.asleep {
                let chip = self.chip_mut();
                let wakes = chip.next_event().min(until);
                chip.pass(wakes.saturating_sub(chip.now).max(1));
                // Whatever waits wakes it, masked or not.
                self.asleep = self.lockup || !self.chip().private.waits();
                continue;
            }
            self.chip_mut().continues = true;
            self.engine.run(self.program);
            self.program = self.engine.processor().get(Register::Program) & !1;
            if std::mem::take(&mut self.chip_mut().returned) {
                if self.leave() == Some(SYSTICK) {
                    return Stop::Tick;
                }
                continue;
            }
            if self.stops_before == Some(self.program) {
                return Stop::Place;
            }
            if self.is_sleep(self.program) {
                self.program += 2;
                self.asleep = !self.chip().private.waits();
            }
        }
    }

    fn is_sleep(&self, address: u32) -> bool {
        if !self.chip().flash.memory.contains(address) {
            return false;
        }
        let mut half = [0; 2];
        self.chip().flash.memory.read(address, &mut half);
        half == WFI
    }

    /// Registers to the stack, and to the handler.
    fn enter(&mut self, exception: u32) {
        let processor = self.engine.processor();
        processor.set(Register::Program, self.program | 1);
        let before = Rc::new(self.engine.save());
        let floating = processor.get(Register::Control) & FLOATING_POINT != 0;
        let stack = processor.get(Register::Stack);
        let frame = stack.wrapping_sub(if floating { 0x68 } else { 0x20 }) & !7;
        let [r0, r1, r2, r3, r12, link, status] =
            [Register::R0, Register::R1, Register::R2, Register::R3, Register::R12, Register::Link, Register::Status]
                .map(|register| processor.get(register));
        let words = [r0, r1, r2, r3, r12, link, self.program, status & !0x1FF];
        let chip = self.engine.guest_mut();
        // Where the stack has no memory, what would go there is lost, and the fault's handler runs: before that of any other exception.
        let exception = if chip.ram.contains(frame) && chip.ram.contains(stack - 1) {
            for (place, word) in (frame..).step_by(4).zip(words) {
                chip.ram.write(place, &word.to_le_bytes());
            }
            exception
        } else {
            chip.private.stacking_fault();
            HARD_FAULT
        };
        let processor = self.engine.processor();
        processor.set(Register::Status, status & !IF_THEN);
        processor.set(Register::Stack, frame);
        processor.set(Register::Link, if floating { RETURN & !0x10 } else { RETURN });
        processor.set(Register::Control, processor.get(Register::Control) & !FLOATING_POINT);
        let chip = self.engine.guest_mut();
        chip.pass_cycles(ENTRY);
        chip.private.take(exception);
        if exception == HARD_FAULT {
            chip.stuck = None;
        }
        let priority = chip.private.priority(exception);
        chip.set_active(priority);
        let begun = (chip.instructions, chip.half_cycles);
        self.program = chip.flash.memory.word(flash::START + chip.private.vectors() % flash::START + 4 * exception) & !1;
        self.running.push(Running { number: exception, priority, before, begun });
        self.asleep = false;
    }

    /// Registers back from the stack; the exception that has ended.
    fn leave(&mut self) -> Option<u32> {
        let ended = self.running.pop()?;
        let masks = [Register::PriorityMask, Register::BasePriority];
        let kept = masks.map(|register| self.engine.processor().get(register));
        self.engine.restore(&ended.before);
        for (register, value) in masks.into_iter().zip(kept) {
            self.engine.processor().set(register, value);
        }
        self.program = self.engine.processor().get(Register::Program) & !1;
        let active = self.running.last().map_or(IDLE, |running| running.priority);
        let chip = self.engine.guest_mut();
        chip.set_active(active);
        chip.pass_cycles(ENTRY);
        if ended.number == SYSTICK {
            let (instructions, half_cycles) = ended.begun;
            let instructions = chip.instructions - instructions;
            let cycles = (chip.half_cycles - half_cycles) / 2;
            self.last_tick =
                Some(TickCost { instructions, cycles, at: chip.now - (chip.half_cycles - half_cycles) * chip.half_cycle() });
        }
        Some(ended.number)
    }
}
