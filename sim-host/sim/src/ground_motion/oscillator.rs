//! A support that is a damped oscillator on the ground: z̈ + 2ζω ż + ω² z = −ü_g, with z relative to the ground.
//!
//! Its response to straight lines and sines is the steady one, in closed form, and a free oscillation from what differs at the start of each
//! piece (the exact recurrence of Nigam and Jennings 1969). Wavelets without such a response are followed by chords.

use core::f64::consts::TAU;

use sprag_shared::ground::harmonic::Harmonic;
use sprag_shared::ground::{AnySegment, DampedOscillation, GroundSegment, Harmonics, Linear};
use sprag_shared::math;

use super::{Component, GroundMotion, Segment, SumSegment};

/// What is left of the oscillation, over what it was when the ground ended, when it counts as over.
pub const LEFT: f64 = 1e-4;

/// Pieces of the oscillation after the ground.
const TAIL: u32 = 10;

/// How far chords depart from a wavelet, over its largest acceleration.
const CHORD: f64 = 1e-5;

/// A damped oscillator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oscillator {
    /// Undamped natural frequency, Hz; above 0.
    pub frequency_hz: f64,
    /// Damping ratio ζ; above 0 and below 1.
    pub damping_ratio: f64,
}

/// Complex numbers as far as they are needed here.
type Complex = [f64; 2];

fn product([a, b]: Complex, [c, d]: Complex) -> Complex {
    [a * c - b * d, a * d + b * c]
}

/// Displacement (g s²) and velocity (g s) relative to the ground.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    displacement: f64,
    velocity: f64,
}

/// A stretch of ground motion, from its start on.
#[derive(Clone, Debug, Default)]
struct Input {
    line: (f64, f64),
    waves: Vec<Harmonic<f64>>,
}

impl Input {
    /// The sum `shape`, with chords over `length` (s) in the place of what has no closed response.
    fn of(shape: &SumSegment<f64>, length: f64) -> Input {
        let mut input = Input::default();
        let single;
        let parts = match shape {
            SumSegment::Single(segment) => {
                single = [(0.0, *segment)];
                &single[..]
            }
            SumSegment::Several(parts) => parts,
        };
        for (offset, part) in parts {
            input.add(*offset, part, length);
        }
        input
    }

    fn add(&mut self, offset: f64, part: &AnySegment<f64>, length: f64) {
        let mut waves = |terms: &[Harmonic<f64>]| {
            self.waves.extend(terms.iter().map(|term| Harmonic { phase: term.phase + term.frequency * offset, ..*term }));
        };
        match part {
            AnySegment::Quiet => {}
            AnySegment::Sine(sine) => waves(&sine.terms),
            AnySegment::ThreeSines(sines) => waves(&sines.terms),
            AnySegment::Linear(_) | AnySegment::Ricker(_) | AnySegment::Damped(_) => {
                let line = match part {
                    AnySegment::Linear(line) => line.after(offset),
                    _ => Linear::between(part.acceleration(offset), part.acceleration(offset + length), length),
                };
                self.line = (self.line.0 + line.start, self.line.1 + line.slope);
            }
        }
    }
}

/// How long the chords of `shape` may be, s.
fn longest_chord(shape: &SumSegment<f64>) -> f64 {
    let parts = match shape {
        SumSegment::Single(segment) => core::slice::from_ref(segment).iter().collect(),
        SumSegment::Several(parts) => parts.iter().map(|(_, part)| part).collect::<Vec<_>>(),
    };
    let curved = parts.into_iter().filter(|part| matches!(part, AnySegment::Ricker(_) | AnySegment::Damped(_)));
    curved.fold(f64::INFINITY, |length, part| {
        length.min(math::square_root(8.0 * CHORD * part.bound(f64::INFINITY) / part.curvature_bound()))
    })
}

impl Oscillator {
    fn frequency(&self) -> f64 {
        TAU * self.frequency_hz
    }

    /// μ = −ζω + iω √(1 − ζ²).
    fn exponent(&self) -> Complex {
        let (frequency, damping) = (self.frequency(), self.damping_ratio);
        [-damping * frequency, frequency * math::square_root(1.0 - damping * damping)]
    }

    /// How long it is followed after the ground, s.
    pub fn rings_for(&self) -> f64 {
        -math::ln(LEFT) / (self.damping_ratio * self.frequency())
    }

