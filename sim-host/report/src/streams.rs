//! Standard output and standard error of the command. Neither is locked over a run: any thread may have something to say.

use std::io::{self, LineWriter, Write, stderr, stdout};

use crate::progress::without_bar;

/// Exit code for bad input, and for output that cannot be written.
pub const BAD_INPUT: i32 = 2;

/// Standard output, which remembers why it could not be written.
#[derive(Debug, Default)]
pub struct Output {
    failed: Option<io::Error>,
}

impl Output {
    /// `result` of writing to standard output, which is remembered.
    ///
    /// # Errors
    /// The errors of `result`.
    pub fn noted<T>(&mut self, result: io::Result<T>) -> io::Result<T> {
        if let Err(error) = &result
            && error.kind() != io::ErrorKind::Interrupted
        {
            self.failed.get_or_insert_with(|| io::Error::new(error.kind(), error.to_string()));
        }
        result
    }

    /// The exit code of a command that has written here and would end with `code`. A reader that stops early, such as `head`, has what it
    /// wanted; anything else that keeps results from being written is reported to `err`, and is exit code 2.
    pub fn finish(mut self, code: i32, err: &mut impl Write) -> i32 {
        let _ = self.flush();
        match self.failed {
            Some(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                let _ = writeln!(err, "sprag: standard output cannot be written: {error}");
                BAD_INPUT
            }
            _ => code,
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = without_bar(|| stdout().write(bytes));
        self.noted(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        let flushed = without_bar(|| stdout().flush());
        self.noted(flushed)
    }
}

/// Standard error, by whole lines that no bar tears.
#[derive(Debug)]
pub struct Errors(LineWriter<Unbuffered>);

impl Default for Errors {
    fn default() -> Errors {
        Errors(LineWriter::new(Unbuffered))
    }
}

impl Write for Errors {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[derive(Debug)]
struct Unbuffered;

impl Write for Unbuffered {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        without_bar(|| stderr().write_all(bytes)).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
