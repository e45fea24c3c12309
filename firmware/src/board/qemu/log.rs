//! Logs into a file of the host, which the command line names: `log=PATH`.

use core::cell::UnsafeCell;
use core::ffi::CStr;
use core::mem::MaybeUninit;

use critical_section::RestoreState;
use defmt::Encoder;
use semihosting::fs::File;
use semihosting::io::Write as _;
use semihosting::sys::arm_compat;

/// Bytes of a command line that are looked at.
const COMMAND_LINE: usize = 512;

/// Bytes of an entry at most; what is longer is cut, and the decoder says so.
const ENTRY: usize = 256;

struct Sink {
    encoder: Encoder,
    file: Option<File>,
    opened: bool,
    entry: [u8; ENTRY],
    length: usize,
    restore: RestoreState,
}

struct Guarded(UnsafeCell<Sink>);

// SAFETY: only looked at between `acquire` and `release`, with interrupts off.
unsafe impl Sync for Guarded {}

static SINK: Guarded = Guarded(UnsafeCell::new(Sink {
    encoder: Encoder::new(),
    file: None,
    opened: false,
    entry: [0; ENTRY],
    length: 0,
    restore: RestoreState::invalid(),
}));

#[defmt::global_logger]
struct Logger;

// SAFETY: interrupts are off from `acquire` to `release`, so entries do not mix.
unsafe impl defmt::Logger for Logger {
    fn acquire() {
        // SAFETY: released in `release`.
        let restore = unsafe { critical_section::acquire() };
        // SAFETY: interrupts are off, and nobody logs while logging.
        let sink = unsafe { &mut *SINK.0.get() };
        (sink.restore, sink.length) = (restore, 0);
        if !sink.opened {
            (sink.opened, sink.file) = (true, open());
        }
        let Sink { encoder, entry, length, .. } = sink;
        encoder.start_frame(|bytes| keep(entry, length, bytes));
    }

    unsafe fn flush() {}

    unsafe fn write(bytes: &[u8]) {
        // SAFETY: between `acquire` and `release`.
        let Sink { encoder, entry, length, .. } = unsafe { &mut *SINK.0.get() };
        encoder.write(bytes, |bytes| keep(entry, length, bytes));
    }

    unsafe fn release() {
        // SAFETY: still between `acquire` and `release`.
        let sink = unsafe { &mut *SINK.0.get() };
        let Sink { encoder, entry, length, .. } = sink;
        encoder.end_frame(|bytes| keep(entry, length, bytes));
        if let (Some(file), Some(entry)) = (&mut sink.file, sink.entry.get(..sink.length)) {
            // A log that cannot be written must not stop what it reports.
            let _ = file.write_all(entry);
        }
        // SAFETY: what `acquire` gave.
        unsafe { critical_section::release(sink.restore) };
    }
}

fn keep(entry: &mut [u8; ENTRY], length: &mut usize, bytes: &[u8]) {
    for (place, byte) in entry.iter_mut().skip(*length).zip(bytes) {
        *place = *byte;
        *length += 1;
    }
}

fn open() -> Option<File> {
    let mut line = [MaybeUninit::uninit(); COMMAND_LINE];
    let line = arm_compat::sys_get_cmdline_uninit(&mut line).ok()?;
    let start = line.windows(4).position(|word| word == b"log=")? + 4;
    let mut path = [0; COMMAND_LINE];
    for (place, byte) in path.iter_mut().zip(line.get(start..)?.iter().take_while(|byte| **byte != 0 && **byte != b' ')) {
        *place = *byte;
    }
    File::create(CStr::from_bytes_until_nul(&path).ok()?).ok()
}
