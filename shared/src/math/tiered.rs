//! A number whose sines come from a chosen [`Tier`].

use core::cmp::Ordering;
use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Neg, Sub};

use super::scalar::{Real, Scalar};
use super::tier::Tier;

/// A number `S` with the sines of tier `T`; everything else, e^x and the square root included, is that of `S`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(transparent)]
pub struct Tiered<S, T> {
    /// The number itself.
    pub number: S,
    tier: PhantomData<T>,
}

impl<S, T> Tiered<S, T> {
    /// `number` with the sines of `T`.
    #[inline(always)]
    pub const fn new(number: S) -> Self {
        Tiered { number, tier: PhantomData }
    }
}

macro_rules! operator {
    ($operator:ident, $method:ident) => {
        impl<S: $operator<Output = S>, T> $operator for Tiered<S, T> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Tiered::new(self.number.$method(other.number))
            }
        }
    };
}

operator!(Add, add);
operator!(Sub, sub);
operator!(Mul, mul);
operator!(Div, div);

impl<S: Neg<Output = S>, T> Neg for Tiered<S, T> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Tiered::new(-self.number)
    }
}

// Each comparison by itself: derived, they would go through an ordering, which takes the target two comparisons.
impl<S: PartialOrd, T: PartialEq> PartialOrd for Tiered<S, T> {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.number.partial_cmp(&other.number)
    }

    #[inline(always)]
    fn lt(&self, other: &Self) -> bool {
        self.number < other.number
    }

    #[inline(always)]
    fn le(&self, other: &Self) -> bool {
        self.number <= other.number
    }

    #[inline(always)]
    fn gt(&self, other: &Self) -> bool {
        self.number > other.number
    }

    #[inline(always)]
    fn ge(&self, other: &Self) -> bool {
        self.number >= other.number
    }
}

impl<S: Scalar, T: Tier<S>> Scalar for Tiered<S, T> {
    type Mask = S::Mask;

    #[inline(always)]
    fn of(value: f64) -> Self {
        Tiered::new(S::of(value))
    }

    #[inline(always)]
    fn sin_cos(self) -> (Self, Self) {
        let (sine, cosine) = T::sin_cos(self.number);
        (Tiered::new(sine), Tiered::new(cosine))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Tiered::new(Scalar::abs(self.number))
    }

    #[inline(always)]
    fn exceeds(self, other: Self) -> S::Mask {
        self.number.exceeds(other.number)
    }

    #[inline(always)]
    fn select(mask: S::Mask, yes: Self, no: Self) -> Self {
        Tiered::new(S::select(mask, yes.number, no.number))
    }
}

impl<S: Real, T: Tier<S>> Real for Tiered<S, T> {
    const ZERO: Self = Tiered::new(S::ZERO);
    const ONE: Self = Tiered::new(S::ONE);
    const HALF: Self = Tiered::new(S::HALF);
    const SMALLEST: Self = Tiered::new(S::SMALLEST);
    const EPSILON: Self = Tiered::new(S::EPSILON);
    const STUMPFF_TERMS: usize = S::STUMPFF_TERMS;

    #[inline]
    fn sin_cos_of_phase(self) -> (Self, Self) {
        let (sine, cosine) = T::sin_cos_of_phase(self.number);
        (Tiered::new(sine), Tiered::new(cosine))
    }

    #[inline]
    fn exp(self) -> Self {
        Tiered::new(self.number.exp())
    }

    #[inline]
    fn square_root(self) -> Self {
        Tiered::new(self.number.square_root())
    }

    #[inline(always)]
    fn count(count: u32) -> Self {
        Tiered::new(S::count(count))
    }

    #[inline]
    fn rough_power(self, exponent: Self) -> Self {
        Tiered::new(self.number.rough_power(exponent.number))
    }

    #[inline(always)]
    fn to_f64(self) -> f64 {
        self.number.to_f64()
    }

    #[inline(always)]
    fn bits(self) -> u64 {
        self.number.bits()
    }

