//! Which corners touch the ground and whether they slide, and the forces in each case.

use super::body::{Body, State, root, solve};

/// By which a mode may contradict itself and still be the one that follows, m/s².
const ROUNDING: f64 = 1e-9;

/// What touches the ground: a corner (1 right, −1 left) or the whole base, and the direction in which it slides (0 where it sticks).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    /// None: both corners.
    pub corner: Option<f64>,
    pub slides: f64,
}

/// Forces and accelerations of a mode.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Force of the ground, right and up.
    pub force: [f64; 2],
    pub accelerations: [f64; 3],
    /// Where it acts, m along the base.
    pub at: f64,
}

impl Mode {
    /// The point of the base that speaks for the contact.
    pub fn point(&self, body: &Body) -> f64 {
        self.corner.unwrap_or(0.0) * body.half_width
    }

    /// Forces while it lasts; `field` is the acceleration of everything relative to the ground, right and up.
    pub fn forces(&self, body: &Body, state: &State, field: [f64; 2]) -> Forces {
        let turn = state.position[2];
        match self.corner {
            None => {
                let up = -field[1];
                let right = if self.slides == 0.0 { -field[0] } else { -self.slides * body.friction * up };
                // No moment about the centre of mass.
                let at = root(|at| body.accelerations(0.0, at, [right, up], field)[2]);
                Forces { force: [right, up], accelerations: [field[0] + right, 0.0, 0.0], at }
            }
            Some(_) => {
                let at = self.point(body);
                let point = |force: [f64; 2]| body.acceleration_of(at, state, body.accelerations(turn, at, force, field));
                let force = if self.slides == 0.0 {
                    solve(|right, up| point([right, up]))
                } else {
                    let pressed = |up: f64| [-self.slides * body.friction * up, up];
                    pressed(root(|up| point(pressed(up))[1]))
                };
                Forces { force, accelerations: body.accelerations(turn, at, force, field), at }
            }
        }
    }

    /// How far it is from contradicting itself: negative where it does.
    pub fn margin(&self, body: &Body, state: &State, field: [f64; 2], begins: bool) -> f64 {
        let Forces { force, accelerations, at } = self.forces(body, state, field);
        let mut margin = force[1];
        if self.slides == 0.0 {
            margin = margin.min(body.friction * force[1] - force[0].abs());
        } else if begins {
            let along = body.acceleration_of(self.point(body), state, accelerations)[0];
            margin = margin.min(self.slides * along);
        }
        match self.corner {
            // The force acts between the corners.
            None => margin.min(force[1] * (1.0 - at.abs() / body.half_width)),
            Some(corner) if state.position[2] == 0.0 && state.rates[2] == 0.0 => {
                margin.min(body.acceleration_of(-corner * body.half_width, state, accelerations)[1])
            }
            Some(_) => margin,
        }
    }
}

/// The mode in which the body goes on, of those that its corner on the ground and its slip leave, but for the one that is `barred`: the
/// first that does not contradict itself, the simplest first, or but for rounding the one that does least. `None` where all do.
pub fn find(
    body: &Body,
    state: &State,
    (corner, slip): (Option<f64>, f64),
    barred: Option<Mode>,
    field: [f64; 2],
) -> Option<Mode> {
    let corners = if corner.is_some() { vec![corner] } else { vec![None, Some(1.0), Some(-1.0)] };
    let ways = if slip == 0.0 { vec![0.0, 1.0, -1.0] } else { vec![slip.signum()] };
    let modes = corners.into_iter().flat_map(|corner| ways.iter().map(move |&slides| Mode { corner, slides }));
    let modes = modes.filter(|mode| Some(*mode) != barred);
    let judged: Vec<(Mode, f64)> = modes.map(|mode| (mode, mode.margin(body, state, field, slip == 0.0))).collect();
    let holds = judged.iter().find(|(_, margin)| *margin >= 0.0);
    let best = || judged.iter().reduce(|a, b| if b.1 > a.1 { b } else { a }).filter(|(_, margin)| *margin > -ROUNDING);
    holds.or_else(best).map(|(mode, _)| *mode)
}
