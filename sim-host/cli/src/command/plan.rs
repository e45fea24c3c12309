//! `sprag plan`: divides a study into parts for many machines.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Args;
use sprag_report::long_run::division::Division;
use sprag_report::long_run::shard::MOST_SHARDS;

use super::context::{Completion, Context, Run};
use super::divided::divided;

/// Divide a map or cloud into parts for many machines.
#[derive(Args, Clone, Debug)]
#[command(
    after_help = "Examples:\n  sprag plan shared/map -- map scenes/figure08.toml --set map.x.cells=8000 --set map.y.cells=8000\n  \
    sprag plan shared/map --slurm -- map scenes/figure08.toml > job.sh && sbatch job.sh\n  \
    for part in 1 2 3; do sprag part shared/map $part; done; sprag collect shared/map\n\n\
    Writes plan.json: the command, the number of parts and a key, which is the same on every machine; it changes with the scene or study, the contents of \
    every record, and the version of Sprag. Parts are made by `sprag part` in any order, anywhere that sees the folder, and put together by `sprag collect`."
)]
pub struct PlanArguments {
    /// Folder for the plan and its parts.
    #[arg(value_name = "FOLDER")]
    pub folder: PathBuf,
    /// Number of parts, in the place of --part-seconds.
    #[arg(long, value_name = "N", value_parser = super::whole_number(1..=MOST_SHARDS))]
    pub parts: Option<u32>,
    /// Length of a part on one core, s, as a rough rate of rows has it; machines differ.
    #[arg(long, value_name = "S", default_value_t = 30.0, conflicts_with = "parts", value_parser = super::number(super::SECONDS))]
    pub part_seconds: f64,
    /// Print a script for Slurm that makes all parts as one array.
    #[arg(long)]
    pub slurm: bool,
    /// The command and its options, after two dashes.
    #[arg(value_name = "COMMAND", required = true, last = true)]
    pub command: Vec<String>,
}

impl Run for PlanArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let rows = divided(&self.command)?.divisible(context)?;
        let wanted = (rows.origin.rows as f64 * rows.seconds_a_row / self.part_seconds).ceil();
        let parts = self.parts.unwrap_or(wanted.clamp(1.0, f64::from(MOST_SHARDS)) as u32);
        let here = std::env::current_dir().context("the working folder")?;
        let division = Division::new(rows.origin, parts, here, self.command.clone());
        let script = self.slurm.then(|| slurm(&division, &self.folder, rows.name)).transpose()?;
        division.write(&self.folder)?;
        let (key, rows) = (&division.key, division.origin.rows);
        context.print(script.unwrap_or_else(|| format!("{parts} parts of {rows} rows, key {key}\n")));
        Ok(Completion::Complete)
    }
}

/// A script for Slurm's `sbatch`. A part that is there already is done at once, so that it may be sent again as a whole.
///
/// # Errors
/// A path that no line of `#SBATCH` can have.
fn slurm(division: &Division, folder: &Path, name: &str) -> anyhow::Result<String> {
    let logs = division.working_folder.join(folder);
    let [here, logs] = [&division.working_folder, &logs].map(|path| path.display().to_string());
    // A backslash keeps Slurm from filling in numbers of parts, so that all of them would write to one log.
    if let Some(path) = [&here, &logs].into_iter().find(|path| path.contains(['\\', '\n'])) {
        anyhow::bail!(
            "--slurm: a folder is {path:?}, but must be one without backslashes and line breaks, which Slurm reads otherwise"
        );
    }
    // In names of logs % begins what Slurm fills in, also in the folder that it puts before a relative one.
    let (parts, log) = (division.parts, for_slurm(&(logs.replace('%', "%%") + "/part-%a.log")));
    let (here, folder) = (for_slurm(&here), folder.display().to_string().replace('\'', r"'\''"));
    Ok(format!(
        "#!/bin/sh\n#SBATCH --job-name=sprag-{name}\n#SBATCH --array=1-{parts}\n#SBATCH --chdir={here}\n\
         #SBATCH --output={log}\n#SBATCH --requeue\n\
         exec sprag part '{folder}' \"$SLURM_ARRAY_TASK_ID\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\"\n"
    ))
}

/// A word of a line of `#SBATCH`, in which a backslash takes their meaning from quotes.
fn for_slurm(word: &str) -> String {
    format!("\"{}\"", word.replace('"', r#"\""#))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use sprag_report::long_run::origin::Origin;
    use sprag_report::output::Subject;

    use super::*;

    /// The script of a plan of three parts that is made `here`.
    fn script(here: &str, folder: &str) -> anyhow::Result<String> {
        let origin = Origin::new(Subject::new("map", BTreeMap::new()), 12);
        slurm(&Division::new(origin, 3, PathBuf::from(here), Vec::new()), Path::new(folder), "map")
    }

    #[test]
    fn paths_reach_slurm_and_the_shell_as_they_are() {
        let script = script(r#"/home/O'Hara "x" #1%"#, "Ann's 50 %a").unwrap();
        let lines: Vec<&str> = script.lines().collect();
        assert!(lines.contains(&r##"#SBATCH --chdir="/home/O'Hara \"x\" #1%""##), "{script}");
        let log = r##"#SBATCH --output="/home/O'Hara \"x\" #1%%/Ann's 50 %%a/part-%a.log""##;
        assert!(lines.contains(&log), "{script}");
        assert!(lines.last().unwrap().starts_with(r#"exec sprag part 'Ann'\''s 50 %a' "$SLURM"#), "{script}");
    }

    #[test]
    fn a_path_that_slurm_would_read_otherwise_is_refused() {
        for (here, folder, named) in
            [("/home", r"a\b", r#""/home/a\\b""#), (r"/home\x", "parts", r#""/home\\x""#), ("/home", "a\nb", r#""/home/a\nb""#)]
        {
            let refused = script(here, folder).unwrap_err().to_string();
            assert!(refused.starts_with(&format!("--slurm: a folder is {named}, but must be")), "{refused}");
        }
    }
}
