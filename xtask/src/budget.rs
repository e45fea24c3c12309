//! The file with what an image may occupy and what it did when that was last accepted.
//!
//! A line is a name and a number of bytes; `#` starts a comment. `flash` and `ram` are limits that people set; a name with a dot
//! in front is a section, and those lines are written by `cargo xtask firmware --overwrite`.

/// What a file says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Budget {
    /// Most that may lie in flash, bytes.
    pub flash: u64,
    /// Most that variables may take, bytes.
    pub ram: u64,
    /// The accepted size of each section, bytes.
    pub sections: Vec<(String, u64)>,
}

impl Budget {
    /// Reads a file.
    ///
    /// # Errors
    /// A line for people on the first fault.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut limits = [("flash", None), ("ram", None)];
        let mut sections: Vec<(String, u64)> = Vec::new();
        for line in text.lines().map(content).filter(|line| !line.is_empty()) {
            let (name, bytes) = line.split_once(char::is_whitespace).ok_or_else(|| format!("no number in \"{line}\""))?;
            let bytes = bytes.trim().parse().map_err(|_| format!("\"{}\" is no number of bytes", bytes.trim()))?;
            let twice = || format!("\"{name}\" is there twice");
            if let Some((_, limit)) = limits.iter_mut().find(|(limited, _)| *limited == name) {
                if limit.replace(bytes).is_some() {
                    return Err(twice());
                }
            } else if !is_section(name) {
                return Err(format!("\"{name}\" is neither flash, ram nor a section such as .text"));
            } else if sections.iter().any(|(known, _)| known == name) {
                return Err(twice());
            } else {
                sections.push((name.to_owned(), bytes));
            }
        }
        let [flash, ram] = limits.map(|(name, limit)| limit.ok_or_else(|| format!("no limit for {name}")));
        Ok(Self { flash: flash?, ram: ram?, sections })
    }
}

/// The text of a file with other sizes of sections, which come last; limits and comments stay.
pub fn with_sections<'a>(text: &str, sections: impl IntoIterator<Item = (&'a str, u64)>) -> String {
    let kept = text.lines().filter(|line| !is_section(content(line))).map(str::to_owned);
    let written = sections.into_iter().map(|(name, bytes)| format!("{name} {bytes}"));
    kept.chain(written).map(|line| line + "\n").collect()
}

fn is_section(name: &str) -> bool {
    name.starts_with('.')
}

/// A line without its comment.
fn content(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "# bytes\nflash 1000 # one\n\n.text 300\nram\t20\n.bss 4\n";

    #[test]
    fn a_budget_has_limits_sections_and_comments() {
        let sections = vec![(".text".into(), 300), (".bss".into(), 4)];
        assert_eq!(Budget::parse(TEXT), Ok(Budget { flash: 1000, ram: 20, sections }));
    }

    #[test]
    fn a_wrong_budget_names_its_fault() {
        for (text, fault) in [
            ("flash", "no number in \"flash\""),
            ("flash 1k", "\"1k\" is no number of bytes"),
            ("heap 1", "\"heap\" is neither flash, ram nor a section such as .text"),
            ("flash 1\nflash 1", "\"flash\" is there twice"),
            (".text 1\n.text 1", "\".text\" is there twice"),
            ("flash 1\n.text 1", "no limit for ram"),
        ] {
            assert_eq!(Budget::parse(text), Err(fault.into()));
        }
    }

    #[test]
    fn new_sizes_leave_limits_and_comments_alone() {
        let text = with_sections(TEXT, [(".text", 310), (".data", 8)]);
        assert_eq!(text, "# bytes\nflash 1000 # one\n\nram\t20\n.text 310\n.data 8\n");
        assert_eq!(with_sections(&text, [(".text", 310), (".data", 8)]), text);
    }
}
