//! Estimators, laws and supervisor in closed loop.

mod bad_frames;
mod closed_loop;
mod controller_hard_cases;
mod digests;
mod feedback;
mod friction_plates;
mod ladder;
mod let_go;
mod own_law;
mod random_loops;
mod sensor_failures;