    /// −1/(ω² − Ω² + 2iζωΩ), the steady displacement over the acceleration of a wave of frequency Ω.
    fn steady(&self, wave: f64) -> Complex {
        let frequency = self.frequency();
        let (real, imaginary) = (frequency * frequency - wave * wave, 2.0 * self.damping_ratio * frequency * wave);
        let over = 1.0 / (real * real + imaginary * imaginary);
        [-real * over, imaginary * over]
    }

    /// The steady response to `input` at `time` (s).
    fn steady_state(&self, input: &Input, time: f64) -> State {
        let (frequency, (start, slope)) = (self.frequency(), input.line);
        let over = 1.0 / (frequency * frequency);
        let mut state = State {
            displacement: over * (2.0 * self.damping_ratio * slope / frequency - start - slope * time),
            velocity: -over * slope,
        };
        for wave in &input.waves {
            let (sin, cos) = math::sin_cos(wave.frequency * time + wave.phase);
            let [real, imaginary] = product(self.steady(wave.frequency), [wave.amplitude * cos, wave.amplitude * sin]);
            state.displacement += imaginary;
            state.velocity += wave.frequency * real;
        }
        state
    }

    /// C of the free oscillation Re(C e^{μt}) with the start `free`.
    fn amplitude(&self, free: State) -> Complex {
        let [decay, frequency] = self.exponent();
        [free.displacement, (decay * free.displacement - free.velocity) / frequency]
    }

    /// The acceleration relative to the ground under `input`, from `state` on, and the state after `length` (s).
    fn response(&self, state: State, input: &Input, length: f64) -> (SumSegment<f64>, State) {
        let steady = self.steady_state(input, 0.0);
        let displacement = state.displacement - steady.displacement;
        let amplitude = self.amplitude(State { displacement, velocity: state.velocity - steady.velocity });
        let exponent = self.exponent();
        let [real, imaginary] = product(product(exponent, exponent), amplitude);
        let free = AnySegment::Damped(DampedOscillation { real, imaginary, decay: -exponent[0], frequency: exponent[1] });
        let waves = input.waves.iter().map(|wave| {
            let [real, imaginary] = self.steady(wave.frequency);
            let amplitude = -wave.frequency * wave.frequency * wave.amplitude;
            // Im[a (real + i imaginary) e^{i(Ωt + φ)}], as two sines a quarter of a turn apart.
            let quarter = core::f64::consts::FRAC_PI_2;
            [(amplitude * real, 0.0), (amplitude * imaginary, quarter)].map(|(amplitude, turn)| {
                AnySegment::Sine(Harmonics {
                    terms: [Harmonic { amplitude, frequency: wave.frequency, phase: wave.phase + turn }],
                })
            })
        });
        let shape = match input.waves.is_empty() {
            true => SumSegment::Single(free),
            false => SumSegment::Several([free].into_iter().chain(waves.flatten()).map(|segment| (0.0, segment)).collect()),
        };
        let left = math::exp(exponent[0] * length);
        let (sin, cos) = math::sin_cos(exponent[1] * length);
        let turned = product(amplitude, [left * cos, left * sin]);
        let steady = self.steady_state(input, length);
        let velocity = steady.velocity + product(exponent, turned)[0];
        (shape, State { displacement: steady.displacement + turned[0], velocity })
    }

    /// What the support does relative to the ground that accelerates by `horizontal`, until the rest is [`LEFT`] of what it was when that
    /// ended. The other motions follow with the same segments.
    pub fn beside(&self, horizontal: &GroundMotion, vertical: Option<&GroundMotion>) -> Beside {
        let mut beside = Beside {
            horizontal: GroundMotion::default(),
            vertical: vertical.map(|_| GroundMotion::default()),
            support: GroundMotion::default(),
        };
        let mut state = State::default();
        for (index, segment) in horizontal.segments.iter().enumerate() {
            let up = vertical.and_then(|motion| motion.segments.get(index));
            let count = (segment.duration / longest_chord(&segment.shape)).ceil().max(1.0);
            let length = segment.duration / count;
            for k in 0..count as u32 {
                let delay = f64::from(k) * length;
                let part = |segment: &Segment| Segment {
                    start: segment.start + delay,
                    duration: length,
                    shape: if delay == 0.0 { segment.shape.clone() } else { segment.shape.after(delay) },
                    bound: segment.bound,
                };
                let level = part(segment);
                let (shape, after) = self.response(state, &Input::of(&level.shape, length), length);
                beside.support.segments.push(Segment { shape, bound: 0.0, ..level });
                beside.horizontal.segments.push(level);
                if let Some(up) = up.map(part) {
                    beside.vertical.get_or_insert_default().segments.push(up);
                }
                state = after;
            }
        }
        let (end, length) = (horizontal.duration(), self.rings_for() / f64::from(TAIL));
        if !horizontal.segments.is_empty() {
            for k in 0..TAIL {
                let quiet =
                    Segment { start: end + f64::from(k) * length, duration: length, shape: SumSegment::QUIET, bound: 0.0 };
                let (shape, after) = self.response(state, &Input::default(), length);
                beside.support.segments.push(Segment { shape, ..quiet.clone() });
                if let Some(vertical) = &mut beside.vertical {
                    vertical.segments.push(quiet.clone());
                }
                beside.horizontal.segments.push(quiet);
                state = after;
            }
        }
        beside.support.bind();
        beside
    }
}

