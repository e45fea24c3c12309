//! The graph of a linked program: its functions and data, and what they refer to.
//!
//! Branches are read from the instructions, as the processor will. Addresses that are taken are found by the relocations that
//! `--emit-relocs` leaves in the file; the linker has already applied them, so that a word in place holds its final value.
//!
//! Data without a name, such as a table of constants, has lost its size: it lasts up to what is referred to next. What that cuts
//! off can only be missed behind a call by an unknown address, and such a call is reported.

use crate::{
    graph::Node,
    thumb::{self, Flow},
};
use object::{
    Object as _, ObjectSection as _, ObjectSymbol as _, RelocationFlags, RelocationTarget, SectionFlags, SymbolKind, elf,
};
use std::ops::Range;

/// Reads the graph of a program.
///
/// # Errors
/// If it is no ELF file that can be read, or has no relocations.
pub fn read(bytes: &[u8]) -> Result<Vec<Node>, String> {
    let file = object::File::parse(bytes).map_err(|error| error.to_string())?;
    let sections = sections(&file)?;
    if sections.iter().all(|section| !section.is_code || section.references.is_empty()) {
        return Err("no relocations in the code; it must be linked with --emit-relocs".into());
    }
    let mut nodes = Vec::new();
    let mut spans: Vec<Vec<Span>> = Vec::new();
    for section in &sections {
        let targets = sections.iter().flat_map(|from| &from.references).filter_map(|reference| reference.target);
        let own = section.spans(&file, targets, nodes.len());
        nodes.extend(own.iter().map(Span::node));
        spans.push(own);
    }
    let find = |address: u64| {
        let index = sections.iter().position(|section| section.addresses.contains(&address))?;
        Some(containing(&spans[index], address).ok_or_else(|| format!("{address:#010x} belongs to no function")))
    };
    for (section, spans) in sections.iter().zip(&spans) {
        for span in spans {
            let node = &mut nodes[span.node];
            for Reference { from, target } in section.references.iter().filter(|it| span.addresses.contains(&it.from)) {
                match target.map(find) {
                    // Data that refers to itself is no recursion.
                    Some(Some(Ok(to))) if to != span.node || span.is_function => connect(node, to),
                    // What lies outside every section, such as a register, is no code.
                    Some(Some(Ok(_)) | None) => {}
                    Some(Some(Err(line))) => node.unknown.push(format!("an address at {from:#010x}: {line}")),
                    None => node.unknown.push(format!("an unknown relocation at {from:#010x}")),
                }
            }
            // The linker's own detours jump by a register to what the relocation of their caller names.
            if !span.is_function || span.names.iter().any(|name| name.starts_with("__Thumb")) {
                continue;
            }
            let code = section.instructions(&span.addresses);
            for (from, flow) in code.into_iter().flat_map(|run| thumb::flows(section.content(&run), run.start)) {
                match flow {
                    Flow::Call(target) | Flow::Jump(target) => match find(target) {
                        // Branches are loops and choices inside a function, unless they call it.
                        Some(Ok(to)) if to == span.node && flow == Flow::Jump(target) => {}
                        Some(Ok(to)) => connect(node, to),
                        Some(Err(line)) => node.unknown.push(format!("a branch at {from:#010x}: {line}")),
                        None => node.unknown.push(format!("a branch at {from:#010x} out of the program")),
                    },
                    Flow::Unknown(what) => node.unknown.push(format!("{what} at {from:#010x}")),
                }
            }
        }
    }
    Ok(nodes)
}

fn connect(node: &mut Node, to: usize) {
    if !node.edges.contains(&to) {
        node.edges.push(to);
    }
}

/// A section that reaches the board.
struct Section<'a> {
    index: object::SectionIndex,
    addresses: Range<u64>,
    bytes: &'a [u8],
    is_code: bool,
    references: Vec<Reference>,
    /// Where instructions (true) and data (false) begin, in order.
    mapping: Vec<(u64, bool)>,
}

/// An address that is held somewhere; none if it cannot be told which.
struct Reference {
    from: u64,
    target: Option<u64>,
}

/// The addresses of a function or of data.
struct Span {
    names: Vec<String>,
    addresses: Range<u64>,
    is_function: bool,
    node: usize,
}

impl Span {
    fn node(&self) -> Node {
        Node {
            names: self.names.clone(),
            bytes: self.addresses.end - self.addresses.start,
            is_function: self.is_function,
            ..Node::default()
        }
    }
}

fn sections<'a>(file: &object::File<'a>) -> Result<Vec<Section<'a>>, String> {
    let mut sections = Vec::new();
    for section in file.sections() {
        let SectionFlags::Elf { sh_flags } = section.flags() else { continue };
        if sh_flags & u64::from(elf::SHF_ALLOC) == 0 || section.size() == 0 {
            continue;
        }
        let bytes = section.data().map_err(|error| error.to_string())?;
        let addresses = section.address()..section.address() + section.size();
        let mut references = Vec::new();
        for (from, relocation) in section.relocations() {
            let offset = usize::try_from(from.wrapping_sub(addresses.start)).unwrap_or(usize::MAX);
            let word =
                offset.checked_add(4).and_then(|end| bytes.get(offset..end)).map(|word| [word[0], word[1], word[2], word[3]]);
            references.extend(reference(file, from, &relocation, word.map(u32::from_le_bytes)));
        }
        let mut mapping: Vec<_> = file
            .symbols()
            .filter(|symbol| symbol.section_index() == Some(section.index()))
            .filter_map(|symbol| {
                // The mark may have a number behind a dot.
                let mark = symbol.name().ok()?.split('.').next()?;
                matches!(mark, "$t" | "$d" | "$a").then_some((symbol.address(), mark != "$d"))
            })
            .collect();
        mapping.sort_unstable();
        let is_code = sh_flags & u64::from(elf::SHF_EXECINSTR) != 0;
        sections.push(Section { index: section.index(), addresses, bytes, is_code, references, mapping });
    }
    Ok(sections)
}

