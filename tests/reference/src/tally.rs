//! Verdicts by family, as a table.

use std::collections::BTreeMap;
use std::fmt;

use crate::compare::Verdict;

/// Verdicts by family.
#[derive(Clone, Debug, Default)]
pub struct Tally(BTreeMap<&'static str, Row>);

#[derive(Clone, Copy, Debug, Default)]
struct Row {
    agree: usize,
    chaotic: usize,
    differ: usize,
    refused: usize,
    /// Largest |Δθ|/α and largest residual of the other's ledger among those that agree.
    largest: [f64; 2],
}

impl Tally {
    /// Counts a verdict.
    pub fn add(&mut self, family: &'static str, verdict: &Result<Verdict, String>) {
        let row = self.0.entry(family).or_default();
        match verdict {
            Ok(Verdict::Agree(difference)) => {
                row.agree += 1;
                row.largest[0] = row.largest[0].max(difference.history);
                row.largest[1] = row.largest[1].max(difference.residuals[1]);
            }
            Ok(Verdict::Chaotic(_)) => row.chaotic += 1,
            Ok(Verdict::Differ(_)) => row.differ += 1,
            Err(_) => row.refused += 1,
        }
    }

    /// Scenes that rounding decides, of all families.
    pub fn chaotic(&self) -> usize {
        self.0.values().map(|row| row.chaotic).sum()
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(out, "| family | scenes | agree | chaotic | differ | not run | largest difference / α | largest residual |")?;
        writeln!(out, "| --- | --- | --- | --- | --- | --- | --- | --- |")?;
        for (family, Row { agree, chaotic, differ, refused, largest: [history, residual] }) in &self.0 {
            let scenes = agree + chaotic + differ + refused;
            writeln!(
                out,
                "| {family} | {scenes} | {agree} | {chaotic} | {differ} | {refused} | {history:.1e} | {residual:.1e} |"
            )?;
        }
        Ok(())
    }
}
