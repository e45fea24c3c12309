//! Sines: the one-cycle sine and cosine pulses, the half sine, and the Mavroeidis-Papageorgiou wavelet, which is a sum
//! of three.

use super::elementary::Wave;
use super::{Elementary, GroundSegment};
use crate::math;
use crate::math::scalar::Real;

/// One term A sin(ωτ + φ).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonic<S> {
    /// A, in g.
    pub amplitude: S,
    /// ω, rad/s, not negative.
    pub frequency: S,
    /// φ, rad.
    pub phase: S,
}

/// ü_g/g = Σ A_i sin(ω_i τ + φ_i).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Harmonics<S, const M: usize> {
    /// The terms.
    pub terms: [Harmonic<S>; M],
}

impl<S> Harmonics<S, 0> {
    /// No motion.
    pub const QUIET: Self = Harmonics { terms: [] };
}

impl<S: Real> Harmonics<S, 1> {
    /// The sine pulse A sin ωτ; one cycle lasts 2π/ω, a half-sine pulse π/ω.
    pub fn sine(amplitude: S, frequency: S) -> Self {
        Harmonics { terms: [Harmonic { amplitude, frequency, phase: S::ZERO }] }
    }

    /// The cosine pulse A cos ωτ.
    pub fn cosine(amplitude: S, frequency: S) -> Self {
        Harmonics { terms: [Harmonic { amplitude, frequency, phase: S::of(core::f64::consts::FRAC_PI_2) }] }
    }
}

impl<S: Real, const M: usize> Harmonics<S, M> {
    /// Upper bound of |ü_g/g|.
    pub fn bound(&self) -> S {
        self.terms.iter().fold(S::ZERO, |sum, term| sum + term.amplitude.abs())
    }

    /// In precision `T`.
    pub fn to<T: Real>(&self) -> Harmonics<T, M> {
        let precise = |number: S| T::of(number.to_f64());
        Harmonics {
            terms: self.terms.map(|term| Harmonic {
                amplitude: precise(term.amplitude),
                frequency: precise(term.frequency),
                phase: precise(term.phase),
            }),
        }
    }
}

/// The near-fault pulse of Mavroeidis and Papageorgiou (2003), in velocity
///
/// v(τ) = (A/2) [1 + cos(2πf(τ−t₀)/γ)] cos(2πf(τ−t₀) + ν),  |τ − t₀| ≤ γ/(2f),
///
/// whose derivative, by the product formulas, is three sines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MavroeidisPapageorgiou {
    /// A, peak velocity of the envelope, m/s.
    pub velocity_amplitude: f64,
    /// f, Hz; above 0.
    pub frequency: f64,
    /// γ, number of cycles: the pulse lasts γ/f; above 1.
    pub oscillations: f64,
    /// ν, rad.
    pub phase: f64,
}

impl MavroeidisPapageorgiou {
    /// From the pulse's first instant, τ = 0 where the envelope rises from zero.
    pub fn harmonics(&self) -> Harmonics<f64, 3> {
        let carrier = core::f64::consts::TAU * self.frequency;
        let envelope = carrier / self.oscillations;
        // With x = τ − t₀: v = (A/2) cos(ωx+ν) + (A/4) cos((ω+ω_e)x+ν) + (A/4) cos((ω−ω_e)x+ν).
        let half_duration = self.duration() / 2.0;
        let term = |weight: f64, frequency: f64| Harmonic {
            amplitude: -weight * self.velocity_amplitude * frequency / crate::structure::block::GRAVITY,
            frequency,
            phase: self.phase - frequency * half_duration,
        };
        Harmonics { terms: [term(0.5, carrier), term(0.25, carrier + envelope), term(0.25, carrier - envelope)] }
    }

    /// γ/f, s.
    pub fn duration(&self) -> f64 {
        self.oscillations / self.frequency
    }
}

impl<S: Real, const M: usize> GroundSegment<S> for Harmonics<S, M> {
    // Out of line, for `AnySegment`.
    #[inline(never)]
    fn acceleration(&self, time: S) -> S {
        self.terms
            .iter()
            .fold(S::ZERO, |sum, term| sum + term.amplitude * (term.frequency * time + term.phase).sin_cos_of_phase().0)
    }

