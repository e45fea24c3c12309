//! The motion of a block and its device: closed forms, reference cells, recorded motions, hard cases, lanes, the statements of the paper,
//! and the second program (`tests/reference`).

mod balanced_starts;
mod batches_in_lanes;
mod closed_forms;
mod convergence;
mod endings;
mod error_estimates_of_devices;
mod fast_motions;
mod figures;
mod footing;
mod hard_devices;
mod hard_starts;
mod lanes_of_real_devices;
mod lanes_under_pulses;
mod lanes_under_records;
mod needs_cells;
mod needs_records;
mod paper_statements;
mod random_devices;
mod record_hard_cases;
mod reference;
mod second_program;
mod second_program_foundation;
mod second_program_sliding;
mod sine_exhaustive;
mod symmetry;
