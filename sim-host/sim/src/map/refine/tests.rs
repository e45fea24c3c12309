//! Boundaries that are known in closed form.

use std::cell::RefCell;
use std::collections::HashSet;
use std::convert::Infallible;

use sprag_shared::math::{exp, hypot, pow, sin};

use super::{Polyline, Position, Tolerance, Traced, trace};

const GRID: usize = 9;

/// Traces on a grid of `GRID` x `GRID` points over the unit square, to `tolerance` of it; no place is asked for twice.
fn traced(tolerance: f64, budget: usize, outcome: impl Fn(f64, f64) -> u8) -> Traced<u8> {
    let seen = RefCell::new(HashSet::new());
    let steps = (GRID - 1) as f64;
    let grid: Vec<u8> =
        (0..GRID * GRID).map(|index| outcome((index % GRID) as f64 / steps, (index / GRID) as f64 / steps)).collect();
    let shares = vec![tolerance * steps; GRID - 1];
    let evaluate = |places: &[Position]| {
        let new = |place: &Position| {
            assert!(place.column.fract() != 0.0 || place.row.fract() != 0.0, "{place:?} is a grid point");
            assert!(seen.borrow_mut().insert((place.column.to_bits(), place.row.to_bits())), "{place:?} twice");
            outcome(place.column / steps, place.row / steps)
        };
        Ok::<_, Infallible>(places.iter().map(new).collect())
    };
    let Ok(traced) = trace(GRID, &grid, Tolerance { columns: shares.clone(), rows: shares }, budget, &evaluate);
    assert_eq!(traced.evaluations, seen.borrow().len());
    assert!(traced.evaluations <= budget);
    traced
}

fn points(polyline: &Polyline<u8>) -> Vec<(f64, f64)> {
    let steps = (GRID - 1) as f64;
    polyline.vertices.iter().map(|place| (place.column / steps, place.row / steps)).collect()
}

/// The vertices and the middles between them.
fn samples(polyline: &Polyline<u8>) -> Vec<(f64, f64)> {
    let vertices = points(polyline);
    let middles = vertices.windows(2).map(|pair| (0.5 * (pair[0].0 + pair[1].0), 0.5 * (pair[0].1 + pair[1].1)));
    middles.chain(vertices.iter().copied()).collect()
}

fn length(polyline: &Polyline<u8>) -> f64 {
    points(polyline).windows(2).map(|pair| hypot(pair[1].0 - pair[0].0, pair[1].1 - pair[0].1)).sum()
}

/// All vertices and middles lie within `tolerance` of the zero of a signed `distance`; returns the largest.
fn hold(traced: &Traced<u8>, tolerance: f64, distance: impl Fn(f64, f64) -> f64) -> f64 {
    assert_eq!(traced.unresolved, Default::default());
    let worst = traced.polylines.iter().flat_map(samples).map(|(x, y)| distance(x, y).abs()).fold(0.0, f64::max);
    assert!(worst <= tolerance, "{worst:e} beyond {tolerance:e}");
    worst
}

const PLENTY: usize = 10_000_000;

#[test]
fn a_circle() {
    let (centre, radius) = ((0.53, 0.47), 0.31);
    let distance = |x: f64, y: f64| hypot(x - centre.0, y - centre.1) - radius;
    for tolerance in [1e-3, 1e-5, 1e-6] {
        let circle = traced(tolerance, PLENTY, |x, y| u8::from(distance(x, y) < 0.0));
        println!("{tolerance:e}: worst {:e}", hold(&circle, tolerance, distance) / tolerance);
        let [polyline] = &circle.polylines[..] else { panic!("{} polylines", circle.polylines.len()) };
        assert_eq!(polyline.vertices.first(), polyline.vertices.last());
        let exact = std::f64::consts::TAU * radius;
        let error = length(polyline) / exact - 1.0;
        println!("length {error:e}");
        assert!(error.abs() < tolerance, "{error:e}");
        // Outside, which is the lesser, lies on the left: clockwise.
        let vertices = points(polyline);
        let area: f64 = vertices.windows(2).map(|pair| 0.5 * (pair[0].0 * pair[1].1 - pair[1].0 * pair[0].1)).sum();
        assert!((area / (-std::f64::consts::PI * radius * radius) - 1.0).abs() < 2.0 * tolerance / radius);
    }
}

#[test]
fn a_line() {
    let distance = |x: f64, y: f64| (0.37 * x - y + 0.213) / hypot(0.37, 1.0);
    let line = traced(1e-6, PLENTY, |x, y| u8::from(distance(x, y) < 0.0));
    hold(&line, 1e-6, distance);
    let [polyline] = &line.polylines[..] else { panic!("{} polylines", line.polylines.len()) };
    // Below the line, which is the lesser, lies on the left.
    let ends = points(polyline);
    assert_eq!((ends[0].0, ends[ends.len() - 1].0), (1.0, 0.0));
    assert!((length(polyline) - hypot(0.37, 1.0)).abs() < 1e-6);
}

