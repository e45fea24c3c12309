//! Blocks under pulses as JavaScript hands them over.

use sprag_ensemble::machine::{Registers, run};
use sprag_ensemble::pulsed::{PulseResult, PulsedBlock};
use sprag_ensemble::rows::BLOCK;
use wasm_bindgen::prelude::*;

/// Whether this module has SIMD.
#[wasm_bindgen]
pub fn simd() -> bool {
    cfg!(target_feature = "simd128")
}

/// What becomes of blocks under pulses: rows of results for rows of blocks, as [`sprag_ensemble::rows`] has them.
///
/// # Errors
/// For numbers that are no rows, and a block that cannot be followed.
#[wasm_bindgen]
pub fn pulses(rows: &[f64]) -> Result<Vec<f64>, JsError> {
    let blocks: Option<Vec<PulsedBlock>> = rows.as_chunks::<BLOCK>().0.iter().map(PulsedBlock::of_row).collect();
    let blocks = blocks.ok_or_else(|| JsError::new("these are no rows of blocks"))?;
    let results = run(&blocks, Registers::Widest).map_err(|(index, error)| JsError::new(&format!("block {index}: {error}")))?;
    Ok(results.iter().flat_map(PulseResult::row).collect())
}
