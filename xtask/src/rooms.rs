//! The rooms of `shared/src`: which may import which. A room imports only rooms on lower floors, so no circle can arise, and the two wings
//! never import each other. Unit tests are free to import what they like.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug, PartialEq)]
enum Wing {
    Foundation,
    Motion,
    Controller,
}

use Wing::{Controller, Foundation, Motion};

/// Rooms from the ground up: floor, wing, path. A room is all that its path begins, less the rooms inside it.
const ROOMS: [(u8, Wing, &str); 24] = [
    (0, Foundation, "math"),
    (1, Foundation, "equation"),
    (2, Foundation, "structure"),
    (3, Motion, "ground"),
    (3, Motion, "drivetrain"),
    (4, Motion, "method"),
    (5, Motion, "motion::rest"),
    (6, Motion, "motion"),
    (7, Motion, "motion::ideal"),
    (7, Motion, "motion::hybrid"),
    (7, Motion, "motion::sliding"),
    (7, Motion, "motion::compliant"),
    (8, Motion, "observers"),
    (3, Controller, "control::ticks"),
    (3, Controller, "control::model"),
    (3, Controller, "control::sensing"),
    (4, Controller, "control::monitor"),
    (4, Controller, "control::estimation"),
    (5, Controller, "control::law"),
    (5, Controller, "control::supervisor"),
    (6, Controller, "control"),
    (7, Controller, "settings"),
    (7, Controller, "link"),
    (8, Controller, "device"),
];

/// The innermost room of a path from the root of the crate.
fn room(path: &[String]) -> Option<(u8, Wing, &'static str)> {
    let inside = |name: &str| name.split("::").zip(0..).all(|(segment, at)| path.get(at).is_some_and(|own| own == segment));
    ROOMS.into_iter().filter(|(_, _, name)| inside(name)).max_by_key(|(_, _, name)| name.len())
}

/// Every module below `folder` but tests, with its path from the root of the crate.
fn modules(folder: &Path, path: &[String], found: &mut Vec<(PathBuf, Vec<String>)>) {
    let mut entries: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for entry in entries {
        let name = entry.file_stem().unwrap().to_str().unwrap().to_owned();
        let mut module = path.to_vec();
        if !["mod", "lib"].contains(&name.as_str()) {
            module.push(name.clone());
        }
        if name == "tests" {
            continue;
        }
        if entry.is_dir() {
            modules(&entry, &module, found);
        } else {
            found.push((entry, module));
        }
    }
}

/// The text without comments and without unit tests.
fn code(text: &str) -> String {
    let mut lines = text.lines();
    let mut code = String::new();
    while let Some(line) = lines.next() {
        if line == "#[cfg(test)]" {
            let head = lines.next().unwrap_or_default();
            if head.contains("mod ") && head.ends_with('{') {
                lines.by_ref().find(|line| *line == "}");
            }
            continue;
        }
        code.push_str(line.split("//").next().unwrap_or_default());
        code.push('\n');
    }
    code
}

/// The paths that a text after `crate::` or `super::` names: one, or all of a group in braces.
fn paths(text: &str) -> Vec<Vec<String>> {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    let (name, rest) = text.split_at(end);
    if let Some(rest) = rest.strip_prefix("::") {
        let mut below = paths(rest);
        below.iter_mut().for_each(|path| path.insert(0, name.to_owned()));
        return below;
    }
    let Some(group) = name.is_empty().then(|| rest.strip_prefix('{')).flatten() else {
        return vec![vec![name.to_owned()]];
    };
    let (mut all, mut depth, mut starts) = (Vec::new(), 0, true);
    for (at, c) in group.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 && starts && !c.is_whitespace() && c != ',' {
            all.extend(paths(&group[at..]));
        }
        starts = depth == 0 && (c == ',' || (starts && c.is_whitespace()));
    }
    all
}

/// Every path in the code of `module` that begins with `crate` or `super`, from the root of the crate.
fn imports(code: &str, module: &[String]) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let before = &code[..at];
            // The rest of a longer path, or how far something may be seen.
            if before.ends_with(|c: char| c.is_alphanumeric() || ['_', ':', '$'].contains(&c)) || before.ends_with("pub(in ") {
                continue;
            }
            for mut path in paths(&code[at..]) {
                let up = path.iter().take_while(|segment| *segment == "super").count();
                let base = if up > 0 { &module[..module.len() - up] } else { &[] };
                path.drain(..up.max(1));
                found.push([base, path.as_slice()].concat());
            }
        }
    }
    found
}

#[test]
fn rooms_import_only_rooms_below_them_and_no_wing_imports_the_other() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/src");
    let mut files = Vec::new();
    modules(&source, &[], &mut files);
    let (mut wrong, mut arrows) = (String::new(), 0);
    for (file, module) in files.iter().filter(|(_, module)| !module.is_empty()) {
        let name = file.strip_prefix(&source).unwrap().display();
        let Some((floor, wing, own)) = room(module) else {
            writeln!(wrong, "{name} is in no room; ROOMS in {} lists them", file!()).unwrap();
            continue;
        };
        for import in imports(&code(&fs::read_to_string(file).unwrap()), module) {
            let path = import.join("::");
            match room(&import) {
                None => writeln!(wrong, "{name} imports {path}, which is in no room").unwrap(),
                Some((_, _, other)) if other == own => {}
                Some((_, other_wing, other)) if other_wing != wing && other_wing != Foundation => {
                    writeln!(wrong, "{name} imports {path}: {own} is in the {wing:?} wing, {other} in the {other_wing:?} wing")
                        .unwrap();
                }
                Some((other_floor, _, other)) if other_floor >= floor => {
                    writeln!(
                        wrong,
                        "{name} imports {path}: {own} is on floor {floor}, {other} on floor {other_floor}, not below"
                    )
                    .unwrap();
                }
                Some(_) => arrows += 1,
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(files.len() > 100 && arrows > 300, "{} files with {arrows} imports: not all were found", files.len());
}

#[test]
fn imports_are_found_in_every_form() {
    let text = "use crate::math::{self, root::locate, scalar::{Real, Scalar}};\n// crate::nothing\nuse super::super::equation::Lever;\n\
                const X: f64 = crate::structure::block::GRAVITY;\n#[cfg(test)]\nmod tests {\n    use crate::tests;\n}\n";
    let module = ["control", "law"].map(str::to_owned);
    let found: Vec<String> = imports(&code(text), &module).iter().map(|path| path.join("::")).collect();
    let expected = [
        "math::self",
        "math::root::locate",
        "math::scalar::Real",
        "math::scalar::Scalar",
        "structure::block::GRAVITY",
        "equation::Lever",
    ];
    assert_eq!(found, expected);
}
