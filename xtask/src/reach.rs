//! Proof on the linked program that no panic can be reached from a function.
//!
//! It holds for what the program can call: a call by an address that only the running program knows has no place in it and
//! fails unless the function with the call is allowed by name.

use crate::{
    graph::{self, Node},
    program,
    stop::Stop,
};
use std::{fs, path::Path};

/// Parts of the names of functions that panic.
const PANICS: &[&str] = &[
    "core::panicking",
    "panic_fmt",
    "panic_bounds_check",
    "panic_const",
    "rust_begin_unwind",
    "__rust_start_panic",
    "core::option::unwrap_failed",
    "core::option::expect_failed",
    "core::result::unwrap_failed",
    "slice_index_fail",
    "slice_start_index",
    "slice_end_index",
    "slice_error_fail",
    "len_mismatch_fail",
    "core::cell::panic_already",
    "handle_alloc_error",
];

/// What was found from the roots.
#[derive(Debug)]
pub struct Found {
    /// Functions that can be reached, the roots among them.
    pub functions: usize,
    /// What these occupy.
    pub bytes: u64,
    /// Functions on the longest way, or one that can come back to itself.
    pub deepest: Result<usize, String>,
    /// The shortest way to each panic function that is met first, by names from the root on.
    pub panics: Vec<Vec<String>>,
    /// Where and how a function that can be reached leaves for the unknown, and the way to it.
    pub unknown: Vec<(String, Vec<String>)>,
}

/// Requires that nothing reached from the roots panics, and prints what was reached. Roots and functions that are allowed to call
/// by an unknown address are named by the end of their path.
///
/// # Errors
/// If a root is missing, a panic can be reached, there is a way that cannot be followed, or something is allowed for nothing.
pub fn check(elf: &Path, roots: &[&str], allowed_indirect: &[&str]) -> Result<(), Stop> {
    let found = examine(elf, roots, allowed_indirect)?;
    for (index, way) in found.panics.iter().enumerate() {
        println!("way {} to a panic:\n  {}", index + 1, way.join("\n  "));
    }
    for (what, way) in &found.unknown {
        println!("cannot be followed: {what}, in\n  {}", way.join("\n  "));
    }
    println!("from {}: {} functions, {} bytes", roots.join(", "), found.functions, found.bytes);
    let roots = roots.join(", ");
    if let Some(goal) = found.panics.first().and_then(|way| way.last()) {
        return Err(Stop::failed(format!("{} panic functions can be reached from {roots}, such as {goal}", found.panics.len())));
    }
    if !found.unknown.is_empty() {
        return Err(Stop::failed(format!("{} ways from {roots} cannot be followed", found.unknown.len())));
    }
    match found.deepest {
        Ok(deepest) => println!("deepest chain: {deepest} functions; no panic among them"),
        Err(name) => println!("no deepest chain, {name} can come back to itself; no panic among them"),
    }
    Ok(())
}

/// Finds what can be reached from the roots.
///
/// # Errors
/// If the file cannot be read, a root is missing or something is allowed for nothing.
pub fn examine(elf: &Path, roots: &[&str], allowed_indirect: &[&str]) -> Result<Found, Stop> {
    let fault = |line: String| Stop::failed(format!("{}: {line}", elf.display()));
    let bytes = fs::read(elf).map_err(|error| fault(error.to_string()))?;
    let nodes = program::read(&bytes).map_err(fault)?;
    search(&nodes, roots, allowed_indirect).map_err(fault)
}

fn search(nodes: &[Node], roots: &[&str], allowed_indirect: &[&str]) -> Result<Found, String> {
    let mut starts = Vec::new();
    for root in roots {
        let before = starts.len();
        starts.extend((0..nodes.len()).filter(|node| nodes[*node].is_function && nodes[*node].is_named(root)));
        if starts.len() == before {
            return Err(format!("no function {root}; without #[inline(never)] it may have gone into its caller"));
        }
    }
    let reached = graph::reach(nodes, &starts, panics);
    let names = |node: usize| reached.path(node).into_iter().map(|node| shown(&nodes[node])).collect::<Vec<_>>();
    let within: Vec<usize> = reached.order.iter().copied().filter(|node| !panics(&nodes[*node])).collect();
    let functions = || within.iter().filter(|node| nodes[**node].is_function);
    let mut unknown = Vec::new();
    let mut idle = allowed_indirect.to_vec();
    for node in &within {
        let allowed = allowed_indirect.iter().find(|name| nodes[*node].is_named(name));
        match allowed {
            Some(name) if !nodes[*node].unknown.is_empty() => idle.retain(|idle| idle != name),
            _ => unknown.extend(nodes[*node].unknown.iter().map(|what| (what.clone(), names(*node)))),
        }
    }
    if let Some(name) = idle.first() {
        return Err(format!("{name} is allowed calls that cannot be followed, but makes none"));
    }
    Ok(Found {
        functions: functions().count(),
        bytes: functions().map(|node| nodes[*node].bytes).sum(),
        deepest: graph::deepest(nodes, &starts).map_err(|node| nodes[node].name().to_owned()),
        panics: reached.order.iter().filter(|node| panics(&nodes[**node])).map(|node| names(*node)).collect(),
        unknown,
    })
}

fn panics(node: &Node) -> bool {
    panic_name(node).is_some()
}

/// That of its names which makes it a panic function.
fn panic_name(node: &Node) -> Option<&str> {
    let mut names = node.names.iter().filter(|_| node.is_function);
    names.find(|name| PANICS.iter().any(|part| name.contains(part))).map(String::as_str)
}