    fn slope(&self, time: S) -> S {
        self.terms.iter().fold(S::ZERO, |sum, term| {
            sum + term.amplitude * term.frequency * (term.frequency * time + term.phase).sin_cos_of_phase().1
        })
    }

    fn gain(&self, time: S) -> S {
        self.terms.iter().fold(S::ZERO, |sum, term| {
            // (cos φ − cos(ωτ + φ))/ω = τ sin(φ + x) sin x / x with x = ωτ/2, which loses nothing.
            let x = S::HALF * term.frequency * time;
            let share = if x == S::ZERO { S::ONE } else { x.sin_cos_of_phase().0 / x };
            sum + term.amplitude * (term.phase + x).sin_cos_of_phase().0 * (share * time)
        })
    }

    fn curvature_bound(&self) -> S {
        self.terms.iter().fold(S::ZERO, |sum, term| sum + term.amplitude.abs() * (term.frequency * term.frequency))
    }

    fn angular_frequency(&self) -> S {
        self.terms.iter().fold(S::ZERO, |fastest, term| fastest.larger(term.frequency))
    }

    fn series(&self, time: S, coefficients: &mut [S]) {
        coefficients.fill(S::ZERO);
        for term in &self.terms {
            // d²/dτ² = −ω², so c_{k+2} = −ω² c_k / ((k+1)(k+2)).
            let (sin, cos) = (term.frequency * time + term.phase).sin_cos_of_phase();
            let mut even = term.amplitude * sin;
            let mut odd = term.amplitude * cos * term.frequency;
            let factor = -(term.frequency * term.frequency);
            let mut k = 0;
            for pair in coefficients.chunks_mut(2) {
                for (slot, next) in pair.iter_mut().zip([&mut even, &mut odd]) {
                    *slot = *slot + *next;
                    *next = *next * factor * S::of(math::RECIPROCALS[(k + 1) & 63] * math::RECIPROCALS[(k + 2) & 63]);
                    k += 1;
                }
            }
        }
    }

    fn is_quiet(&self) -> bool {
        M == 0
    }

    fn elementary(&self, time: S) -> Option<Elementary<S>> {
        self.terms.iter().try_fold(Elementary::line(S::ZERO), |sum, term| {
            let (sine, cosine) = (term.frequency * time + term.phase).sin_cos_of_phase();
            sum.with(Wave { frequency: term.frequency, sine: term.amplitude * sine, cosine: term.amplitude * cosine })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_and_a_cosine() {
        let sine = Harmonics::sine(1.5, 4.0);
        crate::ground::check::consistency(&sine, &[0.0, 0.3, 1.2]);
        crate::ground::check::consistency(&Harmonics::cosine(0.7, 7.0), &[0.0, 0.3, 0.8]);
        assert!((GroundSegment::<f64>::acceleration(&sine, 0.1) - 1.5 * math::sin(0.4)).abs() < 1e-15);
    }

    #[test]
    fn the_wavelet_is_the_derivative_of_its_velocity_and_ends_at_rest() {
        let wavelet = MavroeidisPapageorgiou { velocity_amplitude: 0.9, frequency: 0.5, oscillations: 1.8, phase: 0.6 };
        let motion = wavelet.harmonics();
        crate::ground::check::consistency(&motion, &[0.05, 1.0, 3.0]);
        let t0 = wavelet.duration() / 2.0;
        let velocity = |t: f64| {
            let x = t - t0;
            let carrier = core::f64::consts::TAU * wavelet.frequency;
            0.5 * wavelet.velocity_amplitude
                * (1.0 + math::cos(carrier * x / wavelet.oscillations))
                * math::cos(carrier * x + wavelet.phase)
        };
        for t in [0.2, 1.1, 1.8, 2.9] {
            let slope = (velocity(t + 1e-5) - velocity(t - 1e-5)) / 2e-5 / crate::structure::block::GRAVITY;
            assert!((slope - motion.acceleration(t)).abs() < 1e-8);
        }
        assert!(velocity(0.0).abs() < 1e-15 && velocity(wavelet.duration()).abs() < 1e-15);
        assert!(motion.acceleration(0.0).abs() < 1e-15);
    }
}
