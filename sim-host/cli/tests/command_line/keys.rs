//! The tables of keys in the manual are those of the types.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use serde_json::Value;
use sprag_sim::keys::Described;
use sprag_sim::keys::list::keys;
use sprag_sim::keys::table::table;
use sprag_sim::scene::schema::SceneFile;
use sprag_studies::cloud::study_file::StudyFile;

const PAGES: [&str; 3] = ["scenes.md", "controller.md", "studies.md"];

/// Before a table: `<!-- keys of scene controller. * belief. -->`, the words of [`table`].
const START: &str = "<!-- keys of ";

const END: &str = "<!-- end of keys -->\n";

fn schema(kind: &str) -> &'static Value {
    match kind {
        "scene" => SceneFile::schema(),
        "study" => StudyFile::schema(),
        _ => panic!("keys of what? {kind}"),
    }
}

/// `page` with its tables as they should be, and the keys that these have, each after its kind.
fn with_tables(page: &str) -> (String, BTreeSet<String>) {
    let mut pieces = page.split(START);
    let (mut text, mut found) = (pieces.next().unwrap().to_owned(), BTreeSet::new());
    for piece in pieces {
        let (words, rest) = piece.split_once(" -->\n").unwrap();
        let (_, rest) = rest.split_once(END).unwrap();
        let parts: Vec<&str> = words.split(' ').collect();
        let [kind, within, parts @ ..] = &parts[..] else { panic!("{words}") };
        let rows = table(schema(kind), within, parts);
        let names = rows.lines().skip(2).map(|row| row.split('`').nth(1).unwrap());
        found.extend(names.map(|name| format!("{kind} {}{name}", within.trim_start_matches('.'))));
        text += &format!("{START}{words} -->\n{rows}{END}{rest}");
    }
    (text, found)
}

fn pages() -> impl Iterator<Item = (std::path::PathBuf, String)> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs"));
    PAGES.iter().map(move |name| (folder.join(name), fs::read_to_string(folder.join(name)).unwrap()))
}

#[test]
fn tables_of_the_manual_have_every_key_with_its_range_and_default() {
    let mut found = BTreeSet::new();
    for (path, page) in pages() {
        let (expected, keys) = with_tables(&page);
        assert!(
            page == expected,
            "{}: write its tables by `cargo test -p sprag-cli --test command_line write_tables -- --ignored`",
            path.display()
        );
        found.extend(keys);
    }
    for kind in ["scene", "study"] {
        for key in keys(schema(kind)) {
            // Of tables with the same keys the first has them.
            let same = [("vertical.N.", "ground.N."), ("map.y.", "map.x."), ("ground_accelerometer.", "block_accelerometer.")];
            let path = same.iter().fold(key.path, |path, (this, first)| path.replace(this, first));
            assert!(found.contains(&format!("{kind} {path}")), "{path} of a {kind} is in no table");
        }
    }
}

#[test]
#[ignore = "writes tables of the manual"]
fn write_tables_of_the_manual() {
    for (path, page) in pages() {
        fs::write(path, with_tables(&page).0).unwrap();
    }
}
