//! What a step costs on the microcontroller: the instructions that the emulated Cortex-M4F takes, as the image that tests the core prints them.

use std::collections::BTreeMap;

use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;
use sprag_sim::scene::accuracy::EventTreatment;

use super::variant::{Family, Method, Number};

/// Cycles that an instruction takes on a Cortex-M4F, as an estimate: most take one, loads and taken branches two or three, divisions and
/// square roots fourteen, and flash at 168 MHz has five wait states behind a cache.
pub const CYCLES_PER_INSTRUCTION: f64 = 1.5;

/// The cost of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoardCost {
    /// Instructions.
    pub instructions: u32,
}

impl BoardCost {
    /// Estimated cycles.
    pub fn cycles(self) -> f64 {
        CYCLES_PER_INSTRUCTION * f64::from(self.instructions)
    }
}

/// Costs by the name of the kernel.
#[derive(Clone, Debug, Default)]
pub struct Board(BTreeMap<String, u32>);

impl Board {
    /// From lines `kernel NAME INSTRUCTIONS …`.
    pub fn read(lines: &str) -> Board {
        let kernel = |line: &str| {
            let mut words = line.strip_prefix("kernel ")?.split(' ');
            Some((words.next()?.to_owned(), words.next()?.parse().ok()?))
        };
        Board(lines.lines().filter_map(kernel).collect())
    }

    /// The cost of a step of `family`, where the image has it or one that costs the same: a step with a single inerter does what one with a
    /// pair does, and a slender block needs no sine.
    pub fn cost(&self, family: Family, geometry: Geometry, device: DeviceKind) -> Option<BoardCost> {
        let pair = if device == DeviceKind::Inerter { DeviceKind::ClutchedPair } else { device };
        let own = match family.number {
            number if geometry == Geometry::Full => number,
            Number::F64Libm | Number::F64Own => Number::F64Libm,
            _ => Number::F32Own,
        };
        let names = [(family.number, device), (family.number, pair), (own, device), (own, pair)];
        names
            .iter()
            .find_map(|&(number, device)| self.0.get(&kernel(Family { number, ..family }, geometry, device)))
            .map(|&instructions| BoardCost { instructions })
    }
}

/// The name of the kernel that takes a step of `family`.
fn kernel(family: Family, geometry: Geometry, device: DeviceKind) -> String {
    let method = match family.method {
        Method::SemiImplicitEuler => "euler",
        Method::RungeKutta4 => "rk4",
        Method::Taylor => "taylor12",
        Method::ClosedForm => "closed-form",
    };
    let events = if family.events == EventTreatment::StepEnd { "step-end" } else { "located" };
    let geometry = if geometry == Geometry::Full { "full" } else { "slender" };
    let device = match device {
        DeviceKind::None => "none",
        DeviceKind::Inerter => "inerter",
        DeviceKind::ClutchedPair => "clutched-pair",
    };
    format!("step-{method}-{events}-{}-{}-{geometry}-{device}", family.number.precision(), family.number.math())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kernel_is_found_by_what_it_does() {
        let board =
            Board::read("noise\nkernel nothing 3\nkernel step-rk4-step-end-f32-micromath-full-clutched-pair 150 (2 steps)\n");
        let family = Family { method: Method::RungeKutta4, events: EventTreatment::StepEnd, number: Number::F32Micromath };
        let cost = board.cost(family, Geometry::Full, DeviceKind::ClutchedPair);
        assert_eq!(cost, Some(BoardCost { instructions: 150 }));
        assert_eq!(cost.unwrap().cycles(), 225.0);
        assert_eq!(board.cost(family, Geometry::Slender, DeviceKind::ClutchedPair), None);
    }
}
