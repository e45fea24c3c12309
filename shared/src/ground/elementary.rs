//! Ground acceleration that a linear oscillator answers in closed form: a straight line and sines.

use crate::math::scalar::Real;

/// Most sines in one piece; a Mavroeidis-Papageorgiou wavelet has three.
pub const MOST_WAVES: usize = 4;

/// One sine, A sin(ωτ + φ), as it stands at an instant τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave<S> {
    /// ω, rad/s.
    pub frequency: S,
    /// A sin(ωτ + φ), in g.
    pub sine: S,
    /// A cos(ωτ + φ), in g.
    pub cosine: S,
}

/// Continuation of ü_g/g from an instant: by the time t after it, it has changed by
///
/// slope t + Σ \[ sine (cos ωt − 1) + cosine sin ωt \].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elementary<S> {
    /// Slope of the straight line, g/s.
    pub slope: S,
    waves: [Wave<S>; MOST_WAVES],
    count: usize,
}

impl<S: Real> Elementary<S> {
    /// A straight line of this slope (g/s).
    pub fn line(slope: S) -> Self {
        Elementary { slope, waves: [Wave { frequency: S::ZERO, sine: S::ZERO, cosine: S::ZERO }; MOST_WAVES], count: 0 }
    }

    /// With one sine more; None when it is one too many.
    pub fn with(mut self, wave: Wave<S>) -> Option<Self> {
        *self.waves.get_mut(self.count)? = wave;
        self.count += 1;
        Some(self)
    }

    /// Both at once; None when they have too many sines.
    pub fn and(self, other: &Elementary<S>) -> Option<Self> {
        let sum = Elementary { slope: self.slope + other.slope, ..self };
        other.waves().iter().try_fold(sum, |sum, wave| sum.with(*wave))
    }

    /// The sines.
    pub fn waves(&self) -> &[Wave<S>] {
        self.waves.get(..self.count).unwrap_or(&self.waves)
    }

    /// The sines, to be changed.
    pub fn waves_mut(&mut self) -> &mut [Wave<S>] {
        &mut self.waves[..self.count.min(MOST_WAVES)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::check::Sum;
    use crate::ground::harmonic::MavroeidisPapageorgiou;
    use crate::ground::{GroundSegment, Harmonics, Linear, Ricker};
    use crate::math::sin_cos;

    fn change(motion: &Elementary<f64>, t: f64) -> f64 {
        motion.waves().iter().fold(motion.slope * t, |sum, wave| {
            let (sine, cosine) = sin_cos(wave.frequency * t);
            sum + wave.sine * (cosine - 1.0) + wave.cosine * sine
        })
    }

    fn continues(piece: &impl GroundSegment<f64>) {
        for start in [0.0, 0.3, 1.7] {
            let motion = piece.elementary(start).unwrap();
            for t in [0.0, 1e-3, 0.4, 2.0] {
                let exact = piece.acceleration(start + t) - piece.acceleration(start);
                assert!((change(&motion, t) - exact).abs() < 1e-14, "from {start} by {t}");
            }
        }
    }

    #[test]
    fn pieces_continue_as_they_say() {
        let wavelet = MavroeidisPapageorgiou { velocity_amplitude: 0.9, frequency: 0.5, oscillations: 1.8, phase: 0.6 };
        let line = Linear { start: 0.2, slope: -0.3 };
        continues(&Harmonics::QUIET);
        continues(&line);
        continues(&Harmonics::sine(1.5, 4.0));
        continues(&Harmonics::cosine(0.7, 7.0));
        continues(&wavelet.harmonics());
        continues(&Sum(line, Sum(wavelet.harmonics(), Harmonics::sine(0.3, 11.0))));
    }

    #[test]
    fn what_has_no_closed_form_says_so() {
        let wavelet = MavroeidisPapageorgiou { velocity_amplitude: 0.9, frequency: 0.5, oscillations: 1.8, phase: 0.6 };
        assert_eq!(Ricker { amplitude: 0.8, rate: 4.0, centre: 1.0 }.elementary(0.0), None);
        assert_eq!(Sum(wavelet.harmonics(), wavelet.harmonics()).elementary(0.0), None, "six sines");
    }
}
