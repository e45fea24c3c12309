//! The motion a few milliseconds ahead, where a command that is given now takes effect.

use super::estimate::Estimate;
use crate::control::model::Model;
use crate::equation::any_body::AnyConfiguration;

/// `now`, of a known `configuration`, a time `horizon` (s) later, with `engaged` flywheels on the rack until then: one step of Heun's method
/// with the ground's acceleration carried on along its tangent, and at most one impact. The terminals' acceleration moves by what the model
/// says that it moves, so that an estimator's own measure of it keeps its offset.
#[inline]
pub fn predict_from(model: &Model, configuration: &AnyConfiguration<f32>, now: &Estimate, engaged: u8, horizon: f32) -> Estimate {
    if now.standing || horizon <= 0.0 {
        return *now;
    }
    let ground = [now.ground[0] + now.ground_rate * horizon, now.ground[1]];
    let first = model.acceleration_at(configuration, now.velocity, now.ground, engaged);
    let rotation = now.rotation + (now.velocity + 0.5 * first * horizon) * horizon;
    let hits = now.side.times(rotation) < 0.0;
    let side = if hits { now.side.opposite() } else { now.side };
    let kept = if hits { model.parameters.restitution } else { 1.0 };
    let reached = kept * (now.velocity + first * horizon);
    let ahead = model.configuration(side, rotation);
    let last = model.acceleration_at(&ahead, reached, ground, engaged);
    let velocity = if hits { reached } else { now.velocity + 0.5 * (first + last) * horizon };
    let before = model.push_at(configuration, now.velocity, now.ground);
    let after = model.push_at(&ahead, velocity, ground);
    Estimate { rotation, velocity, side, push: now.push + (after - before), ground, ..*now }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::tests::example_model;
    use crate::math::sign::Sign;

    fn at(rotation: f32, velocity: f32) -> Estimate {
        let side = Sign::of(rotation, Sign::Positive);
        let ground = [-0.1, 0.0];
        let push = example_model().push(side, rotation, velocity, ground);
        Estimate { rotation, velocity, side, push, ground, ground_rate: 2.0, ..Estimate::default() }
    }

    fn predict(model: &Model, now: &Estimate, engaged: u8, horizon: f32) -> Estimate {
        predict_from(model, &model.configuration(now.side, now.rotation), now, engaged, horizon)
    }

    /// Against many small steps of the same equation.
    #[test]
    fn a_few_milliseconds_are_predicted_to_third_order() {
        let model = example_model();
        for engaged in [0, 1] {
            let mut errors = [0.0_f64; 2];
            for (error, horizon) in errors.iter_mut().zip([0.04_f32, 0.02]) {
                let start = at(0.08, -0.3);
                let ahead = predict(&model, &start, engaged, horizon);
                let (mut rotation, mut velocity) = (f64::from(start.rotation), f64::from(start.velocity));
                let steps = 4000;
                let h = f64::from(horizon) / f64::from(steps);
                for k in 0..steps {
                    let ground = -0.1 + 2.0 * h * (f64::from(k) + 0.5);
                    let middle = (rotation + 0.5 * h * velocity) as f32;
                    velocity +=
                        h * f64::from(model.acceleration(Sign::Positive, middle, velocity as f32, [ground as f32, 0.0], engaged));
                    rotation += h * velocity;
                }
                *error = (f64::from(ahead.velocity) - velocity).abs();
                assert!((f64::from(ahead.rotation) - rotation).abs() < 2.0 * f64::from(horizon * horizon * horizon));
            }
            assert!(errors[0] < 2e-4 && errors[1] < errors[0] / 3.0, "{errors:?}");
        }
    }

    #[test]
    fn an_impact_on_the_way_changes_toe_and_speed() {
        let model = example_model();
        let ahead = predict(&model, &at(0.0005, -0.3), 0, 0.004);
        assert_eq!(ahead.side, Sign::Negative);
        assert!((ahead.velocity / (-0.3 * model.parameters.restitution) - 1.0).abs() < 0.02);
        assert!(ahead.push > 0.0, "the weight brakes the rise on the other toe");
    }

    #[test]
    fn an_estimators_own_acceleration_keeps_its_offset() {
        let model = example_model();
        let mut start = at(0.1, 0.2);
        let whole = predict(&model, &start, 0, 0.003).push;
        start.push += 0.05;
        assert!((predict(&model, &start, 0, 0.003).push - whole - 0.05).abs() < 1e-6);
    }
}
