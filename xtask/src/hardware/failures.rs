//! Each test that the table of failures names is there.

use std::{collections::HashSet, fs, path::Path};

fn functions(folder: &Path, found: &mut HashSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && path.file_name().is_some_and(|name| name != "target") {
            functions(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            // After an attribute of a test, perhaps with others in between.
            let mut test = false;
            for line in text.lines().map(str::trim) {
                test |= line.starts_with("#[test]");
                if let Some(rest) = line.strip_prefix("fn ")
                    && std::mem::take(&mut test)
                {
                    found.extend(rest.split('(').next().map(str::to_owned));
                }
            }
        }
    }
}

#[test]
fn each_test_that_the_table_of_failures_names_is_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut tests = HashSet::new();
    for folder in ["shared", "tests", "firmware", "sim-host", "xtask"] {
        functions(&root.join(folder), &mut tests);
    }
    for (page, head, columns) in [("docs/fmea.md", "| failure", 6), ("docs/board-review.md", "| no.", 5)] {
        let text = fs::read_to_string(root.join(page)).unwrap();
        let is_row = |line: &&str| line.starts_with("| ") && !line.starts_with("| ---") && !line.starts_with(head);
        let rows: Vec<&str> = text.lines().filter(is_row).collect();
        let mut named = 0;
        for row in &rows {
            let cells: Vec<&str> = row.trim_matches('|').split('|').collect();
            assert_eq!(cells.len(), columns, "{row}");
            let names: Vec<&str> = cells[columns - 1].split('`').skip(1).step_by(2).collect();
            for name in &names {
                assert!(tests.contains(*name), "no test {name}");
            }
            named += names.len();
            // What no test shows is said to be open.
            assert!(!names.is_empty() || cells[columns - 1].contains("none"), "{row}");
        }
        assert!(rows.len() > 30 && named > 30, "{page}: {} rows, {named} tests", rows.len());
    }
}