    #[inline(always)]
    fn is_finite(self) -> bool {
        self.number.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ground::Harmonics;
    use crate::math::tier::{Libm, Micromath, OwnPolynomial};
    use crate::method::dense_output::Integrator;
    use crate::method::fixed::{FixedStep, Scheme};
    use crate::method::taylor::Taylor;
    use crate::motion::state::{BlockState, Limits};
    use crate::observers::digest::Digest;
    use crate::structure::added_mass::AddedMass;
    use crate::structure::block::{Block, Geometry, RECTANGLE_INERTIA_RATIO};
    use crate::structure::device::{Device, DeviceKind, KinematicsKind};
    use crate::structure::mount::Mount;
    use crate::structure::{Base, RestitutionScatter};
    use crate::structure::{REST_SPEED, Restitution, Structure};

    /// One cycle of sine and 2.5 s of quiet on a block of 10°, p = 1/s; gives the digest of every stretch and event, and θ.
    fn run<S: Real, M: Integrator<S>>(method: M, kinematics: KinematicsKind) -> (u64, f64) {
        let device = Device { kind: DeviceKind::ClutchedPair, mass_ratio: 0.5, mount: Mount::CentreOfMass, kinematics };
        let structure = Structure {
            block: Block::of_unit_frequency(10.0_f64.to_radians(), RECTANGLE_INERTIA_RATIO).unwrap(),
            geometry: Geometry::Full,
            device,
            added_mass: AddedMass::NONE,
            restitution: Restitution::Constant(0.85),
            restitution_scatter: RestitutionScatter::NONE,
            base: Base::Rigid,
            rest_speed: REST_SPEED,
        };
        let system = structure.resolve().unwrap();
        let mut digest = Digest::default();
        let mut state = BlockState::default();
        let limits = Limits { overturned: S::of(1.57), events: 100_000 };
        let sine = Harmonics::sine(S::of(0.3), S::of(4.0));
        let duration = S::of(core::f64::consts::TAU / 4.0);
        system.advance(&method, &mut state, &sine, duration, &limits, &mut digest).unwrap();
        system.advance(&method, &mut state, &Harmonics::QUIET, S::of(2.5), &limits, &mut digest).unwrap();
        assert!(digest.events > 10);
        (digest.hash(), state.rotation.to_f64())
    }

    #[test]
    fn a_number_of_its_own_tier_gives_the_same_bits() {
        for kinematics in [KinematicsKind::Paper, KinematicsKind::Consistent] {
            type Single = Tiered<f32, OwnPolynomial>;
            let plain = run::<f32, _>(FixedStep { scheme: Scheme::RungeKutta4, step: 2e-3 }, kinematics);
            assert_eq!(plain, run::<Single, _>(FixedStep { scheme: Scheme::RungeKutta4, step: Single::of(2e-3) }, kinematics));
            type Double = Tiered<f64, Libm>;
            let plain = run::<f64, _>(Taylor::<f64, 20>::adaptive(1e-17), kinematics);
            assert_eq!(plain, run::<Double, _>(Taylor::<Double, 20>::adaptive(Double::of(1e-17)), kinematics));
        }
    }

    #[test]
    fn other_tiers_give_other_bits_and_nearly_the_same_motion() {
        let exact = run::<f64, _>(Taylor::<f64, 20>::adaptive(1e-17), KinematicsKind::Paper).1;
        let error = |(_, rotation): (u64, f64)| (rotation - exact).abs();
        type Careful = Tiered<f32, Libm>;
        let careful =
            run::<Careful, _>(FixedStep { scheme: Scheme::RungeKutta4, step: Careful::of(2e-3) }, KinematicsKind::Paper);
        let own = run::<f32, _>(FixedStep { scheme: Scheme::RungeKutta4, step: 2e-3 }, KinematicsKind::Paper);
        assert_ne!(careful.0, own.0);
        assert!(error(careful) < 2e-5 && error(own) < 2e-5, "{:e} {:e}", error(careful), error(own));
        type Wide = Tiered<f64, OwnPolynomial>;
        let wide = run::<Wide, _>(Taylor::<Wide, 20>::adaptive(Wide::of(1e-17)), KinematicsKind::Paper);
        assert!(error(wide) < 1e-12, "{:e}", error(wide));
        type Cheap = Tiered<f32, Micromath>;
        let cheap = run::<Cheap, _>(FixedStep { scheme: Scheme::RungeKutta4, step: Cheap::of(2e-3) }, KinematicsKind::Paper);
        std::println!(
            "rotation at the end {exact}; errors: own {:e}, libm {:e}, micromath {:e}",
            error(own),
            error(careful),
            error(cheap)
        );
        assert!((1e-5..0.1).contains(&error(cheap)), "{:e}", error(cheap));
    }

    #[test]
    fn it_is_no_larger_than_its_number() {
        assert_eq!(size_of::<Tiered<f32, Micromath>>(), size_of::<f32>());
        assert!(Tiered::<f32, Libm>::new(1.0) < Tiered::new(2.0) && Tiered::<f64, Libm>::new(f64::NAN) != Tiered::new(f64::NAN));
        assert_eq!(Tiered::<f64, Libm>::new(-2.5).abs().number, 2.5);
    }
}
