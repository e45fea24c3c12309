//! Unicorn, by the fifteen functions of its C interface that are needed, as a Cortex-M4 between callbacks.
//!
//! Everything unsafe of this package is here. The interface is that of Unicorn 2 (`unicorn/unicorn.h`).

use std::alloc::{Layout, alloc_zeroed, dealloc, handle_alloc_error};
use std::ffi::{c_int, c_void};
use std::ops::Range;
use std::ptr::{NonNull, null_mut};

/// Bytes of a page.
const PAGE: usize = 4096;

const ARCHITECTURE_ARM: c_int = 1;
const MODE_THUMB: c_int = 1 << 4;
const MODE_M_CLASS: c_int = 1 << 5;
/// `UC_CTL_WRITE(UC_CTL_CPU_MODEL, 1)`.
const SET_MODEL: c_int = 1 << 30 | 1 << 26 | 7;
const CORTEX_M4: c_int = 9;
/// `UC_CTL_WRITE(UC_CTL_UC_USE_EXITS, 1)`.
const USE_EXITS: c_int = 1 << 30 | 1 << 26 | 4;
/// `UC_CTL_WRITE(UC_CTL_UC_EXITS, 2)`.
const SET_EXITS: c_int = 1 << 30 | 2 << 26 | 6;
/// `UC_CTL_WRITE(UC_CTL_TB_REMOVE_CACHE, 2)`.
const FORGET_BLOCKS: c_int = 1 << 30 | 2 << 26 | 9;
const READ_AND_EXECUTE: u32 = 1 | 4;
const ALL: u32 = 7;
const HOOK_INTERRUPT: c_int = 1;
const HOOK_BLOCK: c_int = 1 << 3;
/// All three of unmapped and all three of protected memory.
const HOOK_INVALID_MEMORY: c_int = 0b11_1111 << 4;
const HOOK_INVALID_INSTRUCTION: c_int = 1 << 14;

/// What a jump to EXC_RETURN is to Unicorn: `EXCP_EXCEPTION_EXIT`.
const RETURN_OF_EXCEPTION: u32 = 8;

/// A register, by Unicorn's number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(i32)]
pub enum Register {
    /// R14.
    Link = 10,
    /// R15.
    Program = 11,
    /// R13.
    Stack = 12,
    /// R0.
    R0 = 66,
    /// R1.
    R1 = 67,
    /// R2.
    R2 = 68,
    /// R3.
    R3 = 69,
    /// R12.
    R12 = 78,
    /// CONTROL.
    Control = 117,
    /// XPSR.
    Status = 120,
    /// PRIMASK.
    PriorityMask = 123,
    /// BASEPRI.
    BasePriority = 124,
    /// FAULTMASK.
    FaultMask = 126,
}

type Handle = *mut c_void;

unsafe extern "C" {
    fn uc_open(architecture: c_int, mode: c_int, engine: *mut Handle) -> c_int;
    fn uc_close(engine: Handle) -> c_int;
    fn uc_ctl(engine: Handle, control: c_int, ...) -> c_int;
    fn uc_reg_read(engine: Handle, register: c_int, value: *mut c_void) -> c_int;
    fn uc_reg_write(engine: Handle, register: c_int, value: *const c_void) -> c_int;
    fn uc_emu_start(engine: Handle, begin: u64, until: u64, timeout: u64, count: usize) -> c_int;
    fn uc_emu_stop(engine: Handle) -> c_int;
    fn uc_hook_add(
        engine: Handle,
        hook: *mut usize,
        kind: c_int,
        callback: *mut c_void,
        user: *mut c_void,
        begin: u64,
        end: u64,
        ...
    ) -> c_int;
    fn uc_mem_map_ptr(engine: Handle, address: u64, size: usize, permissions: u32, host: *mut c_void) -> c_int;
    fn uc_mmio_map(
        engine: Handle,
        address: u64,
        size: usize,
        read: *mut c_void,
        user: *mut c_void,
        write: *mut c_void,
        user: *mut c_void,
    ) -> c_int;
    fn uc_context_alloc(engine: Handle, context: *mut Handle) -> c_int;
    fn uc_context_save(engine: Handle, context: Handle) -> c_int;
    fn uc_context_restore(engine: Handle, context: Handle) -> c_int;
    fn uc_context_free(context: Handle) -> c_int;
}

/// Panics at an error of Unicorn's: the bench uses it wrongly.
fn well(code: c_int, what: &str) {
    assert_eq!(code, 0, "Unicorn refuses to {what}");
}

