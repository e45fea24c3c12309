//! The native module of the Python package `sprag`: what Python cannot do itself, over the packages of the host.
//!
//! - `errors`: exceptions; `value`: values of Python as TOML; `columns`: tables as arrays; `long_call`: work without the interpreter's lock.
//! - `record`, `scene`: what is simulated; `run`, `map`, `closed_loop`: what comes of it; `law`: clutch laws in Python.
//! - `study`: studies over many records; `fits`: demand models and fragilities; `plan`: studies in parts; `board`: boards and emulators.

mod board;
mod closed_loop;
mod columns;
mod design;
mod errors;
mod fits;
mod law;
mod long_call;
mod map;
mod plan;
mod record;
mod run;
mod scene;
mod study;
mod value;

use pyo3::prelude::*;

#[pymodule(gil_used = false)]
mod _core {
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::board::{board_info, board_log, board_loop, board_settings};
    #[pymodule_export]
    use crate::closed_loop::closed_loop;
    #[pymodule_export]
    use crate::design::design;
    #[pymodule_export]
    use crate::fits::{DemandModel, Fragility, demand, fragility};
    #[pymodule_export]
    use crate::law::Situation;
    #[pymodule_export]
    use crate::map::overturning_map;
    #[pymodule_export]
    use crate::plan::{missing_parts, plan};
    #[pymodule_export]
    use crate::record::Record;
    #[pymodule_export]
    use crate::run::simulate;
    #[pymodule_export]
    use crate::scene::{Scene, change, check_table, unit};
    #[pymodule_export]
    use crate::study::{Study, accuracy, cloud, optimise};

    /// The command `sprag` with the words of a command line; its exit code.
    #[pyfunction]
    fn main(py: Python<'_>, words: Vec<std::ffi::OsString>) -> i32 {
        py.detach(|| sprag_cli::run(words))
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

/// Threads for one call, which end with it; one a core without a number.
///
/// # Errors
/// `InputError` for a number of threads that cannot be had.
fn threads(number: Option<&Bound<'_, PyAny>>) -> PyResult<rayon::ThreadPool> {
    let allowed = "a whole number from 1 to 1024";
    let within = |number| match usize::try_from(value::whole(number, "threads", allowed)?) {
        Ok(threads @ 1..=1024) => Ok(threads),
        _ => Err(errors::range("threads", number, allowed)),
    };
    let number = number.map(within).transpose()?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(number.unwrap_or(0)).build();
    pool.map_err(|error| errors::failed(format!("the threads cannot be started: {error}")))
}
