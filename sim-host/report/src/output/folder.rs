//! The folder of a command's results: made when it is needed, gone if nothing came of it, and never another command's unasked.

use std::fs;
use std::ops::Deref;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use serde_json::Value;

use super::same_file::same_file;
use super::{OutputError, REPLACE, Subject};

/// Endings of results.
const ENDINGS: [&str; 6] = ["csv", "parquet", "svg", "png", "md", "txt"];

/// Every folder that this process has made, for [`remove_empty_folders`].
static MADE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the folders that this process has made and that hold nothing: for a process that ends where it is.
pub fn remove_empty_folders() {
    let made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    made.iter().rev().for_each(|folder| _ = fs::remove_dir(folder));
}

/// What a command is about to write into its folder.
#[derive(Clone, Debug)]
pub struct Claim<'a> {
    /// What the results are of.
    pub subject: Subject,
    /// The result that says so: `summary.json` of most commands.
    pub page: &'a str,
    /// Names of the other results, without endings: `history` for history.csv, history.svg, history-2.svg.
    pub names: &'a [&'a str],
    /// Files that the command reads.
    pub inputs: Vec<PathBuf>,
}

impl Claim<'_> {
    /// Whether the file `name` may be one of these results.
    fn has(&self, name: &str) -> bool {
        let ended = name.rsplit_once('.').is_some_and(|(_, ending)| ENDINGS.contains(&ending));
        name == self.page || (ended && self.is_named(name)) || self.is_ledger(name)
    }

    /// Whether the file `name` says what rows of this command are of: `map.run.json`, `map-1-of-2.run.json`.
    fn is_ledger(&self, name: &str) -> bool {
        name.ends_with(".run.json") && self.is_named(name)
    }

    fn is_named(&self, name: &str) -> bool {
        let stem = name.split('.').next().unwrap_or_default();
        self.names.iter().filter_map(|known| stem.strip_prefix(known)).any(|rest| {
            rest.is_empty() || rest.strip_prefix('-').is_some_and(|rest| rest.starts_with(|first: char| first.is_ascii_digit()))
        })
    }
}

/// A folder for results. What it made itself is removed with it where it is still empty: a command that fails leaves no empty folder.
#[derive(Debug)]
pub struct ResultFolder {
    path: PathBuf,
    overwrite: bool,
    any_accuracy: bool,
    /// What it was opened for, and the result that says so.
    opened: Option<(Subject, PathBuf)>,
    /// Results of another run of the command, which are to be overwritten.
    replaced: Vec<PathBuf>,
    made: Vec<PathBuf>,
}

impl ResultFolder {
    /// The folder at `path`, which need not be there; whether results of other commands and inputs in it may be overwritten.
    pub fn new(path: PathBuf, overwrite: bool) -> ResultFolder {
        ResultFolder { path, overwrite, any_accuracy: false, opened: None, replaced: Vec::new(), made: Vec::new() }
    }

    /// Whether results of another accuracy are of the same subject: where a time budget chooses it.
    #[must_use]
    pub fn of_any_accuracy(mut self, any_accuracy: bool) -> ResultFolder {
        self.any_accuracy = any_accuracy;
        self
    }

    /// Makes the folder, unless the results of `claim` would take the place of others: of another command or input, of files that are no
    /// results of Sprag, of an input itself. Does nothing when it was opened before.
    ///
    /// # Errors
    /// [`OutputError`] says whose place it would be, or why the folder cannot be made.
    pub fn open(&mut self, claim: &Claim<'_>) -> Result<(), OutputError> {
        if self.opened.is_some() {
            return Ok(());
        }
        self.replaced = self.check(claim)?;
        self.make("")?;
        self.opened = Some((claim.subject.clone(), self.path.join(claim.page)));
        Ok(())
    }

    /// Refuses to take the place of what another process has put here since the folder was opened, as [`ResultFolder::open`] does.
    ///
    /// # Errors
    /// [`OutputError`] says whose place it would be.
    pub fn check_again(&self) -> Result<(), OutputError> {
        match &self.opened {
            Some((subject, page)) if !self.overwrite && page.exists() => self.check_page(subject, page),
            _ => Ok(()),
        }
    }

    /// Files of another run of the command that are to be overwritten, whether or not they are written anew: a picture of one scene beside the
    /// summary of another would mislead.
    pub fn replaced(&self) -> &[PathBuf] {
        &self.replaced
    }

