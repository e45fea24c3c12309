//! Options of commands whose rows can be split and resumed.

use std::path::{Path, PathBuf};

use clap::Args;
use sprag_report::long_run::shard::{MOST_SHARDS, Shard};
use sprag_report::long_run::start::Start;

/// What to do with the rows of an interrupted run.
#[derive(Args, Clone, Debug, Default)]
pub struct ResumeArguments {
    /// Resume an interrupted run: its rows are kept.
    #[arg(long, help_heading = "Long runs")]
    pub resume: bool,
    /// Throw away the rows of an interrupted run, and begin again.
    #[arg(long, conflicts_with = "resume", help_heading = "Long runs")]
    pub restart: bool,
}

/// Which rows, and what to do with those that are there.
#[derive(Args, Clone, Debug, Default)]
pub struct LongRunArguments {
    /// Only the I-th of N equal parts of the rows, as for array jobs of a cluster; --merge N puts them together.
    #[arg(long, value_name = "I/N", help_heading = "Long runs")]
    pub shard: Option<Shard>,
    #[command(flatten)]
    pub rows: ResumeArguments,
    /// Put the N shards in the folder together, to the bytes of a run that was not split.
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "resume", "restart"], help_heading = "Long runs",
        value_parser = super::whole_number(1..=MOST_SHARDS))]
    pub merge: Option<u32>,
    /// Folder of the shards, where that is another than the results'.
    #[arg(skip)]
    pub shards: Option<PathBuf>,
    /// Whether rows that were made are gone where others cannot be.
    #[arg(skip)]
    pub in_scratch: bool,
}

impl ResumeArguments {
    /// The first of these options that is given, if any.
    pub fn given(&self) -> Option<&'static str> {
        [("--resume", self.resume), ("--restart", self.restart)].into_iter().find_map(|(option, given)| given.then_some(option))
    }

    /// How the rows begin.
    pub fn start(&self) -> Start {
        match self {
            ResumeArguments { resume: true, .. } => Start::Resume,
            ResumeArguments { restart: true, .. } => Start::Restart,
            _ => Start::New,
        }
    }
}

impl LongRunArguments {
    /// The first of these options that is given, if any.
    pub fn given(&self) -> Option<&'static str> {
        let here = [("--shard", self.shard.is_some()), ("--merge", self.merge.is_some())];
        here.into_iter().find_map(|(option, given)| given.then_some(option)).or_else(|| self.rows.given())
    }

    /// How the rows begin.
    pub fn start(&self) -> Start {
        self.merge.map_or_else(|| self.rows.start(), Start::Merge)
    }

    /// What goes on after an interruption.
    pub fn again(&self) -> &'static str {
        // A merge reads all shards again.
        if self.merge.is_some() { "the same command" } else { super::RESUMED }
    }

    /// Where shards are that are merged into results in `folder`.
    pub fn shards<'a>(&'a self, folder: &'a Path) -> &'a Path {
        self.shards.as_deref().unwrap_or(folder)
    }

    /// Rows that this process makes.
    pub fn shard(&self) -> Shard {
        self.shard.unwrap_or(Shard::WHOLE)
    }
}
