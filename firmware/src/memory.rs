//! Memory that a reset does not clear.

use core::cell::UnsafeCell;
use core::mem::MaybeUninit;
use sprag_shared::control::supervisor::LOG_ENTRIES;
use sprag_shared::device::Device;
use sprag_shared::device::retained::{RETAINED_WORDS, Retained, latest};
use sprag_shared::device::retained_log::{SLOT_WORDS, Slots, slot, words};

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

    /// Where it is.
    #[cfg(any(feature = "board-f405", feature = "board-g474"))]
    pub const fn address(&self) -> *mut T {
        self.0.get().cast()
    }

    /// Replaces it.
    pub fn write(&self, value: T) {
        // SAFETY: the place is aligned and always there, and nobody else uses it meanwhile; see `Sync`.
        unsafe { self.0.get().cast::<T>().write_volatile(value) }
    }
}

#[unsafe(link_section = ".uninit.KEPT")]
static KEPT: [Lasting<[u32; RETAINED_WORDS]>; 2] = [const { Lasting::new() }; 2];

fn copies() -> [[u32; RETAINED_WORDS]; 2] {
    // SAFETY: words hold any bits.
    KEPT.each_ref().map(|copy| unsafe { copy.read() })
}

/// State retained over the reset, if it has survived.
pub fn load() -> Option<Retained> {
    let copies = copies();
    Retained::of(copies.get(latest(&copies)?.0)?)
}

/// Keeper of the state that is retained over a reset.
pub struct Keeper {
    last: Option<Retained>,
    turn: u8,
}

impl Keeper {
    /// A keeper that leaves the latest copy as it is until it has written a whole one.
    pub fn new() -> Keeper {
        // Which copy a turn is written to follows from its number.
        Keeper { last: None, turn: latest(&copies()).map_or(0, |(_, turn)| turn) }
    }

    /// Stores `kept`, unless it is stored already.
    pub fn save(&mut self, kept: &Retained) {
        if self.last.as_ref() == Some(kept) {
            return;
        }
        self.turn = self.turn.wrapping_add(1);
        if let Some(copy) = KEPT.get(usize::from(self.turn % 2)) {
            copy.write(kept.words(self.turn));
        }
        self.last = Some(*kept);
    }
}

#[unsafe(link_section = ".uninit.LOG")]
static LOG: [Lasting<[u32; SLOT_WORDS]>; LOG_ENTRIES] = [const { Lasting::new() }; LOG_ENTRIES];

/// The event log as it was before the reset, if `survived`; otherwise its memory is cleared.
pub fn load_log(survived: bool) -> Option<Slots> {
    if survived {
        // SAFETY: words hold any bits.
        return Some(LOG.each_ref().map(|slot| unsafe { slot.read() }));
    }
    LOG.iter().for_each(|slot| slot.write([0; SLOT_WORDS]));
    None
}

/// Keeper of what is new in the event log.
pub struct LogKeeper {
    /// Entries that are stored, counted from the first that there ever was.
    kept: u32,
}

impl LogKeeper {
    /// A keeper that has stored nothing since the last start.
    pub const fn new() -> LogKeeper {
        LogKeeper { kept: 0 }
    }

    /// Stores the entries that have come since.
    pub fn save(&mut self, device: &Device) {
        if device.log_count() == self.kept {
            return;
        }
        let (entries, count) = device.logged(self.kept);
        for (number, entry) in entries {
            if let Some(place) = LOG.get(slot(number)) {
                place.write(words(number, entry));
            }
        }
        self.kept = count;
    }
}

/// Clears the retained state.
#[cfg(feature = "board-qemu")]
pub fn forget() {
    load_log(false);
    for copy in &KEPT {
        copy.write([0; RETAINED_WORDS]);
    }
}