/// Motions of the ground and of a support relative to it, with the same segments.
#[derive(Clone, Debug, Default)]
pub struct Beside {
    /// ü_g.
    pub horizontal: GroundMotion,
    /// v̈_g.
    pub vertical: Option<GroundMotion>,
    /// ü_s − ü_g.
    pub support: GroundMotion,
}

impl Beside {
    /// Of a support that accelerates by `support` itself.
    pub fn recorded(horizontal: &[Component], vertical: Option<&[Component]>, support: &Component) -> Beside {
        let mut against = vec![support.clone()];
        against.extend(horizontal.iter().map(Component::opposite));
        let [horizontal, support, vertical_motion] =
            GroundMotion::cut_together([horizontal, &against, vertical.unwrap_or_default()]);
        Beside { horizontal, vertical: vertical.map(|_| vertical_motion), support }
    }
}

#[cfg(test)]
mod tests {
    use sprag_shared::ground::Ricker;

    use super::*;

    fn at(motion: &GroundMotion, time: f64) -> f64 {
        let index = motion.segments().partition_point(|s| s.start + s.duration <= time);
        motion.segments().get(index).map_or(0.0, |s| s.shape.acceleration(time - s.start))
    }

    fn record() -> Component {
        Component::record(0.3, 0.02, (0..150).map(|k| 0.4 * math::sin(0.37 * f64::from(k)) * math::sin(0.021 * f64::from(k))))
    }

    fn wall(frequency_hz: f64, damping_ratio: f64) -> Oscillator {
        Oscillator { frequency_hz, damping_ratio }
    }

    /// z̈ of the oscillator by Runge-Kutta from kink to kink.
    fn by_steps(wall: Oscillator, ground: &GroundMotion, until: f64) -> Vec<(f64, f64)> {
        let (w, zeta) = (wall.frequency(), wall.damping_ratio);
        let mut seen = Vec::new();
        let mut y = [0.0_f64; 2];
        let quiet = Segment { start: ground.duration(), duration: until, shape: SumSegment::QUIET, bound: 0.0 };
        for segment in ground.segments().iter().chain([&quiet]) {
            let steps = (segment.duration * 1000.0 * wall.frequency_hz.max(4.0)).ceil();
            let h = segment.duration / steps;
            let rate = |t: f64, y: [f64; 2]| [y[1], -segment.shape.acceleration(t) - 2.0 * zeta * w * y[1] - w * w * y[0]];
            for k in 0..steps as u32 {
                let t = f64::from(k) * h;
                seen.push((segment.start + t, rate(t, y)[1]));
                let go = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
                let a = rate(t, y);
                let b = rate(t + h / 2.0, go(y, a, h / 2.0));
                let c = rate(t + h / 2.0, go(y, b, h / 2.0));
                let d = rate(t + h, go(y, c, h));
                y = go(go(go(go(y, a, h / 6.0), b, h / 3.0), c, h / 3.0), d, h / 6.0);
            }
        }
        seen
    }

