//! The choice of a device under a few recorded motions, which `--nocapture` prints.

use std::path::PathBuf;

use sprag_tests::shared_file;

use crate::optimise::{simulated_again, study};

#[test]
#[ignore = "needs the recorded motions beside the repository: run by cargo xtask test"]
fn the_same_holds_under_recorded_motions() {
    let folder = shared_file("records/tclmodel_near_pulse");
    let mut files: Vec<PathBuf> = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    let few = tempfile::tempdir().unwrap();
    for file in files.iter().filter(|file| file.extension().is_some_and(|ending| ending == "AT2")).step_by(5) {
        std::fs::copy(file, few.path().join(file.file_name().unwrap())).unwrap();
    }
    simulated_again(&study("largest_force_ratio = 0.25", few.path()), 1e-10, |name| few.path().join(name));
}
