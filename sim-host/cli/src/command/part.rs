//! `sprag part` and `sprag collect`: the parts of a plan, and their results.

use std::path::PathBuf;

use clap::Args;
use sprag_report::long_run::shard::MOST_SHARDS;

use super::context::{Completion, Context, Run};
use super::divided::Planned;
use super::thread_arguments::ThreadArguments;

/// Make a part of a plan, unless it is there.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  sprag part shared/map 17 --threads 8\n\n\
    Writes part-00017.parquet beside the plan: first under another name, then in its place. A part that is there is left as it is, so a job that was killed is \
    sent again as it was; two that make the same part write the same bytes.")]
pub struct PartArguments {
    /// Folder of the plan.
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Number of the part, from 1.
    #[arg(value_name = "I", value_parser = super::whole_number(1..=MOST_SHARDS))]
    pub part: u32,
    #[command(flatten)]
    pub threads: ThreadArguments,
}

impl Run for PartArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let planned = Planned::read(&self.folder)?;
        let made = planned.make(self.part, self.threads.threads, context)?;
        context.print(format_args!("part {}: {}\n", self.part, if made { "made" } else { "was there" }));
        Ok(Completion::Complete)
    }
}

/// Put the parts of a plan together to the results of its command.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Example:\n  sprag collect shared/map\n\n\
    Writes what the command of the plan writes, where it writes it, to the bytes of a run that was not divided. Parts that are missing or damaged are named.")]
pub struct CollectArguments {
    /// Folder of the plan.
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
}

impl Run for CollectArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        Planned::read(&self.folder)?.collect(context)
    }
}
