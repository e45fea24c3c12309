//! `sprag completions`: completions of commands and options for a shell.

use std::io::Write;

use clap::Args;
use clap_complete::Shell;

/// Print completions of commands and options for a shell.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag completions bash > ~/.local/share/bash-completion/completions/sprag\n  \
    sprag completions fish > ~/.config/fish/completions/sprag.fish")]
pub struct CompletionsArguments {
    /// The shell.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

/// Runs the command and gives its exit code.
pub fn run(arguments: &CompletionsArguments, out: &mut impl Write) -> i32 {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut crate::line::definition(), "sprag", &mut text);
    // What cannot be written is reported where standard output ends.
    let _ = out.write_all(&text);
    0
}
