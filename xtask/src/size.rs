//! An image's size by section, held against its budget.

use crate::{
    budget::{Budget, with_sections},
    stop::Stop,
};
use object::{Object as _, ObjectSection as _, SectionFlags, SectionKind, elf};
use std::{fs, path::Path};

/// A section may differ from its accepted size by this part of it,
const TOLERATED_PART: u64 = 50;

/// or by so many bytes if these are more.
const TOLERATED_BYTES: u64 = 256;

/// The lines that say how to accept a size.
const ACCEPT: &str = "run `cargo xtask firmware --overwrite` to accept this";

/// A section that reaches the board.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Section {
    name: String,
    bytes: u64,
    /// Whether it lies in flash, be it only to be copied from there.
    in_flash: bool,
    /// Whether it lies in memory.
    in_ram: bool,
}

/// Prints the sections of an image and compares them with its budget; or accepts their sizes, but never more than the limits.
///
/// # Errors
/// If a file cannot be read or written, a limit is exceeded, or a section's size is not the accepted one.
pub fn check(elf: &Path, budget: &Path, overwrite: bool) -> Result<(), Stop> {
    let fault = |path: &Path, error: &dyn std::fmt::Display| Stop::failed(format!("{}: {error}", path.display()));
    let bytes = fs::read(elf).map_err(|error| fault(elf, &error))?;
    let sections = measure(&bytes).map_err(|error| fault(elf, &error))?;
    let mut text = fs::read_to_string(budget).map_err(|error| fault(budget, &error))?;
    if overwrite {
        text = with_sections(&text, sections.iter().map(|section| (section.name.as_str(), section.bytes)));
        fs::write(budget, &text).map_err(|error| fault(budget, &error))?;
    }
    let limits = Budget::parse(&text).map_err(|error| fault(budget, &error))?;
    let excess = compare(&sections, &limits);
    if excess.is_empty() { Ok(()) } else { Err(fault(budget, &excess.join("; "))) }
}

/// Prints the table and gives what exceeds the budget, for people.
fn compare(sections: &[Section], budget: &Budget) -> Vec<String> {
    let mut excess = Vec::new();
    println!("{:<16} {:>8} {:>8} {:>8}", "section", "bytes", "accepted", "change");
    for (name, now, accepted) in pairs(sections, &budget.sections) {
        let change = now.cast_signed() - accepted.cast_signed();
        println!("{name:<16} {now:>8} {accepted:>8} {change:>+8}");
        if change.unsigned_abs() > (accepted / TOLERATED_PART).max(TOLERATED_BYTES) {
            excess.push(format!("{name} takes {now} bytes instead of {accepted}"));
        }
    }
    if !excess.is_empty() {
        excess.push(ACCEPT.to_owned());
    }
    println!("{:<16} {:>8} {:>8} {:>8}", "", "bytes", "limit", "left");
    let in_flash = |section: &&Section| section.in_flash;
    let in_ram = |section: &&Section| section.in_ram;
    let flash: u64 = sections.iter().filter(in_flash).map(|section| section.bytes).sum();
    let ram: u64 = sections.iter().filter(in_ram).map(|section| section.bytes).sum();
    for (name, used, limit) in [("flash", flash, budget.flash), ("ram", ram, budget.ram)] {
        println!("{name:<16} {used:>8} {limit:>8} {:>8}", limit.cast_signed() - used.cast_signed());
        if used > limit {
            excess.push(format!("{used} bytes of {name} exceed the limit of {limit}"));
        }
    }
    excess
}

/// The sections of the image and of its budget with both sizes; one that is missing takes nothing.
fn pairs<'a>(sections: &'a [Section], accepted: &'a [(String, u64)]) -> Vec<(&'a str, u64, u64)> {
    let size_of = |name: &str| accepted.iter().find(|(known, _)| known == name).map_or(0, |(_, bytes)| *bytes);
    let here = sections.iter().map(|section| (section.name.as_str(), section.bytes, size_of(&section.name)));
    let gone = accepted.iter().filter(|(name, _)| sections.iter().all(|section| section.name != *name));
    here.chain(gone.map(|(name, bytes)| (name.as_str(), 0, *bytes))).collect()
}

/// The sections that reach the board.
fn measure(bytes: &[u8]) -> object::Result<Vec<Section>> {
    let mut sections = Vec::new();
    for section in object::File::parse(bytes)?.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else {
            continue;
        };
        let flag = |flag: u32| sh_flags & u64::from(flag) != 0;
        if !flag(elf::SHF_ALLOC) || section.size() == 0 {
            continue;
        }
        let in_flash = section.kind() != SectionKind::UninitializedData;
        let in_ram = !in_flash || flag(elf::SHF_WRITE);
        sections.push(Section { name: section.name()?.to_owned(), bytes: section.size(), in_flash, in_ram });
    }
    Ok(sections)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(name: &str, bytes: u64, in_flash: bool, in_ram: bool) -> Section {
        Section { name: name.into(), bytes, in_flash, in_ram }
    }

    fn excess(text: u64, budget: &str) -> Vec<String> {
        let sections =
            [section(".text", text, true, false), section(".data", 300, true, true), section(".bss", 400, false, true)];
        compare(&sections, &Budget::parse(budget).unwrap())
    }

    #[test]
    fn data_counts_twice_and_the_rest_once() {
        assert!(excess(50_000, "flash 50300\nram 700\n.text 50000\n.data 300\n.bss 400").is_empty());
        let tight = excess(50_000, "flash 50299\nram 699\n.text 50000\n.data 300\n.bss 400");
        assert_eq!(tight, ["50300 bytes of flash exceed the limit of 50299", "700 bytes of ram exceed the limit of 699"]);
    }

    #[test]
    fn a_section_may_change_by_the_larger_tolerance_up_and_down() {
        let budget = "flash 100000\nram 1000\n.text 50000\n.data 300\n.bss 400";
        for (text, well) in [(51_000, true), (51_001, false), (49_000, true), (48_999, false)] {
            assert_eq!(excess(text, budget).is_empty(), well, "{text}");
        }
        assert!(excess(50_000, &budget.replace(".bss 400", ".bss 144")).is_empty());
        assert!(!excess(50_000, &budget.replace(".bss 400", ".bss 143")).is_empty());
    }

    #[test]
    fn a_section_that_came_or_went_is_a_change() {
        let come = excess(50_000, "flash 100000\nram 1000\n.text 50000\n.data 300");
        assert_eq!(come, [".bss takes 400 bytes instead of 0", ACCEPT]);
        let gone = excess(50_000, "flash 100000\nram 1000\n.text 50000\n.data 300\n.bss 400\n.uninit 300");
        assert_eq!(gone, [".uninit takes 0 bytes instead of 300", ACCEPT]);
    }

    #[test]
    fn what_is_no_elf_is_an_error() {
        assert!(measure(b"not an ELF file").is_err());
    }
}
