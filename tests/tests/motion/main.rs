//! The motion of a block with an ideal device: closed forms, reference cells, hard cases, lanes, and the statements of the paper.

mod balanced_starts;
mod closed_forms;
mod convergence;
mod endings;
mod error_estimates;
mod fast_motions;
mod figures;
mod grazes;
mod hard_starts;
mod lanes_under_pulses;
mod lanes_under_records;
mod paper_statements;
mod record_hard_cases;
mod recorded_motions;
mod reference_cells;
mod sine_exhaustive;
mod symmetry;
