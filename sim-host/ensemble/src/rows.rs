//! Pulsed blocks and their results as rows of numbers, between programs that share no types, such as two modules of a page.

use sprag_shared::observers::outcome::Outcome;
use sprag_shared::structure::block::Geometry;
use sprag_shared::structure::device::DeviceKind;

use crate::plain::PlainBlock;
use crate::pulsed::{PulseResult, PulseShape, PulsedBlock};

/// Numbers of a block.
pub const BLOCK: usize = 9;

/// Numbers of a result.
pub const RESULT: usize = 3;

const GEOMETRIES: [Geometry; 2] = [Geometry::Full, Geometry::Slender];
const PULSES: [PulseShape; 2] = [PulseShape::Sine, PulseShape::Cosine];

/// Number of `value` in `all`.
fn code<T: PartialEq>(all: &[T], value: &T) -> f64 {
    all.iter().position(|known| known == value).unwrap_or(all.len()) as f64
}

/// The value of `all` with this number, if there is one.
fn of_code<T: Copy>(all: &[T], code: f64) -> Option<T> {
    all.iter().enumerate().find(|(index, _)| *index as f64 == code).map(|(_, value)| *value)
}

impl PulsedBlock {
    /// As a row.
    pub fn row(&self) -> [f64; BLOCK] {
        let PlainBlock { geometry, device, slenderness, coupling, restitution, overturned_at_slenderness } = self.plain;
        [
            code(&GEOMETRIES, &geometry),
            code(&DeviceKind::ALL, &device),
            slenderness,
            coupling,
            restitution,
            f64::from(u8::from(overturned_at_slenderness)),
            code(&PULSES, &self.pulse),
            self.frequency_ratio,
            self.amplitude_ratio,
        ]
    }

    /// Of a row; none for a code that there is not.
    pub fn of_row(row: &[f64; BLOCK]) -> Option<PulsedBlock> {
        let [geometry, device, slenderness, coupling, restitution, at_slenderness, pulse, frequency_ratio, amplitude_ratio] =
            *row;
        let plain = PlainBlock {
            geometry: of_code(&GEOMETRIES, geometry)?,
            device: of_code(&DeviceKind::ALL, device)?,
            slenderness,
            coupling,
            restitution,
            overturned_at_slenderness: at_slenderness != 0.0,
        };
        Some(PulsedBlock { plain, pulse: of_code(&PULSES, pulse)?, frequency_ratio, amplitude_ratio })
    }
}

impl PulseResult {
    /// As a row.
    pub fn row(&self) -> [f64; RESULT] {
        [code(&Outcome::ALL, &self.outcome), self.peak_rotation, self.peak_acceleration]
    }

    /// Of a row; none for a code that there is not.
    pub fn of_row(row: &[f64; RESULT]) -> Option<PulseResult> {
        let [outcome, peak_rotation, peak_acceleration] = *row;
        Some(PulseResult { outcome: of_code(&Outcome::ALL, outcome)?, peak_rotation, peak_acceleration })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_read_back_to_every_bit() {
        for (geometry, device, pulse) in [
            (Geometry::Full, DeviceKind::ClutchedPair, PulseShape::Cosine),
            (Geometry::Slender, DeviceKind::None, PulseShape::Sine),
            (Geometry::Full, DeviceKind::Inerter, PulseShape::Sine),
        ] {
            let plain = PlainBlock {
                geometry,
                device,
                slenderness: 0.1 + 0.2,
                coupling: 1.0 / 3.0,
                restitution: 0.85,
                overturned_at_slenderness: device == DeviceKind::None,
            };
            let block = PulsedBlock { plain, pulse, frequency_ratio: 6.1, amplitude_ratio: -7.7 };
            assert_eq!(PulsedBlock::of_row(&block.row()), Some(block));
        }
        for outcome in Outcome::ALL {
            let result = PulseResult { outcome, peak_rotation: 0.1 + 0.2, peak_acceleration: 1e-300 };
            assert_eq!(PulseResult::of_row(&result.row()), Some(result));
        }
    }

    #[test]
    fn codes_that_there_are_not_give_nothing() {
        let row = PulsedBlock {
            plain: PlainBlock {
                geometry: Geometry::Full,
                device: DeviceKind::None,
                slenderness: 0.2,
                coupling: 0.0,
                restitution: 0.9,
                overturned_at_slenderness: false,
            },
            pulse: PulseShape::Sine,
            frequency_ratio: 1.0,
            amplitude_ratio: 2.0,
        }
        .row();
        for (place, code) in [(0, 2.0), (1, 3.0), (6, -1.0), (0, f64::NAN), (1, 0.5)] {
            let mut wrong = row;
            wrong[place] = code;
            assert_eq!(PulsedBlock::of_row(&wrong), None, "{place} {code}");
        }
        assert_eq!(PulseResult::of_row(&[4.0, 0.0, 0.0]), None);
    }
}