/// The name to show.
fn shown(node: &Node) -> String {
    panic_name(node).unwrap_or_else(|| node.name()).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{firmware, process, tools};
    use std::{path::PathBuf, process::Command};

    fn node(name: &str, edges: &[usize]) -> Node {
        Node { names: vec![name.into()], bytes: 10, is_function: true, edges: edges.to_vec(), unknown: Vec::new() }
    }

    fn guessing(name: &str) -> Node {
        Node { unknown: vec!["blx at 0x08000000".into()], ..node(name, &[]) }
    }

    #[test]
    fn a_panic_two_hops_away_is_named_with_the_way_to_it() {
        let nodes = [
            node("a::tick", &[1]),
            node("a::filter", &[2]),
            node("core::panicking::panic_bounds_check", &[3]),
            node("core::fmt::write", &[]),
        ];
        let found = search(&nodes, &["tick"], &[]).unwrap();
        assert_eq!(found.panics, [["a::tick", "a::filter", "core::panicking::panic_bounds_check"]]);
        assert_eq!((found.functions, found.bytes), (2, 20));
    }

    #[test]
    fn a_panic_that_others_reach_is_no_fault() {
        let nodes = [node("tick", &[1]), node("filter", &[0]), node("main", &[0, 3]), node("rust_begin_unwind", &[])];
        let found = search(&nodes, &["tick"], &[]).unwrap();
        assert!(found.panics.is_empty() && found.unknown.is_empty());
        assert_eq!(found.deepest, Err("tick".into()));
    }

    #[test]
    fn a_panic_behind_a_table_of_pointers_is_found() {
        let table = Node { edges: vec![2], ..Node::default() };
        let nodes = [node("tick", &[1]), table, node("method", &[3]), node("core::option::unwrap_failed", &[])];
        let found = search(&nodes, &["tick"], &[]).unwrap();
        assert_eq!(found.panics, [["tick", "data without a name", "method", "core::option::unwrap_failed"]]);
    }

    #[test]
    fn a_panic_under_another_name_is_found() {
        let mut merged = node("a::stop", &[]);
        merged.names.push("core::panicking::panic".into());
        let found = search(&[node("tick", &[1]), merged], &["tick"], &[]).unwrap();
        assert_eq!(found.panics, [["tick", "core::panicking::panic"]]);
    }

    #[test]
    fn a_call_by_an_unknown_address_needs_leave() {
        let nodes = [node("tick", &[1]), guessing("a::dispatch"), guessing("elsewhere")];
        let found = search(&nodes, &["tick"], &[]).unwrap();
        assert_eq!(found.unknown, [("blx at 0x08000000".into(), vec!["tick".into(), "a::dispatch".into()])]);
        assert!(search(&nodes, &["tick"], &["dispatch"]).unwrap().unknown.is_empty());
        assert!(search(&nodes, &["tick"], &["dispatch", "elsewhere"]).is_err());
    }

    /// Links the sample for the board and gives its file.
    fn sample(level: &str) -> PathBuf {
        let package = Path::new(env!("CARGO_MANIFEST_DIR"));
        tools::need_target(package, firmware::TARGET).unwrap();
        let elf = std::env::temp_dir().join(format!("sprag-ways-to-a-panic-{level}-{}.elf", std::process::id()));
        let mut rustc = Command::new("rustc");
        rustc.current_dir(package).args(["samples/ways_to_a_panic.rs", "--edition", "2024", "--target", firmware::TARGET]);
        rustc.args(["-Cpanic=abort", "-Ccodegen-units=1", "-Clto=fat", &format!("-Copt-level={level}")]);
        let script = ["--emit-relocs", "--entry=start", "-Ttext=0x08000000", "--section-start=.data.far=0x20000000"];
        rustc.args(script.map(|argument| format!("-Clink-arg={argument}"))).arg("-o").arg(&elf);
        process::run(&mut rustc).unwrap();
        elf
    }

    #[test]
    fn every_way_to_a_panic_is_found_in_a_linked_program() {
        // They refer to data in two ways: by words between functions, and by halves in instructions.
        for level in ["z", "3"] {
            let elf = sample(level);
            let ways = |root: &str| examine(&elf, &[root], &[]).map(|found| (found.panics, found.unknown.len())).unwrap();
            assert_eq!(ways("calm"), (vec![], 0));
            let names = ["ways_to_a_panic::two_hops", "ways_to_a_panic::indexed", "core::panicking::panic_bounds_check"];
            assert_eq!(ways("two_hops"), (vec![names.map(str::to_owned).to_vec()], 0));
            for (root, goal, unknown) in [
                ("sliced", "core::slice::index::slice_index_fail", 0),
                ("by_virtual_call", "core::panicking::panic_bounds_check", 1),
                ("by_table", "core::panicking::panic_bounds_check", 1),
                ("by_detour", "core::panicking::panic_bounds_check", 0),
            ] {
                let (panics, blind) = ways(root);
                assert_eq!((panics.len(), panics[0].last().unwrap().as_str(), blind), (1, goal, unknown), "{root} {level}");
            }
            let again = examine(&elf, &["again"], &[]).unwrap();
            assert_eq!(again.deepest, Err("ways_to_a_panic::again".into()), "{level}");
            fs::remove_file(elf).unwrap();
        }
    }

    #[test]
    fn a_missing_root_is_an_error() {
        assert!(search(&[node("tick", &[])], &["tick", "tock"], &[]).is_err());
    }
}
