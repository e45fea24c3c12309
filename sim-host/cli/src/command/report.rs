//! Results of a subcommand: files that appear together in its folder, and the text that is printed once they have.

use std::fmt::{Display, Write as _};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use serde::Serialize;
use sprag_report::columns::{Column, Table, metadata_of};
use sprag_report::long_run::rows::Rows;
use sprag_report::output::{
    Formats, Maker, OutputError, ResultFolder, Results, RowTaker, SCHEMA_VERSION, Subject, Summary, VERSION,
};
use sprag_report::plot::PlotError;
use sprag_report::progress::Progress;
use sprag_report::terminal::for_terminal;
use sprag_sim::record::RecordSummary;
use sprag_sim::scene::schema::SceneFile;
use sprag_sim::simulation::demand::Demand;

use super::context::{Completion, Context};
use super::out_arguments::OutputArguments;

/// Results that are made from finished runs.
pub struct Report {
    command: &'static str,
    folder: PathBuf,
    formats: Formats,
    json: bool,
    results: Results,
    /// Rows that are made, and not in their place.
    rows: Option<Rows>,
    /// What every Parquet file says of itself.
    made_by: Vec<(String, String)>,
    summary: String,
    text: String,
    notes: Vec<String>,
    completion: Completion,
    drawing: Option<Progress>,
}

impl Report {
    /// No results of `command` yet, for `folder`.
    ///
    /// # Errors
    /// Formats that cannot be written.
    pub fn new(command: &'static str, folder: &Path, output: &OutputArguments) -> anyhow::Result<Report> {
        Ok(Report {
            command,
            folder: folder.to_owned(),
            formats: output.formats(command)?,
            json: output.json,
            results: Results::default(),
            rows: None,
            made_by: Vec::new(),
            summary: String::new(),
            text: String::new(),
            notes: Vec::new(),
            completion: Completion::Complete,
            drawing: Some(drawing()),
        })
    }

    /// Says in Parquet files what made them.
    ///
    /// # Errors
    /// An input that has no JSON.
    pub fn made_by(&mut self, input: impl Serialize) -> anyhow::Result<()> {
        self.made_by = metadata_of(&Maker::new(self.command, input))?;
        Ok(())
    }

    /// Writes `summary.json`: `input` is the scene or study as resolved, `subject` has the files that were read.
    pub fn summary(
        &mut self,
        input: impl Serialize,
        records: &[RecordSummary],
        warnings: &[String],
        subject: &Subject,
        findings: impl Serialize,
    ) -> Result<(), OutputError> {
        let (command, files) = (self.command, &subject.files);
        let (version, schema_version) = (VERSION, SCHEMA_VERSION);
        self.document("summary.json", &Summary { command, version, schema_version, input, records, warnings, files, findings })
    }

    /// Writes the document `name`, which `--json` prints.
    pub fn document(&mut self, name: &str, document: &impl Serialize) -> Result<(), OutputError> {
        let failed = |error| OutputError { path: self.folder.join(name), reason: format!("cannot be written: {error}") };
        self.summary = serde_json::to_string_pretty(document).map_err(failed)? + "\n";
        self.results.add(&self.folder.join(name), |file| file.write_all(self.summary.as_bytes()))
    }

    /// Writes a file through `fill`.
    pub fn file(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<&mut std::fs::File>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        self.results.add(&self.folder.join(name), fill)
    }

    /// Writes a page of text.
    pub fn page(&mut self, name: &str, text: &str) -> Result<(), OutputError> {
        self.file(name, |file| file.write_all(text.as_bytes()))
    }

    /// Writes a table in all formats.
    pub fn table(&mut self, name: &str, table: &dyn Table) -> Result<(), OutputError> {
        self.results.add_table(&self.folder, name, table, &self.made_by, self.formats)
    }

