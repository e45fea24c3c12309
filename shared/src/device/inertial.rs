//! From the numbers that an inertial sensor gives to SI units.

use crate::settings::wiring::Axis;
use crate::structure::block::GRAVITY;

/// Standard gravity, m/s².
const STANDARD_GRAVITY: f32 = GRAVITY as f32;

/// Of the gyroscope at ±500 °/s in 16 bits, LSB/(°/s): ICM-42688-P, DS-000347 rev. 1.7, Table 1, "Sensitivity Scale Factor",
/// GYRO_FS_SEL = 2.
pub const GYROSCOPE_COUNTS_PER_DEGREE: f32 = 65.5;

/// Of the accelerometer at ±8 g in 16 bits, LSB/g: the same data sheet, Table 2, "Sensitivity Scale Factor", ACCEL_FS_SEL = 1.
pub const ACCELEROMETER_COUNTS_PER_GRAVITY: f32 = 4096.0;

/// Largest reading of the gyroscope, rad/s, as its scale factor makes it.
pub const GYROSCOPE_FULL_SCALE: f32 = i16::MAX as f32 * RATE_PER_COUNT;

/// Largest reading of the accelerometer, m/s².
pub const ACCELEROMETER_FULL_SCALE: f32 = i16::MAX as f32 * ACCELERATION_PER_COUNT;

const RATE_PER_COUNT: f32 = core::f32::consts::PI / 180.0 / GYROSCOPE_COUNTS_PER_DEGREE;
const ACCELERATION_PER_COUNT: f32 = STANDARD_GRAVITY / ACCELEROMETER_COUNTS_PER_GRAVITY;

/// The component of a sensor's counts along an axis, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Component {
    index: u8,
    /// Of a count, with the axis's direction.
    scale: f32,
}

impl Component {
    /// Component of a gyroscope's counts, rad/s.
    pub fn of_rate(axis: Axis) -> Component {
        Component::new(axis, RATE_PER_COUNT)
    }

    /// Component of an accelerometer's counts, m/s².
    pub fn of_acceleration(axis: Axis) -> Component {
        Component::new(axis, ACCELERATION_PER_COUNT)
    }

    fn new(axis: Axis, scale: f32) -> Component {
        Component { index: axis.index(), scale: if axis.reversed() { -scale } else { scale } }
    }

    /// Its value, of the counts along x, y and z.
    #[inline]
    pub fn of(&self, [x, y, z]: [i16; 3]) -> f32 {
        let count = match self.index {
            0 => x,
            1 => y,
            _ => z,
        };
        count as f32 * self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::Settings;
    use crate::settings::table::Item;
    use crate::settings::wiring::Wiring;

    /// A part at its end is known as such, and one that is not is believed.
    #[test]
    fn a_sensor_is_saturated_by_default_just_below_its_full_scale() {
        let settings = Settings::default();
        for (item, most) in [
            (Item::GyroscopeFullScale, GYROSCOPE_FULL_SCALE),
            (Item::BlockFullScale, ACCELEROMETER_FULL_SCALE),
            (Item::GroundFullScale, ACCELEROMETER_FULL_SCALE),
        ] {
            let limit = settings.real(item);
            assert!(limit <= most && limit > 0.99 * most, "{item:?}: {limit}, the part {most}");
        }
    }

    /// Along x, y and z, and against them.
    fn components(of: fn(Axis) -> Component) -> [Component; 6] {
        let mut settings = Settings::default();
        core::array::from_fn(|word| {
            settings.set(Item::GroundAlongAxis.index(), word as u32).unwrap();
            of(Wiring::of(&settings).ground[0])
        })
    }

    #[test]
    fn full_scale_is_that_of_the_data_sheet() {
        let [rate, none, most] = [6550, 0, i16::MIN].map(|count| components(Component::of_rate)[0].of([count, 1, 1]));
        assert!((rate - 100f32.to_radians()).abs() < 1e-6, "{rate}");
        assert_eq!(none, 0.0);
        assert!((most + 500f32.to_radians()).abs() < 0.005, "{most}");
        let [gravity, none, most] = [4096, 0, i16::MIN].map(|count| components(Component::of_acceleration)[0].of([count, 1, 1]));
        assert_eq!(gravity, STANDARD_GRAVITY);
        assert_eq!(none, 0.0);
        assert_eq!(most, -8.0 * STANDARD_GRAVITY);
        assert!((GYROSCOPE_FULL_SCALE - 500f32.to_radians()).abs() < 0.005);
        assert!((ACCELEROMETER_FULL_SCALE - 8.0 * STANDARD_GRAVITY).abs() < 0.003);
    }

    #[test]
    fn a_component_is_that_along_its_axis() {
        let values = components(Component::of_acceleration).map(|component| component.of([4096, 8192, 12_288]));
        assert_eq!(values, [1.0, -1.0, 2.0, -2.0, 3.0, -3.0].map(|gravities| gravities * STANDARD_GRAVITY));
    }
}
