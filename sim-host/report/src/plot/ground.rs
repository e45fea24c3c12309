//! The ground motion that all responses share.

use sprag_sim::history::History;

use super::TimeAxis;

/// Standard gravity (m/s²), the unit of the ground acceleration panel.
const GRAVITY_M_S2: f64 = 9.806_65;

/// The ground acceleration of the longest response, in g.
pub(super) fn ground_curve(histories: &[History], axes: TimeAxis) -> Vec<(f64, f64)> {
    let end = |history: &History| history.samples.last().map_or(f64::NEG_INFINITY, |sample| sample.time_s);
    let longest = histories.iter().reduce(|best, next| if end(next) > end(best) { next } else { best });
    longest.map_or_else(Vec::new, |history| {
        let scale = axes.scale(history.frequency_parameter_1_s);
        history.samples.iter().map(|sample| (scale * sample.time_s, sample.ground_m_s2 / GRAVITY_M_S2)).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::synthetic::{overturning, safe};

    #[test]
    fn the_response_that_lasts_longest_gives_the_curve() {
        let histories = [overturning("short", 300), safe("long", 0.5, 300)];
        let curve = ground_curve(&histories, TimeAxis::Seconds);
        assert_eq!(curve.len(), histories[1].samples.len());
        let peak = curve.iter().map(|point| point.1.abs()).fold(0.0, f64::max);
        assert!(peak > 0.2 && peak < 3.0 / GRAVITY_M_S2);
    }
}
