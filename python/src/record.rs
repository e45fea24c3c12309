//! Recorded ground motions.

use std::fmt::Display;
use std::path::PathBuf;

use numpy::{IntoPyArray as _, PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyByteArray, PyBytes, PyComplex, PyString, PyTuple};
use sprag_shared::math::fnv::Fnv;
use sprag_sim::record::intensity::{cumulative_absolute_velocity_m_s, uniform_duration_s};
use sprag_sim::record::{Component, Header, Intensity, ReadOptions, Record as SimRecord, StatedStep, TIME_STEP_RANGE_S, Units};

use crate::errors::{Raise as _, by_argument, input, range};
use crate::long_call::long_call;

/// Recorded ground acceleration with equal time steps, in SI units; linear between its samples.
///
/// Parameters
/// ----------
/// acceleration
///     Samples, one-dimensional, two or more, finite, up to 1e5 m/s².
/// time_step_s
///     Time step, 1e-5 to 1 s.
/// units
///     Of the samples: g, m/s2, cm/s2 (gal), mm/s2, in/s2 or ft/s2.
/// name
///     Its name in messages and tables.
///
/// Raises
/// ------
/// InputError
///     For a value outside its range.
#[pyclass(frozen, module = "sprag")]
pub struct Record {
    pub(crate) record: SimRecord,
    format: String,
    warnings: Vec<String>,
    intensity: PyOnceLock<Intensity>,
    samples: PyOnceLock<Py<PyArray1<f64>>>,
}

impl Record {
    fn of(record: SimRecord) -> Record {
        let warnings = record.warnings.iter().map(|warning| by_argument(&warning.to_string())).collect();
        let format = record.format.name().to_owned();
        Record { record, format, warnings, intensity: PyOnceLock::new(), samples: PyOnceLock::new() }
    }

    fn intensity(&self, py: Python<'_>) -> &Intensity {
        self.intensity.get_or_init(py, || Intensity::of(&self.record))
    }
}

/// Units by their name.
fn units_of(name: &str) -> PyResult<Units> {
    name.parse().map_err(|_| range("units", name, Units::ALLOWED))
}

/// A copy of a one-dimensional array of numbers, whatever it is made of.
pub fn numbers<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    let numpy = object.py().import("numpy")?;
    let refused = |reason: &dyn Display| {
        let range = "an array of real numbers";
        input(&format!("{name} must be {range}: {reason}"), Some(name), None, Some(range))
    };
    let of = |object: &Bound<'py, PyAny>, dtype: Option<&str>| {
        numpy.call_method1("asarray", (object, dtype)).map_err(|error| refused(error.value(object.py())))
    };
    let ma = numpy.getattr("ma")?;
    if object.is_instance(&ma.getattr("MaskedArray")?)? && ma.call_method1("is_masked", (object,))?.is_truthy()? {
        return Err(refused(&"it has masked values"));
    }
    let array = of(object, None)?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    if shape.len() != 1 {
        return Err(range(name, format_args!("of shape {shape:?}"), "one-dimensional"));
    }
    // Texts, times and the real parts of complex numbers would be taken for numbers.
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if !"biufO".contains(&kind) {
        return Err(refused(&dtype));
    }
    if kind == "O" {
        let [complex, date, span] = ["complexfloating", "datetime64", "timedelta64"].map(|name| numpy.getattr(name));
        let others = PyTuple::new(object.py(), [complex?, date?, span?])?;
        for item in array.try_iter()? {
            let item = item?;
            let is_text =
                item.is_instance_of::<PyString>() || item.is_instance_of::<PyBytes>() || item.is_instance_of::<PyByteArray>();
            if is_text || item.is_instance_of::<PyComplex>() || item.is_instance(&others)? {
                return Err(refused(&item.get_type().name()?));
            }
        }
    }
    Ok(of(&array, Some("float64"))?.extract::<PyReadonlyArray1<'_, f64>>()?.as_array().to_vec())
}

