//! Proof that the firmware's control tick can reach no panic: the linker collects what nothing that it keeps refers to, and shall keep the tick
//! alone. It looks at the very object that the image is linked from, after all optimisation, and counts every address that is taken as a call.

use crate::{
    firmware::{BOARD, BOARD_G474, PANICKING, TARGET},
    process::{host, output},
    stop::Stop,
};
use object::{Object as _, ObjectSymbol as _, SymbolKind};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

/// The function from which no panic may be reached.
const TICK: &str = "control_tick";

/// Names of functions that panic: the handler in which all end, and those before it, into which it may have gone.
const PANICS: [&str; 3] = ["*rust_begin_unwind*", "*panicking*", "*_fail*"];

/// The function that the feature `deliberate-panic` adds below the tick.
const DELIBERATE: &str = "deliberate_panic";

/// What can be reached from a function.
#[derive(Debug)]
struct Reached {
    /// Functions, itself among them.
    functions: usize,
    /// What these occupy.
    bytes: u64,
    /// The names on a way to the panic handler, from the function on; none without one.
    way: Vec<String>,
}

/// Checks the firmware for each board, which must be built, then one with a panic added.
///
/// # Errors
/// If a panic can be reached in one of the first, or none through the added function in the last.
pub fn run(root: &Path) -> Result<(), Stop> {
    for board in [&BOARD, &BOARD_G474] {
        let reached = reach(root, &board.object(root), TICK)?;
        println!("{}: from {TICK}: {} functions, {} bytes", board.name, reached.functions, reached.bytes);
        if !reached.way.is_empty() {
            return Err(Stop::failed(format!("{TICK} can reach a panic:\n  {}", reached.way.join("\n  "))));
        }
    }
    PANICKING.build(root)?;
    let way = reach(root, &PANICKING.object(root), TICK)?.way;
    if !way.iter().any(|name| name.contains(DELIBERATE)) {
        return Err(Stop::failed(format!("the panic check sees nothing of {DELIBERATE} in the image {}", PANICKING.name)));
    }
    println!("the deliberate panic is seen:\n  {}", way.join("\n  "));
    Ok(())
}

/// Links what the function `start` of an object can reach, and asks the linker why the panic handler is among it.
///
/// # Errors
/// If there is no such function, or it refers to something that is neither in the object nor in the compiler's own library.
fn reach(root: &Path, object: &Path, start: &str) -> Result<Reached, Stop> {
    let fault = |path: &Path, line: String| Stop::failed(format!("{}: {line}", path.display()));
    let (script, linked) = (object.with_extension("x"), object.with_extension("reached"));
    let kept = format!("SECTIONS {{ .text : {{ KEEP(*(.text.*{start}*)) *(.text .text.*) }} }}\n");
    fs::write(&script, kept).map_err(|error| fault(&script, error.to_string()))?;
    let sysroot = PathBuf::from(output(Command::new("rustc").current_dir(root).args(["--print", "sysroot"]))?.trim());
    let libraries = sysroot.join("lib/rustlib");
    let mut linker = Command::new(libraries.join(host(root)?).join("bin/rust-lld"));
    linker.args(["-flavor", "gnu", "--gc-sections", "--demangle", "--entry=0"]);
    linker.args(PANICS.map(|name| format!("--why-live={name}"))).arg("-T");
    linker.arg(&script).arg(object).arg(compiler_builtins(&libraries.join(TARGET).join("lib"))?).arg("-o").arg(&linked);
    let report = output(&mut linker)?;

    let bytes = fs::read(&linked).map_err(|error| fault(&linked, error.to_string()))?;
    let file = object::File::parse(&*bytes).map_err(|error| fault(&linked, error.to_string()))?;
    let functions: Vec<_> = file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0).collect();
    if !functions.iter().any(|function| function.name().is_ok_and(|name| name.contains(start))) {
        return Err(fault(object, format!("no function {start}; without #[inline(never)] it may have gone into its caller")));
    }
    // A line for each step of the first way, from its end on: the file, and in brackets the name.
    let name = |line: &str| line.trim_end().strip_suffix(')')?.split_once(":(").map(|(_, name)| name.to_owned());
    let mut way: Vec<_> = report.lines().take_while(|line| !line.contains("in live section")).filter_map(name).collect();
    way.reverse();
    Ok(Reached { functions: functions.len(), bytes: functions.iter().map(|function| function.size()).sum(), way })
}

/// The library of what the compiler itself calls, in a folder.
fn compiler_builtins(folder: &Path) -> Result<PathBuf, Stop> {
    let files = fs::read_dir(folder).map_err(|error| Stop::usage(format!("{}: {error}", folder.display())))?;
    let mut paths = files.filter_map(|file| Some(file.ok()?.path()));
    let named = |path: &PathBuf| {
        let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        name.starts_with("libcompiler_builtins") && name.ends_with(".rlib")
    };
    paths.find(named).ok_or_else(|| Stop::usage(format!("{}: no compiler_builtins", folder.display())))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{process::run, tools};

    /// A program with each way in which a function can lead to a panic.
    #[test]
    fn every_way_to_a_panic_is_found() {
        let package = Path::new(env!("CARGO_MANIFEST_DIR"));
        tools::need_target(package, TARGET).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let object = folder.path().join("ways.o");
        let mut rustc = Command::new("rustc");
        rustc.current_dir(package).args(["samples/ways_to_a_panic.rs", "--edition", "2024", "--target", TARGET]);
        rustc.args(["-Cpanic=abort", "-Ccodegen-units=1", "-Clto=fat", "-Copt-level=z"]).args([
            "--crate-name=ways",
            "--emit=link,obj",
            "-Clink-arg=--entry=start",
            "--out-dir",
        ]);
        run(rustc.arg(folder.path())).unwrap();
        let way = |start: &str| reach(package, &object, start).unwrap().way;
        assert_eq!(way("calm"), Vec::<String>::new());
        for start in ["two_hops", "sliced", "by_virtual_call", "by_table"] {
            let way = way(start);
            assert!(way.first().is_some_and(|name| name.contains(start)), "{way:?}");
            assert!(way.last().is_some_and(|name| name.contains("core::")), "{way:?}");
        }
        assert!(way("two_hops").iter().any(|name| name.contains("indexed")));
        assert!(reach(package, &object, "tock").is_err());
    }
}
