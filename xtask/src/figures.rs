//! Figures of the code itself: lines, test executables, event loops and their size.

use crate::{
    process::{cargo, output, target_folder},
    stop::Stop,
};
use object::{Object as _, ObjectSymbol as _, SymbolKind};
use serde_json::Value;
use std::{
    collections::{BTreeMap, BTreeSet},
    fs, io,
    path::Path,
    str::Lines,
};

/// Folders of sources whose lines are counted.
const SOURCES: [&str; 2] = ["shared/src", "sim-host/ensemble/src"];

/// Programs below the target folder, and what builds them.
const PROGRAMS: [(&str, &str); 2] = [("release/sprag", "cargo build --release"), ("images/core.elf", "cargo xtask firmware")];

/// Names of functions that are event loops.
const LOOPS: [&str; 2] = ["advance", "follow"];

/// Rooms of the core in which no motion is computed.
const CONTROLLER_WING: [&str; 4] = ["control", "device", "link", "settings"];

/// Prints the figures of the sources and of the programs that are built; or those of one other program.
///
/// # Errors
/// If a source or a program cannot be read.
pub fn run(root: &Path, program: Option<&str>) -> Result<(), Stop> {
    if let Some(program) = program {
        return show(program, Path::new(program));
    }
    println!("lines of code, without tests, comments and blank lines");
    let mut total = 0;
    for folder in SOURCES {
        let count = lines_below(&root.join(folder)).map_err(|error| Stop::failed(format!("{folder}: {error}")))?;
        println!("{count:>10}  {folder}");
        total += count;
    }
    let about = output(&mut cargo(root, &["metadata", "--no-deps", "--format-version", "1"]))?;
    let about: Value = serde_json::from_str(&about).map_err(|error| Stop::failed(error.to_string()))?;
    let packages = about["packages"].as_array().into_iter().flatten();
    let tests =
        packages.filter_map(|package| package["targets"].as_array()).flatten().filter(|target| target["test"] == true).count();
    println!("{total:>10}  total\n{tests:>10}  test executables");
    for (name, built_by) in PROGRAMS {
        let path = target_folder(root).join(name);
        if path.is_file() { show(name, &path)? } else { println!("{name} is not built: `{built_by}`") }
    }
    Ok(())
}

/// Lines of code of all sources below `folder`, without folders and files of tests.
fn lines_below(folder: &Path) -> io::Result<usize> {
    let mut count = 0;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() && !path.ends_with("tests") {
            count += lines_below(&path)?;
        } else if path.extension().is_some_and(|extension| extension == "rs") && !path.ends_with("tests.rs") {
            count += lines(&fs::read_to_string(&path)?);
        }
    }
    Ok(count)
}

/// Lines of `text` that are neither blank nor comments nor in an item for tests.
fn lines(text: &str) -> usize {
    let (mut count, mut lines) = (0, text.lines());
    while let Some(line) = lines.next() {
        let code = line.trim_start();
        if code == "#[cfg(test)]" {
            skip_item(&line[..line.len() - code.len()], &mut lines);
        } else if !code.is_empty() && !code.starts_with("//") {
            count += 1;
        }
    }
    count
}

/// Goes past the item that follows, which is indented by `indent`.
fn skip_item(indent: &str, lines: &mut Lines<'_>) {
    let closing = format!("{indent}}}");
    if lines.find(|line| line.ends_with([';', '{', '}'])).is_some_and(|head| head.ends_with('{')) {
        lines.find(|line| line.trim_end_matches(';') == closing);
    }
}

/// Prints the event loops of a program, and the size of the core's code in it.
fn show(name: &str, path: &Path) -> Result<(), Stop> {
    let fault = |error: &dyn std::fmt::Display| Stop::failed(format!("{}: {error}", path.display()));
    let bytes = fs::read(path).map_err(|error| fault(&error))?;
    let (mut loops, mut rooms) = (BTreeMap::<String, u32>::new(), BTreeMap::<String, u64>::new());
    for (function, size) in functions(&bytes).map_err(|error| fault(&error))? {
        let room = function.split("::").next().unwrap_or_default();
        *rooms.entry(room.to_owned()).or_default() += size;
        if function.rsplit("::").next().is_some_and(|last| LOOPS.contains(&last)) {
            *loops.entry(function).or_default() += 1;
        }
    }
    println!("event loops in {name}");
    loops.iter().for_each(|(function, count)| println!("{count:>10}  {function}"));
    println!("{:>10}  total\nbytes of code in {name}, by room of the core", loops.values().sum::<u32>());
    rooms.iter().for_each(|(room, bytes)| println!("{bytes:>10}  {room}"));
    let motion = rooms.iter().filter(|(room, _)| !CONTROLLER_WING.contains(&room.as_str()));
    println!("{:>10}  total without {}", motion.map(|(_, bytes)| bytes).sum::<u64>(), CONTROLLER_WING.join(", "));
    Ok(())
}

/// The functions of the core in a program: path below the core's root, and size in bytes.
fn functions(bytes: &[u8]) -> object::Result<Vec<(String, u64)>> {
    let file = object::File::parse(bytes)?;
    let mut seen = BTreeSet::new();
    // Two names of one address are one function.
    let texts = file.symbols().filter(|it| it.kind() == SymbolKind::Text && it.size() > 0 && seen.insert(it.address()));
    let path = |name: &str| path_in_core(&format!("{:#}", rustc_demangle::demangle(name)));
    Ok(texts.filter_map(|symbol| Some((path(symbol.name().ok()?)?, symbol.size()))).collect())
}

/// The path of a function of the core below its root, without type parameters; none for any other function.
fn path_in_core(name: &str) -> Option<String> {
    let rest = name.trim_start_matches(['<', '&', '(']).strip_prefix("sprag_shared::")?;
    let owner = rest.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':')).next()?.trim_end_matches(':');
    let (mut depth, mut plain) = (0, String::new());
    for c in name.replace("->", "").chars() {
        depth += i32::from(c == '<');
        plain.extend((depth == 0).then_some(c));
        depth -= i32::from(c == '>');
    }
    let function = plain.trim_end_matches(':').rsplit("::").next()?;
    Some(if owner.ends_with(function) { owner.to_owned() } else { format!("{owner}::{function}") })
}

#[cfg(test)]
mod tests {
    #[test]
    fn neither_comments_nor_tests_are_lines_of_code() {
        let text = "//! a\n\nuse a;\n  // b\n#[cfg(test)]\nuse b::{\n  c,\n};\n#[cfg(test)]\nmod tests;\nd(); // e\n";
        assert_eq!(super::lines(&[text, "#[cfg(test)]\nmod f {\n    fn g() {\n    }\n}\nh();"].concat()), 3);
    }

    #[test]
    fn both_forms_of_symbols_give_one_path() {
        for name in ["sprag_shared::B<S>::follow", "<sprag_shared::B<S>>::follow::<C>", "<sprag_shared::B as E>::follow"] {
            assert_eq!(super::path_in_core(name).as_deref(), Some("B::follow"));
        }
        assert_eq!(super::path_in_core("<sprag_host::A as sprag_shared::B>::follow"), None);
    }
}
