//! The block, its mounts, and what rides on it: everything that a rotation decides.

use crate::scene::{BlockTable, NumberOr};

/// g, m/s².
pub const GRAVITY: f64 = 9.80665;

/// Which equation of the block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Geometry {
    /// Eq. 13 to 16.
    Full,
    /// Eq. 17 and 18: sin δ → δ, cos δ → 1, ℓ constant.
    Slender,
}

/// Where η comes from (Eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restitution {
    /// As given.
    Constant(f64),
    /// η = 1 − 2 sin²α/λ.
    Geometric,
    /// With the moment of momentum of what stays locked to the rack.
    MomentumBalance,
}

/// A block about its toe, R from the centre of mass, with half its width R sin α.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// R, m.
    pub size: f64,
    /// α, rad.
    pub slenderness: f64,
    /// λ = I_O/(mR²).
    pub inertia: f64,
    /// Full or slender.
    pub geometry: Geometry,
}

impl Block {
    /// The bare block of a scene, and its restitution.
    ///
    /// # Errors
    /// A missing or an unknown value, in words.
    pub fn of(table: &BlockTable) -> Result<(Block, Restitution), String> {
        let inertia = table.inertia_ratio.unwrap_or(4.0 / 3.0);
        let size = match (table.size_m, table.frequency_parameter_1_s) {
            (Some(size), None) => size,
            (None, Some(p)) => GRAVITY / (inertia * p * p),
            _ => return Err("one of size_m and frequency_parameter_1_s".to_owned()),
        };
        let geometry = match table.geometry.as_deref() {
            None | Some("full") => Geometry::Full,
            Some("slender") => Geometry::Slender,
            Some(other) => return Err(format!("geometry {other}")),
        };
        let restitution = match &table.restitution {
            None => Restitution::Constant(0.85),
            Some(NumberOr::Number(value)) => Restitution::Constant(*value),
            Some(NumberOr::Word(word)) if word == "geometric" => Restitution::Geometric,
            Some(NumberOr::Word(word)) if word == "momentum-balance" => Restitution::MomentumBalance,
            Some(NumberOr::Word(word)) => return Err(format!("restitution {word}")),
        };
        Ok((Block { size, slenderness: table.slenderness_deg.to_radians(), inertia, geometry }, restitution))
    }

    /// p = √(g/(λR)), 1/s.
    pub fn frequency_parameter(&self) -> f64 {
        (GRAVITY / (self.inertia * self.size)).sqrt()
    }

    /// sin δ and cos δ, or δ and 1.
    pub fn weight_arms(&self, delta: f64) -> (f64, f64) {
        match self.geometry {
            Geometry::Full => delta.sin_cos(),
            Geometry::Slender => (delta, 1.0),
        }
    }

    /// Potential energy over mR² above that of the standing block: (g/R)(cos δ − cos α), or (g/R)(α² − δ²)/2.
    pub fn potential(&self, delta: f64) -> f64 {
        let rise = match self.geometry {
            Geometry::Full => delta.cos() - self.slenderness.cos(),
            Geometry::Slender => (self.slenderness * self.slenderness - delta * delta) / 2.0,
        };
        GRAVITY / self.size * rise
    }

    /// The block together with a mass μ on its centre line at height z (m): parallel axes and composition of centres of mass.
    pub fn carrying(&self, mass: f64, height: f64) -> Block {
        let (sin, cos) = self.slenderness.sin_cos();
        let (half_width, centre) = (self.size * sin, self.size * cos);
        let total = 1.0 + mass;
        let centre = (centre + mass * height) / total;
        let size = half_width.hypot(centre);
        let about_toe = self.inertia * self.size * self.size + mass * (half_width * half_width + height * height);
        Block { size, slenderness: half_width.atan2(centre), inertia: about_toe / (total * size * size), geometry: self.geometry }
    }

    /// η of the block alone by its moment of momentum about the new toe.
    pub fn geometric_restitution(&self) -> f64 {
        let sin = self.slenderness.sin();
        1.0 - 2.0 * sin * sin / self.inertia
    }
}

/// How far the terminals travel: dx = R ℓ dθ with ℓ = A cos δ + s B sin δ, or a constant (slender).
#[derive(Clone, Copy, Debug)]
pub struct Lever {
    /// A.
    along: f64,
    /// B.
    across: f64,
    /// The slender model's ℓ, if it is that.
    constant: Option<f64>,
    /// ℓ on the side of the old toe for the new one: 1 if the lever stays through an impact, 0 if another corner takes over.
    pub carries_over: f64,
}

/// Where the inerter is tied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mount {
    /// Figure 3b.
    CentreOfMass,
    /// A point of the centre line, m above the base, through a pulley of ratio n.
    TyingPoint(f64, f64),
    /// Figure 3a, through pulleys of ratio n.
    BaseCorners(f64),
}

impl Lever {
    /// Of a mount on `bare`, for the equations of `block`, which is `bare` and what rides on it.
    ///
    /// A point (0, z) lies at height z and R sin α from the toe: its horizontal travel per radian is z cos θ + s R sin α sin θ.
    /// With θ = αs − δ that is A cos δ + s B sin δ. A raised corner is 2R sin α from the toe and rises by 2R sin α cos θ.
    pub fn of(mount: Mount, bare: &Block, block: &Block) -> Lever {
        let (sin, cos) = block.slenderness.sin_cos();
        let at_height = |height: f64, pulley: f64, slender: f64| Lever {
            along: pulley * (height * cos / block.size + sin * sin),
            across: pulley * (height * sin / block.size - sin * cos),
            constant: (block.geometry == Geometry::Slender).then_some(pulley * slender / block.size),
            carries_over: 1.0,
        };
        match mount {
            Mount::CentreOfMass => at_height(bare.size * bare.slenderness.cos(), 1.0, bare.size),
            Mount::TyingPoint(height, pulley) => at_height(height, pulley, height),
            Mount::BaseCorners(pulley) => Lever {
                along: 2.0 * pulley * sin * cos,
                across: 2.0 * pulley * sin * sin,
                constant: (block.geometry == Geometry::Slender).then_some(2.0 * pulley * block.slenderness),
                carries_over: 0.0,
            },
        }
    }

    /// ℓ and dℓ/dθ on side s.
    pub fn at(&self, side: f64, delta: f64) -> (f64, f64) {
        if let Some(lever) = self.constant {
            return (lever, 0.0);
        }
        let (sin, cos) = delta.sin_cos();
        (self.along * cos + side * self.across * sin, self.along * sin - side * self.across * cos)
    }
}
