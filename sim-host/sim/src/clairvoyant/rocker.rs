//! Block and clutched pair in short steps of one length.

use sprag_shared::control::law::turn_taking::AHEAD;
use sprag_shared::drivetrain::any_transmission::TransmissionKind;
use sprag_shared::equation::any_body::AnyBody;
use sprag_shared::equation::body::Body;
use sprag_shared::equation::first_integral::{FirstIntegral, FullIntegral, SlenderIntegral};
use sprag_shared::math;
use sprag_shared::motion::hybrid::HybridSystem;
use sprag_shared::structure::block::Geometry;

/// A block with a clutched pair, ideal or rigid.
#[derive(Clone, Copy, Debug)]
pub struct Rocker {
    body: AnyBody<f64>,
    geometry: Geometry,
    /// p², 1/s².
    frequency_squared: f64,
    slenderness: f64,
    /// Ground acceleration at which it uplifts, g.
    uplift: f64,
    restitution: f64,
    rest_speed: f64,
    /// k = σ/λ of a flywheel.
    coupling: f64,
    wheels: Wheels,
}

/// What flywheels do beside resisting.
#[derive(Clone, Copy, Debug)]
enum Wheels {
    /// Nothing: they have no speed of their own.
    Ideal,
    /// They are engaged by a plastic impact and spin on when released.
    Spinning {
        /// 1/s.
        viscous_rate: f64,
        /// Constant deceleration of a released one over R, 1/s².
        drag: f64,
    },
}

/// Which flywheels are on the rack.
pub type Engaged = [bool; 2];

/// None of them.
pub(super) const OPEN: Engaged = [false; 2];

/// Where a block with its device is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// θ, rad.
    pub rotation: f64,
    /// θ̇, rad/s.
    pub velocity: f64,
    /// Toe that carries it, ±1.
    pub side: f64,
    /// It stands on both toes.
    pub standing: bool,
    /// Speeds of the flywheels as racks that moved with them, over R, 1/s; 0 of ideal ones.
    pub spins: [f64; 2],
    /// Which are on the rack.
    pub engaged: Engaged,
    /// Largest |θ| so far, rad.
    pub peak: f64,
}

impl Place {
    /// A block that stands, its device at rest.
    pub const REST: Place =
        Place { rotation: 0.0, velocity: 0.0, side: 1.0, standing: true, spins: [0.0; 2], engaged: [false; 2], peak: 0.0 };
}

impl Rocker {
    /// Of a `machine` of this `geometry`; none for a device that is neither an ideal clutched pair nor a rigid one, and for impacts that
    /// differ, whose numbers a search over states does not know.
    pub fn of(machine: &HybridSystem<f64>, geometry: Geometry) -> Option<Rocker> {
        if machine.scatter.is_on() {
            return None;
        }
        let parameters = &machine.transmission.parameters;
        let wheels = match machine.transmission.kind {
            TransmissionKind::Ideal => Wheels::Ideal,
            TransmissionKind::Rigid if !parameters.stops_at_once => {
                Wheels::Spinning { viscous_rate: parameters.bearing_rate, drag: parameters.bearing_dry + parameters.brake }
            }
            _ => return None,
        };
        Some(Rocker {
            body: machine.body,
            geometry,
            frequency_squared: machine.body.frequency_squared(),
            slenderness: machine.slenderness,
            uplift: geometry.uplift_threshold(machine.slenderness),
            restitution: machine.restitution[0],
            rest_speed: machine.rest_speed,
            coupling: parameters.inertance,
            wheels,
        })
    }

    /// α, rad.
    pub fn slenderness(&self) -> f64 {
        self.slenderness
    }

    /// p, 1/s.
    pub fn frequency(&self) -> f64 {
        math::square_root(self.frequency_squared)
    }

    /// Flywheels have speeds of their own.
    pub fn spins(&self) -> bool {
        matches!(self.wheels, Wheels::Spinning { .. })
    }

    /// |θ| (rad) beyond which an outward motion never returns while the ground stays within ±`bound` (g).
    pub fn no_return(&self, bound: f64) -> f64 {
        self.geometry.point_of_no_return(self.slenderness, bound)
    }

    /// Largest |θ| (rad) from here on of a block that stands, or that on quiet ground and with its flywheels released never reaches its tip
    /// ([`FirstIntegral`]): outward to its turn, inward to that after the next impact. None for any other block.
    pub fn settles_at(&self, place: &Place) -> Option<f64> {
        match self.geometry {
            _ if place.standing => Some(place.peak),
            Geometry::Full => self.turns_at(&FullIntegral { coupling: 0.0 }, place),
            Geometry::Slender => self.turns_at(&SlenderIntegral { inertia: 1.0 }, place),
        }
    }

