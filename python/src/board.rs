//! A board with the firmware on it, or an emulator: found anew by every call, as by the command.

use std::path::PathBuf;

use numpy::IntoPyArray as _;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Map, Value};
use sprag_cli::board::device_loop::{DeviceLoop, DeviceLoopError};
use sprag_cli::board::emulator::{Emulator, Way};
use sprag_cli::board::event_table::what;
use sprag_cli::board::info::firmware;
use sprag_cli::board::line::{DeviceError, Line};
use sprag_cli::board::session::Session;
use sprag_cli::board::{image, parameters, serial, setting_text};
use sprag_shared::control::supervisor::event_log::{Entry, Kind};
use sprag_sim::closed_loop::LoopTask;
use sprag_sim::interrupt::Interrupt;

use crate::closed_loop::{LoopOf, run};
use crate::errors::{Raise as _, refused, silent};
use crate::long_call::long_call;
use crate::scene::Scene;

/// Where a board is: the system's name of a serial port, or the image for an emulator.
#[derive(FromPyObject)]
pub struct Place {
    port: Option<String>,
    image: Option<PathBuf>,
}

impl Place {
    fn line(&self) -> Result<Box<dyn Line>, DeviceError> {
        match (&self.port, &self.image) {
            (Some(port), _) => serial::open(port),
            (None, image) => {
                let image = image.clone().unwrap_or_default();
                image::check(&image)?;
                Ok(Box::new(Emulator::start(image::Image::File(image), Way::Streams, None)?))
            }
        }
    }

    /// Talks to the board without the interpreter's lock.
    fn talk<T: Send>(
        &self,
        py: Python<'_>,
        talk: impl FnOnce(&mut Session<Box<dyn Line>>, &Interrupt) -> PyResult<T> + Send,
    ) -> PyResult<T> {
        long_call(py, |interrupt| talk(&mut Session::new(self.line().map_err(silent)?), interrupt))?
    }
}

/// Who a board is and how it is, as JSON.
///
/// # Errors
/// `BoardError`.
#[pyfunction]
pub fn board_info(py: Python<'_>, place: Place) -> PyResult<String> {
    place.talk(py, |session, _| {
        let identity = session.identify().map_err(silent)?;
        let state = session.state().map_err(silent)?;
        let mut info = Map::new();
        info.insert("firmware".to_owned(), firmware(&identity).into());
        for part in [serde_json::to_value(identity), serde_json::to_value(state)] {
            let Value::Object(part) = part.map_err(refused)? else { continue };
            // Bytes of texts that the firmware's name has.
            info.extend(part.into_iter().filter(|(key, _)| !["build", "board"].contains(&key.as_str())));
        }
        serde_json::to_string(&info).map_err(refused)
    })
}

/// The settings of a board, with `changes` where there are any, as JSON; with `store` they are kept in its flash.
///
/// # Errors
/// `BoardError`, and `InputError` for a change that cannot be.
#[pyfunction]
pub fn board_settings(py: Python<'_>, place: Place, changes: Vec<(String, String)>, store: bool) -> PyResult<String> {
    place.talk(py, |session, _| {
        let mut settings = parameters::read(session).map_err(silent)?;
        if store || !changes.is_empty() {
            let each = changes.iter().map(|(name, value)| (name.as_str(), value.as_str()));
            setting_text::assign(&mut settings, each).map_err(refused)?;
            setting_text::check(&settings).map_err(refused)?;
            parameters::write(session, &settings, store).map_err(silent)?;
        }
        let table: toml::Table = setting_text::to_toml(&settings).parse().map_err(refused)?;
        serde_json::to_string(&table).map_err(refused)
    })
}

/// The event log of a board, as a dict of columns.
///
/// # Errors
/// `BoardError`.
#[pyfunction]
pub fn board_log<'py>(py: Python<'py>, place: Place) -> PyResult<Bound<'py, PyDict>> {
    let (entries, period) = place.talk(py, |session, _| {
        let period = f64::from(parameters::read(session).map_err(silent)?.period());
        Ok((session.log().map_err(silent)?.0, period))
    })?;
    let column = |pick: &dyn Fn(&Entry) -> f64| entries.iter().map(pick).collect::<Vec<f64>>().into_pyarray(py);
    let code = |entry: &Entry| match entry.kind {
        Kind::Fault(code) | Kind::Warning(code) => code,
        _ => 0,
    };
    let dict = PyDict::new(py);
    dict.set_item("tick", entries.iter().map(|entry| entry.tick).collect::<Vec<u32>>().into_pyarray(py))?;
    dict.set_item("time_s", column(&|entry| f64::from(entry.tick) * period))?;
    dict.set_item("rotation_rad", column(&|entry| entry.rotation.into()))?;
    dict.set_item("velocity_rad_s", column(&|entry| entry.velocity.into()))?;
    dict.set_item("what", entries.iter().map(|entry| what(entry.kind)).collect::<Vec<String>>())?;
    dict.set_item("fault_code", entries.iter().map(code).collect::<Vec<u16>>().into_pyarray(py))?;
    Ok(dict)
}

/// The loop of a scene closed by the board in the place of the host's controller: a dict of the board's loop, the host's own, and how many
/// decisions differ.
///
/// # Errors
/// `BoardError`, and those of `closed_loop`.
#[pyfunction]
pub fn board_loop<'py>(
    py: Python<'py>,
    place: Place,
    scene: &Scene,
    device: Option<usize>,
    seed: Option<u64>,
) -> PyResult<Bound<'py, PyDict>> {
    let LoopOf { desk, index, seed } = LoopOf::new(scene, device, seed)?;
    let made = long_call(py, |interrupt| -> PyResult<_> {
        let (closeness, host) = run(&desk, index, seed, interrupt, None).map_err(|failure| failure.raise())?;
        let task = LoopTask { closeness, ..desk.task(index, seed, interrupt) };
        let line = place.line().map_err(silent)?;
        let closed = DeviceLoop::run(&task, line, host.ideal.clone()).map_err(|error| match error {
            DeviceLoopError::Device(error) => silent(error),
            DeviceLoopError::Loop(failure) => failure.raise(),
        })?;
        Ok((host, closed))
    })?;
    let (host, DeviceLoop { mut report, farewell, .. }) = made?;
    report.summary.error = host.summary.error;
    let dict = PyDict::new(py);
    dict.set_item("differing", farewell.ticks.iter().filter(|tick| tick.differs).count())?;
    dict.set_item("firmware", firmware(&farewell.identity))?;
    dict.set_item("board", crate::closed_loop::dict(py, report, &desk)?)?;
    dict.set_item("host", crate::closed_loop::dict(py, host, &desk)?)?;
    Ok(dict)
}
