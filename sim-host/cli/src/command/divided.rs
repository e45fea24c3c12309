//! Commands whose rows are made in parts, by as many machines as there are.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, anyhow, bail};
use sprag_report::long_run::division::{Divisible, Division};
use sprag_report::long_run::shard::Shard;

use super::context::{Completion, Context, Run};
use super::long_run_arguments::LongRunArguments;
use super::out_arguments::OutputArguments;
use super::thread_arguments::ThreadArguments;
use crate::line::{self, Command};

/// A command whose rows can be made in parts.
pub trait Divided: Run {
    /// Its rows; no other option of long runs may be given.
    ///
    /// # Errors
    /// Input that cannot be read.
    fn divisible(&self, context: &mut Context<'_>) -> anyhow::Result<Divisible>;

    /// What its parts and their merge have otherwise.
    fn options(&mut self) -> (&mut OutputArguments, &mut ThreadArguments, &mut LongRunArguments);
}

/// The divided command of a command line without the name of the program.
///
/// # Errors
/// A command that makes no rows in parts, or an option that contradicts them.
pub fn divided(words: &[String]) -> anyhow::Result<Box<dyn Divided>> {
    let words: Vec<_> = ["sprag"].into_iter().map(Into::into).chain(words.iter().map(Into::into)).collect();
    let command = line::read(&words).map_err(|error| anyhow!("{}", super::wrong_line::wrong_line(&error)))?.command;
    let mut command: Box<dyn Divided> = match command {
        Command::Map(arguments) => Box::new(arguments),
        Command::Cloud(arguments) => Box::new(arguments),
        _ => bail!("only `map` and `cloud` are divided into parts"),
    };
    let (_, _, long_run) = command.options();
    match long_run.given() {
        None => Ok(command),
        Some(option) => bail!("{option} is what a plan stands for: leave it out"),
    }
}

/// How names of scratch folders begin.
const SCRATCH: &str = ".unfinished-";

/// A plan in its folder, with the command that it divides.
pub struct Planned {
    folder: PathBuf,
    division: Division,
    command: Box<dyn Divided>,
}

impl Planned {
    /// The plan in `folder`.
    ///
    /// # Errors
    /// A folder without a plan, and another working folder than where it was made.
    pub fn read(folder: &Path) -> anyhow::Result<Planned> {
        let division = Division::read(folder)?;
        let here = std::env::current_dir().context("the working folder")?;
        // Paths of the command line are relative to it.
        if here != division.working_folder {
            bail!("the plan was made in {}: run this there", division.working_folder.display());
        }
        let command = divided(&division.command_line)?;
        Ok(Planned { folder: folder.to_owned(), division, command })
    }

    /// The rows of the plan, which must still be those that its command makes.
    fn rows(&self, context: &mut Context<'_>) -> anyhow::Result<Divisible> {
        let rows = self.command.divisible(context)?;
        self.division.require(&rows.origin, &self.folder)?;
        Ok(rows)
    }

    /// Makes a part, unless it is there: then nothing else is read, and the answer is false. Any number of processes may do so at once.
    ///
    /// # Errors
    /// A part that there is none of, a scene, record or program that has changed since the plan, an interrupt, and rows that cannot be made
    /// or kept.
    pub fn make(mut self, part: u32, threads: Option<u16>, context: &mut Context<'_>) -> anyhow::Result<bool> {
        let parts = self.division.parts;
        let shard = self.division.shard(part).ok_or_else(|| anyhow!("there is no part {part}: the plan has 1 to {parts}"))?;
        if self.division.has(&self.folder, part) {
            return Ok(false);
        }
        context.interrupt.keep(format_args!("part {part} is not there; the same command makes it"));
        let scratch_name = format!("{SCRATCH}{part:05}-");
        let made = self.work(part, shard, threads, &scratch_name, context);
        if self.division.has(&self.folder, part) {
            // Also those of processes that still make it: it is there, and so they end well.
            self.sweep(&scratch_name);
            return Ok(made.is_ok());
        }
        made.map(|()| true)
    }

    /// Makes a part of these rows that is not there.
    fn work(
        &mut self,
        part: u32,
        shard: Shard,
        threads: Option<u16>,
        scratch_name: &str,
        context: &mut Context<'_>,
    ) -> anyhow::Result<()> {
        let rows = self.rows(context)?;
        let scratch = self.scratch(scratch_name)?;
        let (output, of_threads, long_run) = self.command.options();
        output.out = Some(scratch.path().to_owned());
        output.replace.overwrite = true;
        of_threads.threads = threads.or(of_threads.threads);
        long_run.shard = Some(shard);
        long_run.in_scratch = true;
        let (mut out, interrupt) = (io::sink(), context.interrupt.of_step());
        let mut inner = Context { out: &mut out, err: context.err, interrupt: &interrupt, quiet: true };
        let completion = self.command.run(&mut inner)?;
        if completion == Completion::Interrupted {
            inner.check_interrupt()?;
        }
        Ok(self.division.keep(&self.folder, part, &rows, scratch.path())?)
    }

    /// Puts all parts together to the results of the command, as if it had not been divided.
    ///
    /// # Errors
    /// A scene, record or program that has changed since the plan, parts that are missing, and the errors of the command.
    pub fn collect(mut self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        context.interrupt.keep("the parts are kept; the same command collects them");
        let rows = self.rows(context)?;
        let scratch = self.scratch(SCRATCH)?;
        self.division.unpack(&self.folder, &rows, scratch.path())?;
        let parts = self.division.parts;
        let (_, _, long_run) = self.command.options();
        (long_run.merge, long_run.shards) = (Some(parts), Some(scratch.path().to_owned()));
        let interrupt = context.interrupt.of_step();
        let mut inner = Context { out: context.out, err: context.err, interrupt: &interrupt, quiet: context.quiet };
        let completion = self.command.run(&mut inner)?;
        self.sweep(SCRATCH);
        Ok(completion)
    }

    /// A folder in that of the plan, which is gone at the end; its name begins with `name`.
    fn scratch(&self, name: &str) -> anyhow::Result<tempfile::TempDir> {
        let folder = tempfile::Builder::new().prefix(name).tempdir_in(&self.folder);
        folder.with_context(|| self.folder.display().to_string())
    }

    /// Removes scratch folders whose names begin with `name`, which processes that were killed have left. What cannot be removed stays.
    fn sweep(&self, name: &str) {
        for entry in fs::read_dir(&self.folder).into_iter().flatten().flatten() {
            if entry.file_name().to_str().is_some_and(|other| other.starts_with(name)) {
                let _ = fs::remove_dir_all(entry.path());
            }
        }
    }
}
