//! What is wrong with a command line, in one line.

use std::ffi::OsString;

use clap::Error;

/// `error` in the words of clap, without what takes several lines: how the command is used, and tips on hyphens.
pub fn wrong_line(error: &Error) -> String {
    let text = error.render().to_string();
    let mut said = Vec::new();
    for paragraph in text.split("\n\n") {
        let lines = paragraph.lines().map(str::trim).filter(|line| !line.is_empty());
        let paragraph = match paragraph.trim_start() {
            usage if usage.starts_with("Usage: ") || usage.starts_with("For more information") => continue,
            // A value that begins with a hyphen is hardly ever meant.
            tips if tips.starts_with("tip: ") => {
                lines.filter(|tip| !tip.contains("as a value, use")).collect::<Vec<_>>().join("; ")
            }
            _ => lines.collect::<Vec<_>>().join(" "),
        };
        let paragraph = paragraph.replace("error: ", "").replace("tip: ", "");
        said.extend(Some(paragraph).filter(|paragraph| !paragraph.is_empty()));
    }
    said.join("; ")
}

/// The words of `line` that name the command or subcommand that was meant, such as `sprag board info`.
pub fn command_named(command: &clap::Command, line: impl Iterator<Item = OsString>) -> String {
    let mut named = vec![command.get_name().to_owned()];
    let mut command = command;
    for word in line {
        let Some(inner) = command.find_subcommand(&word) else { break };
        named.push(inner.get_name().to_owned());
        command = inner;
    }
    named.join(" ")
}
