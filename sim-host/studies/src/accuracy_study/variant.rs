//! The ways to follow a motion.

use std::fmt;

use sprag_sim::scene::accuracy::EventTreatment;

/// How the equation of motion is integrated between events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Method {
    /// Order 1.
    SemiImplicitEuler,
    /// Order 4.
    RungeKutta4,
    /// Power series of the solution, steps of its own choice.
    Taylor,
    /// Exact between events; for the slender block under lines and sines.
    ClosedForm,
}

impl Method {
    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Method::SemiImplicitEuler => "semi-implicit-euler",
            Method::RungeKutta4 => "runge-kutta-4",
            Method::Taylor => "taylor",
            Method::ClosedForm => "closed-form",
        }
    }
}

/// The number type, and where its sines come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Number {
    /// f64, sines of libm: what this program uses.
    F64Libm,
    /// f64, sines by an own polynomial.
    F64Own,
    /// f32, sines by an own polynomial: what the microcontroller uses.
    F32Own,
    /// f32, sines of libm.
    F32Libm,
    /// f32, sines of micromath.
    F32Micromath,
}

impl Number {
    /// All number types.
    pub const ALL: [Number; 5] = [Number::F64Libm, Number::F64Own, Number::F32Own, Number::F32Libm, Number::F32Micromath];

    /// "f64" or "f32".
    pub fn precision(self) -> &'static str {
        match self {
            Number::F64Libm | Number::F64Own => "f64",
            Number::F32Own | Number::F32Libm | Number::F32Micromath => "f32",
        }
    }

    /// Where its sines come from.
    pub fn math(self) -> &'static str {
        match self {
            Number::F64Libm | Number::F32Libm => "libm",
            Number::F64Own | Number::F32Own => "own-polynomial",
            Number::F32Micromath => "micromath",
        }
    }
}

/// What is turned to make a method more accurate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// A fixed step, in 1/p.
    Step(f64),
    /// Size of the last terms of the series over the rotation that matters.
    Tolerance(f64),
}

impl Setting {
    /// The number itself.
    pub fn value(self) -> f64 {
        match self {
            Setting::Step(value) | Setting::Tolerance(value) => value,
        }
    }

    /// "step" or "tolerance".
    pub fn name(self) -> &'static str {
        match self {
            Setting::Step(_) => "step",
            Setting::Tolerance(_) => "tolerance",
        }
    }
}

/// One way to follow a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// What it has in common with those that differ in the setting only.
    pub family: Family,
    /// Step or tolerance.
    pub setting: Setting,
}

/// Variants that differ in the setting only: a line of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family {
    /// Between events.
    pub method: Method,
    /// Whether events are located, or noticed at the ends of steps.
    pub events: EventTreatment,
    /// The numbers.
    pub number: Number,
}

impl Family {
    /// "located" or "step-end".
    pub fn events(&self) -> &'static str {
        match self.events {
            EventTreatment::Located => "located",
            EventTreatment::StepEnd => "step-end",
        }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let method = match self.method {
            Method::SemiImplicitEuler => "Euler",
            Method::RungeKutta4 => "RK4",
            Method::Taylor => "Taylor",
            Method::ClosedForm => "closed form",
        };
        let events = match (self.method, self.events) {
            (_, EventTreatment::StepEnd) => ", events at step ends",
            (Method::Taylor | Method::ClosedForm, _) => "",
            _ => ", events located",
        };
        let math = match self.number {
            Number::F64Libm | Number::F32Own => "",
            other => other.math(),
        };
        write!(formatter, "{method} {}{}{math}{events}", self.number.precision(), if math.is_empty() { "" } else { " " })
    }
}

/// Steps of the fixed-step methods, in 1/p.
pub const STEPS: [f64; 9] = [0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4, 3e-5];

/// Tolerances of the series.
pub const TOLERANCES: [f64; 8] = [1e-2, 1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13, 1e-15];

/// Below this many steps to a unit of time sines of other sources are not tried: they change the error, not how it falls.
const SMALLEST_STEP_OF_OTHERS: f64 = 3e-4;

/// All variants, those with steps from `smallest` (in 1/p) on; the closed form only where it applies.
pub fn variants(closed_form: bool, smallest: f64) -> Vec<Variant> {
    let mut variants = Vec::new();
    let mut steps = |method, events, number, from: f64| {
        let steps = STEPS.iter().filter(|step| **step >= from * (1.0 - 1e-9));
        let family = Family { method, events, number };
        variants.extend(steps.map(|&step| Variant { family, setting: Setting::Step(step) }));
    };
    let (located, step_end) = (EventTreatment::Located, EventTreatment::StepEnd);
    for method in [Method::SemiImplicitEuler, Method::RungeKutta4] {
        for number in [Number::F64Libm, Number::F32Own] {
            steps(method, step_end, number, smallest);
            steps(method, located, number, smallest);
        }
    }
    for number in [Number::F64Own, Number::F32Libm, Number::F32Micromath] {
        steps(Method::RungeKutta4, step_end, number, smallest.max(SMALLEST_STEP_OF_OTHERS));
    }
    steps(Method::Taylor, located, Number::F32Own, smallest.max(SMALLEST_STEP_OF_OTHERS));
    if closed_form {
        for number in [Number::F64Libm, Number::F32Own] {
            steps(Method::ClosedForm, located, number, smallest);
        }
    }
    let family = Family { method: Method::Taylor, events: located, number: Number::F64Libm };
    variants.extend(TOLERANCES.map(|tolerance| Variant { family, setting: Setting::Tolerance(tolerance) }));
    variants
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_method_number_and_treatment_is_there_once() {
        let all = variants(true, 1e-9);
        for (index, one) in all.iter().enumerate() {
            assert!(all[..index].iter().all(|other| other != one), "{one:?} twice");
        }
        for method in [Method::SemiImplicitEuler, Method::RungeKutta4, Method::Taylor, Method::ClosedForm] {
            assert!(all.iter().any(|variant| variant.family.method == method));
        }
        assert!(Number::ALL.iter().all(|number| all.iter().any(|variant| variant.family.number == *number)));
        assert!(variants(false, 1e-2).iter().all(|variant| variant.family.method != Method::ClosedForm));
        assert!(variants(false, 1e-2).iter().all(|v| !matches!(v.setting, Setting::Step(step) if step < 1e-2)));
    }

    #[test]
    fn families_have_names_of_their_own() {
        let mut names: Vec<String> = Vec::new();
        for variant in variants(true, 1e-9) {
            let name = variant.family.to_string();
            if names.last() != Some(&name) {
                assert!(!names.contains(&name), "{name}");
                names.push(name);
            }
        }
    }
}
