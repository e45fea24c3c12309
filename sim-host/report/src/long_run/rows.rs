//! A file of rows that grows in order, and what is done of it.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufReader, BufWriter, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};

use csv::StringRecord;
use serde::Serialize;

use super::error::LongRunError;
use super::origin::{Ledger, Origin};
use super::shard::Shard;
use super::start::Start;
use crate::output::{Results, is_at};

/// Which rows are to be made, and where.
#[derive(Clone, Debug)]
pub struct Plan<'a> {
    /// Folder of the results.
    pub folder: &'a Path,
    /// Folder of the shards that are merged.
    pub shards: &'a Path,
    /// Name of the table: `map` for map.csv.
    pub name: &'a str,
    /// Heading.
    pub columns: Vec<String>,
    /// Rows that are never parted.
    pub together: usize,
    /// Shard of the run's rows.
    pub shard: Shard,
    /// What they come from.
    pub origin: Origin,
}

/// What a file of rows looks like.
#[derive(Debug)]
struct Shape {
    columns: Vec<String>,
    /// Rows that are never parted.
    together: usize,
    /// Its rows of those of the whole run.
    range: Range<usize>,
}

/// Where the rows of a shard are and will be.
struct Paths {
    unfinished: PathBuf,
    unfinished_page: PathBuf,
    finished: PathBuf,
    page: PathBuf,
}

impl Plan<'_> {
    fn paths(&self, folder: &Path, shard: Shard) -> Paths {
        let stem = shard.file_stem(self.name);
        let path = |ending: &str| folder.join(format!("{stem}{ending}"));
        Paths {
            unfinished: path(".csv.unfinished"),
            unfinished_page: path(".csv.unfinished.json"),
            finished: path(".csv"),
            page: path(".run.json"),
        }
    }

    fn shape(&self, shard: Shard) -> Shape {
        let range = shard.rows(self.origin.rows, self.together);
        Shape { columns: self.columns.clone(), together: self.together, range }
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
    /// None where all of them were there at the beginning. It is locked: no other process writes to it.
    growing: Option<File>,
    shape: Shape,
    paths_of: Paths,
    done: usize,
    /// Bytes that the file should have.
    length: u64,
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
        let (paths, shape) = (plan.paths(plan.folder, plan.shard), plan.shape(plan.shard));
        let rows = shape.range.len();
        let file = match start {
            Start::New => create(plan, &paths, new(&paths.unfinished)?)?,
            Start::Restart => create(plan, &paths, lock(&paths.unfinished, true)?)?,
            Start::Merge(shards) => merge(plan, &paths, shards)?,
            Start::Resume if paths.unfinished.exists() => {
                let file = lock(&paths.unfinished, false)?;
                // Where a run ended between the two renamings at its end, the page is in its place already.
                let page = if paths.unfinished_page.exists() { &paths.unfinished_page } else { &paths.page };
                if !page.exists() {
                    return Err(LongRunError::NoPage { page: paths.unfinished_page, rows: paths.unfinished });
                }
                let mut ledger = Ledger::read(page)?;
                ledger.require(&plan.origin, page)?;
                ledger.command_lines.extend(Ledger::new(plan.origin.clone(), plan.shard).command_lines);
                write_page(&ledger, &paths.unfinished_page)?;
                file
            }
            Start::Resume => {
                let of_this_run = |ledger: &Ledger| ledger.origin == plan.origin;
                if paths.finished.exists() && Ledger::read(&paths.page).is_ok_and(|ledger| of_this_run(&ledger)) {
                    let found = scan(&shape, &paths.finished, &mut known)?;
                    whole(plan.shard, &paths.finished, found.rows, rows)?;
                    return Ok(Rows { growing: None, shape, paths_of: paths, done: rows, length: found.end });
                }
                create(plan, &paths, new(&paths.unfinished)?)?
            }
        };
        let failed = |error: io::Error| LongRunError::file(&paths.unfinished, &error);
        let found = scan(&shape, &paths.unfinished, &mut known)?;
        if let Start::Merge(_) = start {
            whole(plan.shard, &paths.unfinished, found.rows, rows)?;
        }
        file.set_len(found.end).map_err(failed)?;
        (&file).seek(SeekFrom::End(0)).map_err(failed)?;
        Ok(Rows { growing: Some(file), shape, paths_of: paths, done: found.rows, length: found.end })
    }

    /// Rows of the whole run that are still to be made.
    pub fn left(&self) -> Range<usize> {
        self.shape.range.start + self.done..self.shape.range.end
    }

    /// Rows that are there.
    pub fn done(&self) -> usize {
        self.done
    }

    /// Where they are until they are finished.
    pub fn path(&self) -> &Path {
        if self.growing.is_some() { &self.paths_of.unfinished } else { &self.paths_of.finished }
    }

    /// What to say of a run that was interrupted.
    pub fn interrupted(&self) -> LongRunError {
        LongRunError::Interrupted { done: self.done, rows: self.shape.range.len() }
    }

    /// Adds the next `rows` rows as `text`.
    ///
    /// # Errors
    /// [`LongRunError::File`], for a full disk for one.
    pub fn append(&mut self, text: &[u8], rows: usize) -> Result<(), LongRunError> {
        if let Some(file) = &mut self.growing {
            file.write_all(text).map_err(|error| LongRunError::file(&self.paths_of.unfinished, &error))?;
            self.length += text.len() as u64;
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
        // Still locked, so that the file of another process cannot be meant.
        [&self.paths_of.unfinished, &self.paths_of.unfinished_page]
            .into_iter()
            .try_for_each(|path| std::fs::remove_file(path).map_err(|error| LongRunError::file(path, &error)))
    }

    /// Puts the whole file into its place, once every row was found in it, and says where that is.
    ///
    /// # Errors
    /// [`LongRunError::Changed`] when the file is not what was written, [`LongRunError::File`] when it cannot be put there.
    pub fn finish(self) -> Result<PathBuf, LongRunError> {
        let Rows { growing, shape, paths_of: paths, length, .. } = self;
        if let Some(file) = growing {
            let failed = |error: io::Error| LongRunError::file(&paths.unfinished, &error);
            file.sync_all().map_err(failed)?;
            let changed = |reason: String| LongRunError::Changed { path: paths.unfinished.clone(), reason };
            if !is_at(&file, &paths.unfinished) {
                return Err(changed("another file is in its place".to_owned()));
            }
            let bytes = file.metadata().map_err(failed)?.len();
            if bytes != length {
                return Err(changed(format!("{bytes} bytes for {length}")));
            }
            let found = scan(&shape, &paths.unfinished, &mut |_, _| Ok(()));
            let (rows, due) = (found.map_err(|error| changed(error.reason()))?.rows, shape.range.len());
            if rows != due {
                return Err(changed(format!("{rows} rows for {due}")));
            }
            for (from, to) in [(&paths.unfinished_page, &paths.page), (&paths.unfinished, &paths.finished)] {
                std::fs::rename(from, to).map_err(|error| LongRunError::file(to, &error))?;
            }
        }
        Ok(paths.finished)
    }
}