    #[test]
    fn its_response_is_that_of_its_equation() {
        let sine = Component::pulse(0.6, 1.0, AnySegment::Sine(Harmonics::sine(0.4, 9.0)));
        let block = Component::pulse(0.1, 0.8, AnySegment::Linear(Linear::constant(0.05)));
        let wavelet = Component::pulse(0.0, 1.2, AnySegment::Ricker(Ricker { amplitude: 0.3, rate: 10.0, centre: 0.6 }));
        for (components, error) in [
            (vec![record()], 1e-9),
            (vec![sine.clone(), block.clone()], 1e-9),
            (vec![record(), sine, block], 1e-9),
            // Chords; near resonance an input counts 1/(2ζ) times.
            (vec![wavelet], 10.0 * CHORD),
        ] {
            let ground = GroundMotion::sum(&components);
            for wall in [wall(5.0, 0.05), wall(1.0, 0.02), wall(0.3, 0.5), wall(20.0, 0.9)] {
                let beside = wall.beside(&ground, None);
                let ends = beside.support.duration();
                assert!((ends - ground.duration() - wall.rings_for()).abs() < 1e-9);
                for (time, expected) in by_steps(wall, &ground, wall.rings_for().min(3.0)) {
                    // Where the ground jumps both sides are right.
                    let next = ground.segments().partition_point(|s| s.start < time - 1e-9);
                    let jumps = ground.segments().get(next).is_some_and(|s| s.start < time + 1e-9);
                    let found = at(&beside.support, time);
                    assert!(jumps || (found - expected).abs() < error, "{wall:?} at {time}: {found} and {expected}");
                    assert!((at(&beside.horizontal, time) - at(&ground, time)).abs() < 1e-12 || jumps);
                }
                let last = beside.support.segments().last().unwrap();
                let (first, left) = (beside.support.segments().iter().rev().nth(9).unwrap().bound, last.shape.bound(0.0));
                assert!(left <= first && last.shape.acceleration(last.duration).abs() <= LEFT * first * (1.0 + 1e-9));
                assert!(beside.support.segments().iter().all(|s| s.bound >= s.shape.acceleration(0.7 * s.duration).abs()));
            }
        }
    }

    /// A stiff wall moves with the ground, but for z̈ ≈ −(d²ü_g/dt²)/ω².
    #[test]
    fn the_stiffer_it_is_the_less_it_moves() {
        let wave = 7.0;
        let ground = GroundMotion::sum(&[Component::pulse(0.0, 20.0, AnySegment::Sine(Harmonics::sine(0.4, wave)))]);
        // Near the end the start is forgotten.
        let largest = |frequency_hz: f64| {
            let beside = wall(frequency_hz, 0.3).beside(&ground, None);
            (0..400).map(|k| at(&beside.support, 18.0 + 0.005 * f64::from(k)).abs()).fold(0.0, f64::max)
        };
        for frequency in [50.0, 100.0, 200.0] {
            let ratio = wave / (TAU * frequency);
            assert!((largest(frequency) / (0.4 * ratio * ratio) - 1.0).abs() < 0.01, "{frequency}");
        }
    }

    /// Under a long sine at its own frequency the wall's absolute acceleration is √(1 + 4ζ²)/(2ζ) times the ground's.
    #[test]
    fn at_resonance_it_amplifies_as_a_damped_oscillator_does() {
        for zeta in [0.02, 0.05, 0.2] {
            let wave = TAU * 2.0;
            let ground = GroundMotion::sum(&[Component::pulse(0.0, 80.0, AnySegment::Sine(Harmonics::sine(0.1, wave)))]);
            let beside = wall(2.0, zeta).beside(&ground, None);
            let absolute = |time: f64| at(&beside.support, time) + at(&ground, time);
            let largest = (0..2000).map(|k| absolute(79.0 + 0.0005 * f64::from(k)).abs()).fold(0.0, f64::max);
            let expected = 0.1 * math::square_root(1.0 + 4.0 * zeta * zeta) / (2.0 * zeta);
            assert!((largest / expected - 1.0).abs() < 1e-5, "ζ = {zeta}: {largest} and {expected}");
        }
    }

    #[test]
    fn a_record_of_its_own_counts_against_the_ground() {
        let ground = [record()];
        let support = Component::record(0.3, 0.013, (0..300).map(|k| 0.5 * math::sin(0.2 * f64::from(k))));
        let vertical = [Component::pulse(0.0, 1.0, AnySegment::Sine(Harmonics::sine(0.1, 11.0)))];
        let beside = Beside::recorded(&ground, Some(&vertical), &support);
        let alone = [&ground[0], &support, &vertical[0]].map(|one| GroundMotion::sum(std::slice::from_ref(one)));
        for k in 0..900 {
            let time = 0.005 * f64::from(k) + 0.0007;
            assert!((at(&beside.horizontal, time) - at(&alone[0], time)).abs() < 1e-14);
            assert!((at(&beside.support, time) - at(&alone[1], time) + at(&alone[0], time)).abs() < 1e-13, "{time}");
            assert!((at(beside.vertical.as_ref().unwrap(), time) - at(&alone[2], time)).abs() < 1e-14);
        }
        let same = Beside::recorded(&ground, None, &ground[0]);
        assert!(same.vertical.is_none() && same.support.segments().iter().all(|s| s.bound == 0.0));
    }
}