/// What a relocation refers to; nothing if it is none of an address.
fn reference(file: &object::File<'_>, from: u64, relocation: &object::Relocation, word: Option<u32>) -> Option<Reference> {
    let RelocationFlags::Elf { r_type } = relocation.flags() else { return Some(Reference { from, target: None }) };
    if matches!(r_type, elf::R_ARM_NONE | elf::R_ARM_V4BX) {
        return None;
    }
    let RelocationTarget::Symbol(index) = relocation.target() else { return Some(Reference { from, target: None }) };
    let named = file.symbol_by_index(index).ok().filter(|symbol| !symbol.is_undefined());
    let target = match (named, r_type) {
        (None, _) => None,
        (Some(symbol), _) if symbol.kind() != SymbolKind::Section => Some(symbol.address()),
        // The name of a section says too little, but the place tells the rest.
        (_, elf::R_ARM_ABS32 | elf::R_ARM_TARGET1) => word.map(u64::from),
        (_, elf::R_ARM_REL32) => word.map(|word| (from + u64::from(word)) & 0xffff_ffff),
        // The branch itself is read.
        (_, elf::R_ARM_THM_PC22 | elf::R_ARM_THM_JUMP24 | elf::R_ARM_THM_JUMP19) => return None,
        _ => None,
    };
    Some(Reference { from, target })
}

impl Section<'_> {
    /// The functions and data of the section in order. Data without a name lasts from where it is referred to up to what
    /// follows.
    fn spans(&self, file: &object::File<'_>, targets: impl Iterator<Item = u64>, first_node: usize) -> Vec<Span> {
        let mut spans: Vec<Span> = Vec::new();
        for symbol in file.symbols().filter(|symbol| symbol.section_index() == Some(self.index)) {
            let is_function = symbol.kind() == SymbolKind::Text;
            if !is_function && (symbol.kind() != SymbolKind::Data || symbol.size() == 0) {
                continue;
            }
            // The lowest bit of a function's address only tells that it is Thumb code.
            let start = if is_function { symbol.address() & !1 } else { symbol.address() };
            let names = vec![format!("{:#}", rustc_demangle::demangle(symbol.name().unwrap_or("?")))];
            spans.push(Span { names, addresses: start..start + symbol.size(), is_function, node: 0 });
        }
        if !self.is_code {
            let unnamed = targets
                .filter(|target| self.addresses.contains(target) && !spans.iter().any(|span| span.addresses.contains(target)));
            let unnamed: Vec<u64> = unnamed.collect();
            spans.extend(unnamed.into_iter().map(|start| Span {
                names: Vec::new(),
                addresses: start..start,
                is_function: false,
                node: 0,
            }));
        }
        spans.sort_by_key(|span| (span.addresses.start, std::cmp::Reverse(span.addresses.end)));
        let mut merged: Vec<Span> = Vec::new();
        for span in spans {
            match merged.last_mut() {
                Some(last) if span.addresses.start < last.addresses.end || span.addresses.start == last.addresses.start => {
                    last.addresses.end = last.addresses.end.max(span.addresses.end);
                    last.is_function |= span.is_function;
                    last.names.extend(span.names);
                }
                _ => merged.push(span),
            }
        }
        let mut end = self.addresses.end;
        for span in merged.iter_mut().rev() {
            if span.addresses.is_empty() {
                span.addresses.end = end;
            }
            end = span.addresses.start;
        }
        for (index, span) in merged.iter_mut().enumerate() {
            span.node = first_node + index;
        }
        merged
    }

    /// The runs of instructions between some addresses; the rest are constants.
    fn instructions(&self, addresses: &Range<u64>) -> Vec<Range<u64>> {
        let before = self.mapping.iter().rev().find(|(at, _)| *at <= addresses.start).is_none_or(|(_, code)| *code);
        let inside = self.mapping.iter().filter(|(at, _)| *at > addresses.start && *at < addresses.end);
        let mut runs = Vec::new();
        let mut open = before.then_some(addresses.start);
        for (at, code) in inside.copied().chain([(addresses.end, false)]) {
            match (open, code) {
                (None, true) => open = Some(at),
                (Some(start), false) => {
                    runs.push(start..at);
                    open = None;
                }
                _ => {}
            }
        }
        runs
    }

    fn content(&self, addresses: &Range<u64>) -> &[u8] {
        let place = |address: u64| usize::try_from(address.saturating_sub(self.addresses.start)).unwrap_or(usize::MAX);
        self.bytes.get(place(addresses.start)..place(addresses.end)).unwrap_or_default()
    }
}

/// The node whose span contains an address.
fn containing(spans: &[Span], address: u64) -> Option<usize> {
    let after = spans.partition_point(|span| span.addresses.start <= address);
    spans[..after].last().filter(|span| span.addresses.contains(&address)).map(|span| span.node)
}