/// Memory of the chip that the host reads and writes, too.
#[derive(Debug)]
pub struct Memory {
    start: u32,
    length: usize,
    bytes: NonNull<u8>,
}

impl Memory {
    /// From `start` on, of whole pages, filled with `fill`.
    pub fn new(start: u32, length: usize, fill: u8) -> Memory {
        assert!(length > 0 && length.is_multiple_of(PAGE), "whole pages");
        let layout = Memory::layout(length);
        // SAFETY: the length is not 0.
        let Some(bytes) = NonNull::new(unsafe { alloc_zeroed(layout) }) else { handle_alloc_error(layout) };
        // SAFETY: the block is this long.
        unsafe { bytes.as_ptr().write_bytes(fill, length) };
        Memory { start, length, bytes }
    }

    fn layout(length: usize) -> Layout {
        Layout::from_size_align(length, PAGE).expect("pages")
    }

    /// Whether it has the address.
    pub fn contains(&self, address: u32) -> bool {
        (address.wrapping_sub(self.start) as usize) < self.length
    }

    /// Copies `bytes.len()` bytes from `address`.
    pub fn read(&self, address: u32, bytes: &mut [u8]) {
        let offset = self.offset(address, bytes.len());
        // SAFETY: within the block, as `offset` has seen; the processor writes only while no Rust code runs, or from this very call.
        unsafe { self.bytes.as_ptr().add(offset).copy_to(bytes.as_mut_ptr(), bytes.len()) };
    }

    /// Copies `bytes` to `address`.
    pub fn write(&self, address: u32, bytes: &[u8]) {
        let offset = self.offset(address, bytes.len());
        // SAFETY: as in `read`.
        unsafe { self.bytes.as_ptr().add(offset).copy_from(bytes.as_ptr(), bytes.len()) };
    }

    /// The word at `address`.
    pub fn word(&self, address: u32) -> u32 {
        let mut bytes = [0; 4];
        self.read(address, &mut bytes);
        u32::from_le_bytes(bytes)
    }

    /// Takes what another memory of this length holds; the processor sees it.
    pub fn restore(&self, kept: &Memory) {
        let mut bytes = vec![0; kept.length];
        kept.read(kept.start, &mut bytes);
        self.write(self.start, &bytes);
    }

    fn offset(&self, address: u32, length: usize) -> usize {
        let offset = address.wrapping_sub(self.start) as usize;
        assert!(offset.saturating_add(length) <= self.length, "{address:#010x} is outside of this memory");
        offset
    }
}

impl Clone for Memory {
    fn clone(&self) -> Memory {
        let copy = Memory::new(self.start, self.length, 0);
        copy.restore(self);
        copy
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: allocated by `new` with this layout.
        unsafe { dealloc(self.bytes.as_ptr(), Memory::layout(self.length)) };
    }
}

/// What surrounds the processor.
pub trait Guest {
    /// A load from a register.
    fn read(&mut self, address: u32, size: u32) -> u32;
    /// A store to a register.
    fn write(&mut self, address: u32, size: u32, value: u32);
    /// A block of instructions begins; whether the processor shall stop before it.
    fn block(&mut self, processor: &Processor, address: u32, size: u32) -> bool;
    /// A handler has returned.
    fn returned(&mut self);
    /// The processor cannot continue: an access that nothing answers at `address`, or an instruction that it does not have.
    fn stuck(&mut self, address: Option<u32>);
}

/// The processor's registers.
#[derive(Debug)]
pub struct Processor(Handle);

impl Processor {
    /// Of a register.
    pub fn get(&self, register: Register) -> u32 {
        let mut value = 0_u64;
        // SAFETY: the engine is open, and no register is longer than the place.
        well(unsafe { uc_reg_read(self.0, register as c_int, (&raw mut value).cast()) }, "read a register");
        value as u32
    }

    /// Sets a register.
    pub fn set(&self, register: Register, value: u32) {
        let value = u64::from(value);
        // SAFETY: as in `get`.
        well(unsafe { uc_reg_write(self.0, register as c_int, (&raw const value).cast()) }, "write a register");
    }
}

/// All registers at one time.
#[derive(Debug)]
pub struct Context(Handle);

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: allocated by Unicorn and freed once.
        unsafe { uc_context_free(self.0) };
    }
}

