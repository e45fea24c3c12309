//! A batch is its cases: one at a time, in shards or all at once, on however many threads, the bytes of their results are the same.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use sprag_cli::command::accuracy_arguments::AccuracyArguments;
use sprag_cli::command::batch::BatchArguments;
use sprag_cli::command::context::Context;
use sprag_cli::command::out_arguments::OverwriteArguments;
use sprag_cli::command::thread_arguments::ThreadArguments;
use sprag_sim::batch::case::TIGHT;
use sprag_sim::batch::table::{CASE_COLUMNS, RESULT_COLUMNS};
use sprag_sim::interrupt::Interrupt;
use sprag_tests::dice::Dice;

const CASES: usize = 600;

/// A row of a case file.
fn row(dice: &mut Dice, index: usize) -> String {
    let unit = |dice: &mut Dice| f64::from(dice.word()) / 4_294_967_296.0;
    let geometry = ["full", "slender"][dice.below(2)];
    let device = ["none", "inerter", "clutched-pair"][dice.below(3)];
    let pulse = ["sine", "cosine"][dice.below(2)];
    let slenderness = 1.0 + 44.0 * unit(dice);
    let mass_ratio = if dice.hits(0.1) { 0.0 } else { 2.0 * unit(dice) };
    let restitution = if dice.hits(0.1) { 0.0 } else { 0.5 + 0.5 * unit(dice) };
    let frequency = 0.2 + 8.0 * unit(dice);
    let amplitude = 0.5 + 9.5 * unit(dice);
    let free = 30.0 * unit(dice);
    // Ids that need quotes stay what they are.
    let id = if dice.hits(0.1) { format!("\"{index}, \"\"again\"\"\"") } else { index.to_string() };
    format!(
        "{id},{geometry},{slenderness:?},{device},{mass_ratio:?},{restitution:?},{pulse},{frequency:?},{amplitude:?},{free:?}\n"
    )
}

/// The results of `rows` on so many threads, below their header.
fn results(folder: &Path, rows: &[String], threads: Option<u16>) -> Vec<u8> {
    let cases: PathBuf = folder.join("cases.csv");
    let mut text = format!("{CASE_COLUMNS}\n");
    rows.iter().for_each(|row| text.write_str(row).unwrap());
    std::fs::write(&cases, text).unwrap();
    let out = folder.join("results.csv");
    let (arguments, mut errors) = (
        BatchArguments {
            cases,
            out: out.clone(),
            replace: OverwriteArguments { overwrite: true },
            threads: ThreadArguments { threads },
            tolerance: TIGHT,
            accuracy: AccuracyArguments::default(),
        },
        Vec::new(),
    );
    let (mut out_text, interrupt) = (Vec::new(), Interrupt::default());
    let code = Context { out: &mut out_text, err: &mut errors, interrupt: &interrupt, quiet: false }.run(&arguments);
    assert_eq!(code, 0, "{}", String::from_utf8_lossy(&errors));
    let bytes = std::fs::read(out).unwrap();
    bytes.strip_prefix(format!("{RESULT_COLUMNS}\n").as_bytes()).unwrap().to_vec()
}

#[test]
fn one_by_one_sharded_and_threaded_give_the_same_bytes() {
    let mut dice = Dice::new(20);
    let rows: Vec<String> = (0..CASES).map(|index| row(&mut dice, index)).collect();
    let folder = tempfile::tempdir().unwrap();
    let whole = results(folder.path(), &rows, Some(1));
    assert_eq!(whole.iter().filter(|&&byte| byte == b'\n').count(), CASES);
    let text = String::from_utf8(whole.clone()).unwrap();
    for outcome in ["no-rocking", "safe", "overturned-without-impact", "overturned-after-impact"] {
        assert!(text.matches(&format!(",{outcome},")).count() > 5, "too few cases are {outcome}");
    }
    for threads in [Some(2), Some(3), None] {
        assert!(results(folder.path(), &rows, threads) == whole, "{threads:?} threads");
    }
    for shards in [2, 3, 7, 600] {
        let mut joined = Vec::new();
        // Parts that are not all of one length.
        let ends: Vec<usize> = (0..=shards).map(|part| part * CASES / shards).collect();
        for part in ends.windows(2) {
            let threads = [Some(1), Some(2), Some(3)][dice.below(3)];
            joined.extend(results(folder.path(), &rows[part[0]..part[1]], threads));
        }
        assert!(joined == whole, "{shards} shards");
    }
}
