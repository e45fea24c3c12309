//! What the support of a device does against the ground: ü_s − ü_g.
//!
//! As an oscillator on the ground, z̈ + 2ζω ż + ω² z = −ü_g, it is followed by Runge-Kutta steps from kink to kink, with a cubic between two.

use std::f64::consts::TAU;
use std::path::Path;

use crate::block::Block;
use crate::ground::Ground;
use crate::scene::{DeviceTable, MotionTable, Scene};

/// ω times a step of the oscillator.
const STEP: f64 = 2e-3;
/// Longest step, s.
const LONGEST: f64 = 1e-4;
/// What is left of the oscillation, over what it was at the end of the ground, when it counts as over.
const LEFT: f64 = 1e-4;

/// A support.
#[derive(Clone, Debug)]
pub enum Support {
    /// It moves with the ground.
    Ground,
    /// ü_s = (1 + this) ü_g.
    Beyond(f64),
    /// An oscillator.
    Wall(Wall),
    /// ü_s itself.
    Record(Ground),
}

impl Support {
    /// Of the device `table` of `scene`, whose records lie in `folder`; the ground moves until `end` (s).
    ///
    /// # Errors
    /// A missing value or an unreadable record, in words.
    pub fn of(
        table: &DeviceTable,
        scene: &Scene,
        bare: &Block,
        folder: &Path,
        (horizontal, end): (&Ground, f64),
    ) -> Result<Support, String> {
        Ok(match (table.support_amplification, table.support_frequency_hz, &table.support_record) {
            (None, None, None) => Support::Ground,
            (Some(factor), None, None) => Support::Beyond(factor - 1.0),
            (None, Some(hertz), None) => {
                let damping = table.support_damping_ratio.ok_or("support_damping_ratio")?;
                Support::Wall(Wall::on(horizontal, end, TAU * hertz, damping))
            }
            (None, None, Some(record)) => {
                let start_s = scene.ground.first().ok_or("ground")?.start_s;
                let record = MotionTable { motion: "record".to_owned(), start_s, ..record.clone() };
                Support::Record(Ground::of(&[record], bare, folder)?)
            }
            _ => return Err("one motion of the support".to_owned()),
        })
    }

    /// Whether it moves against the ground.
    pub fn moves(&self) -> bool {
        !matches!(self, Support::Ground | Support::Beyond(0.0))
    }

    /// ü_s − ü_g (m/s²) at `time` in the piece that holds `within`, while the ground accelerates by `ground`.
    pub fn at(&self, time: f64, within: f64, ground: f64) -> f64 {
        match self {
            Support::Ground => 0.0,
            Support::Beyond(factor) => factor * ground,
            Support::Wall(wall) => wall.at(time, within, ground),
            Support::Record(record) => record.at(time, within) - ground,
        }
    }

    /// When it has come to its end, s.
    pub fn end(&self) -> f64 {
        match self {
            Support::Ground | Support::Beyond(_) => 0.0,
            Support::Wall(wall) => wall.end,
            Support::Record(record) => record.end(),
        }
    }

    /// The kinks that it adds to those of the ground, s.
    pub fn kinks(&self) -> Vec<f64> {
        match self {
            Support::Ground | Support::Beyond(_) => Vec::new(),
            Support::Wall(wall) => vec![wall.end],
            Support::Record(record) => record.kinks(),
        }
    }

    /// Fastest rate, 1/s.
    pub fn rate(&self) -> f64 {
        match self {
            Support::Ground | Support::Beyond(_) => 0.0,
            Support::Wall(wall) => wall.frequency / 3.0,
            Support::Record(record) => record.rate(),
        }
    }

    /// A bound of |ü_s − ü_g|, m/s², where the ground stays within `ground`.
    pub fn bound(&self, ground: f64) -> f64 {
        match self {
            Support::Ground => 0.0,
            Support::Beyond(factor) => factor.abs() * ground,
            Support::Wall(wall) => wall.largest,
            Support::Record(record) => record.bound() + ground,
        }
    }
}

