//! The single-precision sine and cosine, at every f32 in [−π, π]: the bound of their error is a proof by exhaustion.

use std::thread;

use sprag_shared::math::lanes::Lanes;
use sprag_shared::math::sine32::{ERROR_BOUND, sin_cos};
use sprag_shared::math::{self, wide_sine};

/// Angles at a time: as many as the lanes of the double-precision reference.
const WIDTH: usize = 8;

/// Largest errors over angles with consecutive bits, and the bits that have them.
#[derive(Clone, Copy, Debug, Default)]
struct Worst {
    sine: f64,
    cosine: f64,
    sine_at: u32,
    cosine_at: u32,
}

impl Worst {
    fn merge(self, other: Worst) -> Worst {
        let (sine, sine_at) = if other.sine > self.sine { (other.sine, other.sine_at) } else { (self.sine, self.sine_at) };
        let (cosine, cosine_at) =
            if other.cosine > self.cosine { (other.cosine, other.cosine_at) } else { (self.cosine, self.cosine_at) };
        Worst { sine, cosine, sine_at, cosine_at }
    }
}

/// The angles with bits from `from` to before `to`, and with them their negatives.
fn worst(from: u32, to: u32) -> Worst {
    let mut worst = Worst::default();
    let mut uneven = false;
    let mut start = from;
    while start < to {
        // The last ones again rather than ones too far.
        start = start.min(to - WIDTH as u32);
        let angles: [f32; WIDTH] = std::array::from_fn(|lane| f32::from_bits(start + lane as u32));
        let (sine, cosine) = wide_sine::sin_cos(Lanes(angles.map(f64::from)));
        let (mut sine_error, mut cosine_error) = ([0.0; WIDTH], [0.0; WIDTH]);
        for lane in 0..WIDTH {
            let (s, c) = sin_cos(angles[lane]);
            let (minus_s, same_c) = sin_cos(-angles[lane]);
            uneven |= (s != -minus_s) | (c != same_c);
            sine_error[lane] = (f64::from(s) - sine.0[lane]).abs();
            cosine_error[lane] = (f64::from(c) - cosine.0[lane]).abs();
        }
        let largest = |errors: [f64; WIDTH]| errors.iter().fold(0.0, |a: f64, &b| if b > a { b } else { a });
        let (sine, cosine) = (largest(sine_error), largest(cosine_error));
        if sine > worst.sine || cosine > worst.cosine {
            worst = worst.merge(Worst { sine, cosine, sine_at: start, cosine_at: start });
        }
        start += WIDTH as u32;
    }
    assert!(!uneven, "sin −x = −sin x and cos −x = cos x to the last bit");
    worst
}

#[test]
fn every_angle_keeps_to_the_error_bound() {
    let end = std::f32::consts::PI.to_bits() + 1;
    // Large angles cost the same as small ones, so equal runs of bits are equal work; more runs than cores even it out.
    let runs = 4 * thread::available_parallelism().map_or(1, std::num::NonZero::get) as u64;
    let bound = |run: u64| (u64::from(end) * run / runs) as u32;
    let worst = thread::scope(|scope| {
        let threads: Vec<_> = (0..runs).map(|run| scope.spawn(move || worst(bound(run), bound(run + 1)))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).fold(Worst::default(), Worst::merge)
    });
    println!(
        "{end} angles and their negatives: sine {:.4e} near {:?}, cosine {:.4e} near {:?}",
        worst.sine,
        f32::from_bits(worst.sine_at),
        worst.cosine,
        f32::from_bits(worst.cosine_at)
    );
    let largest = worst.sine.max(worst.cosine);
    assert!(largest <= ERROR_BOUND, "{largest:e} above {ERROR_BOUND:e}");
    assert!(largest > 0.95 * ERROR_BOUND, "{largest:e}: the bound {ERROR_BOUND:e} could be tighter");
}

/// The reference above is itself within 1e-15 of libm, here at a thinned-out choice of the same angles.
#[test]
fn the_reference_agrees_with_libm() {
    for bits in (0..=std::f32::consts::PI.to_bits()).step_by(4099) {
        let x = f64::from(f32::from_bits(bits));
        let (sine, cosine) = wide_sine::sin_cos(x);
        let (exact_sine, exact_cosine) = math::sin_cos(x);
        assert!((sine - exact_sine).abs() < 1e-15 && (cosine - exact_cosine).abs() < 1e-15, "{x}");
    }
}