/// A Cortex-M4 and what surrounds it.
pub struct Engine<G: Guest> {
    processor: Processor,
    /// Of the callbacks while the processor runs, else of `guest` and `guest_mut`.
    guest: *mut G,
    // In boxes, for Unicorn has their addresses.
    #[allow(clippy::vec_box)]
    regions: Vec<Box<Region<G>>>,
    exits: Vec<u64>,
}

/// Where registers begin, for the callbacks.
struct Region<G> {
    base: u32,
    guest: *mut G,
}

impl<G: Guest> Engine<G> {
    /// With nothing mapped.
    pub fn new(guest: G) -> Engine<G> {
        let mut handle = null_mut();
        // SAFETY: the place takes a pointer.
        well(unsafe { uc_open(ARCHITECTURE_ARM, MODE_THUMB | MODE_M_CLASS, &mut handle) }, "open");
        // SAFETY: the control takes one integer.
        well(unsafe { uc_ctl(handle, SET_MODEL, CORTEX_M4) }, "be a Cortex-M4");
        let guest = Box::into_raw(Box::new(guest));
        let engine = Engine { processor: Processor(handle), guest, regions: Vec::new(), exits: Vec::new() };
        engine.hook(HOOK_BLOCK, on_block::<G> as *mut c_void, 1, 0);
        engine.hook(HOOK_INVALID_MEMORY, on_invalid_memory::<G> as *mut c_void, 1, 0);
        engine.hook(HOOK_INVALID_INSTRUCTION, on_invalid_instruction::<G> as *mut c_void, 1, 0);
        engine.hook(HOOK_INTERRUPT, on_interrupt::<G> as *mut c_void, 1, 0);
        engine
    }

    fn hook(&self, kind: c_int, callback: *mut c_void, begin: u64, end: u64) {
        let mut hook = 0;
        // SAFETY: the callback has the signature of its kind, and its user data lives as long as the engine.
        well(unsafe { uc_hook_add(self.processor.0, &mut hook, kind, callback, self.guest.cast(), begin, end) }, "hook");
    }

    /// Has [`Engine::run`] come back before an instruction at one of these addresses.
    ///
    /// Not by a hook on instructions: where there is one, Unicorn does not bring the program counter up to date when it is stopped.
    pub fn stop_at(&mut self, addresses: &[u32]) {
        let addresses: Vec<u64> = addresses.iter().map(|address| u64::from(*address)).collect();
        let changed: Vec<u64> = self
            .exits
            .iter()
            .chain(&addresses)
            .filter(|address| self.exits.contains(address) != addresses.contains(address))
            .copied()
            .collect();
        // SAFETY: the controls take an integer, and a pointer with a length.
        unsafe {
            well(uc_ctl(self.processor.0, USE_EXITS, 1), "stop at addresses");
            well(uc_ctl(self.processor.0, SET_EXITS, addresses.as_ptr(), addresses.len()), "stop at these addresses");
            // Blocks that were translated before know nothing of it.
            for address in changed {
                well(uc_ctl(self.processor.0, FORGET_BLOCKS, address, address + 2), "forget a block");
            }
        }
        self.exits = addresses;
    }

    /// Maps `length` bytes of a memory from `start` on, which the guest keeps as long as the engine lives.
    pub fn map(&mut self, memory: impl Fn(&G) -> &Memory, start: u32, length: u32, writable: bool) {
        let memory = memory(self.guest());
        let permissions = if writable { ALL } else { READ_AND_EXECUTE };
        let length = length as usize;
        // SAFETY: `offset` has seen that the range is within the block.
        let bytes = unsafe { memory.bytes.as_ptr().add(memory.offset(start, length)) };
        // SAFETY: the block lives as long as the guest, which is dropped after the engine is closed.
        let code = unsafe { uc_mem_map_ptr(self.processor.0, start.into(), length, permissions, bytes.cast()) };
        well(code, "map memory");
    }

    /// Has loads and stores in `range` answered by the guest.
    pub fn map_registers(&mut self, range: Range<u32>) {
        let region = Box::new(Region { base: range.start, guest: self.guest });
        let user: *mut c_void = (&raw const *region).cast_mut().cast();
        self.regions.push(region);
        let (read, write) = (on_read::<G> as *mut c_void, on_write::<G> as *mut c_void);
        let length = (range.end - range.start) as usize;
        // SAFETY: the callbacks have these signatures, and the region lives as long as the engine.
        let code = unsafe { uc_mmio_map(self.processor.0, range.start.into(), length, read, user, write, user) };
        well(code, "map registers");
    }

