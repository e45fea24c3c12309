//! What the paper says of single pulses (its Sections 2.3 to 5, Figures 5 to 13), statement by statement: docs/paper.md has the table, and
//!
//!     cargo test -p sprag-tests --test motion paper_statements -- --nocapture
//!
//! prints its numbers, each line with the number of its statement. The tests hold the verdicts.

mod cuts;
mod demands;
mod equations;
mod histories;
mod overturning;
mod reversals;
mod spectra;

/// One line of the table's numbers.
fn say(statement: &str, what: &str, numbers: &str) {
    println!("{statement:<5} {what:<15} {numbers}");
}
