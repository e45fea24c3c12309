//! A file of rows that grows in order, and what is done of it.

use std::fs::{File, OpenOptions};
use std::io::{self, BufReader, BufWriter, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use csv::StringRecord;

use super::arguments::Start;
use super::error::LongRunError;
use super::origin::{Ledger, Origin};
use super::shard::Shard;
use crate::output::Results;

/// Which rows are to be made, and where.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    /// Folder of the results.
    pub folder: &'a Path,
    /// Name of the table: `map` for map.csv.
    pub name: &'a str,
    /// Heading.
    pub columns: Vec<String>,
    /// Rows that are never parted.
    pub together: usize,
    /// Which of the run's rows.
    pub shard: Shard,
    /// What they come from.
    pub origin: Origin,
}

/// Where the rows of a shard are and will be.
struct Paths {
    unfinished: PathBuf,
    unfinished_page: PathBuf,
    finished: PathBuf,
    page: PathBuf,
}

impl Plan<'_> {
    fn paths(&self, shard: Shard) -> Paths {
        let stem = shard.file_stem(self.name);
        let path = |ending: &str| self.folder.join(format!("{stem}{ending}"));
        Paths {
            unfinished: path(".csv.unfinished"),
            unfinished_page: path(".csv.unfinished.json"),
            finished: path(".csv"),
            page: path(".run.json"),
        }
    }

    fn rows(&self, shard: Shard) -> Range<usize> {
        shard.rows(self.origin.rows, self.together)
    }

    fn heading(&self) -> Result<Vec<u8>, csv::Error> {
        let mut heading = csv::Writer::from_writer(Vec::new());
        heading.write_record(&self.columns)?;
        heading.into_inner().map_err(|error| csv::Error::from(io::Error::other(error.to_string())))
    }
}

/// Rows of a run, on the way to be whole.
#[derive(Debug)]
pub struct Rows {
    /// None where all of them were there at the beginning.
    growing: Option<File>,
    paths_of: Paths,
    range: Range<usize>,
    done: usize,
}

impl std::fmt::Debug for Paths {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.finished.fmt(out)
    }
}

