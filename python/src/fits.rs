//! Demand models and fragilities of anybody's runs.

use std::fmt::Display;

use numpy::{IntoPyArray as _, PyArray1};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use sprag_studies::statistics::{
    Band, Bootstrap, BootstrapError, CurveBand, DemandPoint, Fragility as Fit, FragilityCurve, FragilityError, Level,
    Observation, ObservationError, PowerLaw as Law, PowerLawError, fragility as fitted, fragility_bands,
};

use crate::errors::{Raise, failed, missing, range};
use crate::long_call::long_call;
use crate::record::numbers;
use crate::threads;
use crate::value::whole;

/// What the number of resamples may be.
const RESAMPLES: &str = "from 1 to 1000000";

/// A column of numbers.
type Column<'py> = Bound<'py, PyArray1<f64>>;

/// Median demand as a power of an intensity measure, D = a IM^b, fitted by least squares to the logarithms
/// (Thiers-Moggia and Málaga-Chuquitaype 2019, Eq. 24-25; Cornell et al. 2002).
#[pyclass(frozen, module = "sprag", name = "DemandModel")]
pub struct DemandModel {
    law: Law,
    points: Vec<DemandPoint>,
}

#[pymethods]
impl DemandModel {
    /// a, the median demand at IM = 1, in the unit of the demand.
    #[getter]
    fn a(&self) -> f64 {
        self.law.a
    }

    /// Exponent b.
    #[getter]
    fn b(&self) -> f64 {
        self.law.b
    }

    /// Standard error of ln a.
    #[getter]
    fn ln_a_standard_error(&self) -> f64 {
        self.law.ln_a_standard_error
    }

    /// Standard error of b.
    #[getter]
    fn b_standard_error(&self) -> f64 {
        self.law.b_standard_error
    }

    /// R², 0 to 1; None if all demands are equal.
    #[getter]
    fn r_squared(&self) -> Option<f64> {
        self.law.r_squared
    }

    /// β of D given IM: the standard deviation of ln D about the law, with n − 2 degrees of freedom.
    #[getter]
    fn dispersion(&self) -> f64 {
        self.law.dispersion
    }

    /// n, the points.
    #[getter]
    fn number(&self) -> u32 {
        self.law.number
    }

    /// Median demand at each intensity.
    #[pyo3(signature = (intensity))]
    fn median<'py>(&self, py: Python<'py>, intensity: &Bound<'py, PyAny>) -> PyResult<Column<'py>> {
        Ok(intensities(intensity)?.into_iter().map(|im| self.law.median(im)).collect::<Vec<_>>().into_pyarray(py))
    }

    /// Where the median at each intensity lies with the probability `level`: lower and upper ends.
    #[pyo3(signature = (intensity, *, level = 0.95))]
    fn median_band<'py>(
        &self,
        py: Python<'py>,
        intensity: &Bound<'py, PyAny>,
        level: f64,
    ) -> PyResult<(Column<'py>, Column<'py>)> {
        let level = confidence(level)?;
        Ok(ends(py, intensities(intensity)?.into_iter().map(|im| self.law.median_band(im, level))))
    }

    /// Where the demand of one more run at each intensity lies with the probability `level`: lower and upper ends.
    #[pyo3(signature = (intensity, *, level = 0.95))]
    fn prediction_band<'py>(
        &self,
        py: Python<'py>,
        intensity: &Bound<'py, PyAny>,
        level: f64,
    ) -> PyResult<(Column<'py>, Column<'py>)> {
        let level = confidence(level)?;
        Ok(ends(py, intensities(intensity)?.into_iter().map(|im| self.law.prediction_band(im, level))))
    }

    /// What was pickled.
    #[staticmethod]
    fn _fitted(intensity: &Bound<'_, PyAny>, demand: &Bound<'_, PyAny>) -> PyResult<DemandModel> {
        let (intensities, demands) = (numbers(intensity, "intensity")?, numbers(demand, "demand")?);
        same_length("demand", demands.len(), intensities.len())?;
        let points: Vec<DemandPoint> =
            intensities.into_iter().zip(demands).map(|(intensity, demand)| DemandPoint { intensity, demand }).collect();
        let law = Law::fit(&points).map_err(|error| error.raise())?;
        Ok(DemandModel { law, points })
    }

    fn __eq__(&self, other: &DemandModel) -> bool {
        self.law == other.law
    }

    fn __hash__(&self) -> u64 {
        self.law.ln_a.to_bits() ^ self.law.b.to_bits().rotate_left(1)
    }

    fn __repr__(&self) -> String {
        let Law { a, b, dispersion, number, .. } = self.law;
        format!("<DemandModel: {a:.6} IM^{b:.6}, dispersion {dispersion:.6}, {number} points>")
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Column<'py>, Column<'py>))> {
        let column = |pick: fn(&DemandPoint) -> f64| slf.get().points.iter().map(pick).collect::<Vec<_>>().into_pyarray(slf.py());
        let function = slf.get_type().getattr("_fitted")?;
        Ok((function, (column(|point| point.intensity), column(|point| point.demand))))
    }
}

