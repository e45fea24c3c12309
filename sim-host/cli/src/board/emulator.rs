//! The firmware in QEMU.

use std::io::{Read, Write};
use std::path::Path;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use sprag_shared::link::Pace;

use super::image::Image;
use super::line::{DeviceError, Line};

/// The emulator's program.
const PROGRAM: &str = "qemu-system-arm";

/// How bytes get into the emulator and out of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Way {
    /// By semihosting: a chunk each way for every control period, in the emulator's own time.
    #[default]
    Streams,
    /// By its USART1, byte by byte.
    Usart,
}

/// An emulator that runs.
pub struct Emulator {
    child: Child,
    input: ChildStdin,
    output: Receiver<Vec<u8>>,
    errors: Receiver<String>,
    way: Way,
    /// What goes with the next chunk.
    out: Vec<u8>,
    /// A chunk has come and waits for ours.
    asked: bool,
    /// What has come of a chunk that is not whole yet.
    pending: Vec<u8>,
    /// What it runs, as long as it runs.
    _image: Option<Image>,
}

impl Emulator {
    /// Starts `image`, which logs into `log` if it logs at all.
    ///
    /// # Errors
    /// [`DeviceError::Emulator`].
    pub fn start(image: Image, way: Way, log: Option<&Path>) -> Result<Emulator, DeviceError> {
        let failed = |error: std::io::Error| {
            DeviceError::Emulator(format!("{PROGRAM}: {error}; on Debian: sudo apt-get install qemu-system-arm"))
        };
        let mut semihosting = "enable=on,target=native,arg=sprag".to_owned();
        if way == Way::Usart {
            semihosting.push_str(",arg=usart");
        }
        if let Some(log) = log {
            semihosting.push_str(&format!(",arg=log={}", log.display()));
        }
        let mut command = Command::new(PROGRAM);
        command.args(["-machine", "netduinoplus2", "-display", "none", "-monitor", "none"]);
        // Waiting for the USART the emulated clock must not run ahead of the host; a chunk waits for nobody's clock.
        match way {
            Way::Streams => command.args(["-serial", "none", "-icount", "shift=0,sleep=off"]),
            Way::Usart => command.args(["-serial", "stdio", "-icount", "shift=0"]),
        };
        command.args(["-semihosting-config", &semihosting, "-kernel"]).arg(image.path());
        Emulator::spawn(command, way, Some(image), failed)
    }

    /// Starts the board's own `image` in `bench`, the program that has models of the board's parts.
    ///
    /// # Errors
    /// [`DeviceError::Emulator`].
    pub fn between_models(bench: &Path, image: &Path) -> Result<Emulator, DeviceError> {
        let mut command = Command::new(bench);
        command.arg("serve").arg(image);
        Emulator::spawn(command, Way::Streams, None, |error| DeviceError::Emulator(format!("{}: {error}", bench.display())))
    }

    fn spawn(
        mut command: Command,
        way: Way,
        image: Option<Image>,
        failed: impl Fn(std::io::Error) -> DeviceError,
    ) -> Result<Emulator, DeviceError> {
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().map_err(failed)?;
        let (Some(input), Some(mut stdout), Some(mut stderr)) = (child.stdin.take(), child.stdout.take(), child.stderr.take())
        else {
            return Err(DeviceError::Emulator("no streams".to_owned()));
        };
        let (to_output, output) = channel();
        thread::spawn(move || {
            let mut bytes = [0; 4096];
            while let Ok(count @ 1..) = stdout.read(&mut bytes) {
                if to_output.send(bytes[..count].to_vec()).is_err() {
                    break;
                }
            }
        });
        let (to_errors, errors) = channel();
        thread::spawn(move || {
            let mut text = String::new();
            let _ = stderr.read_to_string(&mut text);
            let _ = to_errors.send(text);
        });
        Ok(Emulator { child, input, output, errors, way, out: Vec::new(), asked: false, pending: Vec::new(), _image: image })
    }

    /// Why it has gone, as far as it says.
    fn gone(&mut self) -> DeviceError {
        let said = self.errors.recv_timeout(Duration::from_millis(200)).unwrap_or_default();
        // What follows the first line is the state of the emulated processor.
        DeviceError::Gone(said.trim().lines().next().map_or_else(String::new, |line| format!(": {line}")))
    }

    /// The next bytes, or none within `patience`.
    fn more(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        match self.output.recv_timeout(patience) {
            Ok(bytes) => Ok(bytes),
            Err(RecvTimeoutError::Timeout) => Ok(Vec::new()),
            Err(RecvTimeoutError::Disconnected) => Err(self.gone()),
        }
    }

    fn exchange(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        if self.asked {
            // The device reads 1022 bytes at most.
            let mut chunk: Vec<u8> = self.out.drain(..self.out.len().min(1022)).collect();
            let count = (chunk.len() as u16).to_le_bytes();
            chunk.splice(0..0, count);
            if self.input.write_all(&chunk).is_err() {
                return Err(self.gone());
            }
            self.asked = false;
        }
        loop {
            if let Some(count) = self.pending.first_chunk::<2>() {
                let end = 2 + usize::from(u16::from_le_bytes(*count));
                if self.pending.len() >= end {
                    let rest = self.pending.split_off(end);
                    let chunk = std::mem::replace(&mut self.pending, rest);
                    self.asked = true;
                    return Ok(chunk[2..].to_vec());
                }
            }
            let more = self.more(patience)?;
            if more.is_empty() {
                return Ok(Vec::new());
            }
            self.pending.extend(more);
        }
    }
}

impl Line for Emulator {
    fn send(&mut self, bytes: &[u8]) -> Result<(), DeviceError> {
        match self.way {
            Way::Streams => {
                self.out.extend(bytes);
                Ok(())
            }
            Way::Usart => self.input.write_all(bytes).map_err(|_| self.gone()),
        }
    }

    fn receive(&mut self, patience: Duration) -> Result<Vec<u8>, DeviceError> {
        match self.way {
            Way::Streams => self.exchange(patience),
            Way::Usart => self.more(patience),
        }
    }

    fn pace(&self) -> Pace {
        match self.way {
            Way::Streams => Pace::Timer,
            Way::Usart => Pace::Sample,
        }
    }
}

impl Drop for Emulator {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
