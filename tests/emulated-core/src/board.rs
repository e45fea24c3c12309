//! The board's world: arguments, files and lines are those of the semihosting host.

use crate::{
    case::run_case,
    case_file::{self, LoadError, MAX_WORDS},
    failure::Failure,
    instruction_counter::InstructionCounter,
    self_check,
};
use core::{
    ffi::CStr,
    fmt::{self, Write as _},
    mem::MaybeUninit,
    panic::PanicInfo,
};
use cortex_m_rt::{ExceptionFrame, entry, exception};
use semihosting::{
    fs::File,
    io::{self, Read as _},
    process,
    sys::arm_compat,
};

/// The exit code of a panic, as on the host.
const PANICKED: i32 = 101;

/// The longest command line that is read.
const MAX_COMMAND_LINE: usize = 1024;

#[entry]
fn main() -> ! {
    // `entry` makes this a reference that nobody else can have; on the stack it would be half the memory.
    static mut WORDS: [u32; MAX_WORDS] = [0; MAX_WORDS];

    match run(&mut [0; MAX_COMMAND_LINE], WORDS) {
        Ok(()) => process::exit(0),
        Err(failure) => {
            let _ = writeln!(Console::stderr(), "error: {failure}");
            process::exit(failure.exit_code().into())
        }
    }
}

fn run<'p>(path: &'p mut [u8; MAX_COMMAND_LINE], words: &mut [u32; MAX_WORDS]) -> Result<(), Failure<'p>> {
    let path = case_path(path)?;
    let mut counter = InstructionCounter::start();
    let mut counter = || counter.read();
    let mut console = Console::stdout();
    let Some((path, text)) = path else {
        return self_check::run(&mut counter, &mut console).map_err(Failure::SelfCheck);
    };
    let words = read(path, words).map_err(|error| Failure::Load(text, error))?;
    run_case(words, &mut counter, &mut console).map_err(|error| Failure::Case(text, error))
}

/// The path on the command line, as the host wants it and as text: all that follows the program's name, so that a path
/// may contain blanks.
fn case_path(path: &mut [u8; MAX_COMMAND_LINE]) -> Result<Option<(&CStr, &str)>, Failure<'_>> {
    let mut line = [MaybeUninit::uninit(); MAX_COMMAND_LINE];
    let line = arm_compat::sys_get_cmdline_uninit(&mut line).map_err(|_| Failure::CommandLine)?;
    let Some(blank) = line.iter().position(|byte| *byte == b' ') else {
        return Ok(None);
    };
    let given = &line[blank + 1..];
    path[..given.len()].copy_from_slice(given);
    // The copy is shorter than the buffer, so that the zero that ends it is there.
    let path = CStr::from_bytes_until_nul(path).map_err(|_| Failure::CommandLine)?;
    let text = path.to_str().map_err(|_| Failure::CommandLine)?;
    Ok((!text.is_empty()).then_some((path, text)))
}

fn read<'w>(path: &CStr, words: &'w mut [u32; MAX_WORDS]) -> Result<&'w [u32], LoadError> {
    let mut file = File::open(path).map_err(|_| LoadError::Open)?;
    let byte_count = file.metadata().map_err(|_| LoadError::Open)?.len();
    case_file::load(byte_count, |part| file.read_exact(part).is_ok(), words)
}

/// A stream of the host. Text is handed over a line at a time, for every request stops the emulator.
struct Console<Stream: io::Write> {
    stream: io::Result<Stream>,
    line: [u8; 256],
    filled: usize,
}

impl Console<io::Stdout> {
    fn stdout() -> Self {
        Self { stream: io::stdout(), line: [0; 256], filled: 0 }
    }
}

impl Console<io::Stderr> {
    fn stderr() -> Self {
        Self { stream: io::stderr(), line: [0; 256], filled: 0 }
    }
}

impl<Stream: io::Write> Console<Stream> {
    fn flush(&mut self) -> fmt::Result {
        let text = &self.line[..self.filled];
        self.filled = 0;
        let stream = self.stream.as_mut().map_err(|_| fmt::Error)?;
        stream.write_all(text).map_err(|_| fmt::Error)
    }
}

impl<Stream: io::Write> fmt::Write for Console<Stream> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for byte in text.bytes() {
            self.line[self.filled] = byte;
            self.filled += 1;
            if byte == b'\n' || self.filled == self.line.len() {
                self.flush()?;
            }
        }
        Ok(())
    }
}

impl<Stream: io::Write> Drop for Console<Stream> {
    fn drop(&mut self) {
        let _ = self.flush();
    }
}

/// Text without line breaks: assertions of the core library write several lines, a report has one.
struct OneLine<Sink: fmt::Write>(Sink);

impl<Sink: fmt::Write> fmt::Write for OneLine<Sink> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.chars().try_for_each(|c| self.0.write_char(if c == '\n' { ';' } else { c }))
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    let mut line = OneLine(Console::stderr());
    let _ = match info.location() {
        Some(place) => write!(line, "panic at {}:{}: {}", place.file(), place.line(), info.message()),
        None => write!(line, "panic: {}", info.message()),
    };
    let _ = line.0.write_char('\n');
    process::exit(PANICKED)
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    let _ = writeln!(Console::stderr(), "hard fault at {:#010x}, called from {:#010x}", frame.pc(), frame.lr());
    process::exit(PANICKED)
}

#[exception]
unsafe fn DefaultHandler(number: i16) -> ! {
    let _ = writeln!(Console::stderr(), "interrupt {number} has no handler");
    process::exit(PANICKED)
}
