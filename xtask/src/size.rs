//! The firmware's size, held against the committed budget.

use crate::stop::Stop;
use object::{Object as _, ObjectSection as _, SectionFlags, SectionKind, elf};
use std::{fs, path::Path};

/// The file with the budget, relative to the root of the workspace.
const BUDGET: &str = "tests/emulated-core/size.budget";

/// What the program occupies, in bytes.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Size {
    /// Code and constants, only in flash.
    text: u64,
    /// Variables with a first value: that lies in flash, they in memory.
    data: u64,
    /// Variables that start as zero, only in memory.
    bss: u64,
}

impl Size {
    fn rows(self) -> [(&'static str, u64); 5] {
        [
            ("text", self.text),
            ("data", self.data),
            ("bss", self.bss),
            ("flash", self.text + self.data),
            ("ram", self.data + self.bss),
        ]
    }
}

/// Prints the size of the firmware and compares it with the budget.
///
/// # Errors
/// If a file cannot be read or a size exceeds its limit.
pub fn check(root: &Path, firmware: &Path) -> Result<(), Stop> {
    let bytes = fs::read(firmware).map_err(|error| Stop::failed(format!("{}: {error}", firmware.display())))?;
    let size = measure(&bytes).map_err(|error| Stop::failed(format!("{}: {error}", firmware.display())))?;
    let budget = fs::read_to_string(root.join(BUDGET)).map_err(|error| Stop::failed(format!("{BUDGET}: {error}")))?;
    let limits = parse_budget(&budget).map_err(|line| Stop::failed(format!("{BUDGET}: {line}")))?;
    let mut excess = Vec::new();
    println!("{:<6} {:>8} {:>8}", "", "bytes", "budget");
    for (name, used) in size.rows() {
        let limit = limits.iter().find(|(limited, _)| limited == name).map(|(_, limit)| *limit);
        println!("{name:<6} {used:>8} {:>8}", limit.map_or_else(|| "-".into(), |limit| limit.to_string()));
        if let Some(limit) = limit.filter(|limit| used > *limit) {
            excess.push(format!("{name} takes {used} bytes of {limit}"));
        }
    }
    if excess.is_empty() {
        Ok(())
    } else {
        Err(Stop::failed(format!("the firmware is too big: {}; see {BUDGET}", excess.join(", "))))
    }
}

/// Adds up the sections that reach the board.
fn measure(bytes: &[u8]) -> object::Result<Size> {
    let mut size = Size::default();
    for section in object::File::parse(bytes)?.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else {
            continue;
        };
        let flag = |flag: u32| sh_flags & u64::from(flag) != 0;
        if !flag(elf::SHF_ALLOC) {
            continue;
        }
        let part = match section.kind() {
            SectionKind::UninitializedData => &mut size.bss,
            _ if flag(elf::SHF_WRITE) => &mut size.data,
            _ => &mut size.text,
        };
        *part += section.size();
    }
    Ok(size)
}

/// Reads lines of a name and a number of bytes; `#` starts a comment.
fn parse_budget(text: &str) -> Result<Vec<(String, u64)>, String> {
    let names = Size::default().rows().map(|(name, _)| name);
    text.lines()
        .map(|line| line.split('#').next().unwrap_or_default().trim())
        .filter(|line| !line.is_empty())
        .map(|line| {
            let (name, bytes) = line.split_once(char::is_whitespace).ok_or_else(|| format!("no number in \"{line}\""))?;
            if !names.contains(&name) {
                return Err(format!("\"{name}\" is none of {}", names.join(", ")));
            }
            let bytes = bytes.trim().parse().map_err(|_| format!("\"{}\" is no number of bytes", bytes.trim()))?;
            Ok((name.to_owned(), bytes))
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_budget_has_names_numbers_and_comments() {
        let budget = parse_budget("# bytes\nflash 1000 # one\n\nram\t20\n");
        assert_eq!(budget, Ok(vec![("flash".into(), 1000), ("ram".into(), 20)]));
    }

    #[test]
    fn a_wrong_budget_names_its_fault() {
        assert_eq!(parse_budget("flash"), Err("no number in \"flash\"".into()));
        assert_eq!(parse_budget("flash 1k"), Err("\"1k\" is no number of bytes".into()));
        assert_eq!(parse_budget("heap 1"), Err("\"heap\" is none of text, data, bss, flash, ram".into()));
    }

    #[test]
    fn what_is_no_elf_is_an_error() {
        assert!(measure(b"not an ELF file").is_err());
    }
}