/// Fits the demand model of runs that did not overturn.
///
/// Raises
/// ------
/// InputError
///     For fewer than three points, one that is not positive and finite, and intensities that are all equal.
#[pyfunction]
#[pyo3(signature = (*, intensity, demand))]
pub fn demand(intensity: &Bound<'_, PyAny>, demand: &Bound<'_, PyAny>) -> PyResult<DemandModel> {
    DemandModel::_fitted(intensity, demand)
}

/// Probability of overturning P(IM) = Φ((ln IM − μ)/β) by maximum likelihood (Thiers-Moggia and Málaga-Chuquitaype 2019,
/// Eq. 26), or why the runs have none.
#[pyclass(frozen, module = "sprag", name = "Fragility")]
pub struct Fragility {
    fit: Fit,
    observations: Vec<Observation>,
}

impl Fragility {
    fn curve(&self) -> PyResult<&FragilityCurve> {
        self.fit.curve().ok_or_else(|| failed(self.fit.to_string()))
    }
}

#[pymethods]
impl Fragility {
    /// Why there is no curve; None where there is one.
    #[getter]
    fn reason(&self) -> Option<String> {
        self.fit.reason()
    }

    /// Intensity at which half of the blocks overturn, e^μ; None without a curve.
    #[getter]
    fn median(&self) -> Option<f64> {
        self.fit.curve().map(|curve| curve.median)
    }

    /// Dispersion β; None without a curve.
    #[getter]
    fn dispersion(&self) -> Option<f64> {
        self.fit.curve().map(|curve| curve.beta)
    }

    /// Standard error of μ, the logarithm of the median; None without a curve.
    #[getter]
    fn ln_median_standard_error(&self) -> Option<f64> {
        self.fit.curve().map(|curve| curve.mu_standard_error)
    }

    /// Standard error of β; None without a curve.
    #[getter]
    fn dispersion_standard_error(&self) -> Option<f64> {
        self.fit.curve().map(|curve| curve.beta_standard_error)
    }

    /// Log-likelihood, without binomial coefficients; None without a curve.
    #[getter]
    fn ln_likelihood(&self) -> Option<f64> {
        self.fit.curve().map(|curve| curve.ln_likelihood)
    }

    /// Probability of overturning at each intensity; RunError without a curve.
    fn probability<'py>(&self, py: Python<'py>, intensity: &Bound<'py, PyAny>) -> PyResult<Column<'py>> {
        let curve = self.curve()?;
        Ok(intensities(intensity)?.into_iter().map(|im| curve.probability(im)).collect::<Vec<_>>().into_pyarray(py))
    }

