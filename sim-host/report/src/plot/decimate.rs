//! Fewer points with the same picture: per pixel column the first, lowest, highest and last point stay.

use std::ops::Range;

/// Keeps at most four points per column of `columns` equal columns over `span`: first, lowest, highest and last.
///
/// `points` are in order of their first coordinate. Order is kept, extremes are kept exactly, and a curve with few
/// points per column comes back unchanged.
pub(super) fn decimate(points: &[(f64, f64)], span: &Range<f64>, columns: usize) -> Vec<(f64, f64)> {
    let column_of = |x: f64| ((x - span.start) / (span.end - span.start) * columns as f64) as usize;
    let mut kept = Vec::new();
    let mut start = 0;
    while start < points.len() {
        let column = column_of(points[start].0);
        let length = points[start..].iter().take_while(|point| column_of(point.0) == column).count();
        let members = &points[start..start + length];
        let mut lowest = 0;
        let mut highest = 0;
        for (index, point) in members.iter().enumerate() {
            if point.1 < members[lowest].1 {
                lowest = index;
            }
            if point.1 > members[highest].1 {
                highest = index;
            }
        }
        let mut chosen = [0, lowest, highest, length - 1];
        chosen.sort_unstable();
        for (place, &index) in chosen.iter().enumerate() {
            if place == 0 || index != chosen[place - 1] {
                kept.push(members[index]);
            }
        }
        start += length;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A rough curve without a random generator: a linear congruential sequence.
    fn rough(count: usize) -> Vec<(f64, f64)> {
        let mut state = 12_345_u64;
        (0..count)
            .map(|index| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (index as f64 / count as f64 * 7.0, (state >> 40) as f64)
            })
            .collect()
    }

    #[test]
    fn extremes_and_ends_stay_and_order_holds() {
        let points = rough(100_000);
        let kept = decimate(&points, &(0.0..7.0), 500);
        assert!(kept.len() <= 4 * 501);
        assert_eq!(kept.first(), points.first());
        assert_eq!(kept.last(), points.last());
        assert!(kept.windows(2).all(|pair| pair[0].0 <= pair[1].0));
        for column in 0..500 {
            let inside = |point: &&(f64, f64)| (point.0 / 7.0 * 500.0) as usize == column;
            for pick in [f64::min, f64::max] {
                let all = points.iter().filter(inside).map(|point| point.1).reduce(pick);
                assert_eq!(all, kept.iter().filter(inside).map(|point| point.1).reduce(pick));
            }
        }
    }

    #[test]
    fn sparse_curves_and_jumps_are_unchanged() {
        let points = [(0.0, 1.0), (0.5, 2.0), (0.5, -2.0), (1.0, 0.0)];
        assert_eq!(decimate(&points, &(0.0..1.0), 100), points);
        assert!(decimate(&[], &(0.0..1.0), 100).is_empty());
    }
}
