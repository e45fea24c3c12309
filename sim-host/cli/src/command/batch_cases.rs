//! The cases of `sprag batch`: rows of a file or of standard input, read one by one.

use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::thread::spawn;

use anyhow::{anyhow, bail};
use csv::{Position, StringRecord};
use sprag_report::columns::{TableError as ReadError, TextRows};
use sprag_report::progress::Progress;
use sprag_sim::batch::case::Case;
use sprag_sim::batch::table::{CaseColumns, Place, TableError};

/// Whether the file at `path` is Parquet by its name; any other is CSV.
pub fn is_parquet(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("parquet"))
}

/// A source of cases that is open.
pub struct CaseFile {
    path: PathBuf,
    /// None for standard input.
    file: Option<File>,
    /// Bytes of a file that can be read again.
    length: Option<u64>,
}

impl CaseFile {
    /// Opens the file at `path`, or standard input for `-`.
    ///
    /// # Errors
    /// A file that cannot be opened.
    pub fn open(path: &Path) -> anyhow::Result<CaseFile> {
        if path == Path::new("-") {
            return Ok(CaseFile { path: path.to_owned(), file: None, length: None });
        }
        let failed = |error| anyhow!("{}: {error}", path.display());
        let file = File::open(path).map_err(failed)?;
        let data = file.metadata().map_err(failed)?;
        if data.is_dir() {
            bail!("{}: is a folder; name a file of cases", path.display());
        }
        let length = data.is_file().then_some(data.len());
        if is_parquet(path) && length.is_none() {
            bail!("{}: Parquet is read from files only", path.display());
        }
        Ok(CaseFile { path: path.to_owned(), file: Some(file), length })
    }

    /// What messages call it.
    pub fn name(&self) -> String {
        if self.file.is_some() { self.path.display().to_string() } else { "standard input".to_owned() }
    }

    /// Whether it can be read more than once.
    pub fn is_file(&self) -> bool {
        self.length.is_some()
    }

    /// Its cases, from the first, beside those that are read elsewhere.
    ///
    /// # Errors
    /// Those of [`CaseFile::open`] and [`CaseFile::cases`].
    pub fn again(&self) -> anyhow::Result<Cases> {
        CaseFile::open(&self.path)?.cases()
    }

    /// Its cases.
    ///
    /// # Errors
    /// A file that is no table of cases.
    pub fn cases(self) -> anyhow::Result<Cases> {
        let name = self.name();
        let failed = |error| wrong(&name, error);
        let mut rows = match self.file {
            None => TextRows::of_csv(std::io::stdin()),
            Some(file) if is_parquet(&self.path) => TextRows::of_parquet(file).map_err(failed)?,
            Some(file) => TextRows::of_csv(file),
        };
        // A stream may be long in coming, even its first line.
        let waiting = self.length.is_none().then(|| Progress::uncounted(&format!("waiting for cases on {name}")));
        let titles = rows.titles().map_err(failed)?;
        drop(waiting);
        let columns = CaseColumns::of(&titles).map_err(|error| anyhow!("{name}: {error}"))?;
        let (place, length): (fn(u64) -> Place, _) = match &rows {
            TextRows::Csv(_) => (Place::Line, self.length.map(|bytes| (bytes, "bytes of cases"))),
            TextRows::Parquet(rows) => (Place::Row, Some((rows.length, "cases"))),
        };
        Ok(Cases { rows, length, done: 0, any: false, reader: CaseReader { name, columns, place } })
    }
}

fn wrong(name: &str, error: ReadError) -> anyhow::Error {
    match error {
        ReadError::Csv(error) => anyhow!("{name}: {}", TableError::from(error)),
        error => anyhow!("{name}: {error}"),
    }
}

/// What makes cases of rows, on any thread.
#[derive(Clone)]
pub struct CaseReader {
    name: String,
    columns: CaseColumns,
    place: fn(u64) -> Place,
}