    /// Where that probability lies with the probability `level`, by the delta method: lower and upper ends; RunError without a curve.
    #[pyo3(signature = (intensity, *, level = 0.95))]
    fn band<'py>(&self, py: Python<'py>, intensity: &Bound<'py, PyAny>, level: f64) -> PyResult<(Column<'py>, Column<'py>)> {
        let (curve, level) = (self.curve()?, confidence(level)?);
        Ok(ends(py, intensities(intensity)?.into_iter().map(|im| curve.band(im, level))))
    }

    /// The same by resampling the runs (Efron and Tibshirani 1993), as a dict: `low`, `median` and `high` of the probability at each
    /// intensity, NaN where no resample has a curve, and the share of resamples that have none.
    #[pyo3(signature = (intensity, *, level = 0.95, resamples = None, seed = None, threads = None), text_signature = "($self, intensity, *, level=0.95, resamples=1000, seed=1, threads=None)")]
    fn bootstrap<'py>(
        &self,
        py: Python<'py>,
        intensity: &Bound<'py, PyAny>,
        level: f64,
        resamples: Option<&Bound<'py, PyAny>>,
        seed: Option<&Bound<'py, PyAny>>,
        threads: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let seed = seed.map_or(Ok(1), |seed| {
            seed.extract().map_err(|_| range("seed", seed, "a whole number from 0 to 18446744073709551615"))
        })?;
        let resamples = resamples.map_or(Ok(1000), |resamples| whole(resamples, "resamples", RESAMPLES))?;
        let resamples = u32::try_from(resamples).map_err(|_| resamples_refused(resamples))?;
        let bootstrap = Bootstrap { resamples, seed, level: confidence(level)? };
        let (intensities, pool) = (intensities(intensity)?, self::threads(threads)?);
        let bands =
            long_call(py, |interrupt| pool.install(|| fragility_bands(&self.observations, &intensities, bootstrap, interrupt)))?;
        let bands = bands.map_err(|error| error.raise())?;
        let dict = PyDict::new(py);
        let column = |pick: fn(&CurveBand) -> f64| {
            let mut column: Vec<f64> = bands.curve.iter().map(pick).collect();
            column.resize(intensities.len(), f64::NAN);
            column.into_pyarray(py)
        };
        dict.set_item("low", column(|at| at.band.low))?;
        dict.set_item("median", column(|at| at.median))?;
        dict.set_item("high", column(|at| at.band.high))?;
        dict.set_item("share_without_estimate", bands.share_without_estimate)?;
        Ok(dict)
    }

    /// What was pickled.
    #[staticmethod]
    fn _fitted(
        intensity: &Bound<'_, PyAny>,
        overturned: &Bound<'_, PyAny>,
        of: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Fragility> {
        let intensities = numbers(intensity, "intensity")?;
        let overturned = counts(overturned, "overturned")?;
        let of = of.map_or_else(|| Ok(vec![1; intensities.len()]), |of| counts(of, "of"))?;
        same_length("overturned", overturned.len(), intensities.len())?;
        same_length("of", of.len(), intensities.len())?;
        let observation = |((intensity, overturned), of)| Observation { intensity, overturned, of };
        let observations: Vec<Observation> = intensities.into_iter().zip(overturned).zip(of).map(observation).collect();
        let fit = fitted(&observations).map_err(|error| error.raise())?;
        Ok(Fragility { fit, observations })
    }

    fn __eq__(&self, other: &Fragility) -> bool {
        self.fit == other.fit
    }

    fn __hash__(&self) -> u64 {
        self.fit.curve().map_or(0, |curve| curve.mu.to_bits() ^ curve.beta.to_bits().rotate_left(1))
    }

    fn __repr__(&self) -> String {
        format!("<Fragility: {}>", self.fit)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Column<'py>, Column<'py>, Column<'py>))> {
        let py = slf.py();
        let column = |pick: fn(&Observation) -> f64| slf.get().observations.iter().map(pick).collect::<Vec<_>>().into_pyarray(py);
        let function = slf.get_type().getattr("_fitted")?;
        let state = (column(|one| one.intensity), column(|one| f64::from(one.overturned)), column(|one| f64::from(one.of)));
        Ok((function, state))
    }
}