    /// Those of [`ResultFolder::replaced`].
    fn check(&self, claim: &Claim<'_>) -> Result<Vec<PathBuf>, OutputError> {
        // A folder that is not there has nothing to lose; one that cannot be read is refused when it is written.
        let entries = fs::read_dir(&self.path).into_iter().flatten().flatten();
        let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
        names.retain(|name| claim.has(name));
        names.sort();
        for name in &names {
            let path = self.path.join(name);
            if let Some(input) = claim.inputs.iter().find(|input| same_file(input, &path)) {
                return Err(OutputError { path, reason: super::is_input(input) });
            }
        }
        if self.overwrite {
            let replaced = matches!(self.difference(&claim.subject, &self.path.join(claim.page)), Ok(Some(_)));
            // Rows and their ledger are replaced by whoever makes rows.
            let of_rows = |name: &str| {
                claim.is_ledger(name) || name.strip_suffix(".csv").is_some_and(|stem| names.contains(&format!("{stem}.run.json")))
            };
            let results = names.iter().filter(|name| replaced && *name != claim.page && !of_rows(name));
            let may_go = |path: &PathBuf| path.metadata().is_ok_and(|data| data.is_file() && !data.permissions().readonly());
            return Ok(results.map(|name| self.path.join(name)).filter(may_go).collect());
        }
        let mut known = false;
        for name in names.iter().filter(|name| *name == claim.page || claim.is_ledger(name)) {
            known = true;
            self.check_page(&claim.subject, &self.path.join(name))?;
        }
        match names.first() {
            Some(name) if !known => {
                let reason = format!("{name} is there, and no {} says what it is of; {REPLACE}", claim.page);
                Err(OutputError { path: self.path.clone(), reason })
            }
            _ => Ok(Vec::new()),
        }
    }

    /// Refuses the results of the page at `path` if they are not of `subject`.
    fn check_page(&self, subject: &Subject, path: &Path) -> Result<(), OutputError> {
        let refuse = |reason| OutputError { path: self.path.clone(), reason: format!("{reason}; {REPLACE}") };
        self.other(subject, path).map_or(Ok(()), |reason| Err(refuse(reason)))
    }

    /// What the results of the page at `path` are of, if not of `subject`.
    fn other(&self, subject: &Subject, path: &Path) -> Option<String> {
        let command = &subject.command;
        let another = |what| format!("it holds results of another run of `sprag {command}`: {what} differs");
        self.difference(subject, path).map_or_else(Some, |what| what.map(another))
    }

    /// In what the page at `path`, of the same command, differs from `subject`.
    ///
    /// # Errors
    /// What else the page is of.
    fn difference(&self, subject: &Subject, path: &Path) -> Result<Option<String>, String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let page: Option<Value> = fs::read(path).ok().and_then(|text| serde_json::from_slice(&text).ok());
        let Some((page, command)) = page.as_ref().and_then(|page| Some((page, page.get("command")?.as_str()?))) else {
            return Err(format!("its {name} is no result of sprag"));
        };
        if command == subject.command {
            Ok(subject.difference(page, self.any_accuracy))
        } else {
            Err(format!("it holds results of `sprag {command}`"))
        }
    }

    /// Makes `inner`, a folder in this one, and those above it.
    ///
    /// # Errors
    /// [`OutputError`] when that is not possible.
    pub fn make(&mut self, inner: &str) -> Result<(), OutputError> {
        let folder = if inner.is_empty() { self.path.clone() } else { self.path.join(inner) };
        let named = |folder: &&Path| !folder.as_os_str().is_empty();
        let mut missing: Vec<&Path> = folder.ancestors().filter(named).take_while(|folder| !folder.is_dir()).collect();
        while let Some(next) = missing.pop() {
            match fs::create_dir(next) {
                Ok(()) => {
                    self.made.push(next.to_owned());
                    MADE.lock().unwrap_or_else(PoisonError::into_inner).push(next.to_owned());
                }
                // Another process has made it.
                Err(_) if next.is_dir() => {}
                Err(_) if next.exists() => {
                    let reason = format!("cannot be written: {} is a file, not a folder", next.display());
                    return Err(OutputError { path: self.path.clone(), reason });
                }
                Err(error) => return Err(OutputError::new(&self.path, &error)),
            }
        }
        Ok(())
    }
}

impl Deref for ResultFolder {
    type Target = Path;

    fn deref(&self) -> &Path {
        &self.path
    }
}

impl Drop for ResultFolder {
    fn drop(&mut self) {
        // Those that hold anything stay.
        self.made.iter().rev().for_each(|folder| _ = fs::remove_dir(folder));
    }
}