impl CaseReader {
    /// The id of `row`, and its case.
    ///
    /// # Errors
    /// A row that cannot be a case.
    pub fn case<'a>(&self, row: &'a StringRecord) -> anyhow::Result<(&'a str, Case)> {
        let place = (self.place)(row.position().map_or(0, Position::line));
        self.columns.case(row, place).map_err(|error| anyhow!("{}: {error}", self.name))
    }

    /// What messages call the file.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Cases that are being read.
pub struct Cases {
    rows: TextRows,
    /// How far [`TextRows::done`] goes, and of what.
    length: Option<(u64, &'static str)>,
    /// How far that was when a window was last full.
    done: u64,
    /// Whether there was a case.
    any: bool,
    /// What makes cases of the rows.
    pub reader: CaseReader,
}

/// A window of rows, and whether there may be more.
pub type Filled = (Window, anyhow::Result<bool>);

/// Some rows that are read.
#[derive(Default)]
pub struct Window {
    /// Rows, and room for more.
    rows: Vec<StringRecord>,
    count: usize,
    /// What they are of what [`Cases::progress`] counts.
    pub advance: u64,
}

impl Window {
    /// The rows.
    pub fn rows(&self) -> &[StringRecord] {
        &self.rows[..self.count]
    }
}

impl Cases {
    /// Reads as many rows as there are and as `rows` has room for.
    fn fill(&mut self, mut rows: Vec<StringRecord>) -> Filled {
        let mut count = 0;
        let more = loop {
            let Some(row) = rows.get_mut(count) else { break Ok(true) };
            match self.rows.read(row) {
                Ok(true) => count += 1,
                Ok(false) if self.any || count > 0 => break Ok(false),
                Ok(false) => break Err(anyhow!("{}: {}", self.reader.name, TableError::Empty)),
                Err(error) => break Err(wrong(&self.reader.name, error)),
            }
        };
        self.any |= count > 0;
        let done = if self.length.is_some() { self.rows.done() } else { self.done + count as u64 };
        let advance = done.saturating_sub(std::mem::replace(&mut self.done, done));
        (Window { rows, count, advance }, more)
    }

    /// Gives one window of `size` rows after the other, made of one that is no longer needed; with `ahead` another thread reads the next
    /// meanwhile.
    pub fn windows(mut self, size: usize, ahead: bool) -> Box<dyn FnMut(Option<Window>) -> Filled> {
        let mut fill = move |used: Option<Window>| {
            let rows = used.map_or_else(|| vec![StringRecord::new(); size], |window| window.rows);
            self.fill(rows)
        };
        if !ahead {
            return Box::new(fill);
        }
        let (used, empty) = channel();
        let (full, filled) = channel();
        // Nobody waits for its end: it may wait for input that never comes.
        spawn(move || {
            for used in empty {
                let filled = fill(used);
                let last = !matches!(filled.1, Ok(true));
                if full.send(filled).is_err() || last {
                    break;
                }
            }
        });
        let _ = used.send(None);
        Box::new(move |window| {
            let _ = used.send(window);
            filled.recv().unwrap_or_else(|_| (Window::default(), Err(anyhow!("the cases are no longer read"))))
        })
    }

    /// Gives all cases with their ids to `take` as long as it wants more; whether it took all.
    ///
    /// # Errors
    /// A row that cannot be a case, and a file without any.
    pub fn each(&mut self, mut take: impl FnMut(&str, Case) -> bool) -> anyhow::Result<bool> {
        let mut rows = vec![StringRecord::new()];
        loop {
            let (window, more) = self.fill(rows);
            for row in window.rows() {
                let (id, case) = self.reader.case(row)?;
                if !take(id, case) {
                    return Ok(false);
                }
            }
            if !more? {
                return Ok(true);
            }
            rows = window.rows;
        }
    }

    /// Shows how far they are worked out.
    pub fn progress(&self) -> Progress {
        let Some((length, what)) = self.length else { return Progress::of_unknown_length("cases") };
        let progress = Progress::new(what);
        progress.begin(length);
        progress
    }
}
