//! The motion of a block with an ideal device: closed forms, reference cells, recorded motions, hard cases, lanes, and the statements of the paper.

mod balanced_starts;
mod closed_forms;
mod convergence;
mod endings;
mod fast_motions;
mod figures;
mod hard_starts;
mod lanes_under_pulses;
mod lanes_under_records;
mod needs_cells;
mod needs_records;
mod paper_statements;
mod record_hard_cases;
mod sine_exhaustive;
mod symmetry;
