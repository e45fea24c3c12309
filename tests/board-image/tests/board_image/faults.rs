//! The program goes astray, its stack ends, its counter of cycles stands still.

use sprag_board_image::bench::Stop;
use sprag_board_image::peripheral::rcc::Cause;
use sprag_board_image::rig::{Rig, image};
use sprag_board_image::time::{microseconds, milliseconds};
use sprag_shared::link::{Started, reset_cause};
use sprag_shared::settings::{Item, Settings};

/// A board whose safe state is to release both clutches, with one of them engaged.
fn armed() -> Rig {
    let mut settings = Settings::default();
    settings.set(Item::SafeState.index(), 0).expect("in range");
    let mut rig = Rig::new(&image(), Some(&settings));
    rig.arm();
    // The pull-in is over, and the program has nothing left to do.
    rig.ticks(100);
    rig.settle(milliseconds(1));
    assert_ne!(drives(&rig), RELEASED);
    rig
}

fn drives(rig: &Rig) -> [(bool, f64); 2] {
    [rig.bench.chip().drive(0), rig.bench.chip().drive(1)]
}

const RELEASED: [(bool, f64); 2] = [(false, 0.0); 2];

/// Runs on to the reset that a fault leads to; instructions from where the coils were still driven to where they are released, and what the
/// board says of its start.
fn fault(rig: &mut Rig) -> (u64, Started) {
    let end = rig.bench.now() + milliseconds(2);
    // The processor's last instruction before the fault.
    let begun = rig.bench.chip().faults.len();
    let mut at_fault = None;
    let mut released = None;
    loop {
        let now = rig.bench.now();
        let stop = rig.bench.run(now + 1);
        let instructions = rig.bench.chip().instructions;
        if at_fault.is_none() && rig.bench.chip().private.faulted() {
            at_fault = Some(instructions);
        }
        if let Stop::Reset(cause) = stop {
            assert_eq!(cause, Cause::Software);
            break;
        }
        if released.is_none() && drives(rig) == RELEASED {
            released = Some(instructions);
        }
        assert!(rig.bench.now() < end, "no reset; {} faults, lockup {}", rig.bench.chip().faults.len() - begun, rig.bench.lockup);
    }
    let taken = released.expect("reset with the coils on") - at_fault.expect("no fault");
    rig.boot();
    rig.ticks(20);
    (taken, *rig.starts.last().expect("it says nothing"))
}

/// CFSR, HFSR, BFAR and LR of a fault.
fn registers(start: &Started) -> [u32; 4] {
    let text = std::str::from_utf8(&start.file).expect("digits");
    [0, 8, 16, 24].map(|place| u32::from_str_radix(&text[place..place + 8], 16).expect("digits"))
}

/// B8: at every depth at which the stack ends, in a function or at the entry of an interrupt, the coils are switched off before anything else.
#[test]
fn a_stack_that_ends_releases_the_coils_and_is_reported() {
    const UNSTACKED: u32 = 1 << 12;
    const PRECISE: u32 = 1 << 9;
    let mut kinds = [0; 2];
    armed().for_each((0..400).step_by(32), |rig, depth| {
        rig.bench.deepen_stack(depth);
        let (instructions, start) = fault(rig);
        assert_eq!(start.cause, reset_cause::Cause::HardFault, "{depth} bytes left");
        let [status, hard, ..] = registers(&start);
        assert!(status & (UNSTACKED | PRECISE) != 0 && hard == 1 << 30, "{depth} bytes left: {status:#x} {hard:#x}");
        kinds[usize::from(status & PRECISE != 0)] += 1;
        assert!(instructions < 100, "{depth} bytes left: {instructions} instructions before the coils are off");
    });
    println!("{} times at the entry of an interrupt, {} times in a function", kinds[0], kinds[1]);
    assert!(kinds.iter().all(|count| *count > 0), "{kinds:?}");
}

/// C4: an instruction that there is not, where the program goes astray.
#[test]
fn a_fault_keeps_its_registers() {
    // What is erased is no instruction.
    let address = (image().end() + 0xFF) & !0xFF;
    let mut rig = armed();
    rig.bench.stray(address);
    let (instructions, start) = fault(&mut rig);
    println!("astray at {address:#010x}: {instructions} instructions until the coils are off; {:x?}", registers(&start));
    assert_eq!((start.cause, start.place), (reset_cause::Cause::HardFault, address));
    let [status, hard, _, link] = registers(&start);
    assert_eq!((status, hard), (1 << 16, 1 << 30));
    assert!((0x0801_0000..0x0810_0000).contains(&link), "{link:#x}");
}

/// C2: a tick that is late is noticed, and one that never ends reset, with the processor's counter of cycles stopped.
#[test]
fn deadlines_do_not_hang_on_the_counter_of_cycles() {
    const CYCLES_CONTROL: u32 = 0xE000_1000;
    let mut rig = armed();
    rig.bench.chip_mut().store(CYCLES_CONTROL, 0);
    rig.ticks(20);
    assert_eq!(rig.state().fault, None);
    // Nothing is carried out for 3 ms.
    rig.bench.chip_mut().pass(milliseconds(3));
    rig.ticks(20);
    let state = rig.state();
    let late = state.worst_lateness;
    println!("{:?}, late by {late}", state.fault);
    assert_eq!(state.fault.map(|fault| fault.code()), Some(61));
    assert!(late > 0 && state.worst_cost > 0);
    let now = rig.bench.now();
    rig.bench.chip_mut().pass(milliseconds(100));
    let stop = rig.bench.run(now + milliseconds(100) + microseconds(10));
    assert_eq!(stop, Stop::Reset(Cause::Watchdog));
}