impl Rows {
    /// Opens the rows of `plan`; those that are there already go to `known` in order, with their number in the whole run.
    ///
    /// # Errors
    /// [`LongRunError`], also for what `known` says of a row.
    pub fn begin(
        plan: &Plan<'_>,
        start: Start,
        mut known: impl FnMut(usize, &StringRecord) -> Result<(), String>,
    ) -> Result<Rows, LongRunError> {
        let (paths, range) = (plan.paths(plan.shard), plan.rows(plan.shard));
        match start {
            Start::Merge(shards) => merge(plan, &paths, shards)?,
            Start::New if paths.unfinished.exists() => return Err(LongRunError::Unfinished { path: paths.unfinished }),
            Start::New | Start::Restart => create(plan, &paths)?,
            Start::Resume if paths.unfinished.exists() => {
                // Where a run ended between the two renamings at its end, the page is in its place already.
                let page = if paths.unfinished_page.exists() { &paths.unfinished_page } else { &paths.page };
                let mut ledger = Ledger::read(page)?;
                ledger.require(&plan.origin, page)?;
                ledger.command_lines.extend(Ledger::new(plan.origin.clone(), plan.shard).command_lines);
                write_page(&ledger, &paths.unfinished_page)?;
            }
            Start::Resume => {
                let of_this_run = |ledger: &Ledger| ledger.origin == plan.origin;
                if paths.finished.exists() && Ledger::read(&paths.page).is_ok_and(|ledger| of_this_run(&ledger)) {
                    let found = scan(plan, &paths.finished, range.clone(), &mut known)?;
                    return whole(plan.shard, &paths.finished, found.rows, range.len()).map(|()| Rows {
                        growing: None,
                        done: range.len(),
                        paths_of: paths,
                        range,
                    });
                }
                create(plan, &paths)?;
            }
        }
        let failed = |error: io::Error| LongRunError::file(&paths.unfinished, &error);
        let mut file = OpenOptions::new().read(true).write(true).open(&paths.unfinished).map_err(failed)?;
        if file.try_lock().is_err() {
            return Err(LongRunError::file(&paths.unfinished, &"another process works on it"));
        }
        let found = scan(plan, &paths.unfinished, range.clone(), &mut known)?;
        if let Start::Merge(_) = start {
            whole(plan.shard, &paths.unfinished, found.rows, range.len())?;
        }
        file.set_len(found.end).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Rows { growing: Some(file), done: found.rows, paths_of: paths, range })
    }

    /// Rows of the whole run that are still to be made.
    pub fn left(&self) -> Range<usize> {
        self.range.start + self.done..self.range.end
    }

    /// Rows that are there.
    pub fn done(&self) -> usize {
        self.done
    }

    /// What to say of a run that was interrupted.
    pub fn interrupted(&self) -> LongRunError {
        LongRunError::Interrupted { done: self.done, rows: self.range.len() }
    }

    /// Adds the next `rows` rows as `text`.
    ///
    /// # Errors
    /// [`LongRunError::File`], for a full disk for one.
    pub fn append(&mut self, text: &[u8], rows: usize) -> Result<(), LongRunError> {
        if let Some(file) = &mut self.growing {
            file.write_all(text).map_err(|error| LongRunError::file(&self.paths_of.unfinished, &error))?;
        }
        self.done += rows;
        Ok(())
    }

    /// Adds the next rows, field by field.
    ///
    /// # Errors
    /// [`LongRunError::File`].
    pub fn append_fields(&mut self, rows: &[Vec<String>]) -> Result<(), LongRunError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let written = rows.iter().try_for_each(|row| writer.write_record(row)).map_err(|error| error.to_string());
        let text = written.and_then(|()| writer.into_inner().map_err(|error| error.to_string()));
        let text = text.map_err(|reason| LongRunError::file(&self.paths_of.unfinished, &reason))?;
        self.append(&text, rows.len())
    }

    /// Removes the file, whose rows are kept elsewhere.
    ///
    /// # Errors
    /// [`LongRunError::File`].
    pub fn discard(self) -> Result<(), LongRunError> {
        let paths = self.paths_of;
        drop(self.growing);
        [&paths.unfinished, &paths.unfinished_page]
            .into_iter()
            .try_for_each(|path| std::fs::remove_file(path).map_err(|error| LongRunError::file(path, &error)))
    }

    /// Puts the whole file into its place, and says where that is.
    ///
    /// # Errors
    /// [`LongRunError::File`].
    pub fn finish(self) -> Result<PathBuf, LongRunError> {
        let paths = self.paths_of;
        if let Some(file) = self.growing {
            file.sync_all().map_err(|error| LongRunError::file(&paths.unfinished, &error))?;
            for (from, to) in [(&paths.unfinished_page, &paths.page), (&paths.unfinished, &paths.finished)] {
                std::fs::rename(from, to).map_err(|error| LongRunError::file(to, &error))?;
            }
        }
        Ok(paths.finished)
    }
}

fn whole(shard: Shard, path: &Path, have: usize, rows: usize) -> Result<(), LongRunError> {
    let missing = LongRunError::Missing { shard, path: path.to_owned(), have, rows };
    if have == rows { Ok(()) } else { Err(missing) }
}

fn write_page(ledger: &Ledger, path: &Path) -> Result<(), LongRunError> {
    let mut results = Results::default();
    let failed = |error: crate::output::OutputError| LongRunError::File { path: error.path, reason: error.reason };
    results.add_json(path, ledger).map_err(failed)?;
    results.commit().map_err(failed)
}

/// A file with the heading alone, and its page.
fn create(plan: &Plan<'_>, paths: &Paths) -> Result<(), LongRunError> {
    let heading = plan.heading().map_err(|error| LongRunError::file(&paths.unfinished, &error))?;
    std::fs::write(&paths.unfinished, heading).map_err(|error| LongRunError::file(&paths.unfinished, &error))?;
    write_page(&Ledger::new(plan.origin.clone(), plan.shard), &paths.unfinished_page)
}

