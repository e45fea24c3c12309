//! A block for a controller to hold: the controller's own model, moved by small steps in f32, on a ground that keeps still until it is commanded to
//! shake, seen through sensors with biases, noise and steps. The same on every machine, to the last bit: the emulated core has this file as
//! a module too.

use sprag_shared::control::model::Model;
use sprag_shared::control::sensing::sample::{Count, Reading, Sample};
use sprag_shared::equation::body::Body;
use sprag_shared::math::sign::Sign;
use sprag_shared::math::sine32;
use sprag_shared::structure::block::GRAVITY;

/// A control tick and a step of the block, s.
pub const PERIOD: f32 = 5e-4;

/// Amplitude of the ground's acceleration, g, and its angular frequency, rad/s.
const GROUND: (f32, f32) = (0.5, 9.0);

/// Ticks from a command to the clutch that has moved.
pub const CLUTCH_TICKS: u32 = 10;

/// Slower than this (rad/s) a block comes to rest at an impact.
const REST_SPEED: f32 = 1e-3;

const STANDARD_GRAVITY: f32 = GRAVITY as f32;

/// A part with a bias, noise up to an amplitude, and steps.
struct Part {
    bias: f32,
    noise: f32,
    step: f32,
}

/// An ICM-42688-P: half a degree a second, a few mdps/√Hz over 536 Hz, 65.5 counts to a degree a second.
const GYROSCOPE: Part = Part { bias: 0.008, noise: 0.002, step: 2.664_624_2e-4 };
/// 20 mg, 70 µg/√Hz, 4096 counts to g.
const ACCELEROMETER: Part = Part { bias: 0.15, noise: 0.03, step: 2.394_201_6e-3 };
/// Rack over R in a count of 5 µm.
pub const TRAVEL_PER_COUNT: f32 = 2.5e-6;
/// Count of the encoder when the block stands.
const ENCODER_START: i32 = -12_345;

/// The block, its flywheels, clutches and sensors.
#[derive(Clone, Debug)]
pub struct Rig {
    model: Model,
    /// θ, rad.
    pub rotation: f32,
    /// θ̇, rad/s.
    pub velocity: f32,
    acceleration: f32,
    side: Sign,
    stands: bool,
    spins: [f32; 2],
    engaged: [bool; 2],
    /// Commands of the last ticks, the newest in bit 0.
    commands: [u32; 2],
    tick: u32,
    /// Ticks for which the ground has shaken.
    shaken: u32,
    /// Whether it shakes.
    pub shakes: bool,
    noise: u32,
}

impl Rig {
    /// At rest.
    pub fn new(model: Model) -> Rig {
        Rig {
            model,
            rotation: 0.0,
            velocity: 0.0,
            acceleration: 0.0,
            side: Sign::Positive,
            stands: true,
            spins: [0.0; 2],
            engaged: [false; 2],
            commands: [0; 2],
            tick: 0,
            shaken: 0,
            shakes: false,
            noise: 1,
        }
    }

    /// What the sensors say now.
    pub fn sample(&mut self) -> Sample {
        self.tick += 1;
        self.shaken += u32::from(self.shakes);
        let ground =
            if self.shakes { GROUND.0 * sine32::sin_cos_of_phase(GROUND.1 * (PERIOD * self.shaken as f32)).0 } else { 0.0 };
        if self.stands && ground.abs() > self.model.parameters.uplift {
            (self.stands, self.side) = (false, Sign::of(-ground, Sign::Positive));
        }
        let locked = u8::from(self.engaged[0]) + u8::from(self.engaged[1]);
        let (rotation, velocity) = (self.rotation, self.velocity);
        self.acceleration =
            if self.stands { 0.0 } else { self.model.acceleration(self.side, rotation, velocity, [ground, 0.0], locked) };

        let below = STANDARD_GRAVITY * ground;
        let (mut along, mut up) = (below, STANDARD_GRAVITY);
        if !self.stands {
            // The centre of mass about the toe, R (−sin δ, cos δ), twice derived.
            let (cosine, sine) = self.model.direction_cosines(self.side, rotation);
            along += self.model.parameters.size * (cosine * self.acceleration + sine * velocity * velocity);
            up += self.model.parameters.size * (sine * self.acceleration - cosine * velocity * velocity);
        }
        let (sine, cosine) = sine32::sin_cos(rotation);
        let configuration = self.model.body.configuration(self.side.unit(), rotation);
        let standing = self.model.body.configuration(self.side.unit(), 0.0);
        let travel =
            self.model.body.travel(self.side.unit(), &configuration) - self.model.body.travel(self.side.unit(), &standing);
        let number = self.tick;
        Sample {
            gyroscope: self.read(&GYROSCOPE, velocity),
            block_accelerometer: [
                self.read(&ACCELEROMETER, along * cosine - up * sine),
                self.read(&ACCELEROMETER, along * sine + up * cosine),
            ],
            ground_accelerometer: [self.read(&ACCELEROMETER, below), self.read(&ACCELEROMETER, STANDARD_GRAVITY)],
            encoder: Count { counts: ENCODER_START.wrapping_add(whole(travel / TRAVEL_PER_COUNT)), number },
            engaged: self.engaged,
        }
    }

    fn read(&mut self, part: &Part, truth: f32) -> Reading {
        // Numerical Recipes' generator, whose high half is good enough for noise.
        self.noise = self.noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = f32::from((self.noise >> 16) as i16) * (part.noise / 32_768.0);
        let steps = whole((truth + part.bias + noise) / part.step);
        Reading { value: steps as f32 * part.step, number: self.tick }
    }

    /// A tick on, with a command for each clutch.
    pub fn advance(&mut self, command: [bool; 2]) {
        let model = &self.model;
        if !self.stands {
            self.velocity += self.acceleration * PERIOD;
            self.rotation += self.velocity * PERIOD;
            if self.side.times(self.rotation) < 0.0 {
                self.velocity *= model.parameters.restitution;
                self.side = self.side.opposite();
                if self.velocity.abs() < REST_SPEED {
                    (self.rotation, self.velocity, self.stands) = (0.0, 0.0, true);
                }
            }
        }
        let arm = model.body.arm(&model.body.configuration(self.side.unit(), self.rotation));
        let clutches = self.commands.iter_mut().zip(&mut self.engaged).zip(&mut self.spins);
        for (((commands, engaged), spin), command) in clutches.zip(command) {
            *commands = *commands << 1 | u32::from(command);
            let closes = *commands >> CLUTCH_TICKS & 1 == 1;
            if closes && !*engaged && model.parameters.wheels_spin && !self.stands {
                self.velocity =
                    (self.velocity + model.parameters.coupling * arm * *spin) / (1.0 + model.parameters.coupling * arm * arm);
            }
            *engaged = closes;
            *spin = if closes { arm * self.velocity } else { model.coasted(*spin, PERIOD) };
        }
    }
}

/// The whole number nearest to `x`, within what an i32 holds.
fn whole(x: f32) -> i32 {
    (if x < 0.0 { x - 0.5 } else { x + 0.5 }) as i32
}