/// Fits the fragility of runs: `overturned` of `of` runs at each intensity, of 1 by default.
///
/// Raises
/// ------
/// InputError
///     Without a run, and for an intensity that is not positive and finite.
#[pyfunction]
#[pyo3(signature = (*, intensity, overturned, of = None))]
pub fn fragility(
    intensity: &Bound<'_, PyAny>,
    overturned: &Bound<'_, PyAny>,
    of: Option<&Bound<'_, PyAny>>,
) -> PyResult<Fragility> {
    Fragility::_fitted(intensity, overturned, of)
}

/// Whole numbers.
fn counts(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<u32>> {
    let whole = |(index, number): (usize, f64)| {
        if number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0 {
            Ok(number as u32)
        } else {
            Err(range(&format!("{name}.{index}"), number, "a whole number from 0"))
        }
    };
    numbers(object, name)?.into_iter().enumerate().map(whole).collect()
}

/// Intensities at which something is asked for: positive and finite.
fn intensities(object: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let intensities = numbers(object, "intensity")?;
    match intensities.iter().position(|im| !(*im > 0.0 && im.is_finite())) {
        Some(index) => Err(range(&format!("intensity.{index}"), intensities[index], "above 0 and finite")),
        None => Ok(intensities),
    }
}

fn same_length(name: &str, found: usize, expected: usize) -> PyResult<()> {
    if found == expected { Ok(()) } else { Err(range(name, format_args!("of length {found}"), &format!("of length {expected}"))) }
}

fn confidence(level: f64) -> PyResult<Level> {
    Level::new(level).map_err(|_| range("level", level, "above 0 and below 1"))
}

fn resamples_refused(value: impl Display) -> PyErr {
    range("resamples", value, RESAMPLES)
}

/// Lower and upper ends of `bands`.
fn ends<'py>(py: Python<'py>, bands: impl Iterator<Item = Band>) -> (Column<'py>, Column<'py>) {
    let (low, high): (Vec<f64>, Vec<f64>) = bands.map(|band| (band.low, band.high)).unzip();
    (low.into_pyarray(py), high.into_pyarray(py))
}

impl Raise for PowerLawError {
    fn raise(self) -> PyErr {
        match self {
            PowerLawError::Number { found } => range("intensity", format_args!("of length {found}"), "of length 3 or more"),
            PowerLawError::Intensity { index, value } => range(&format!("intensity.{index}"), value, "above 0 and finite"),
            PowerLawError::Demand { index, value } => range(&format!("demand.{index}"), value, "above 0 and finite"),
            PowerLawError::EqualIntensities { value, .. } => range("intensity", value, "two that differ"),
        }
    }
}

impl Raise for ObservationError {
    fn raise(self) -> PyErr {
        match self {
            ObservationError::None => missing("intensity", "one run or more"),
            ObservationError::Intensity { index, value } => range(&format!("intensity.{index}"), value, "above 0 and finite"),
            ObservationError::NoRuns { index } => range(&format!("of.{index}"), 0, "1 or more"),
            ObservationError::Overturned { index, overturned, of } => {
                range(&format!("overturned.{index}"), overturned, &format!("from 0 to {of}"))
            }
        }
    }
}

impl Raise for FragilityError {
    fn raise(self) -> PyErr {
        match self {
            FragilityError::Observation(error) => error.raise(),
            FragilityError::NotConverged { .. } => failed(self),
        }
    }
}

impl Raise for BootstrapError {
    fn raise(self) -> PyErr {
        match self {
            BootstrapError::Resamples { value } => resamples_refused(value),
            BootstrapError::Intensity { index, value } => range(&format!("intensity.{index}"), value, "above 0 and finite"),
            BootstrapError::Observation(error) => error.raise(),
            BootstrapError::Resample { .. } => failed(self),
            BootstrapError::Interrupted => PyKeyboardInterrupt::new_err(()),
        }
    }
}
