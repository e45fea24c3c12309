//! Relative links of the README and of the pages in docs, and the paths that they name in code, lead to files that are there.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders of the repository, by which a path in code is known.
const FOLDERS: [&str; 7] = ["shared/", "sim-host/", "tests/", "firmware/", "xtask/", "docs/", "scenes/"];

/// Lines of Markdown `text` that are no blocks of code.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut in_code = false;
    text.lines().filter(move |line| {
        in_code ^= line.trim_start().starts_with("```");
        !in_code && !line.starts_with("    ")
    })
}

/// Targets of links and pictures in Markdown `text`, without what is in code.
fn links(text: &str) -> Vec<&str> {
    prose(text).flat_map(|line| line.split("](").skip(1)).filter_map(|rest| rest.split([')', ' ']).next()).collect()
}

/// Paths from the root of the repository that Markdown `text` names between backticks, each alone or as the first word of a command.
fn paths(text: &str) -> Vec<&str> {
    let code = prose(text).flat_map(|line| line.split('`').skip(1).step_by(2));
    let words = code.filter_map(|code| code.split(' ').next());
    words.filter(|word| FOLDERS.iter().any(|folder| word.starts_with(folder))).collect()
}

fn pages(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            pages(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "md") {
            found.push(path);
        }
    }
}

#[test]
fn every_path_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    // Not the changelog: it names what there was.
    let mut all = vec![root.join("README.md")];
    pages(&root.join("docs"), &mut all);
    let (mut checked, mut missing) = (0, Vec::new());
    for page in all {
        for path in paths(&fs::read_to_string(&page).unwrap()) {
            if !root.join(path).exists() {
                missing.push(format!("{}: {path}", page.display()));
            }
            checked += 1;
        }
    }
    assert!(missing.is_empty(), "not there:\n{}", missing.join("\n"));
    assert!(checked > 100, "{checked} paths");
}

#[test]
fn paths_are_found_in_code_within_prose() {
    let text = "See `shared/src/a.rs`, `docs/b.sh target/c`, `d/e.rs`, docs/f.md and `tests/g`.\n\n    `docs/h.md`\n```\n`docs/i.md`\n```\n";
    assert_eq!(paths(text), ["shared/src/a.rs", "docs/b.sh", "tests/g"]);
}

#[test]
fn every_relative_link_resolves() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut all = vec![root.join("README.md"), root.join("CHANGELOG.md")];
    pages(&root.join("docs"), &mut all);
    // The words of docs/accuracy.md, whose links are relative to that page.
    all.retain(|page| !page.ends_with("docs/accuracy/page.md"));
    let mut checked = 0;
    for page in all {
        let text = fs::read_to_string(&page).unwrap();
        for link in links(&text) {
            let target = link.split('#').next().unwrap_or_default();
            if target.is_empty() || target.contains("://") || target.starts_with("mailto:") {
                continue;
            }
            let place = page.parent().unwrap().join(target);
            assert!(place.exists(), "{}: {link} leads nowhere", page.display());
            checked += 1;
        }
    }
    assert!(checked > 50, "{checked} links");
}

#[test]
fn links_are_found_where_they_are_meant() {
    let text = "See [a](b.md) and ![c](d/e.svg \"title\"), [x](https://y.z#q).\n\n    [code](no.md)\n```\n[code](no.md)\n```\n";
    assert_eq!(links(text), ["b.md", "d/e.svg", "https://y.z#q"]);
}
