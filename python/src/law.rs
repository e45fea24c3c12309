//! Clutch laws that are functions of Python.

use std::sync::{Arc, Mutex, PoisonError};

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use sprag_shared::control::law::{Law, Situation as SharedSituation, Wish};
use sprag_shared::math::sign::Sign;
use sprag_sim::interrupt::Interrupt;

use crate::value::is_bool;

/// What a clutch law can know at a control tick, in the single precision of the controller.
///
/// The motion is that at the instant at which a command given now takes effect, or that of now for a law that does not predict.
#[pyclass(frozen, get_all, module = "sprag")]
#[derive(PartialEq)]
pub struct Situation {
    /// θ, rad.
    rotation_rad: f32,
    /// θ̇, rad/s.
    velocity_rad_s: f32,
    /// Quantity with the sign of the terminals' acceleration (Eq. 10), 1/s².
    push_1_s2: f32,
    /// Ground acceleration, horizontal, g.
    ground_g: f32,
    /// Ground acceleration, vertical, g.
    ground_vertical_g: f32,
    /// Growth of the horizontal ground acceleration, g/s.
    ground_rate_g_s: f32,
    /// Velocity that the ground has lately gained, g/p: the integral of its acceleration, fading within 3/p.
    ground_drift: f32,
    /// Whether the block stands on both toes.
    standing: bool,
    /// Sign of θ, with hysteresis: 1 or -1, as of the next three.
    rotation_sign: i8,
    /// Sign of θ̇.
    velocity_sign: i8,
    /// Sign of the terminals' acceleration.
    push_sign: i8,
    /// Sign of the ground acceleration.
    ground_sign: i8,
    /// Whether each clutch is engaged.
    engaged: (bool, bool),
    /// Speed of each flywheel over R, as a rack that moved with it, 1/s.
    spins_1_s: (f32, f32),
    /// α that the controller believes in, rad.
    slenderness_rad: f32,
    /// p that the controller believes in, 1/s.
    frequency_parameter_1_s: f32,
    /// Ground acceleration at which the block uplifts, g.
    uplift_threshold_g: f32,
}

impl From<&SharedSituation<'_>> for Situation {
    fn from(at: &SharedSituation<'_>) -> Situation {
        let sign = |sign: Sign| if sign == Sign::Positive { 1 } else { -1 };
        let (estimate, parameters) = (&at.estimate, &at.model.parameters);
        Situation {
            rotation_rad: estimate.rotation,
            velocity_rad_s: estimate.velocity,
            push_1_s2: estimate.push,
            ground_g: estimate.ground[0],
            ground_vertical_g: estimate.ground[1],
            ground_rate_g_s: estimate.ground_rate,
            ground_drift: at.ground_drift,
            standing: estimate.standing,
            rotation_sign: sign(at.signs.rotation),
            velocity_sign: sign(at.signs.velocity),
            push_sign: sign(at.signs.push),
            ground_sign: sign(at.signs.ground),
            engaged: at.engaged.into(),
            spins_1_s: at.spins.into(),
            slenderness_rad: parameters.slenderness,
            frequency_parameter_1_s: parameters.frequency,
            uplift_threshold_g: parameters.uplift,
        }
    }
}

#[pymethods]
impl Situation {
    fn __eq__(&self, other: &Situation) -> bool {
        self == other
    }

    fn __hash__(&self) -> u64 {
        // A negative zero is equal to a positive one.
        let [rotation, velocity] = [self.rotation_rad, self.velocity_rad_s].map(|number| u64::from((number + 0.0).to_bits()));
        rotation ^ velocity.rotate_left(32)
    }

    fn __repr__(&self) -> String {
        let Situation { rotation_rad, velocity_rad_s, push_1_s2, ground_g, .. } = self;
        format!(
            "<Situation: rotation_rad={rotation_rad:?}, velocity_rad_s={velocity_rad_s:?}, push_1_s2={push_1_s2:?}, ground_g={ground_g:?}>"
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Pickled)> {
        let at = slf.get();
        let state = (
            [at.rotation_rad, at.velocity_rad_s, at.push_1_s2],
            [at.ground_g, at.ground_vertical_g, at.ground_rate_g_s, at.ground_drift],
            at.standing,
            [at.rotation_sign, at.velocity_sign, at.push_sign, at.ground_sign],
            at.engaged,
            at.spins_1_s,
            [at.slenderness_rad, at.frequency_parameter_1_s, at.uplift_threshold_g],
        );
        Ok((slf.get_type().getattr("_restored")?, state))
    }

    /// What was pickled.
    #[staticmethod]
    fn _restored(
        motion: [f32; 3],
        ground: [f32; 4],
        standing: bool,
        signs: [i8; 4],
        engaged: (bool, bool),
        spins_1_s: (f32, f32),
        model: [f32; 3],
    ) -> Situation {
        let [rotation_rad, velocity_rad_s, push_1_s2] = motion;
        let [ground_g, ground_vertical_g, ground_rate_g_s, ground_drift] = ground;
        let [rotation_sign, velocity_sign, push_sign, ground_sign] = signs;
        let [slenderness_rad, frequency_parameter_1_s, uplift_threshold_g] = model;
        Situation {
            rotation_rad,
            velocity_rad_s,
            push_1_s2,
            ground_g,
            ground_vertical_g,
            ground_rate_g_s,
            ground_drift,
            standing,
            rotation_sign,
            velocity_sign,
            push_sign,
            ground_sign,
            engaged,
            spins_1_s,
            slenderness_rad,
            frequency_parameter_1_s,
            uplift_threshold_g,
        }
    }
}

/// The state of a pickled situation.
type Pickled = ([f32; 3], [f32; 4], bool, [i8; 4], (bool, bool), (f32, f32), [f32; 3]);

/// A function of Python as a clutch law. What it raises ends the loop.
#[derive(Clone)]
pub struct PythonLaw {
    function: Arc<Py<PyAny>>,
    predicts: bool,
    failure: Arc<Mutex<Option<PyErr>>>,
    interrupt: Interrupt,
}

impl PythonLaw {
    /// Of `function`; `interrupt` is that of the loop.
    pub fn new(function: Py<PyAny>, predicts: bool, interrupt: &Interrupt) -> PythonLaw {
        PythonLaw { function: Arc::new(function), predicts, failure: Arc::default(), interrupt: interrupt.clone() }
    }

    /// What the function raised, if it did.
    pub fn failure(&self) -> Option<PyErr> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn asked(&self, at: &SharedSituation<'_>) -> PyResult<Wish> {
        Python::attach(|py| {
            // A function that is not written in Python does not look for Ctrl-C.
            py.check_signals()?;
            let answer = self.function.bind(py).call1((Situation::from(at),))?;
            let wish = if is_bool(&answer)? { answer.is_truthy().map(u8::from) } else { answer.extract() };
            match wish {
                Ok(0) => Ok(Wish::Release),
                Ok(1) => Ok(Wish::Resist),
                Ok(2) => Ok(Wish::Hold),
                _ => {
                    Err(PyTypeError::new_err(format!("a clutch law returns a bool or a sprag.Wish, and not {}", answer.repr()?)))
                }
            }
        })
    }
}

impl Law for PythonLaw {
    fn wish(&self, at: &SharedSituation<'_>) -> Wish {
        // The loop looks for the interrupt every few thousand ticks.
        if self.interrupt.is_set() {
            return Wish::Release;
        }
        self.asked(at).unwrap_or_else(|error| {
            *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
            self.interrupt.set();
            Wish::Release
        })
    }

    fn predicts(&self) -> bool {
        self.predicts
    }
}
