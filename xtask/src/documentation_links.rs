//! Relative links of the README and of the pages in docs lead to files that are there.

use std::fs;
use std::path::{Path, PathBuf};

/// Targets of links and pictures in Markdown `text`, without what is in code.
fn links(text: &str) -> Vec<&str> {
    let mut in_code = false;
    let prose = text.lines().filter(|line| {
        in_code ^= line.trim_start().starts_with("```");
        !in_code && !line.starts_with("    ")
    });
    prose.flat_map(|line| line.split("](").skip(1)).filter_map(|rest| rest.split([')', ' ']).next()).collect()
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
