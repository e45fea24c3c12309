//! Impact of a corner, by impulses at the base.

use super::body::{Body, State, root, solve};

/// Where the resultant impulse of an impact acts, in half widths from the middle, so that one that sticks leaves η of the turn.
pub fn eccentricity(body: &Body, restitution: f64) -> f64 {
    let turns = |place: f64| {
        let state = turning(body, -1.0);
        after(body, &state, -1.0, place, |impulse| [impulse[0], impulse[1]]).rates[2]
    };
    // η falls as the impulse moves outwards.
    let (mut low, mut high) = (0.0, 1e4);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if -turns(middle) > restitution { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// A body that turns at `rate` about its right corner, at θ = 0.
fn turning(body: &Body, rate: f64) -> State {
    let [x, z] = body.arm(body.half_width, 0.0);
    State { rates: [-rate * z, rate * x, rate], ..State::default() }
}

/// The state after an impulse at `place` half widths towards `corner`, for which `missing` gives what must vanish: of the velocity of the new
/// corner (along, up).
fn after(body: &Body, state: &State, corner: f64, place: f64, missing: impl Fn([f64; 2]) -> [f64; 2]) -> State {
    let changed = |along: f64, up: f64| struck(body, state, corner * place * body.half_width, [along, up]);
    let velocity = |state: &State| body.velocity(corner * body.half_width, state);
    let [along, up] = solve(|along, up| missing(velocity(&changed(along, up))));
    changed(along, up)
}

fn struck(body: &Body, state: &State, at: f64, impulse: [f64; 2]) -> State {
    let change = body.accelerations(0.0, at, impulse, [0.0; 2]);
    let mut rates = state.rates;
    rates.iter_mut().zip(change).for_each(|(rate, change)| *rate += change);
    State { rates, ..*state }
}

/// The body after `corner` has hit the ground.
pub fn land(body: &Body, state: &State, corner: f64, place: f64) -> State {
    let at = corner * place * body.half_width;
    let velocity = |state: &State| body.velocity(corner * body.half_width, state);
    // The old corner rises, or it has been hit as well.
    let rises = |after: &State| body.velocity(-corner * body.half_width, after)[1] > 0.0;
    let within = |after: &State| {
        let [along, up] = [after.rates[0] - state.rates[0], after.rates[1] - state.rates[1]];
        up >= 0.0 && along.abs() <= body.friction * up
    };
    let stuck = after(body, state, corner, place, |missing| missing);
    if within(&stuck) {
        return if rises(&stuck) { stuck } else { flat(body, state) };
    }
    for direction in [1.0, -1.0] {
        let pushed = |up: f64| struck(body, state, at, [-direction * body.friction * up, up]);
        let slides = pushed(root(|up| velocity(&pushed(up))[1]));
        if rises(&slides) && direction * velocity(&slides)[0] > 0.0 && slides.rates[1] >= state.rates[1] {
            return slides;
        }
    }
    flat(body, state)
}

/// The body after both corners have hit the ground.
fn flat(body: &Body, state: &State) -> State {
    let up = -state.rates[1];
    // Along the ground the base had the velocity of any of its points.
    let slip = state.rates[0];
    let left = slip - slip.signum() * (body.friction * up).min(slip.abs());
    State { rates: [left, 0.0, 0.0], ..*state }
}