#[test]
fn a_line_on_a_row_of_the_grid() {
    let line = traced(1e-6, PLENTY, |_, y| u8::from(y > 0.25));
    hold(&line, 1e-6, |_, y| y - 0.25);
    assert_eq!(line.polylines.len(), 1);
}

#[test]
fn two_lines_that_cross() {
    let (first, second) = (|x: f64, y: f64| y - 0.6 * x - 0.111, |x: f64, y: f64| y + 0.9 * x - 0.907);
    let lines = traced(1e-6, PLENTY, |x, y| u8::from(first(x, y) * second(x, y) < 0.0));
    hold(&lines, 1e-6, |x, y| (first(x, y) / hypot(0.6, 1.0)).abs().min((second(x, y) / hypot(0.9, 1.0)).abs()));
    // Both go from edge to edge, with a bend where they meet.
    assert_eq!(lines.polylines.len(), 2);
    for polyline in &lines.polylines {
        let ends = points(polyline);
        for (x, y) in [ends[0], ends[ends.len() - 1]] {
            assert!([x, y].iter().any(|end| *end == 0.0 || *end == 1.0), "{x} {y}");
        }
    }
}

#[test]
fn a_triple_point() {
    let (x0, y0) = (0.4321, 0.5678);
    let outcome = |x: f64, y: f64| if y < y0 { 2 } else { u8::from(x + 0.3 * y < x0 + 0.3 * y0) };
    let traced = traced(1e-6, PLENTY, outcome);
    let off = |x: f64, y: f64| (y - y0).abs().min(if y > y0 - 1e-6 { (x - x0 + 0.3 * (y - y0)).abs() } else { 1.0 });
    hold(&traced, 1e-6, off);
    let pairs: Vec<(u8, u8)> = traced.polylines.iter().map(|polyline| (polyline.left, polyline.right)).collect();
    assert_eq!(pairs, [(0, 1), (0, 2), (1, 2)]);
    // One end of each is the triple point.
    let near = |(x, y): &(f64, f64)| hypot(x - x0, y - y0) < 1e-6;
    for polyline in &traced.polylines {
        let ends = points(polyline);
        assert_eq!([ends[0], ends[ends.len() - 1]].iter().filter(|end| near(end)).count(), 1);
    }
}

#[test]
fn a_cusp() {
    let height = |x: f64| if x > 0.3 { 0.8 * pow(x - 0.3, 1.5) } else { 0.0 };
    let outcome = |x: f64, y: f64| u8::from(x > 0.3 && (y - 0.5071).abs() < height(x));
    let cusp = traced(1e-6, PLENTY, outcome);
    // Vertically, which is no less than the distance.
    hold(&cusp, 2e-6, |x, y| (y - 0.5071).abs() - height(x));
    assert_eq!(cusp.polylines.len(), 1);
    let tip = samples(&cusp.polylines[0]).iter().map(|point| point.0).fold(1.0, f64::min);
    // Where the branches are nearer than the tolerance they may be one.
    println!("tip {:e}", tip - 0.3);
    assert!(tip - 0.3 < 3e-4 && tip > 0.3 - 1e-6, "{tip}");
}

/// A straight line with waves whose points of inflection lie on lines of the squares.
#[test]
fn inflections_are_not_straight() {
    let wave = |x: f64| 0.513 + 0.02 * sin(std::f64::consts::TAU * 4.0 * x);
    let waves = traced(1e-6, PLENTY, |x, y| u8::from(y < wave(x)));
    hold(&waves, 1e-6, |x, y| y - wave(x));
}

#[test]
fn a_boundary_is_followed_out_of_sight_of_the_grid() {
    // A spike up from below, thinner than the grid, which no grid point lies in but for its foot.
    let width = |y: f64| 0.04 * (0.71 - y);
    let outcome = |x: f64, y: f64| u8::from(y < 0.03 || (x - 0.5801).abs() < width(y));
    let spike = traced(1e-6, PLENTY, outcome);
    assert_eq!(spike.polylines.len(), 1);
    let top = samples(&spike.polylines[0]).iter().map(|point| point.1).fold(0.0, f64::max);
    println!("top {top}");
}

/// Two boundaries whose distance falls from a part of a square far below the tolerance: each is followed as if it were alone, and where
/// they cannot be distinguished they are a bundle.
#[test]
fn boundaries_side_by_side_are_followed() {
    let lower = |x: f64| 0.213 + 0.3 * x + 0.2 * x * x;
    let upper = |x: f64| lower(x) + exp(-3.0 / (x + 0.05));
    for between in [1, 2] {
        let outcome = |x: f64, y: f64| {
            if y < lower(x) {
                0
            } else if y < upper(x) {
                between
            } else {
                1
            }
        };
        let both = traced(1e-6, PLENTY, outcome);
        if between == 1 {
            hold(&both, 1e-6, |x, y| y - lower(x));
            assert_eq!(both.polylines.len(), 1);
        } else {
            hold(&both, 1e-6, |x, y| (y - lower(x)).abs().min((y - upper(x)).abs()));
        }
        assert!(both.evaluations < 60_000, "{}", both.evaluations);
    }
}