/// Opens the file at `path` for this process alone, and makes it if it may.
fn lock(path: &Path, make: bool) -> Result<File, LongRunError> {
    loop {
        let file = OpenOptions::new().read(true).write(true).create(make).truncate(false).open(path);
        if let Some(file) = locked(file.map_err(|error| LongRunError::file(path, &error))?, path)? {
            return Ok(file);
        }
    }
}

/// Makes the file at `path`, where none may be, for this process alone.
fn new(path: &Path) -> Result<File, LongRunError> {
    let mut options = OpenOptions::new();
    options.read(true).write(true);
    loop {
        let made = options.clone().create_new(true).open(path);
        let there = matches!(&made, Err(error) if error.kind() == io::ErrorKind::AlreadyExists);
        let file = match if there { options.open(path) } else { made } {
            // The process that worked on it has ended in between.
            Err(error) if there && error.kind() == io::ErrorKind::NotFound => continue,
            file => file.map_err(|error| LongRunError::file(path, &error))?,
        };
        match locked(file, path)? {
            Some(_) if there => return Err(LongRunError::Unfinished { path: path.to_owned() }),
            Some(file) => return Ok(file),
            None => {}
        }
    }
}

/// The `file` that was opened at `path`, for this process alone; none where a process that ended in between has put it elsewhere.
fn locked(file: File, path: &Path) -> Result<Option<File>, LongRunError> {
    match file.try_lock() {
        Ok(()) => Ok(is_at(&file, path).then_some(file)),
        Err(TryLockError::WouldBlock) => Err(LongRunError::file(path, &"another process works on it")),
        Err(TryLockError::Error(error)) => Err(LongRunError::file(path, &error)),
    }
}

fn whole(shard: Shard, path: &Path, have: usize, rows: usize) -> Result<(), LongRunError> {
    let missing = LongRunError::Missing { shard, path: path.to_owned(), have, rows };
    if have == rows { Ok(()) } else { Err(missing) }
}

/// Writes the page at `path`, as a whole or not at all.
pub(super) fn write_page(page: &impl Serialize, path: &Path) -> Result<(), LongRunError> {
    let mut results = Results::default();
    let failed = |error: crate::output::OutputError| LongRunError::File { path: error.path, reason: error.reason };
    results.add_json(path, page).map_err(failed)?;
    results.commit().map_err(failed)
}

