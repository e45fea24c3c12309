//! A run that is divided into parts for many machines: the plan, and a file for each part.

use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use super::error::LongRunError;
use super::origin::{Ledger, Origin};
use super::rows::write_page;
use super::shard::Shard;
use crate::columns::{Column, CsvWriter, parquet_of_csv, parquet_text, read_parquet};
use crate::output::SCHEMA_VERSION;

/// The rows of a run that can be divided.
#[derive(Clone, Debug)]
pub struct Divisible {
    /// What they come from.
    pub origin: Origin,
    /// Name of the table: `map` for map.csv.
    pub name: &'static str,
    /// Columns of the table.
    pub columns: Vec<Column>,
    /// Time that a row takes on one core, s, roughly: how many rows a part has follows from it.
    pub seconds_a_row: f64,
}

/// How a run is divided.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Division {
    schema_version: u32,
    /// SHA-256 of what the rows come from and of the number of parts: files of other rows have another.
    pub key: String,
    /// Number of parts.
    pub parts: u32,
    /// Folder in which the command line was given; its paths may be relative to it.
    pub working_folder: PathBuf,
    /// The command whose rows they are, with its options.
    pub command_line: Vec<String>,
    /// What the rows come from.
    pub origin: Origin,
}

/// Name of the plan in its folder.
const PLAN: &str = "plan.json";

/// Under this name a part has the key of its division.
const KEY: &str = "division_key";

impl Division {
    /// Of the rows of `origin`, which `command_line` makes in `working_folder`, into `parts`.
    pub fn new(origin: Origin, parts: u32, working_folder: PathBuf, command_line: Vec<String>) -> Division {
        let mut content = serde_json::json!({ "origin": origin, "parts": parts });
        content.sort_all_objects();
        let digest = Sha256::digest(content.to_string());
        let key = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        Division { schema_version: SCHEMA_VERSION, key, parts, working_folder, command_line, origin }
    }

    /// The division that is planned in `folder`.
    ///
    /// # Errors
    /// [`LongRunError::File`] when there is none.
    pub fn read(folder: &Path) -> Result<Division, LongRunError> {
        let path = folder.join(PLAN);
        let text = fs::read_to_string(&path).map_err(|error| LongRunError::file(&path, &error))?;
        serde_json::from_str(&text).map_err(|error| LongRunError::file(&path, &format!("not a plan: {error}")))
    }

    /// Writes it into `folder`, which is made where it is missing.
    ///
    /// # Errors
    /// [`LongRunError::OtherPlan`] where another division is planned there, and a file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), LongRunError> {
        let path = folder.join(PLAN);
        if path.exists() {
            let there = Division::read(folder)?;
            if there.key != self.key {
                let what = there.origin.difference(&self.origin).unwrap_or_else(|| "the number of parts".to_owned());
                return Err(LongRunError::OtherPlan { path, what });
            }
        }
        fs::create_dir_all(folder).map_err(|error| LongRunError::file(folder, &error))?;
        write_page(self, &path)
    }

    /// Refuses a run whose rows come from something else than was planned: a scene or record that has changed since, or another version.
    ///
    /// # Errors
    /// [`LongRunError::OtherPlan`] names what differs.
    pub fn require(&self, origin: &Origin, folder: &Path) -> Result<(), LongRunError> {
        match self.origin.difference(origin) {
            None => Ok(()),
            Some(what) => Err(LongRunError::OtherPlan { path: folder.join(PLAN), what }),
        }
    }

    /// The part of this number, from 1.
    pub fn shard(&self, part: u32) -> Option<Shard> {
        Shard::all(self.parts).nth(part.checked_sub(1)? as usize)
    }

    /// The file of a part.
    pub fn part_file(&self, folder: &Path, part: u32) -> PathBuf {
        folder.join(format!("part-{part:05}.parquet"))
    }

    /// Whether a part is there: a whole file with the key of this division.
    pub fn has(&self, folder: &Path, part: u32) -> bool {
        self.lack(folder, part).is_none()
    }

    /// Why a part is not there.
    fn lack(&self, folder: &Path, part: u32) -> Option<&'static str> {
        match File::open(self.part_file(folder, part)).map(|file| parquet_text(file, KEY)) {
            Ok(Ok(Some(key))) if key == self.key => None,
            Ok(Ok(_)) => Some("of another plan"),
            Ok(Err(_)) => Some("damaged"),
            Err(error) if error.kind() == io::ErrorKind::NotFound => Some("not there"),
            Err(_) => Some("cannot be read"),
        }
    }

    /// Numbers of the parts that are not there.
    pub fn missing(&self, folder: &Path) -> Vec<u32> {
        (1..=self.parts).filter(|part| !self.has(folder, *part)).collect()
    }

    /// Puts the rows of a part, which are in `scratch` as CSV, into their place in `folder`. Two processes that do so at once write the
    /// same bytes.
    ///
    /// # Errors
    /// [`LongRunError::File`].
    pub fn keep(&self, folder: &Path, part: u32, rows: &Divisible, scratch: &Path) -> Result<(), LongRunError> {
        let path = self.part_file(folder, part);
        let failed = |error: &dyn std::fmt::Display| LongRunError::file(&path, &error);
        let shard = self.shard(part).unwrap_or(Shard::WHOLE);
        let table = File::open(scratch.join(shard.file_stem(rows.name)).with_extension("csv")).map_err(|error| failed(&error))?;
        let unfinished = scratch.join("part.parquet");
        let file = File::create(&unfinished).map_err(|error| failed(&error))?;
        let metadata = [(KEY.to_owned(), self.key.clone()), ("part".to_owned(), shard.to_string())];
        parquet_of_csv(table, &rows.columns, &metadata, &file).map_err(|error| failed(&error))?;
        file.sync_all().and_then(|()| fs::rename(&unfinished, &path)).map_err(|error| failed(&error))
    }

    /// Writes every part as the shard of a run into `scratch`, for a merge.
    ///
    /// # Errors
    /// [`LongRunError::Parts`] names the first part that is missing or damaged.
    pub fn unpack(&self, folder: &Path, rows: &Divisible, scratch: &Path) -> Result<(), LongRunError> {
        let lacking: Vec<_> = (1..=self.parts).filter_map(|part| Some((part, self.lack(folder, part)?))).collect();
        if let Some((first, why)) = lacking.first() {
            let path = self.part_file(folder, *first);
            return Err(LongRunError::Parts { path, why, missing: lacking.len(), parts: self.parts });
        }
        for (part, shard) in (1..).zip(Shard::all(self.parts)) {
            let path = self.part_file(folder, part);
            let failed = |error: &dyn std::fmt::Display| LongRunError::file(&path, &error);
            let stem = scratch.join(shard.file_stem(rows.name));
            let table = File::create(stem.with_extension("csv")).map_err(|error| failed(&error))?;
            let mut writer = CsvWriter::new(rows.columns.clone(), table).map_err(|error| failed(&error))?;
            let file = File::open(&path).map_err(|error| failed(&error))?;
            read_parquet(file, &rows.columns, &mut writer).and_then(|_| writer.finish()).map_err(|error| failed(&error))?;
            let page = serde_json::to_vec(&Ledger::new(self.origin.clone(), shard)).map_err(|error| failed(&error))?;
            fs::write(stem.with_extension("run.json"), page).map_err(|error| failed(&error))?;
        }
        Ok(())
    }
}
