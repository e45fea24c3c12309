//! Whether two names are of one file, whatever links lead to it.

use std::fs::{File, Metadata};
use std::path::Path;

/// Whether `one` and `other` exist and are the same file.
pub fn same_file(one: &Path, other: &Path) -> bool {
    let of = |path: &Path| path.metadata().ok().and_then(|data| identity(&data));
    match (of(one), of(other)) {
        (Some(one), Some(other)) => one == other,
        _ => matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other),
    }
}

/// Whether `path` still leads to the open `file`, and not to one that has taken its place.
pub fn is_at(file: &File, path: &Path) -> bool {
    let (Ok(open), Ok(there)) = (file.metadata(), path.metadata()) else { return false };
    identity(&open) == identity(&there)
}

/// Whether `path` is `-`, or leads to where this process's standard output goes.
pub fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || leads_to_standard_output(path)
}

#[cfg(unix)]
fn leads_to_standard_output(path: &Path) -> bool {
    use std::os::fd::AsFd;
    let (Ok(descriptor), Ok(there)) = (std::io::stdout().as_fd().try_clone_to_owned(), path.metadata()) else { return false };
    File::from(descriptor).metadata().is_ok_and(|data| identity(&data) == identity(&there))
}

/// A system without names for it has none that do.
#[cfg(not(unix))]
fn leads_to_standard_output(_path: &Path) -> bool {
    false
}

/// What only the file itself has: its device and its number there.
#[cfg(unix)]
fn identity(data: &Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((data.dev(), data.ino()))
}

#[cfg(not(unix))]
fn identity(_data: &Metadata) -> Option<(u64, u64)> {
    None
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_the_same_file_and_copies_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let [file, hard, soft, copy] = ["file", "hard", "soft", "copy"].map(|name| folder.path().join(name));
        std::fs::write(&file, "text").unwrap();
        std::fs::hard_link(&file, &hard).unwrap();
        std::os::unix::fs::symlink("file", &soft).unwrap();
        std::fs::copy(&file, &copy).unwrap();
        assert!(same_file(&file, &hard) && same_file(&soft, &file) && !same_file(&file, &copy));
        assert!(!same_file(&file, &folder.path().join("nothing")));
        let open = File::open(&file).unwrap();
        assert!(is_at(&open, &soft));
        std::fs::rename(&copy, &file).unwrap();
        assert!(!is_at(&open, &file) && is_at(&open, &hard));
    }
}
