//! Pareto fronts: what cannot be had for less.

/// Which of the `points` nothing else betters: no other point is as small in both coordinates and smaller in one. Of equal points all
/// are on the front, or none.
pub fn undominated(points: &[(f64, f64)]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| {
        let (a, b) = (points[*a], points[*b]);
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let mut on_front = vec![false; points.len()];
    // By rising first coordinate, the first of those that are lower than all before.
    let mut lowest: Option<(f64, f64)> = None;
    for index in order {
        let point = points[index];
        if lowest.is_none_or(|lowest| point.1 < lowest.1 || point == lowest) {
            on_front[index] = true;
            lowest = Some(point);
        }
    }
    on_front
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points on a coarse lattice, so that many coincide in one coordinate or both: a linear congruential sequence.
    fn scattered(count: usize, values: u64) -> Vec<(f64, f64)> {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 33) % values) as f64
        };
        (0..count).map(|_| (next(), next())).collect()
    }

    #[test]
    fn a_front_is_what_no_point_betters() {
        for (count, values) in [(1, 5), (40, 6), (200, 30), (200, 1000)] {
            let points = scattered(count, values);
            let betters = |a: (f64, f64), b: (f64, f64)| a.0 <= b.0 && a.1 <= b.1 && a != b;
            let expected: Vec<bool> = points.iter().map(|point| !points.iter().any(|other| betters(*other, *point))).collect();
            assert_eq!(undominated(&points), expected, "{count} of {values}");
            assert!(expected.contains(&true));
        }
    }

    #[test]
    fn what_is_off_a_front_is_bettered_by_a_member() {
        let points = scattered(300, 50);
        let on_front = undominated(&points);
        let members = || points.iter().zip(&on_front).filter(|(_, on)| **on).map(|(point, _)| *point);
        for (point, _) in points.iter().zip(&on_front).filter(|(_, on)| !**on) {
            assert!(members().any(|member| member.0 <= point.0 && member.1 <= point.1));
        }
        assert!(undominated(&[]).is_empty());
        assert_eq!(undominated(&[(1.0, 1.0), (1.0, 1.0), (1.0, 2.0)]), [true, true, false]);
    }
}
