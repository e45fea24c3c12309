//! Searching and comparing numbers.

/// Where `predicate` turns from false at `low` to true at `high`, to the last bits.
pub fn boundary(mut low: f64, mut high: f64, mut predicate: impl FnMut(f64) -> bool) -> f64 {
    assert!(!predicate(low), "already true at {low}");
    assert!(predicate(high), "still false at {high}");
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if predicate(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// |a/b − 1|.
pub fn relative(a: f64, b: f64) -> f64 {
    (a / b - 1.0).abs()
}
