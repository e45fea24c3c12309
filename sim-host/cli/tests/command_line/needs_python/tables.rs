//! Parquet files by pyarrow: see `tables_against_python.py`.

use std::path::PathBuf;

use crate::formats::{parquet_files, studies};

#[test]
#[ignore = "needs Python and its packages: run by cargo xtask test"]
fn pyarrow_reads_what_csv_holds_and_what_made_it() {
    let folder = tempfile::tempdir().unwrap();
    let outs = studies(folder.path());
    let printed = super::printed("tables_against_python.py", &outs.each_ref().map(PathBuf::as_path));
    let found: serde_json::Value = serde_json::from_slice(&printed).unwrap();
    let found = found.as_object().unwrap();
    assert_eq!(found.len(), outs.iter().map(|out| parquet_files(out).len()).sum::<usize>());
    assert!(found.values().all(|metadata| metadata["version"] == env!("CARGO_PKG_VERSION")), "{found:?}");
}
