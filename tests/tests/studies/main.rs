//! Many runs at once: batches, maps, clouds, optimisations.

mod accuracy_study;
mod batch_parts;
mod cloud;
mod design;
mod maps;
mod needs_cells;
mod needs_records;
mod optimise;
mod optimise_scatter;
mod other_programs;
mod refine;
mod similarity;