/// A damped oscillator on a ground motion.
#[derive(Clone, Debug)]
pub struct Wall {
    frequency: f64,
    damping: f64,
    pieces: Vec<Piece>,
    end: f64,
    largest: f64,
}

/// z, ż and z̈ at equal steps between two kinks.
#[derive(Clone, Debug)]
struct Piece {
    start: f64,
    step: f64,
    states: Vec<[f64; 3]>,
}

impl Wall {
    fn on(ground: &Ground, ground_end: f64, frequency: f64, damping: f64) -> Wall {
        let end = if ground_end > 0.0 { ground_end - LEFT.ln() / (damping * frequency) } else { 0.0 };
        let mut kinks = ground.kinks();
        kinks.extend([0.0, ground_end, end]);
        kinks.sort_by(f64::total_cmp);
        kinks.dedup_by(|later, sooner| *later - *sooner < 1e-12);
        let mut wall = Wall { frequency, damping, pieces: Vec::new(), end, largest: 0.0 };
        let (mut z, mut v) = (0.0, 0.0);
        for pair in kinks.windows(2) {
            let (start, length) = (pair[0], pair[1] - pair[0]);
            let within = start + length / 2.0;
            let count = (length / LONGEST.min(STEP / frequency)).ceil();
            let h = length / count;
            let mut states = Vec::with_capacity(count as usize + 1);
            let rate = |t: f64, z: f64, v: f64| wall.acceleration(z, v, ground.at(t, within));
            for k in 0..=count as usize {
                let t = start + k as f64 * h;
                let a = rate(t, z, v);
                states.push([z, v, a]);
                if k as f64 == count {
                    break;
                }
                // Of the second order, so that each stage has one acceleration (Nyström).
                let (z2, v2) = (z + h / 2.0 * v, v + h / 2.0 * a);
                let a2 = rate(t + h / 2.0, z2, v2);
                let (z3, v3) = (z + h / 2.0 * v2, v + h / 2.0 * a2);
                let a3 = rate(t + h / 2.0, z3, v3);
                let (z4, v4) = (z + h * v3, v + h * a3);
                let a4 = rate(t + h, z4, v4);
                z += h / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
                v += h / 6.0 * (a + 2.0 * a2 + 2.0 * a3 + a4);
            }
            let largest = states.iter().fold(wall.largest, |most, state| most.max(state[2].abs()));
            wall.pieces.push(Piece { start, step: h, states });
            wall.largest = largest;
        }
        wall.largest *= 1.01;
        wall
    }

    /// z̈.
    fn acceleration(&self, z: f64, v: f64, ground: f64) -> f64 {
        -ground - 2.0 * self.damping * self.frequency * v - self.frequency * self.frequency * z
    }

    fn at(&self, time: f64, within: f64, ground: f64) -> f64 {
        if within >= self.end {
            return 0.0;
        }
        let index = self.pieces.partition_point(|piece| piece.start <= within);
        let Some(piece) = index.checked_sub(1).and_then(|index| self.pieces.get(index)) else { return 0.0 };
        let place = (time - piece.start) / piece.step;
        let k = (place.floor().max(0.0) as usize).min(piece.states.len() - 2);
        let (x, h) = (place - k as f64, piece.step);
        let [[z, v, a], [z1, v1, a1]] = [piece.states[k], piece.states[k + 1]];
        // Hermite's cubic.
        let cubic = |from: f64, slope: f64, to: f64, end: f64| {
            let y = 1.0 - x;
            y * y * (1.0 + 2.0 * x) * from + x * x * (1.0 + 2.0 * y) * to + x * y * h * (y * slope - x * end)
        };
        self.acceleration(cubic(z, v, z1, v1), cubic(v, a, v1, a1), ground)
    }
}