#[pymethods]
impl Record {
    #[new]
    #[pyo3(signature = (acceleration, *, time_step_s, units = "m/s2", name = "array"))]
    fn new(acceleration: &Bound<'_, PyAny>, time_step_s: f64, units: &str, name: &str) -> PyResult<Record> {
        let samples = numbers(acceleration, "acceleration")?;
        let units = units_of(units)?;
        SimRecord::of_samples(name, time_step_s, units, samples).map(Record::of).map_err(|error| error.raise())
    }

    /// Reads a file: PEER AT2, USGS SMC, SimCenter JSON, CSV or plain text; FILE#NAME takes one component of several.
    ///
    /// What the file says of units and time step goes first; `resample_to_s` interpolates linearly.
    ///
    /// Raises
    /// ------
    /// InputError
    ///     For a file that cannot be read, with the line where there is one.
    #[staticmethod]
    #[pyo3(signature = (path, *, units = None, time_step_s = None, component = None, resample_to_s = None))]
    fn read(
        py: Python<'_>,
        path: PathBuf,
        units: Option<&str>,
        time_step_s: Option<f64>,
        component: Option<&str>,
        resample_to_s: Option<f64>,
    ) -> PyResult<Record> {
        let units = units.map(units_of).transpose()?;
        let (lowest, highest) = TIME_STEP_RANGE_S;
        if let Some(step_s) = resample_to_s.filter(|step_s| !(lowest..=highest).contains(step_s)) {
            return Err(range("resample_to_s", step_s, &format!("from {lowest} to {highest} s")));
        }
        let options = ReadOptions { units, time_step_s, component: component.map(Component::from), resample_to_s };
        long_call(py, |_| SimRecord::read(path, &options))?.map(Record::of).map_err(|error| error.raise())
    }

    /// The file as the caller named it, or the name that was given.
    #[getter]
    fn name(&self) -> &str {
        &self.record.name
    }

    /// Layout of the file; "array" of samples in memory.
    #[getter]
    fn format(&self) -> &str {
        &self.format
    }

    /// Units of the samples in the file.
    #[getter]
    fn units(&self) -> String {
        self.record.units.to_string()
    }

    /// Component taken, if the file has names for several.
    #[getter]
    fn component(&self) -> Option<&str> {
        self.record.component.as_deref()
    }

    /// What a person should look at before the record is used, a line each.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// Time step, s.
    #[getter]
    fn time_step_s(&self) -> f64 {
        self.record.time_step_s
    }

    /// Time of the first sample, s.
    #[getter]
    fn start_time_s(&self) -> f64 {
        self.record.start_time_s
    }