    fn turns_at(&self, integral: &impl FirstIntegral, place: &Place) -> Option<f64> {
        let alpha = self.slenderness;
        let left = alpha - place.rotation.abs();
        let squared = place.velocity * place.velocity / self.frequency_squared;
        let mut turn = integral.turn(left, squared).filter(|_| left > 0.0)?;
        if place.side * place.velocity <= 0.0 {
            let kept = self.restitution * self.restitution;
            turn = integral.turn(alpha, kept * integral.squared_speed(left, squared, alpha))?;
        }
        Some(place.peak.max(alpha - turn))
    }

    /// Flywheel `index` may be put on the rack: it does not run ahead, so that it would drive the block. That is the rule of the controller's
    /// turn-taking.
    pub fn may_engage(&self, place: &Place, index: usize) -> bool {
        if !self.spins() || place.engaged[index] {
            return true;
        }
        let (spin, ahead) = (place.spins[index], f64::from(AHEAD) * self.slenderness);
        if place.standing {
            return spin.abs() <= ahead;
        }
        let direction = if place.velocity == 0.0 { place.side } else { place.velocity.signum() };
        let rack = self.body.to_terminal(&self.body.configuration(place.side, place.rotation), place.velocity);
        direction * spin <= direction * rack + ahead
    }

    /// Moves the clutches.
    pub fn engage(&self, place: &mut Place, engaged: Engaged) {
        if self.spins() {
            let arm = self.body.arm(&self.body.configuration(place.side, place.rotation));
            let inertia = self.coupling * arm * arm;
            let mut on = engaged.iter().zip(place.engaged).filter(|&(&new, old)| new && old).count() as f64;
            for (index, spin) in place.spins.iter_mut().enumerate() {
                if engaged[index] && !place.engaged[index] {
                    let before = 1.0 + on * inertia;
                    let shared = (before * place.velocity + self.coupling * arm * *spin) / (before + inertia);
                    place.velocity = if place.standing { 0.0 } else { shared };
                    on += 1.0;
                }
            }
            for (index, spin) in place.spins.iter_mut().enumerate() {
                if engaged[index] {
                    *spin = arm * place.velocity;
                }
            }
        }
        place.engaged = engaged;
    }

    /// A step of `length` (s) under the ground acceleration `ground` (g) of its middle, by the midpoint rule: second order.
    pub fn step(&self, place: &mut Place, ground: f64, length: f64) {
        if place.standing {
            if ground.abs() <= self.uplift {
                self.coast(place, length);
                return;
            }
            // The block tips away from where the ground goes.
            (place.standing, place.side) = (false, -ground.signum());
        }
        let engaged = f64::from(u8::from(place.engaged[0])) + f64::from(u8::from(place.engaged[1]));
        let middle = self.body.configuration(place.side, place.rotation + 0.5 * length * place.velocity);
        let moment = self.body.driving_moment(&middle, [ground, 0.0]);
        let rate = self.body.solve_acceleration(&middle, moment, engaged * self.coupling, place.velocity);
        let (from, before) = (place.rotation, place.velocity);
        place.velocity += length * rate;
        place.rotation += 0.5 * length * (before + place.velocity);
        if place.side * place.rotation < 0.0 {
            let left = place.rotation / (place.rotation - from);
            place.velocity *= self.restitution;
            place.side = if place.velocity == 0.0 { -place.side } else { place.velocity.signum() };
            place.rotation = left * length * place.velocity;
            if place.velocity.abs() <= self.rest_speed.max(length * self.frequency_squared * self.slenderness * RESTS)
                && ground.abs() < self.uplift
            {
                (place.rotation, place.velocity, place.standing) = (0.0, 0.0, true);
            }
        }
        place.peak = place.peak.max(place.rotation.abs());
        self.coast(place, length);
    }

    /// Flywheels on the rack follow it, others lose speed.
    fn coast(&self, place: &mut Place, length: f64) {
        let Wheels::Spinning { viscous_rate, drag } = self.wheels else { return };
        let rack = self.body.to_terminal(&self.body.configuration(place.side, place.rotation), place.velocity);
        for (spin, engaged) in place.spins.iter_mut().zip(place.engaged) {
            if engaged {
                *spin = rack;
            } else {
                let slowed = spin.abs() * (1.0 - viscous_rate * length) - drag * length;
                *spin = if slowed > 0.0 { slowed * spin.signum() } else { 0.0 };
            }
        }
    }
}

/// A block comes to rest at an impact whose speed the weight takes away within this many steps: its next leg could not be followed.
const RESTS: f64 = 0.5;
