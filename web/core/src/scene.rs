//! A scene and the records that it names, all in memory.

use std::cell::OnceCell;
use std::path::Path;

use sprag_sim::map::grid::Grid;
use sprag_sim::record::{Record, RecordError};
use sprag_sim::scene::ground::GroundTable;
use sprag_sim::scene::{Scene, SceneError, document, overrides};
use toml::Table;

/// Name of the scene in messages.
const ORIGIN: &str = "scene";

/// A file of a page, by its name.
#[derive(Clone, Debug, Default)]
pub struct File {
    /// As `file` of a motion names it.
    pub name: String,
    /// Contents.
    pub bytes: Vec<u8>,
}

/// Reasons why a page cannot follow a scene, one line each.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// The scene.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A record that cannot be read.
    #[error("{0}")]
    Record(#[from] RecordError),
    /// A record that the page does not have.
    #[error("the page has no record \"{0}\": drop the file on it")]
    NoRecord(String),
    /// A name that is not of the page's lists.
    #[error("\"{0}\" is none of {1}")]
    Unknown(String, String),
    /// Whatever ended a run.
    #[error("{0}")]
    Failed(String),
}

impl PageError {
    /// Of whatever ended a run.
    pub fn failed(error: impl ToString) -> PageError {
        PageError::Failed(error.to_string())
    }
}

/// A scene that a page shows.
#[derive(Debug)]
pub struct PageScene {
    /// With its records.
    pub scene: Scene,
    table: Table,
    grid: OnceCell<Grid>,
}

impl PageScene {
    /// Of a TOML text, with every file that one of its motions names.
    ///
    /// # Errors
    /// [`PageError`] for a scene that cannot be read, a record that is none, and one that is not among `files`.
    pub fn new(text: &str, files: &[File]) -> Result<PageScene, PageError> {
        let mut scene = Scene::parse(text, ORIGIN)?;
        scene.take_records(|motion| record(motion, files))?;
        Ok(PageScene { scene, table: document::table(text, ORIGIN)?, grid: OnceCell::new() })
    }

    /// The text with changes (`KEY=VALUE`) of it, each checked.
    ///
    /// # Errors
    /// [`SceneError`] names the key and what it may be.
    pub fn set(&self, settings: &[String]) -> Result<String, SceneError> {
        let mut table = self.table.clone();
        overrides::apply_all(&mut table, settings, ORIGIN)?;
        Scene::of_table(table.clone(), ORIGIN)?;
        Ok(table.to_string())
    }

    /// The grid of its `[map]`.
    ///
    /// # Errors
    /// [`SceneError`] without axes, or for values at a corner that are outside their ranges.
    pub fn grid(&self) -> Result<&Grid, SceneError> {
        match self.grid.get() {
            Some(grid) => Ok(grid),
            None => {
                let grid = Grid::new(self.scene.clone(), self.table.clone())?;
                Ok(self.grid.get_or_init(|| grid))
            }
        }
    }

    /// The text of a cell's scene, without `[map]`.
    ///
    /// # Errors
    /// [`SceneError`] without axes, or for a value outside its range.
    pub fn cell(&self, column: usize, row: usize) -> Result<String, SceneError> {
        let grid = self.grid()?;
        let mut table = self.table.clone();
        let settings = grid.settings(grid.values(column, row));
        overrides::apply_all(&mut table, &settings, ORIGIN)?;
        table.remove("map");
        Ok(table.to_string())
    }
}

/// The record that a motion names.
fn record(motion: &GroundTable, files: &[File]) -> Result<Record, PageError> {
    let name = motion.file.as_deref().unwrap_or(Path::new(""));
    match files.iter().find(|file| Path::new(&file.name) == name) {
        Some(file) => Ok(Record::parse(&file.name, &file.bytes, &motion.read_options())?),
        None => Err(PageError::NoRecord(name.display().to_string())),
    }
}