/// A file with the rows of all `shards`, after each was found whole.
fn merge(plan: &Plan<'_>, paths: &Paths, shards: u32) -> Result<(), LongRunError> {
    if paths.unfinished_page.exists() {
        Ledger::read(&paths.unfinished_page)?.require(&plan.origin, &paths.unfinished_page)?;
    }
    // Shards without a row need not be there.
    let with_rows = Shard::all(shards).filter(|shard| !plan.rows(*shard).is_empty());
    let of: Vec<(Shard, Paths)> = with_rows.map(|shard| (shard, plan.paths(shard))).collect();
    for (shard, part) in &of {
        let range = plan.rows(*shard);
        if !part.finished.exists() {
            whole(*shard, &part.finished, 0, range.len())?;
        }
        Ledger::read(&part.page)?.require(&plan.origin, &part.page)?;
        let found = scan(plan, &part.finished, range.clone(), &mut |_, _| Ok(()))?;
        whole(*shard, &part.finished, found.rows, range.len())?;
    }
    create(plan, paths)?;
    let failed = |error: io::Error| LongRunError::file(&paths.unfinished, &error);
    let heading = plan.heading().map_err(|error| LongRunError::file(&paths.unfinished, &error))?.len() as u64;
    let mut out = BufWriter::new(OpenOptions::new().append(true).open(&paths.unfinished).map_err(failed)?);
    for (_, part) in &of {
        let failed_here = |error: io::Error| LongRunError::file(&part.finished, &error);
        let mut rows = File::open(&part.finished).map_err(failed_here)?;
        rows.seek(SeekFrom::Start(heading)).map_err(failed_here)?;
        io::copy(&mut rows, &mut out).map_err(failed)?;
    }
    out.flush().map_err(failed)
}

/// What of a file is whole.
struct Found {
    rows: usize,
    /// Where the last of them ends, bytes.
    end: u64,
}

/// Reads the file at `path` up to the last group of rows that is whole.
fn scan(
    plan: &Plan<'_>,
    path: &Path,
    range: Range<usize>,
    known: &mut dyn FnMut(usize, &StringRecord) -> Result<(), String>,
) -> Result<Found, LongRunError> {
    let failed = |error: io::Error| LongRunError::file(path, &error);
    let mut file = File::open(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    let ends_a_line = ends_with_line(&mut file, length).map_err(failed)?;
    let mut reader = csv::Reader::from_reader(BufReader::with_capacity(1 << 16, file));
    let heading = reader.headers().map_err(|error| LongRunError::file(path, &error))?;
    if heading.iter().ne(plan.columns.iter().map(String::as_str)) {
        return Err(LongRunError::OtherRun { path: path.to_owned(), what: "the heading".to_owned() });
    }
    let mut found = Found { rows: 0, end: reader.position().byte() };
    let mut group: Vec<StringRecord> = Vec::new();
    let mut record = StringRecord::new();
    loop {
        let row = found.rows + group.len() + 1;
        let bad = |reason: String| LongRunError::BadRow { path: path.to_owned(), row, reason };
        let read = reader.read_record(&mut record);
        let end = reader.position().byte();
        match read {
            Ok(false) => return Ok(found),
            // What a killed process has left of its last row.
            Ok(true) | Err(_) if end == length && !ends_a_line => return Ok(found),
            Err(_) if end == length => return Ok(found),
            Err(error) => return Err(bad(error.to_string())),
            Ok(true) => group.push(record.clone()),
        }
        if found.rows + group.len() > range.len() {
            return Err(bad(format!("there should be {} rows only", range.len())));
        }
        if group.len() == plan.together.max(1) {
            for (index, record) in group.iter().enumerate() {
                known(range.start + found.rows + index, record).map_err(bad)?;
            }
            found = Found { rows: found.rows + group.len(), end };
            group.clear();
        }
    }
}

fn ends_with_line(file: &mut File, length: u64) -> io::Result<bool> {
    let mut last = [0];
    if length > 0 {
        file.seek(SeekFrom::End(-1))?;
        io::Read::read_exact(file, &mut last)?;
        file.seek(SeekFrom::Start(0))?;
    }
    Ok(last == *b"\n")
}
