//! Rows that are interrupted anywhere, split anyhow, and always the same at the end.

use std::collections::BTreeMap;
use std::path::Path;

use super::error::LongRunError;
use super::origin::Origin;
use super::rows::{Plan, Rows};
use super::shard::Shard;
use super::start::Start;
use crate::output::Subject;

const ROWS: usize = 12;

fn plan(folder: &Path, shard: Shard, seed: u32) -> Plan<'_> {
    let origin = Origin::new(Subject::new("test", BTreeMap::new()).with("seed", &seed).unwrap(), ROWS);
    Plan {
        folder,
        shards: folder,
        name: "table",
        columns: ["row", "its name, quoted"].map(str::to_owned).to_vec(),
        together: 2,
        shard,
        origin,
    }
}

/// Begins, and adds `most` rows; the numbers of those that were known.
fn run(plan: &Plan<'_>, start: Start, most: usize) -> Result<(Rows, Vec<usize>), LongRunError> {
    let mut known = Vec::new();
    let mut rows = Rows::begin(plan, start, |row, record| {
        known.push(row);
        if record[0] == row.to_string() { Ok(()) } else { Err(format!("`{}` is not {row}", &record[0])) }
    })?;
    for row in rows.left().take(most) {
        rows.append(format!("{row},\"row, {row}\"\n").as_bytes(), 1)?;
    }
    Ok((rows, known))
}

fn whole(folder: &Path) -> Vec<u8> {
    let plan = plan(folder, Shard::WHOLE, 1);
    let path = run(&plan, Start::New, ROWS).unwrap().0.finish().unwrap();
    std::fs::read(path).unwrap()
}

/// Cut at every byte, a run resumes to the same file; groups of rows that are not whole are made again.
#[test]
fn a_run_resumes_from_any_byte() {
    let folder = tempfile::tempdir().unwrap();
    let expected = whole(folder.path());
    let heading = expected.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let plan = plan(folder.path(), Shard::WHOLE, 1);
    let unfinished = folder.path().join("table.csv.unfinished");
    for length in heading..=expected.len() {
        drop(run(&plan, Start::Restart, 0).unwrap());
        std::fs::write(&unfinished, &expected[..length]).unwrap();
        let (rows, known) = run(&plan, Start::Resume, ROWS).unwrap();
        let lines = expected[heading..length].iter().filter(|byte| **byte == b'\n').count();
        assert!(known.iter().copied().eq(0..lines / 2 * 2), "{length}: {known:?}");
        assert_eq!(std::fs::read(rows.finish().unwrap()).unwrap(), expected, "{length}");
    }
    // All there: nothing is made again.
    let (rows, known) = run(&plan, Start::Resume, ROWS).unwrap();
    assert!(rows.left().is_empty() && known.len() == ROWS);
}

#[test]
fn shards_merge_to_the_bytes_of_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let expected = whole(folder.path());
    std::fs::remove_file(folder.path().join("table.csv")).unwrap();
    let merged = |shards| run(&plan(folder.path(), Shard::WHOLE, 1), Start::Merge(shards), 0);
    for shards in [1, 2, 3, 5, 9] {
        for shard in Shard::all(shards) {
            if shards > 1 && !shard.rows(ROWS, 2).is_empty() {
                let missing = merged(shards).unwrap_err();
                assert!(matches!(&missing, LongRunError::Missing { shard: named, .. } if *named == shard), "{missing}");
            }
            // Interrupted once.
            let plan = plan(folder.path(), shard, 1);
            drop(run(&plan, Start::New, 1).unwrap());
            run(&plan, Start::Resume, ROWS).unwrap().0.finish().unwrap();
        }
        let (rows, known) = merged(shards).unwrap();
        assert_eq!(known.len(), ROWS);
        assert_eq!(std::fs::read(rows.finish().unwrap()).unwrap(), expected);
    }
}

#[test]
fn rows_of_another_run_are_not_mixed() {
    let folder = tempfile::tempdir().unwrap();
    let [ours, other] = [1, 2].map(|seed| plan(folder.path(), Shard::WHOLE, seed));
    drop(run(&ours, Start::New, 4).unwrap());
    assert!(matches!(run(&ours, Start::New, 0).unwrap_err(), LongRunError::Unfinished { .. }));
    let refused = run(&other, Start::Resume, 0).unwrap_err();
    assert!(refused.to_string().contains("seed differs"), "{refused}");
    assert_eq!(run(&ours, Start::Resume, 0).unwrap().1.len(), 4);
    // A finished run of another origin is no beginning of this one.
    run(&ours, Start::Resume, ROWS).unwrap().0.finish().unwrap();
    assert_eq!(run(&other, Start::Resume, 0).unwrap().1.len(), 0);
    // A shard of another run.
    let shard = |seed, index: &str| plan(folder.path(), index.parse().unwrap(), seed);
    for (seed, index) in [(1, "1/2"), (2, "2/2")] {
        run(&shard(seed, index), Start::New, ROWS).unwrap().0.finish().unwrap();
    }
    std::fs::remove_file(folder.path().join("table.csv.unfinished.json")).unwrap();
    let refused = run(&ours, Start::Merge(2), 0).unwrap_err();
    assert!(matches!(&refused, LongRunError::OtherRun { path, .. } if path.ends_with("table-2-of-2.run.json")), "{refused}");
}

