//! What is integrated, and one step of it.

/// Unknowns and integrals.
pub const SIZE: usize = 15;
/// θ, rad.
pub const ROTATION: usize = 0;
/// θ̇, rad/s.
pub const VELOCITY: usize = 1;
/// w of both flywheels: the speed of a rack that would move with each, m/s.
pub const SPIN: usize = 2;
/// z of both clutches: twist as travel of the rack, m.
pub const TWIST: usize = 4;
/// z, the speed of the terminal on a support that moves against the ground, as travel of the rack, m/s: ż = r(ü_s − ü_g).
pub const SUPPORT: usize = 6;
/// Work of the ground and the support; this and what follows in 1/s², energies over mR².
pub const INPUT: usize = 7;
/// Lost to friction of the rack.
pub const RACK: usize = 8;
/// Lost to the bearings.
pub const BEARING: usize = 9;
/// Lost to brakes, and to ideal clutches that stop a flywheel.
pub const BRAKE: usize = 10;
/// Lost to plates, dampers, jolts and springs let go.
pub const CLUTCH: usize = 11;
/// What the paper's kinematics (Eq. 11) add, having left the θ̇² term out.
pub const KINEMATICS: usize = 12;
/// Lost to impacts.
pub const IMPACT: usize = 13;
/// What ideal clutches add by engaging a stopped flywheel at speed.
pub const CREATED: usize = 14;

/// One step of the classical Runge-Kutta method of order 4, over a time `h` after the start; `rates` gets times after it.
pub fn step(start: &[f64; SIZE], h: f64, rates: impl Fn(f64, &[f64; SIZE]) -> [f64; SIZE]) -> [f64; SIZE] {
    let ahead = |slope: &[f64; SIZE], by: f64| std::array::from_fn(|i| start[i] + by * slope[i]);
    let k1 = rates(0.0, start);
    let k2 = rates(h / 2.0, &ahead(&k1, h / 2.0));
    let k3 = rates(h / 2.0, &ahead(&k2, h / 2.0));
    let k4 = rates(h, &ahead(&k3, h));
    std::array::from_fn(|i| start[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
}
