//! What a folder holds that may be a record, and what of it is passed over.

use std::fs::DirEntry;
use std::path::{Path, PathBuf};

/// Endings of the files that a folder is searched for. A file that is named is read whatever its ending.
const ENDINGS: [&str; 8] = ["acc", "at2", "csv", "dat", "g3", "json", "smc", "txt"];

/// Folders within folders that are searched.
const DEEPEST: usize = 16;

/// Most names in one line.
const MOST_NAMES: usize = 3;

/// What a folder holds.
#[derive(Debug, Default)]
struct Found {
    /// Files that may be records, by path.
    files: Vec<PathBuf>,
    /// Folders without such files, or that cannot be searched, in a line each.
    unreadable: Vec<String>,
    /// What may be meant as a record and is none: its path and why.
    passed_over: Vec<(PathBuf, &'static str)>,
}

impl Found {
    /// What of `folder` was passed over, if anything was.
    fn passed_over_line(&self, folder: &Path) -> Option<String> {
        let name = |(path, why): &(PathBuf, &str)| format!("{} ({why})", shown(path.strip_prefix(folder).unwrap_or(path)));
        let names: Vec<String> = self.passed_over.iter().map(name).collect();
        (!names.is_empty()).then(|| format!("{}: {} passed over: {}", folder.display(), names.len(), first_of(&names)))
    }
}

/// The first of `names`, and that there are more.
pub fn first_of(names: &[impl AsRef<str>]) -> String {
    let first: Vec<&str> = names.iter().take(MOST_NAMES).map(AsRef::as_ref).collect();
    format!("{}{}", first.join(", "), if names.len() > MOST_NAMES { ", …" } else { "" })
}

/// A path with `/` between its parts, the same on every system.
pub fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// The files of `folder` and of those below it that may be records. Links to folders are not followed.
fn search(folder: &Path) -> Found {
    let mut found = Found::default();
    search_below(folder, DEEPEST, &mut found);
    if found.files.is_empty() && found.unreadable.is_empty() {
        found.unreadable.push(format!("{}: no file in it ends in {}", folder.display(), ENDINGS.join(", ")));
    }
    found.files.sort();
    found.passed_over.sort();
    found
}

/// Record files that a command line or a study names.
#[derive(Debug, Default)]
pub struct Named {
    /// The files, those of a folder by path in its place.
    pub files: Vec<PathBuf>,
    /// What of folders was passed over, in a line each.
    pub passed_over: Vec<String>,
    /// Folders without records, or that cannot be searched, in a line each.
    pub unreadable: Vec<String>,
}

impl Named {
    /// The files among `paths`, and those of the folders among them.
    pub fn of(paths: &[PathBuf]) -> Named {
        let mut named = Named::default();
        for path in paths {
            if !path.is_dir() {
                named.files.push(path.clone());
                continue;
            }
            let found = search(path);
            named.passed_over.extend(found.passed_over_line(path));
            named.files.extend(found.files);
            named.unreadable.extend(found.unreadable);
        }
        named
    }
}

fn search_below(folder: &Path, deepest: usize, found: &mut Found) {
    let unreadable = |error: std::io::Error| format!("{}: cannot be read: {error}", folder.display());
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) => return found.unreadable.push(unreadable(error)),
    };
    for entry in entries {
        match entry.and_then(|entry| Ok((entry.file_type()?, entry))) {
            Ok((kind, entry)) if kind.is_dir() && !is_hidden(&entry) && deepest > 0 => {
                search_below(&entry.path(), deepest - 1, found);
            }
            Ok((_, entry)) => match why_not(&entry) {
                Some(why) => found.passed_over.push((entry.path(), why)),
                None if is_candidate(&entry.path()) => found.files.push(entry.path()),
                None => {}
            },
            Err(error) => found.unreadable.push(unreadable(error)),
        }
    }
}

fn is_hidden(entry: &DirEntry) -> bool {
    entry.file_name().as_encoded_bytes().starts_with(b".")
}

fn is_candidate(path: &Path) -> bool {
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str()))
}

/// Why an entry that may be meant as a record is none; `None` for records, and for what has another ending.
fn why_not(entry: &DirEntry) -> Option<&'static str> {
    let path = entry.path();
    // Follows links.
    let kind = std::fs::metadata(&path).map(|data| data.file_type());
    let folder = kind.as_ref().is_ok_and(std::fs::FileType::is_dir);
    if !folder && !is_candidate(&path) {
        return None;
    }
    match kind {
        _ if is_hidden(entry) => Some(if folder { "a hidden folder" } else { "hidden" }),
        Err(_) => Some(if path.is_symlink() { "a link that leads nowhere" } else { "unreadable" }),
        Ok(_) if folder => Some(if path.is_symlink() { "a link to a folder" } else { "too deep" }),
        Ok(kind) => (!kind.is_file()).then_some("a pipe or a device"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_passed_over_by_name() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir_all(at("deeper/.git")).unwrap();
        for name in ["a.csv", ".b.csv", "deeper/c.AT2", "README.md", ".DS_Store"] {
            std::fs::write(at(name), "").unwrap();
        }
        symlink("nowhere", at("gone.csv")).unwrap();
        symlink("nowhere", at("gone.md")).unwrap();
        symlink(at("deeper"), at("loop")).unwrap();
        symlink(at("a.csv"), at("z.csv")).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(at("pipe.csv")).status().unwrap().success());
        let found = search(folder.path());
        let names = |paths: &mut dyn Iterator<Item = &PathBuf>| -> Vec<String> {
            paths.map(|path| shown(path.strip_prefix(folder.path()).unwrap())).collect()
        };
        assert_eq!(names(&mut found.files.iter()), ["a.csv", "deeper/c.AT2", "z.csv"]);
        let passed_over = names(&mut found.passed_over.iter().map(|(path, _)| path));
        assert_eq!(passed_over, [".b.csv", "deeper/.git", "gone.csv", "loop", "pipe.csv"]);
        let line = found.passed_over_line(folder.path()).unwrap();
        assert!(
            line.contains(
                ": 5 passed over: .b.csv (hidden), deeper/.git (a hidden folder), gone.csv (a link that leads nowhere), …"
            ),
            "{line}"
        );
        assert!(search(&at("absent")).unreadable[0].contains("absent: cannot be read: "));
    }
}
