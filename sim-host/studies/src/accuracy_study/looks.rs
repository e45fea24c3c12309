//! How the lines of work-precision diagrams look: their colours, dashes and marks.

use sprag_report::plot::LineLook;
use sprag_sim::scene::accuracy::EventTreatment;

use super::variant::{Family, Method};

/// What colours stand for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Colours {
    /// Methods; dashes for the treatment of events.
    Methods,
    /// Sources of the sine, of one method.
    Sources,
}

impl Colours {
    /// The look of the line of `family`; it has circles for f32.
    pub(super) fn look(self, family: &Family) -> LineLook {
        let open = family.number.precision() == "f32";
        match self {
            Colours::Methods => {
                let colour = METHODS.iter().position(|(method, _)| *method == family.method).unwrap_or(0);
                LineLook { colour, dashes: usize::from(family.events == EventTreatment::StepEnd), open }
            }
            Colours::Sources => {
                let colour = SOURCES.iter().position(|source| *source == family.number.math()).unwrap_or(0);
                LineLook { colour, dashes: 0, open }
            }
        }
    }
}

/// Methods in the order of their colours.
pub(super) const METHODS: [(Method, &str); 4] = [
    (Method::Taylor, "Taylor series"),
    (Method::RungeKutta4, "Runge-Kutta 4"),
    (Method::SemiImplicitEuler, "semi-implicit Euler"),
    (Method::ClosedForm, "closed form"),
];

/// Sources of the sine in the order of their colours.
pub(super) const SOURCES: [&str; 3] = ["libm", "own-polynomial", "micromath"];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy_study::variant::variants;

    #[test]
    fn looks_distinguish_methods_events_and_precisions() {
        let families: Vec<Family> = variants(true, 0.0).iter().map(|variant| variant.family).collect();
        for one in &families {
            for other in &families {
                let looks = (Colours::Methods.look(one), Colours::Methods.look(other));
                assert_eq!(looks.0.colour == looks.1.colour, one.method == other.method);
                assert_eq!(looks.0.dashes == looks.1.dashes, one.events == other.events);
                assert_eq!(looks.0.open == looks.1.open, one.number.precision() == other.number.precision());
            }
        }
    }
}
