//! A rigid rectangle in the plane, in coordinates of its centre of mass, and what a force at its base does.

use crate::block::Block;

/// Centre of mass (m, from where it stands at rest, relative to the ground) and turn clockwise (rad), with their rates.
#[derive(Clone, Copy, Debug, Default)]
pub struct State {
    pub position: [f64; 3],
    pub rates: [f64; 3],
    /// Energy that friction has taken, over the mass.
    pub spent: f64,
}

/// The body, of mass 1.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    /// Half the width and the height of the centre of mass, m.
    pub half_width: f64,
    pub height: f64,
    /// Moment of inertia about the centre of mass.
    pub inertia: f64,
    pub friction: f64,
}

impl Body {
    pub fn of(block: &Block, friction: f64) -> Body {
        let (sin, cos) = block.slenderness.sin_cos();
        let inertia = (block.inertia - 1.0) * block.size * block.size;
        Body { half_width: block.size * sin, height: block.size * cos, inertia, friction }
    }

    /// From the centre of mass to the point `along` (m) of the base, 1 m being to the right, when the body is turned by `turn`.
    pub fn arm(&self, along: f64, turn: f64) -> [f64; 2] {
        let (sin, cos) = turn.sin_cos();
        [along * cos - self.height * sin, -along * sin - self.height * cos]
    }

    /// Velocity of that point.
    pub fn velocity(&self, along: f64, state: &State) -> [f64; 2] {
        let [x, z] = self.arm(along, state.position[2]);
        let [right, up, turn] = state.rates;
        [right + turn * z, up - turn * x]
    }

    /// Height of that point over the ground.
    pub fn clearance(&self, along: f64, state: &State) -> f64 {
        self.height + state.position[1] + self.arm(along, state.position[2])[1]
    }

    /// Displacement of the base over the ground: that of its point `along`.
    pub fn displacement(&self, along: f64, state: &State) -> f64 {
        state.position[0] + self.arm(along, state.position[2])[0] - along
    }

    /// Accelerations under a force (right, up) at the point `along` and the field (right, up).
    pub fn accelerations(&self, turn: f64, along: f64, force: [f64; 2], field: [f64; 2]) -> [f64; 3] {
        let [x, z] = self.arm(along, turn);
        [field[0] + force[0], field[1] + force[1], (z * force[0] - x * force[1]) / self.inertia]
    }

    /// Acceleration of the point `at` of the base for these accelerations of the body.
    pub fn acceleration_of(&self, at: f64, state: &State, body: [f64; 3]) -> [f64; 2] {
        let [x, z] = self.arm(at, state.position[2]);
        let turn = state.rates[2];
        // The arm turns clockwise: d/dt (x, z) = turn (z, −x).
        [body[0] + body[2] * z - turn * turn * x, body[1] - body[2] * x - turn * turn * z]
    }
}

/// Solves two linear equations f(u, v) = 0, given f as a function that is linear in u and v.
pub fn solve(f: impl Fn(f64, f64) -> [f64; 2]) -> [f64; 2] {
    let [c, g] = f(0.0, 0.0);
    let [a, e] = f(1.0, 0.0).map(|value| value);
    let [b, h] = f(0.0, 1.0);
    let (a, b, e, h) = (a - c, b - c, e - g, h - g);
    let determinant = a * h - b * e;
    [(b * g - c * h) / determinant, (c * e - a * g) / determinant]
}

/// Solves one linear equation.
pub fn root(f: impl Fn(f64) -> f64) -> f64 {
    let start = f(0.0);
    start / (start - f(1.0))
}
