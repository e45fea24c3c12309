//! Options that say where results go, and what of a scene they depend on.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use sprag_report::output::{Claim, Digest, Formats, OutputError, ResultFolder, Subject};
use sprag_report::part::Part;
use sprag_sim::scene::Scene;
use sprag_sim::scene::ground::GroundTable;
use sprag_sim::scene::schema::SceneFile;

use super::accuracy_arguments::AccuracyArguments;

/// What may be replaced.
#[derive(Args, Clone, Copy, Debug, Default)]
pub struct OverwriteArguments {
    /// Replace what is there, also results of other commands and inputs; those of the same command and input are replaced anyway.
    #[arg(long)]
    pub overwrite: bool,
}

/// Where results go, in which formats, and how they are printed.
#[derive(Args, Clone, Debug, Default)]
pub struct OutputArguments {
    /// Folder for the results; by default out/NAME-COMMAND, of `simulate` out/NAME, with the name of the scene or study.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// What may be replaced in it.
    #[command(flatten)]
    pub replace: OverwriteArguments,
    /// Formats of tables (csv, parquet) and pictures (svg, png), separated by commas; csv must be among them. By default csv,svg, and all four
    /// of `map`, `cloud` and `optimise`.
    #[arg(long, value_name = "LIST")]
    pub formats: Option<Formats>,
    /// Write pictures as PNG too.
    #[arg(long)]
    pub png: bool,
    /// Print the summary as JSON, and the tables on standard error.
    #[arg(long)]
    pub json: bool,
}

impl OutputArguments {
    /// The folder for results of `command` on `input`, a scene or study; all that is asked of them is possible.
    ///
    /// # Errors
    /// The errors of [`OutputArguments::formats`].
    pub(super) fn folder(&self, input: &Path, command: &str) -> anyhow::Result<ResultFolder> {
        self.formats(command)?;
        let path = self.out.clone().unwrap_or_else(|| {
            let stem = input.file_stem().map_or_else(|| "scene".into(), |stem| stem.to_string_lossy());
            Path::new("out").join(if command == "simulate" { stem.into_owned() } else { format!("{stem}-{command}") })
        });
        Ok(ResultFolder::new(path, self.replace.overwrite))
    }

    /// The same for a command that runs as accurately as `accuracy` asks.
    ///
    /// # Errors
    /// The errors of [`OutputArguments::formats`].
    pub(super) fn folder_at(&self, input: &Path, command: &str, accuracy: &AccuracyArguments) -> anyhow::Result<ResultFolder> {
        Ok(self.folder(input, command)?.of_any_accuracy(accuracy.is_chosen()))
    }

    /// The formats of the results of `command`.
    ///
    /// # Errors
    /// A format that the program was built without, and Parquet of a command whose tables have no types.
    pub(super) fn formats(&self, command: &str) -> anyhow::Result<Formats> {
        let default = if matches!(command, "map" | "cloud" | "optimise") { Formats::ALL } else { Formats::PLAIN };
        let formats = self.formats.unwrap_or(default);
        let typed = default.parquet || matches!(command, "design" | "sensitivity" | "similar" | "accuracy");
        anyhow::ensure!(typed || !formats.parquet, "--formats: `sprag {command}` writes its tables as csv only");
        let png = if self.png { Part::PNG.allow(true)? } else { formats.png };
        Ok(Formats { png, ..formats })
    }
}

/// What a command is about to make of the scene at `path`: results called `names` and a summary. `file` is the scene as the user wrote it,
/// `records` are files that it reads beside those of the scene.
///
/// # Errors
/// [`OutputError`] names a record whose name JSON cannot hold.
pub(super) fn claim_of_scene<'a>(
    command: &str,
    path: &Path,
    scene: &Scene,
    file: &SceneFile,
    names: &'a [&'a str],
    records: &[PathBuf],
) -> Result<Claim<'a>, OutputError> {
    let supports: Vec<GroundTable> = file.support_records().collect();
    let tables = file.ground.iter().chain(&file.vertical).chain(&supports);
    let of_scene: Vec<_> = tables.filter_map(|table| Some((table.file.clone()?, table.path(&scene.folder)?))).collect();
    if let Some((name, _)) = of_scene.iter().find(|(name, _)| name.to_str().is_none()) {
        let reason = "its name is not Unicode, and summary.json has to name it; rename the file".to_owned();
        return Err(OutputError { path: name.clone(), reason });
    }
    let read: Vec<(PathBuf, PathBuf)> =
        of_scene.into_iter().chain(records.iter().map(|path| (path.clone(), path.clone()))).collect();
    let subject = Subject::new(command, digests(&read)).with("scene", file)?;
    let inputs = std::iter::once(path.to_owned()).chain(read.into_iter().map(|(_, path)| file_of(&path))).collect();
    Ok(Claim { subject, page: "summary.json", names, inputs })
}

/// The contents of record files by their names.
pub(super) fn digests(read: &[(PathBuf, PathBuf)]) -> BTreeMap<String, Digest> {
    // A file that cannot be read is refused, or named, where its motion is read.
    read.iter().filter_map(|(name, path)| Some((name.display().to_string(), Digest::of(&file_of(path)).ok()?))).collect()
}

/// The file of a record that may be named as FILE#COMPONENT.
pub(super) fn file_of(record: &Path) -> PathBuf {
    match record.to_str().and_then(|name| name.rsplit_once('#')) {
        Some((file, _)) if !record.exists() => PathBuf::from(file),
        _ => record.to_owned(),
    }
}