    /// Time from the first to the last sample, s.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.record.duration_s()
    }

    /// Samples, m/s²; an array that cannot be written to.
    #[getter]
    fn acceleration_m_s2<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let samples = self.samples.get_or_try_init(py, || {
            let array = self.record.acceleration_m_s2.clone().into_pyarray(py);
            array.call_method1("setflags", (false,))?;
            PyResult::Ok(array.unbind())
        })?;
        Ok(samples.bind(py).clone())
    }

    /// Peak ground acceleration, m/s².
    #[getter]
    fn pga_m_s2(&self, py: Python<'_>) -> f64 {
        self.intensity(py).pga_m_s2
    }

    /// Peak ground velocity, m/s: of the acceleration's integral less its least-squares straight line.
    #[getter]
    fn pgv_m_s(&self, py: Python<'_>) -> f64 {
        self.intensity(py).pgv_m_s
    }

    /// Peak ground displacement, m: of the integral of that velocity.
    #[getter]
    fn pgd_m(&self, py: Python<'_>) -> f64 {
        self.intensity(py).pgd_m
    }

    /// Arias intensity π/(2g) ∫ a² dt, m/s (Arias 1970).
    #[getter]
    fn arias_m_s(&self, py: Python<'_>) -> f64 {
        self.intensity(py).arias_m_s
    }

    /// Time between 5 % and 95 % of the Arias intensity, s (Trifunac and Brady 1975).
    #[getter]
    fn d5_95_s(&self, py: Python<'_>) -> f64 {
        self.intensity(py).d5_95_s
    }

    /// Cumulative absolute velocity ∫ |a| dt, m/s.
    #[getter]
    fn cav_m_s(&self) -> f64 {
        cumulative_absolute_velocity_m_s(&self.record.acceleration_m_s2, self.record.time_step_s)
    }

    /// Time during which |a| exceeds `threshold_m_s2`, s.
    #[pyo3(signature = (*, threshold_m_s2))]
    fn uniform_duration_s(&self, threshold_m_s2: f64) -> PyResult<f64> {
        if !(threshold_m_s2 >= 0.0 && threshold_m_s2.is_finite()) {
            return Err(range("threshold_m_s2", threshold_m_s2, "0 m/s2 or more"));
        }
        Ok(uniform_duration_s(&self.record.acceleration_m_s2, self.record.time_step_s, threshold_m_s2))
    }

    fn __len__(&self) -> usize {
        self.record.acceleration_m_s2.len()
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let SimRecord { name, time_step_s, acceleration_m_s2, .. } = &self.record;
        let (samples, pga) = (acceleration_m_s2.len(), self.intensity(py).pga_m_s2);
        format!("<Record {name:?}: {samples} samples, time_step_s={time_step_s:?}, pga_m_s2={pga:.4}>")
    }

    fn __eq__(&self, other: &Record) -> bool {
        let SimRecord { name, time_step_s, start_time_s, units, component, acceleration_m_s2, .. } = &self.record;
        let other = &other.record;
        (name, time_step_s, start_time_s) == (&other.name, &other.time_step_s, &other.start_time_s)
            && (units, component) == (&other.units, &other.component)
            && *acceleration_m_s2 == other.acceleration_m_s2
    }

    fn __hash__(&self) -> u64 {
        let mut hash = Fnv::default();
        self.record.name.bytes().for_each(|byte| hash.byte(byte));
        // A negative zero is equal to a positive one.
        let numbers = [self.record.time_step_s].into_iter().chain(self.record.acceleration_m_s2.iter().copied());
        numbers.for_each(|number| hash.number(number + 0.0));
        hash.value()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Pickled<'py>)> {
        let (py, this) = (slf.py(), slf.get());
        let Header { title, samples, peak_m_s2, time_step } = &this.record.header;
        let state = (
            this.record.name.clone(),
            this.acceleration_m_s2(py)?,
            this.record.time_step_s,
            this.record.start_time_s,
            this.units(),
            this.record.component.clone(),
            this.format.clone(),
            this.warnings.clone(),
            (title.clone(), *samples, *peak_m_s2, time_step.map(|step| (step.value_s, step.resolution_s))),
        );
        Ok((slf.get_type().getattr("_restored")?, state))
    }

    /// What was pickled.
    #[staticmethod]
    #[expect(clippy::too_many_arguments, reason = "what a pickle holds")]
    fn _restored(
        name: String,
        samples: PyReadonlyArray1<'_, f64>,
        time_step_s: f64,
        start_time_s: f64,
        units: &str,
        component: Option<String>,
        format: String,
        warnings: Vec<String>,
        header: PickledHeader,
    ) -> PyResult<Record> {
        let (title, stated_samples, peak_m_s2, step) = header;
        let time_step = step.map(|(value_s, resolution_s)| StatedStep { value_s, resolution_s });
        let header = Header { title, samples: stated_samples, peak_m_s2, time_step };
        let samples = samples.as_array().to_vec();
        let read =
            SimRecord::of_samples(&name, time_step_s, Units::MetrePerSecondSquared, samples).map_err(|error| error.raise())?;
        let record = SimRecord { start_time_s, units: units_of(units)?, component, header, ..read };
        Ok(Record { format, warnings, ..Record::of(record) })
    }
}

/// The state of a pickled record.
type Pickled<'py> = (String, Bound<'py, PyArray1<f64>>, f64, f64, String, Option<String>, String, Vec<String>, PickledHeader);
/// Title, number of samples, peak, and time step with its resolution, as the file states them.
type PickledHeader = (String, Option<u64>, Option<f64>, Option<(f64, f64)>);