#[test]
fn rows_of_nobody_knows_what_are_not_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let plan = plan(folder.path(), Shard::WHOLE, 1);
    let [rows, page] = ["table.csv.unfinished", "table.csv.unfinished.json"].map(|name| folder.path().join(name));
    drop(run(&plan, Start::New, 4).unwrap());
    std::fs::remove_file(&page).unwrap();
    let kept = std::fs::read(&rows).unwrap();
    let refused = run(&plan, Start::Resume, 0).unwrap_err().to_string();
    assert!(refused.starts_with(page.to_str().unwrap()) && refused.contains("give --restart"), "{refused}");
    assert!(!refused.contains('\n') && std::fs::read(&rows).unwrap() == kept, "{refused}");
    assert_eq!(run(&plan, Start::Restart, ROWS).unwrap().0.left().len(), 0);
}

#[test]
fn rows_that_were_changed_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let expected = String::from_utf8(whole(folder.path())).unwrap();
    let plan = plan(folder.path(), Shard::WHOLE, 1);
    for (changed, says) in [
        (expected.replace("\n7,", "\n8,"), "row 8: `8` is not 7"),
        (expected.replace("\n7,", "\n7,7,"), "row 8: CSV error"),
        (format!("{expected}12,x\n"), "row 13: there should be 12 rows only"),
        (expected.replace("row,", "column,"), "the heading differs"),
    ] {
        drop(run(&plan, Start::Restart, 0).unwrap());
        std::fs::write(folder.path().join("table.csv.unfinished"), changed).unwrap();
        let refused = run(&plan, Start::Resume, 0).unwrap_err().to_string();
        assert!(refused.contains(says), "{refused}");
    }
}

#[test]
fn two_processes_do_not_write_one_file() {
    let folder = tempfile::tempdir().unwrap();
    let expected = whole(folder.path());
    let plan = plan(folder.path(), Shard::WHOLE, 1);
    let (mut first, _) = run(&plan, Start::New, 2).unwrap();
    for start in [Start::New, Start::Resume, Start::Restart] {
        let refused = run(&plan, start, 2).unwrap_err().to_string();
        assert!(refused.contains("another process works on it"), "{start:?}: {refused}");
    }
    for row in first.left() {
        first.append(format!("{row},\"row, {row}\"\n").as_bytes(), 1).unwrap();
    }
    assert_eq!(std::fs::read(first.finish().unwrap()).unwrap(), expected);
}

/// Whoever begins while another ends: the rows of each are its own, and the table is whole.
/// Runs that begin at once in `folder`, each in its way; gives how many end, all with the bytes `expected`. The others are refused.
fn together<const RUNS: usize>(folder: &Path, starts: [Start; RUNS], expected: &[u8]) -> usize {
    let run = |start| {
        let (rows, _) = run(&plan(folder, Shard::WHOLE, 1), start, ROWS)?;
        let finished = rows.finish()?;
        Ok::<_, LongRunError>(std::fs::read(finished).unwrap())
    };
    let runs = std::thread::scope(|scope| starts.map(|start| scope.spawn(move || run(start))).map(|run| run.join().unwrap()));
    let mut finished = 0;
    for run in runs {
        match run {
            Ok(bytes) => {
                assert_eq!(bytes, expected);
                finished += 1;
            }
            Err(error) => {
                let refused = error.to_string();
                assert!(["another process", "an interrupted run"].iter().any(|words| refused.contains(words)), "{refused}");
            }
        }
    }
    finished
}

#[test]
fn runs_that_begin_and_end_together_do_not_mix() {
    let folder = tempfile::tempdir().unwrap();
    let expected = whole(folder.path());
    for _ in 0..40 {
        assert!(together(folder.path(), [Start::Restart, Start::Restart, Start::New], &expected) > 0);
    }
}

#[test]
fn a_new_run_begins_beside_one_that_ends_or_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let expected = whole(folder.path());
    // Of new runs alone each may find that another has just begun, so that in a round none ends.
    let starts = [Start::Restart, Start::New, Start::New, Start::New];
    let finished: usize = (0..40).map(|_| together(folder.path(), starts, &expected)).sum();
    assert!(finished > 20, "{finished}");
}

#[test]
fn a_file_that_is_not_as_it_was_written_is_not_finished() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv.unfinished");
    let plan = plan(folder.path(), Shard::WHOLE, 1);
    let text = || std::fs::read(&path).unwrap();
    let write = |text: &[u8]| std::fs::write(&path, text).unwrap();
    let changes: [(&dyn Fn(), &str); 4] = [
        (&|| write(b""), "0 bytes for"),
        (&|| write(&vec![0; text().len()]), "the heading differs"),
        (&|| write(String::from_utf8(text()).unwrap().replace("row, 4", "\0\0\0\0\0\0").as_bytes()), "a zero byte"),
        (&|| std::fs::rename(&path, folder.path().join("elsewhere")).unwrap(), "another file is in its place"),
    ];
    for (change, says) in changes {
        let (rows, _) = run(&plan, Start::Restart, ROWS).unwrap();
        change();
        let refused = rows.finish().unwrap_err();
        assert!(matches!(&refused, LongRunError::Changed { .. }), "{refused}");
        assert!(refused.to_string().contains(says), "{refused}");
        assert!(!folder.path().join("table.csv").exists());
    }
    // One that was cut short: rows that are never parted count together.
    let (rows, _) = run(&plan, Start::Restart, ROWS - 1).unwrap();
    assert!(rows.finish().unwrap_err().to_string().contains("10 rows for 12"));
}