    /// Writes a table as CSV as its rows come from `fill`, which shows itself how far it is.
    ///
    /// # Errors
    /// Those of `fill`, and [`OutputError`].
    pub fn rows_from(
        &mut self,
        name: &str,
        columns: &[Column],
        fill: impl FnOnce(&mut RowTaker<'_>) -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        self.drawing = None;
        let csv = self.folder.join(format!("{name}.csv"));
        self.results.add_rows(&csv, columns, fill)?;
        self.drawing = Some(drawing());
        Ok(())
    }

    /// Writes the table `name` of `rows` in the other formats. As CSV it comes to its place with all other files: results of two runs are
    /// never mixed.
    pub fn rows(&mut self, name: &str, rows: Rows, columns: &[Column]) -> Result<(), OutputError> {
        if self.formats.parquet {
            let path = self.folder.join(format!("{name}.parquet"));
            self.results.add_parquet_of(rows.path(), &path, columns, &self.made_by)?;
        }
        self.rows = Some(rows);
        Ok(())
    }

    /// Removes a file that earlier results have left.
    pub fn remove(&mut self, name: &str) {
        self.results.remove(self.folder.join(name));
    }

    /// Whether pictures are to be written at all.
    pub fn draws(&self) -> bool {
        self.formats.svg || self.formats.png
    }

    /// Writes a picture; gives the file to look at first, if any. One that cannot be drawn is left out, and a line says so: the results are
    /// worth more.
    ///
    /// # Errors
    /// [`OutputError`].
    pub fn picture(&mut self, name: &str, svg: Result<String, PlotError>) -> anyhow::Result<Option<PathBuf>> {
        match svg {
            Ok(svg) => Ok(self.results.add_picture(&self.folder, name, &svg, self.formats)?),
            Err(error) => {
                ["svg", "png"].into_iter().for_each(|ending| self.remove(&format!("{name}.{ending}")));
                if self.draws() {
                    self.note(format_args!("{name}: no picture: {error}"));
                }
                Ok(None)
            }
        }
    }

    /// Prints a line, or text that ends with a line break of its own.
    pub fn print(&mut self, text: impl Display) {
        let _ = write!(self.text, "{text}");
        if !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push('\n');
        }
    }

    /// Prints how accurate the runs are, where that was asked for.
    pub fn accuracy(&mut self, worst: Option<impl Display>) {
        if let Some(worst) = worst {
            self.print(format_args!("accuracy: {worst}"));
        }
    }

    /// Writes a line to standard error.
    pub fn note(&mut self, line: impl Display) {
        self.notes.push(line.to_string());
    }

    /// Notes the warnings of `[checks]` of each device, with its name.
    pub fn note_checks<'a>(&mut self, devices: impl Iterator<Item = (&'a str, Option<&'a Demand>)>) {
        for (device, checks) in devices {
            for warning in checks.iter().flat_map(|checks| &checks.warnings) {
                self.note(format_args!("warning: {device}: {warning}"));
            }
        }
    }

    /// Names what was left out.
    pub fn left_out(&mut self, lines: &[String]) {
        lines.iter().for_each(|line| self.note(format_args!("left out: {line}")));
    }

    /// Whether all that was asked for is there: the answer is negative or partial otherwise.
    pub fn complete(&mut self, complete: bool) {
        self.completion = Completion::of(complete);
    }

    /// Puts all files in their places in `folder` and prints the text, or with `--json` the summary, and the text on standard error.
    ///
    /// # Errors
    /// An interrupt, rows that are not as they were written, results of another run that have come there meanwhile, and [`OutputError`].
    pub fn finish(mut self, folder: &ResultFolder, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        context.check_interrupt()?;
        folder.check_again()?;
        let rows = self.rows.map(Rows::finish).transpose()?;
        let replaced = folder.replaced().iter().filter(|path| rows.as_ref() != Some(path));
        replaced.for_each(|path| self.results.remove(path.clone()));
        self.results.commit_with_notes(&mut context.err)?;
        drop(self.drawing);
        let text = format!("{}results written to {}\n", self.text, self.folder.display());
        if self.json {
            let _ = context.out.write_all(self.summary.as_bytes());
            if !context.quiet {
                let _ = context.err.write_all(text.as_bytes());
            }
        } else {
            context.print(for_terminal(&text));
        }
        self.notes.iter().for_each(|line| context.note(line));
        Ok(self.completion)
    }
}

fn drawing() -> Progress {
    Progress::uncounted("drawing and writing results")
}

/// A scene as resolved.
#[derive(Clone, Copy, Serialize)]
pub struct SceneInput<'a> {
    /// Its keys, with defaults filled in.
    pub scene: &'a SceneFile,
}

/// The runs of a scene.
#[derive(Clone, Copy, Serialize)]
pub struct Runs<'a, R> {
    /// One object for each device.
    pub runs: &'a [R],
}