/// Makes of the locked `file` one with the heading alone, and writes its page.
fn create(plan: &Plan<'_>, paths: &Paths, mut file: File) -> Result<File, LongRunError> {
    let failed = |error: io::Error| LongRunError::file(&paths.unfinished, &error);
    let heading = plan.heading().map_err(|error| LongRunError::file(&paths.unfinished, &error))?;
    file.set_len(0).and_then(|()| file.write_all(&heading)).map_err(failed)?;
    write_page(&Ledger::new(plan.origin.clone(), plan.shard), &paths.unfinished_page)?;
    Ok(file)
}

/// A file with the rows of all `shards`, after each was found whole.
fn merge(plan: &Plan<'_>, paths: &Paths, shards: u32) -> Result<File, LongRunError> {
    if paths.unfinished_page.exists() {
        Ledger::read(&paths.unfinished_page)?.require(&plan.origin, &paths.unfinished_page)?;
    }
    // Shards without a row need not be there.
    let with_rows = Shard::all(shards).filter(|shard| !plan.shape(*shard).range.is_empty());
    let of: Vec<(Shard, Paths)> = with_rows.map(|shard| (shard, plan.paths(plan.shards, shard))).collect();
    for (shard, part) in &of {
        let shape = plan.shape(*shard);
        let rows = shape.range.len();
        if !part.finished.exists() {
            whole(*shard, &part.finished, 0, rows)?;
        }
        Ledger::read(&part.page)?.require(&plan.origin, &part.page)?;
        let found = scan(&shape, &part.finished, &mut |_, _| Ok(()))?;
        whole(*shard, &part.finished, found.rows, rows)?;
    }
    let file = create(plan, paths, lock(&paths.unfinished, true)?)?;
    let failed = |error: io::Error| LongRunError::file(&paths.unfinished, &error);
    let heading = plan.heading().map_err(|error| LongRunError::file(&paths.unfinished, &error))?.len() as u64;
    let mut out = BufWriter::new(&file);
    for (_, part) in &of {
        let failed_here = |error: io::Error| LongRunError::file(&part.finished, &error);
        let mut rows = File::open(&part.finished).map_err(failed_here)?;
        rows.seek(SeekFrom::Start(heading)).map_err(failed_here)?;
        io::copy(&mut rows, &mut out).map_err(failed)?;
    }
    out.flush().map_err(failed)?;
    drop(out);
    Ok(file)
}

/// What of a file is whole.
struct Found {
    rows: usize,
    /// Where the last of them ends, bytes.
    end: u64,
}

/// Reads the file at `path` up to the last group of rows that is whole.
fn scan(
    Shape { columns, together, range }: &Shape,
    path: &Path,
    known: &mut dyn FnMut(usize, &StringRecord) -> Result<(), String>,
) -> Result<Found, LongRunError> {
    let failed = |error: io::Error| LongRunError::file(path, &error);
    let mut file = File::open(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    let ends_a_line = ends_with_line(&mut file, length).map_err(failed)?;
    let mut reader = csv::Reader::from_reader(BufReader::with_capacity(1 << 16, file));
    let heading = reader.headers().map_err(|error| LongRunError::file(path, &error))?;
    if heading.iter().ne(columns.iter().map(String::as_str)) {
        return Err(LongRunError::OtherRun { path: path.to_owned(), what: "the heading".to_owned() });
    }
    let mut found = Found { rows: 0, end: reader.position().byte() };
    let mut group = vec![StringRecord::new(); (*together).max(1)];
    let mut filled = 0;
    loop {
        let row = found.rows + filled + 1;
        let record = &mut group[filled];
        let bad = |reason: String| LongRunError::BadRow { path: path.to_owned(), row, reason };
        let read = reader.read_record(record);
        let end = reader.position().byte();
        match read {
            Ok(false) => return Ok(found),
            // What a killed process has left of its last row.
            Ok(true) | Err(_) if end == length && !ends_a_line => return Ok(found),
            Err(_) if end == length => return Ok(found),
            Err(error) => return Err(bad(error.to_string())),
            // What a hole in a file reads as; no field has one.
            Ok(true) if record.as_slice().contains('\0') => return Err(bad("a zero byte".to_owned())),
            Ok(true) => filled += 1,
        }
        if found.rows + filled > range.len() {
            return Err(bad(format!("there should be {} rows only", range.len())));
        }
        if filled == group.len() {
            for (index, record) in group.iter().enumerate() {
                known(range.start + found.rows + index, record).map_err(bad)?;
            }
            found = Found { rows: found.rows + filled, end };
            filled = 0;
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
