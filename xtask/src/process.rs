//! Starting other programs.

use crate::stop::Stop;
use serde_json::{Deserializer, Value};
use std::{
    ffi::OsString,
    io::{self, BufRead as _, BufReader, Read as _, Write as _},
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    thread::{self, JoinHandle},
};

/// A command of the cargo that runs this task, in the folder of a workspace.
pub fn cargo(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| OsString::from("cargo")));
    command.current_dir(folder).args(args);
    command
}

/// The same in a workspace of its own below the root. Packages that workspaces share must not be built by turns with other flags,
/// so that a target folder of the user's is divided among them.
pub fn cargo_in(root: &Path, workspace: &str, args: &[&str]) -> Command {
    let mut command = cargo(&root.join(workspace), args);
    if let (Some(own), false) = (std::env::var_os("CARGO_TARGET_DIR"), workspace.is_empty()) {
        command.env("CARGO_TARGET_DIR", PathBuf::from(own).join(workspace));
    }
    command
}

/// The folder that the root's workspace is built in.
pub fn target_folder(root: &Path) -> PathBuf {
    root.join(std::env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| OsString::from("target")))
}

/// The target that programs for this machine are built for.
///
/// # Errors
/// If the compiler does not state it.
pub fn host(root: &Path) -> Result<String, Stop> {
    let about = output(Command::new("rustc").current_dir(root).arg("-vV"))?;
    let host = about.lines().find_map(|line| line.strip_prefix("host: "));
    host.map(str::to_owned).ok_or_else(|| Stop::failed("rustc does not state its host"))
}

/// Runs a command to its end.
///
/// # Errors
/// If it cannot be started or does not end well.
pub fn run(command: &mut Command) -> Result<(), Stop> {
    let shown = shown(command);
    let status = command.stdin(Stdio::null()).status().map_err(cannot(&shown))?;
    ended(&shown, status)
}

/// A command that runs beside others, and shows what it wrote when it is waited for; it is ended where nobody waits for it.
#[derive(Debug)]
pub struct Beside {
    shown: String,
    child: Child,
    written: Option<JoinHandle<io::Result<Vec<u8>>>>,
}

impl Beside {
    /// Starts `command`.
    ///
    /// # Errors
    /// If it cannot be started.
    pub fn start(command: &mut Command) -> Result<Self, Stop> {
        let shown = shown(command);
        let (mut reader, writer) = io::pipe().map_err(cannot(&shown))?;
        command.stdin(Stdio::null()).stdout(writer.try_clone().map_err(cannot(&shown))?).stderr(writer);
        let child = command.spawn().map_err(cannot(&shown))?;
        // The pipe ends only when nobody holds its other end.
        command.stdout(Stdio::null()).stderr(Stdio::null());
        let written = thread::spawn(move || {
            let mut bytes = Vec::new();
            reader.read_to_end(&mut bytes).map(|_| bytes)
        });
        Ok(Self { shown, child, written: Some(written) })
    }

    /// Waits for its end.
    ///
    /// # Errors
    /// If it does not end well.
    pub fn wait(mut self) -> Result<(), Stop> {
        let cannot = cannot(&self.shown);
        let written = self.written.take().and_then(|thread| thread.join().ok()).unwrap_or_else(|| Ok(Vec::new()));
        written.and_then(|bytes| io::stderr().write_all(&bytes)).map_err(&cannot)?;
        ended(&self.shown, self.child.wait().map_err(&cannot)?)
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        // Either may fail because it has ended already.
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// Of a command that the system does not run.
fn cannot(shown: &str) -> impl Fn(io::Error) -> Stop {
    move |error| Stop::usage(format!("{shown}: {error}"))
}

/// Whether a command ended well.
fn ended(shown: &str, status: ExitStatus) -> Result<(), Stop> {
    if status.success() { Ok(()) } else { Err(Stop::failed(format!("`{shown}` failed ({status})"))) }
}

/// Runs a command to its end and shows only those lines of its standard error that are wanted.
///
/// # Errors
/// If it cannot be started or does not end well.
pub fn filtered(command: &mut Command, wanted: impl Fn(&str) -> bool) -> Result<(), Stop> {
    let shown = shown(command);
    let cannot = cannot(&shown);
    let mut child = command.stdin(Stdio::null()).stderr(Stdio::piped()).spawn().map_err(&cannot)?;
    if let Some(stderr) = child.stderr.take() {
        // Not `lines`: a program under test may write bytes that are no text.
        for line in BufReader::new(stderr).split(b'\n').map_while(Result::ok) {
            let line = String::from_utf8_lossy(&line);
            if wanted(&line) {
                eprintln!("{line}");
            }
        }
    }
    ended(&shown, child.wait().map_err(cannot)?)
}

/// Runs a command to its end and gives what it wrote to its standard output.
///
/// # Errors
/// If it cannot be started or does not end well.
pub fn output(command: &mut Command) -> Result<String, Stop> {
    let shown = shown(command);
    let output = command.stdin(Stdio::null()).stderr(Stdio::inherit()).output().map_err(cannot(&shown))?;
    ended(&shown, output.status)?;
    String::from_utf8(output.stdout).map_err(|_| Stop::failed(format!("`{shown}` wrote something that is no text")))
}

/// Runs a command to its end, well or not, and gives what it wrote to its standard output.
///
/// # Errors
/// If it cannot be started.
pub fn captured(command: &mut Command) -> Result<String, Stop> {
    let shown = shown(command);
    let output = command.stdin(Stdio::null()).stderr(Stdio::null()).output().map_err(cannot(&shown))?;
    Ok(String::from_utf8_lossy(&output.stdout).into_owned())
}

/// Runs a build of cargo, with arguments for the compiler where it takes some, and gives the paths of the executables that it names; where
/// they lie depends on settings of the user.
///
/// # Errors
/// If the build fails.
pub fn executables(build: &mut Command, to_compiler: &[String]) -> Result<Vec<PathBuf>, Stop> {
    build.arg("--message-format=json-render-diagnostics");
    if !to_compiler.is_empty() {
        build.arg("--").args(to_compiler);
    }
    let messages = output(build)?;
    let messages = Deserializer::from_str(&messages).into_iter::<Value>().flatten();
    Ok(messages.filter_map(|message| message["executable"].as_str().map(PathBuf::from)).collect())
}

/// Whether a program is there and answers.
pub fn answers(program: &str, args: &[&str]) -> bool {
    Command::new(program)
        .args(args)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

/// The command as one would type it, with the program's name only.
fn shown(command: &Command) -> String {
    let program = Path::new(command.get_program());
    let mut words = vec![program.file_name().unwrap_or(program.as_os_str()).to_string_lossy().into_owned()];
    words.extend(command.get_args().map(|arg| arg.to_string_lossy().into_owned()));
    words.join(" ")
}
