//! Where a result goes: a file, beside which it is written first, or a device or pipe that takes it as it comes.

use std::fs::{File, Metadata, OpenOptions};
use std::io::{self, BufReader, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use tempfile::NamedTempFile;

use super::same_file::{is_standard_output, same_file};
use super::{OutputError, REPLACE};

/// Most links that lead from one to another.
const MOST_LINKS: usize = 40;

/// Every file beside its place that this process has made, for [`remove_unfinished`].
static BESIDE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the files of this process that are not in their places: for a process that ends where it is.
pub fn remove_unfinished() {
    let beside = BESIDE.lock().unwrap_or_else(PoisonError::into_inner);
    beside.iter().for_each(|file| _ = std::fs::remove_file(file));
}

/// Where a result goes.
#[derive(Debug)]
enum Target {
    /// A file, once links are followed, and what is there already.
    File { path: PathBuf, present: Option<Metadata> },
    /// A device, a pipe, or this process's standard output.
    Stream,
}

impl Target {
    /// Follows `path`, and refuses what no program should write to.
    fn of(path: &Path) -> Result<Target, OutputError> {
        let refuse = |reason: &str| OutputError { path: path.to_owned(), reason: format!("cannot be written: {reason}") };
        let failed = |error: io::Error| OutputError::new(path, &error);
        if is_standard_output(path) {
            return Ok(Target::Stream);
        }
        let present = match path.metadata() {
            Ok(data) => data,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok(Target::File { path: end_of_links(path), present: None });
            }
            Err(error) => return Err(failed(error)),
        };
        if present.is_dir() {
            return Err(refuse("it is a folder"));
        }
        if !present.is_file() {
            return Ok(Target::Stream);
        }
        // Whoever may do anything still means what the mode says.
        if present.permissions().readonly() {
            return Err(refuse("it is read-only"));
        }
        OpenOptions::new().write(true).open(path).map_err(failed)?;
        Ok(Target::File { path: path.canonicalize().map_err(failed)?, present: Some(present) })
    }
}

/// The place that links to nowhere lead to from `path`.
fn end_of_links(path: &Path) -> PathBuf {
    let mut end = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(next) = end.read_link() else { break };
        end = end.parent().unwrap_or(Path::new("")).join(next);
    }
    end
}

/// A result that is written, but not in its place.
#[derive(Debug)]
pub(super) enum Written {
    /// A file beside its place.
    Beside { file: NamedTempFile, place: PathBuf },
    /// A file of no name, whose bytes go through `path`.
    Apart { file: File, path: PathBuf },
}

impl Written {
    /// An empty result that will be at `path`.
    pub fn new(path: &Path) -> Result<Written, OutputError> {
        let Target::File { path: place, present } = Target::of(path)? else {
            let file = tempfile::tempfile().map_err(|error| OutputError::new(path, &error))?;
            return Ok(Written::Apart { file, path: path.to_owned() });
        };
        let folder = place.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        // Temporary files are private by default; this one becomes the user's, as far as the umask allows.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.prefix(".sprag-").tempfile_in(folder).map_err(|error| OutputError {
            path: path.to_owned(),
            reason: format!("cannot be written: its folder does not exist or may not be written ({})", error.kind()),
        })?;
        BESIDE.lock().unwrap_or_else(PoisonError::into_inner).push(file.path().to_owned());
        if let Some(present) = present {
            // The owner first, since a change of it takes rights away; it is kept where that is allowed.
            #[cfg(unix)]
            {
                use std::os::unix::fs::{MetadataExt, fchown};
                let _ = fchown(file.as_file(), Some(present.uid()), Some(present.gid()));
            }
            file.as_file().set_permissions(present.permissions()).map_err(|error| OutputError::new(path, &error))?;
        }
        Ok(Written::Beside { file, place })
    }

    /// The file to write to.
    pub fn file(&mut self) -> &mut File {
        match self {
            Written::Beside { file, .. } => file.as_file_mut(),
            Written::Apart { file, .. } => file,
        }
    }

    /// Sees to it that nothing of it can be missing later.
    pub fn seal(&mut self) -> io::Result<()> {
        match self {
            Written::Beside { file, .. } => file.as_file().sync_all(),
            Written::Apart { file, .. } => file.rewind(),
        }
    }

    /// Puts it in its place.
    pub fn commit(self) -> Result<(), OutputError> {
        match self {
            Written::Beside { file, place } => {
                file.persist(&place).map(drop).map_err(|error| OutputError::new(&place, &error.error))
            }
            Written::Apart { mut file, path } => match through(&mut file, &path) {
                // A reader that stops early, such as `head`, has what it wanted.
                Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(OutputError::new(&path, &error)),
                _ => Ok(()),
            },
        }
    }
}

fn through(file: &mut File, path: &Path) -> io::Result<()> {
    if is_standard_output(path) {
        let mut out = io::stdout().lock();
        io::copy(file, &mut out)?;
        return out.flush();
    }
    let mut out = OpenOptions::new().write(true).open(path)?;
    io::copy(file, &mut out)?;
    out.flush()
}

/// The device or pipe at `path`, which takes a result as it comes; none where the result is a file.
///
/// # Errors
/// [`OutputError`] when it cannot be written.
pub fn open_stream(path: &Path) -> Result<Option<File>, OutputError> {
    match Target::of(path)? {
        Target::File { .. } => Ok(None),
        Target::Stream => OpenOptions::new().write(true).open(path).map(Some).map_err(|error| OutputError::new(path, &error)),
    }
}

/// Refuses `path` as the one result of a command when it cannot be written, when it is one of `inputs`, and when a file is there that is not
/// `same`, a result of the same command, input and options, unless it is to be overwritten.
///
/// # Errors
/// [`OutputError`] says which.
pub fn claim_file(
    path: &Path,
    inputs: &[&Path],
    overwrite: bool,
    same: impl FnOnce(BufReader<File>) -> bool,
) -> Result<(), OutputError> {
    let refuse = |reason: String| Err(OutputError { path: path.to_owned(), reason });
    match Target::of(path)? {
        Target::File { present: Some(present), .. } => {
            if let Some(input) = inputs.iter().find(|input| same_file(input, path)) {
                return refuse(super::is_input(input));
            }
            let file = File::open(path).map_err(|error| OutputError::new(path, &error))?;
            if !overwrite && present.len() > 0 && !same(BufReader::new(file)) {
                return refuse(format!(
                    "a file is there that this command did not write from the same input and options; {REPLACE}"
                ));
            }
            // Whether there is room beside it.
            Written::new(path).map(drop)
        }
        Target::File { present: None, .. } => Written::new(path).map(drop),
        Target::Stream => Ok(()),
    }
}
