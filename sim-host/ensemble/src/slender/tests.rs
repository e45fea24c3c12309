use std::f64::consts::PI;

use sprag_shared::math::lanes::Lanes;
use sprag_shared::math::scalar::Scalar;

use super::{Motion, Place};
use crate::{Number, WIDTH, number};

/// So many motions a lane, with how long they may be followed: all signs and sizes, far from and near to balance.
pub(super) fn motions(count: usize) -> impl Iterator<Item = (Motion, Number)> {
    let mut state = 7_u64;
    let mut share = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..count).map(move |_| {
        let mut each = |of: &mut dyn FnMut(&mut dyn FnMut() -> f64) -> f64| Lanes([0.0; WIDTH].map(|_| of(&mut share)));
        let rate = each(&mut |share| 1.0 / (1.0 + 20.0 * share() * share()));
        let frequency = each(&mut |share| 0.05 + 12.0 * share() * share());
        let phase = each(&mut |share| if share() < 0.2 { 0.0 } else { PI * share() });
        let ground = each(&mut |share| 6.0 * share() - 3.0);
        let rotation = each(&mut |share| 1.5 * share());
        let velocity = each(&mut |share| 3.0 * share() - 1.5);
        let motion = Motion::new((rotation, velocity), (number(0.3), rate), (ground, frequency), (phase, Scalar::sin_cos(phase)));
        let longest = ((number(PI) - phase) / frequency).smaller(number(2.0));
        let part = each(&mut |share| if share() < 0.5 { 1.0 } else { 0.02 + share() });
        (motion, longest * part.smaller(number(1.0)))
    })
}

/// A motion in many places, up to `length`.
pub(super) fn samples(motion: &Motion, length: Number) -> impl Iterator<Item = Place> {
    (1..256).map(move |k| motion.at(length * number(f64::from(k) / 256.0)))
}

fn assert_near(left: Number, right: Number, most: f64, what: &str) {
    for lane in 0..WIDTH {
        let size = 1.0 + left.0[lane].abs();
        assert!((left.0[lane] - right.0[lane]).abs() <= most * size, "{what}: {} {}", left.0[lane], right.0[lane]);
    }
}

/// I θ̈ = θ − α − G sin ψ, and each derivative is that of the one before.
#[test]
fn motions_obey_the_equation() {
    for (motion, length) in motions(100) {
        let place = motion.at(length * number(0.5));
        let ground = motion.amplitude * (motion.rate + motion.frequency * motion.frequency) / motion.rate;
        let (sine, _) = Scalar::sin_cos(motion.phase + motion.frequency * length * number(0.5));
        let [rate, slope, curvature] = motion.accelerations(&place);
        let should = motion.rate * (place.rotation - motion.slenderness - ground * sine);
        assert_near(rate, should, 1e-12, "equation");
        assert_near(place.rotation, motion.slenderness + place.own + place.forced, 1e-13, "parts");
        let step = number(1e-4) / (number(1.0) + motion.frequency);
        let [before, after] = [-1.0, 1.0].map(|sign| motion.soon_after(&place, step * number(sign)));
        let derivative = |of: &dyn Fn(&Place) -> Number| (of(&after) - of(&before)) / (step + step);
        assert_near(derivative(&|place| place.rotation), motion.velocity(&place), 1e-6, "velocity");
        assert_near(derivative(&|place| motion.velocity(place)), rate, 1e-6, "acceleration");
        assert_near(derivative(&|place| motion.accelerations(place)[0]), slope, 1e-5, "slope");
        assert_near(derivative(&|place| motion.accelerations(place)[1]), curvature, 1e-4, "curvature");
    }
}

/// Where a motion is does not depend on the steps that lead there.
#[test]
fn steps_add_up() {
    for (motion, length) in motions(100) {
        let half = number(0.5) * length;
        let middle = motion.at(half);
        let on = motion.from(half, middle);
        let (twice, once) = (on.at(half), motion.at(length));
        assert_near(twice.rotation, once.rotation, 3e-14, "rotation");
        assert_near(motion.velocity(&twice), motion.velocity(&once), 3e-14 * 13.0, "velocity");
        let short = number(1e-3) / (number(1.0) + motion.frequency);
        let (near, exact) = (motion.soon_after(&middle, short), motion.at(half + short));
        assert_near(near.rotation, exact.rotation, 1e-14, "soon after");
    }
}

/// A bounce of 1e-12 rad: constant acceleration, to the size of the time.
#[test]
fn small_motions_keep_their_digits() {
    let (ground, frequency, phase) = (number(0.2), number(3.0), number(0.7));
    let velocity = 1e-6;
    let motion = Motion::new(
        (number(0.0), number(velocity)),
        (number(0.3), number(0.8)),
        (ground, frequency),
        (phase, Scalar::sin_cos(phase)),
    );
    let [rate, slope, _] = motion.accelerations(&motion.start).map(|numbers| numbers.0[0]);
    for share in [0.1, 0.5, 1.0, 1.9] {
        let time = -share * velocity / rate;
        let should = time * (velocity + time * (0.5 * rate + time * slope / 6.0));
        let found = motion.at(number(time)).rotation.0[0];
        assert!((found / should - 1.0).abs() < 1e-9, "{share}: {found} {should}");
    }
}
