//! Memory that a reset does not clear.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use sprag_shared::device::retained::{RETAINED_WORDS, Retained};

/// A place that start-up code leaves alone.
#[repr(transparent)]
pub struct Lasting<T>(UnsafeCell<MaybeUninit<T>>);

// SAFETY: `Lasting` is read at start, before there are tasks, and written by one task or by a handler that does not return.
unsafe impl<T> Sync for Lasting<T> {}

impl<T: Copy> Lasting<T> {
    /// To be put into a section whose name starts with `.uninit`.
    pub const fn new() -> Lasting<T> {
        Lasting(UnsafeCell::new(MaybeUninit::uninit()))
    }

    /// What is there: after power-on, anything.
    ///
    /// # Safety
    /// Every pattern of bits must be a `T`.
    pub unsafe fn read(&self) -> T {
        // SAFETY: the place is aligned and always there; what it holds is a `T`, as the caller promises.
        unsafe { self.0.get().cast::<T>().read_volatile() }
    }

    /// Replaces it.
    pub fn write(&self, value: T) {
        // SAFETY: the place is aligned and always there, and nobody else uses it meanwhile; see `Sync`.
        unsafe { self.0.get().cast::<T>().write_volatile(value) }
    }
}

#[unsafe(link_section = ".uninit.KEPT")]
static KEPT: Lasting<[u32; RETAINED_WORDS]> = Lasting::new();

/// What was kept over the reset, if it has survived.
pub fn load() -> Option<Retained> {
    // SAFETY: words hold any bits.
    Retained::of(&unsafe { KEPT.read() })
}

/// Keeps `kept` for after a reset.
pub fn save(kept: &Retained) {
    KEPT.write(kept.words());
}

/// Forgets what was kept.
#[cfg(feature = "board-qemu")]
pub fn forget() {
    KEPT.write([0; RETAINED_WORDS]);
}
