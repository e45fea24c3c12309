//! The energy of every kind of drivetrain adds up.

use super::{drivetrains, pair, tight};
use crate::block::Geometry;
use crate::drivetrain::Engagement;
use crate::ledger::{Account, Clutching, Ledger};

#[test]
fn the_ledger_closes_for_every_drivetrain() {
    for geometry in [Geometry::Slender, Geometry::Full] {
        for (name, drivetrain) in drivetrains() {
            for (amplitude, frequency) in [(3.0, 5.0), (1.6, 3.0)] {
                let shake = pair(geometry, amplitude, frequency);
                let ideal = drivetrain.engagement == Engagement::Ideal;
                let account = Account {
                    clutching: if ideal { Clutching::Ideal } else { Clutching::Real },
                    mass_ratio: 0.5,
                    rack_mass_ratio: drivetrain.rack.guided_mass_ratio,
                };
                let mut ledger = Ledger::new(&shake.structure.block, geometry, &account);
                shake.watched(&drivetrain, &tight(), &mut ledger);
                let entries = ledger.entries();
                let residual = entries.residual().abs() / entries.input.abs();
                let what = std::format!("{geometry:?} {name} a = {amplitude}, ω/p = {frequency}: {entries:?}");
                assert!(residual < 1e-10, "{what}: residual {residual:e} of the input");
                assert!(entries.impact > 0.0 && entries.rack > 0.0 && entries.bearing > 0.0, "{what}");
                match drivetrain.engagement {
                    Engagement::Ideal => assert!(entries.created > 0.0 && entries.clutch == 0.0, "{what}"),
                    Engagement::Overrunning => assert!(entries.clutch.abs() < 1e-12 * entries.input, "{what}: no jolt, no loss"),
                    _ => assert!(entries.clutch > 0.0 && entries.created == 0.0, "{what}"),
                }
            }
        }
    }
}