    /// Runs from `address` on until the guest stops it or cannot continue.
    pub fn run(&mut self, address: u32) {
        // What goes wrong has been reported to the guest.
        // SAFETY: the callbacks have the guest to themselves: this holds the engine.
        let _ = unsafe { uc_emu_start(self.processor.0, u64::from(address | 1), u64::from(u32::MAX), 0, 0) };
    }

    /// The registers.
    pub fn processor(&self) -> &Processor {
        &self.processor
    }

    /// The guest.
    pub fn guest(&self) -> &G {
        // SAFETY: the callbacks run only within `run`, which has the engine to itself.
        unsafe { &*self.guest }
    }

    /// The guest, to be changed.
    pub fn guest_mut(&mut self) -> &mut G {
        // SAFETY: as in `guest`.
        unsafe { &mut *self.guest }
    }

    /// All registers as they are now.
    pub fn save(&self) -> Context {
        let mut context = null_mut();
        // SAFETY: the place takes a pointer, and what is allocated fits what is saved.
        unsafe {
            well(uc_context_alloc(self.processor.0, &mut context), "allocate a context");
            well(uc_context_save(self.processor.0, context), "save a context");
        }
        Context(context)
    }

    /// All registers as they were.
    pub fn restore(&mut self, context: &Context) {
        // SAFETY: saved by this engine or one like it.
        well(unsafe { uc_context_restore(self.processor.0, context.0) }, "restore a context");
    }
}

impl<G: Guest> Drop for Engine<G> {
    fn drop(&mut self) {
        // SAFETY: closed once, and before the guest whose memory it has mapped.
        unsafe {
            uc_close(self.processor.0);
            drop(Box::from_raw(self.guest));
        }
    }
}

/// The guest, to be used within a callback only.
///
/// # Safety
/// `user` must be what `Engine::new` made.
unsafe fn guest_of<'a, G>(user: *mut c_void) -> &'a mut G {
    // SAFETY: no other reference exists while a callback runs; see `Engine::run`.
    unsafe { &mut *user.cast() }
}

/// The base of a region and the guest, to be used within a callback only.
///
/// # Safety
/// `user` must be what `Engine::map_registers` made.
unsafe fn region_of<'a, G>(user: *mut c_void) -> (u32, &'a mut G) {
    // SAFETY: the region lives as long as the engine; as to the guest see `guest_of`.
    unsafe {
        let region = &*user.cast::<Region<G>>();
        (region.base, &mut *region.guest)
    }
}

extern "C" fn on_block<G: Guest>(engine: Handle, address: u64, size: u32, user: *mut c_void) {
    // SAFETY: Unicorn hands over what it was given.
    let stop = unsafe { guest_of::<G>(user) }.block(&Processor(engine), address as u32, size);
    if stop {
        // SAFETY: the engine runs.
        unsafe { uc_emu_stop(engine) };
    }
}

extern "C" fn on_invalid_memory<G: Guest>(_: Handle, _: c_int, address: u64, _: c_int, _: i64, user: *mut c_void) -> bool {
    // SAFETY: as in `on_block`.
    unsafe { guest_of::<G>(user) }.stuck(Some(address as u32));
    false
}

extern "C" fn on_invalid_instruction<G: Guest>(_: Handle, user: *mut c_void) -> bool {
    // SAFETY: as in `on_block`.
    unsafe { guest_of::<G>(user) }.stuck(None);
    false
}

extern "C" fn on_interrupt<G: Guest>(engine: Handle, number: u32, user: *mut c_void) {
    // SAFETY: as in `on_block`.
    unsafe {
        let guest = guest_of::<G>(user);
        if number == RETURN_OF_EXCEPTION {
            guest.returned()
        } else {
            guest.stuck(None)
        };
        uc_emu_stop(engine);
    }
}

extern "C" fn on_read<G: Guest>(_: Handle, offset: u64, size: u32, user: *mut c_void) -> u64 {
    // SAFETY: as in `on_block`, by way of the region.
    let (base, guest) = unsafe { region_of::<G>(user) };
    guest.read(base + offset as u32, size).into()
}

extern "C" fn on_write<G: Guest>(_: Handle, offset: u64, size: u32, value: u64, user: *mut c_void) {
    // SAFETY: as in `on_read`.
    let (base, guest) = unsafe { region_of::<G>(user) };
    guest.write(base + offset as u32, size, value as u32);
}