/// Noise has a boundary everywhere.
fn noise(x: f64, y: f64) -> u8 {
    let mut bits = x.to_bits().wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ y.to_bits().rotate_left(31);
    for _ in 0..3 {
        bits = (bits ^ (bits >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    }
    (bits >> 61) as u8 % 3
}

#[test]
fn noise_ends_with_the_budget_and_is_reported() {
    for budget in [0, 1, 10, 500, 20_000] {
        let noise = traced(1e-6, budget, noise);
        assert!(noise.unresolved.squares > 0 && noise.unresolved.largest >= 1.0, "{:?}", noise.unresolved);
        println!("{:?}", noise.unresolved);
        assert_eq!(noise.evaluations, budget);
    }
}

#[test]
fn a_circle_beside_noise_is_traced() {
    let distance = |x: f64, y: f64| hypot(x - 0.7, y - 0.7) - 0.2;
    let outcome = |x: f64, y: f64| if x.max(y) < 0.3 { noise(x, y) } else { u8::from(distance(x, y) < 0.0) };
    let both = traced(1e-6, 200_000, outcome);
    assert!(both.unresolved.squares > 0);
    println!("{:?}", both.unresolved);
    let circle = both.polylines.iter().filter(|polyline| points(polyline).iter().all(|point| point.0.max(point.1) > 0.4));
    let lengths: Vec<f64> = circle.map(length).collect();
    assert_eq!(lengths.len(), 1);
    assert!((lengths[0] / (0.2 * std::f64::consts::TAU) - 1.0).abs() < 1e-6);
}

#[test]
fn swapped_axes_swap_the_result() {
    let outcome = |x: f64, y: f64| if hypot(x - 0.4, 0.7 * y - 0.3) < 0.25 { 1 } else { 2 * u8::from(x + 0.2 * y * y > 0.8) };
    let (one, other) = (traced(1e-5, PLENTY, outcome), traced(1e-5, PLENTY, |x, y| outcome(y, x)));
    assert_eq!(one.evaluations, other.evaluations);
    let sorted = |traced: &Traced<u8>, swap: bool| {
        let all = traced.polylines.iter().flat_map(|polyline| {
            let pair = (polyline.left, polyline.right);
            polyline.vertices.iter().map(move |place| {
                let (x, y) = if swap { (place.row, place.column) } else { (place.column, place.row) };
                (pair, x.to_bits(), y.to_bits())
            })
        });
        let mut all: Vec<_> = all.collect();
        all.sort_unstable();
        all.dedup();
        all
    };
    assert_eq!(sorted(&one, false), sorted(&other, true));
}

#[test]
fn evaluations_grow_with_the_root_of_the_accuracy() {
    let outcome = |x: f64, y: f64| u8::from(hypot(x - 0.53, y - 0.47) < 0.31);
    let counts = [1e-3, 1e-5, 1e-7].map(|tolerance| traced(tolerance, PLENTY, outcome).evaluations);
    // Ten times the vertices, each with a longer bisection, and squares are halved at whole levels only; a uniform grid would need 10⁴ times
    // the points.
    assert!(counts.windows(2).all(|pair| pair[1] < 20 * pair[0]), "{counts:?}");
    assert!(counts[1] < 30_000, "{counts:?}");
}

#[test]
fn a_single_row_is_narrowed() {
    let steps = 4.0;
    let outcome = |x: f64| {
        if x < 0.3 {
            0
        } else if x < 0.31 {
            1
        } else {
            2
        }
    };
    let grid: Vec<u8> = (0..5).map(|index| outcome(index as f64 / steps)).collect();
    let evaluate = |places: &[Position]| Ok::<_, Infallible>(places.iter().map(|place| outcome(place.column / steps)).collect());
    let tolerance = || Tolerance { columns: vec![4e-6; 4], rows: Vec::new() };
    let Ok(found) = trace(5, &grid, tolerance(), PLENTY, &evaluate);
    let [first, second] = &found.polylines[..] else { panic!("{found:?}") };
    for (polyline, at, pair) in [(first, 0.3, (0, 1)), (second, 0.31, (1, 2))] {
        assert_eq!((polyline.left, polyline.right), pair);
        assert!((polyline.vertices[0].column / steps - at).abs() < 1e-6);
    }
    assert_eq!(found.unresolved, Default::default());
    let Ok(poor) = trace(5, &grid, tolerance(), 5, &evaluate);
    assert!(poor.evaluations == 5 && poor.unresolved.squares == 2 && poor.unresolved.largest > 1e3, "{poor:?}");
}

#[test]
fn a_grid_without_boundaries_costs_nothing() {
    let empty = traced(1e-6, PLENTY, |_, _| 1);
    assert_eq!(empty, Traced { polylines: Vec::new(), evaluations: 0, unresolved: Default::default() });
}
