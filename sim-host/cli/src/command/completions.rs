//! `sprag completions`: completions of commands and options for a shell.

use clap::Args;
use clap_complete::Shell;

use super::context::{Completion, Context, Run};

/// Print completions of commands and options for a shell.
#[derive(Args, Clone, Debug)]
#[command(after_help = "Examples:\n  sprag completions bash > ~/.local/share/bash-completion/completions/sprag\n  \
    sprag completions fish > ~/.config/fish/completions/sprag.fish")]
pub struct CompletionsArguments {
    /// Shell that the completions are for.
    #[arg(value_name = "SHELL")]
    pub shell: Shell,
}

impl Run for CompletionsArguments {
    fn run(&self, context: &mut Context<'_>) -> anyhow::Result<Completion> {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut crate::line::definition(), "sprag", &mut text);
        context.print(String::from_utf8_lossy(&text));
        Ok(Completion::Complete)
    }
}
