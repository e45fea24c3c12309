//! Energy ledger: balance of the ground's work, by cause.
//!
//! In the frame that moves with the ground, everything divided by λmR² (1/s²; times λmR² it is joules, over
//! [`Ledger::barrier`] it is a share of the barrier to overturning):
//!
//! initial + input + created = kinetic + potential + stored + Σ dissipated,
//!
//! input = −p² ∫ [ (ü_g/g)(cos δ + (1 + (1 − n)(f − 1)) m_rack/m ℓ) + (v̈_g/g) sin δ ] θ̇ dt − ∫ F z dt,  kinetic = ½θ̇²,
//! potential = p² (cos δ − cos α);
//!
//! The support moves by f times the ground's acceleration, and a guided rack behind the pulley n rides on it. F is the force of the
//! flywheels on the rack, and z the speed of a support that moves otherwise than the ground ([`crate::drivetrain::on_support`]), against
//! which they turn. Energies are relative to the ground (Uang and Bertero 1990).
//!
//! On such a support each bounce of a dying motion engages a flywheel at the speed of the support, and lets it go to its brake, however small the
//! bounce is. As with impacts only those down to a certain speed count: what a clutch creates in a slower one goes back as it lets go.
//!
//! slender: sin δ → δ, cos δ → 1, potential = p² (α|θ| − ½θ²). Powers are integrated along every interval by Gauss-Legendre
//! quadrature, with an error far below rounding on a series; what jumps at an event goes to what caused it. No entry is
//! worked out from the others, so the residual measures all of them.

mod entries;

pub use entries::Entries;

use crate::math::quadrature::integral;
use crate::math::scalar::Real;
use crate::math::sign::Sign;
use crate::motion::device_snapshot::{DeviceOutput, Snapshot};
use crate::motion::observer::{Event, MonotoneInterval, Observer};
use crate::motion::state::BlockState;
use crate::observers::counted_swing::CountedSwing;
use crate::structure::block::{Block, Geometry};

/// Rule for a flywheel's energy at an event, by clutch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Clutching {
    /// No clutch: one flywheel moves with the rack for ever, through impacts too.
    #[default]
    Permanent,
    /// The paper's clutch: at release the flywheel's energy goes to its brake at once, and engagement creates what the
    /// flywheel then has.
    Ideal,
    /// A clutch that exchanges momentum: what a jolt takes is dissipated in it. It passes no impulse of an impact on.
    Real,
    /// One that does: block and flywheel go through an impact as one.
    Rigid,
}

/// Masses and clutch, as a ledger needs them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// The clutch.
    pub clutching: Clutching,
    /// σ of one flywheel.
    pub mass_ratio: f64,
    /// Mass of a guided rack over the block's.
    pub rack_mass_ratio: f64,
    /// Acceleration of a guided rack by its support beyond the ground's, over that, while the block stands: (1 − n)(f − 1).
    pub rack_riding: f64,
    /// The support moves otherwise than the ground.
    pub on_support: bool,
    /// Open clutches drag, so that they pass forces too.
    pub drags: bool,
    /// Clutches are elastic: a spring may throw its flywheel beyond the speed of the rack.
    pub springs: bool,
}

/// Observer that sums the [`Entries`] of a motion.
#[derive(Clone, Copy, Debug)]
pub struct Ledger<S> {
    /// The entries up to the last interval or event.
    pub entries: Entries<S>,
    geometry: Geometry,
    clutching: Clutching,
    frequency: S,
    frequency_squared: S,
    slenderness: S,
    coupling: S,
    rack: S,
    on_support: bool,
    /// Potential energy at θ = α, which a block must pass to overturn by itself: p²(1 − cos α), slender ½p²α²; 1/s². It stands
    /// for mgR(1 − cos α) joules.
    pub barrier: S,
    last: Option<Balance<S>>,
    since: Since,
    swing: CountedSwing,
    /// Created for each flywheel in a swing that does not count, while it does not and the clutch holds.
    lent: [S; 2],
}

/// Energies at an instant.
#[derive(Clone, Copy, Debug, Default)]
struct Balance<S> {
    kinetic: S,
    potential: S,
    rack: S,
    springs: S,
    flywheel: [S; 2],
    /// Speed of each flywheel as that of the rack, 1/s, and by how much the rack is faster.
    spin: [S; 2],
    slip: [S; 2],
    engaged: [bool; 2],
    /// The flywheel turns at the rack's speed, to the last bit.
    locked: [bool; 2],
}

/// Events since the last interval.
#[derive(Clone, Copy, Debug, Default)]
struct Since {
    impact: bool,
    switch: bool,
    stood: bool,
}

impl<S: Real> Balance<S> {
    fn stored(&self) -> S {
        self.flywheel[0] + self.flywheel[1] + self.rack + self.springs
    }

    /// At an impact whatever is locked to the block is slowed as the block is, to `left` of its energy. Returns what is lost.
    fn slow(&mut self, left: S, with_flywheels: bool) -> S {
        let mut lost = self.rack * (S::ONE - left);
        self.rack = self.rack * left;
        for (flywheel, locked) in self.flywheel.iter_mut().zip(self.locked) {
            if locked && with_flywheels {
                lost = lost + *flywheel * (S::ONE - left);
                *flywheel = *flywheel * left;
            }
        }
        lost
    }
}

impl<S: Real> Ledger<S> {
    /// An empty ledger of `block`, which is the block that the equations see, with what it carries
    /// ([`crate::structure::Structure::loaded`]), as are the mass ratios of `account`.
    pub fn new(block: &Block, geometry: Geometry, account: &Account) -> Ledger<S> {
        let (p2, alpha) = (block.frequency_parameter_squared(), block.slenderness());
        let mut ledger = Ledger {
            entries: Entries::default(),
            geometry,
            clutching: account.clutching,
            frequency: S::of(block.frequency_parameter()),
            frequency_squared: S::of(p2),
            slenderness: S::of(alpha),
            coupling: S::of(account.mass_ratio / block.inertia_ratio()),
            rack: S::of(account.rack_mass_ratio * (1.0 + account.rack_riding)),
            on_support: account.on_support,
            barrier: S::ZERO,
            last: None,
            since: Since::default(),
            swing: CountedSwing::of(block),
            lent: [S::ZERO; 2],
        };
        ledger.barrier = ledger.potential(Sign::Positive, ledger.slenderness);
        ledger
    }

    /// p² (cos δ − cos α) = 2p² sin(αs − θ/2) sin(θ/2), which loses nothing near θ = 0.
    fn potential(&self, side: Sign, rotation: S) -> S {
        let half = S::HALF * rotation;
        let middle = side.times(self.slenderness) - half;
        match self.geometry {
            Geometry::Full => (self.frequency_squared + self.frequency_squared) * middle.sin_cos().0 * half.sin_cos().0,
            Geometry::Slender => self.frequency_squared * middle * rotation,
        }
    }

    /// Work per time of ground and support on block, rack and flywheels.
    fn input(&self, side: Sign, snapshot: &Snapshot<S>) -> S {
        let (sin, cos) = self.geometry.sin_cos(side.times(self.slenderness) - snapshot.motion.rotation);
        let [horizontal, vertical, _] = snapshot.ground;
        let block = (horizontal * cos + vertical * sin) * snapshot.motion.velocity;
        let ground = self.frequency_squared * (block + self.rack * horizontal * snapshot.terminal_velocity);
        if !self.on_support {
            return -ground;
        }
        let device = &snapshot.device;
        let carried = |i: usize| device.force[i] * (snapshot.terminal_velocity - device.spin[i]);
        -(ground + carried(0) + carried(1))
    }

    fn balance(&self, side: Sign, snapshot: &Snapshot<S>) -> Balance<S> {
        let half = S::HALF * self.coupling;
        let flywheel = snapshot.device.spin.map(|spin| half * spin * spin);
        Balance {
            kinetic: S::HALF * snapshot.motion.velocity * snapshot.motion.velocity,
            potential: self.potential(side, snapshot.motion.rotation),
            rack: snapshot.device.stored - snapshot.device.sprung - flywheel[0] - flywheel[1],
            springs: snapshot.device.sprung,
            flywheel,
            spin: snapshot.device.spin,
            slip: snapshot.device.spin.map(|spin| snapshot.terminal_velocity - spin),
            engaged: snapshot.device.engaged,
            // On a support of its own motion what is engaged is locked.
            locked: core::array::from_fn(|i| {
                let Snapshot { device, terminal_velocity, .. } = snapshot;
                if self.on_support { device.engaged[i & 1] } else { device.spin[i & 1] == *terminal_velocity }
            }),
        }
    }

    /// Change of the device's energy between two intervals.
    fn attribute(&mut self, before: &Balance<S>, after: &Balance<S>) {
        let Since { impact, switch, stood } = self.since;
        if !(impact || switch || stood) {
            return;
        }
        let (through_impacts, on_support, coupling) = (self.passes_impacts(), self.on_support, self.coupling);
        let entries = &mut self.entries;
        for i in 0..2 {
            let mut lost = before.flywheel[i] - after.flywheel[i];
            let holds = after.engaged[i] || (stood && !on_support);
            let stops_with_the_block = through_impacts && before.locked[i] && (impact || stood) && holds;
            let entry = match (before.engaged[i], after.engaged[i]) {
                (false, true) if self.clutching == Clutching::Ideal => {
                    entries.created = entries.created - lost;
                    self.lent[i] = -lost;
                    continue;
                }
                _ if stops_with_the_block => {
                    if on_support {
                        // Its impulse does work on the support too.
                        let work = coupling * (before.spin[i] - after.spin[i]) * before.slip[i];
                        (entries.input, entries.impact) = (entries.input + work, entries.impact + work);
                    }
                    &mut entries.impact
                }
                (true, false) if after.flywheel[i] == S::ZERO => {
                    let lent = core::mem::take(&mut self.lent[i]).smaller(lost);
                    (entries.created, lost) = (entries.created - lent, lost - lent);
                    &mut entries.brake
                }
                _ => &mut entries.clutch,
            };
            *entry = *entry + lost;
        }
        let rack = before.rack - after.rack;
        let entry = if switch { &mut entries.clutch } else { &mut entries.impact };
        *entry = *entry + rack;
        entries.clutch = entries.clutch + before.springs - after.springs;
    }

    /// The block stands: its energy is gone, and that of a device without a memory. What the flywheels and springs of another still have
    /// shows as it stands.
    fn rest(&mut self, last: &mut Balance<S>) {
        let entries = &mut self.entries;
        entries.impact = entries.impact + last.kinetic + last.potential + last.rack;
        (last.kinetic, last.potential, last.rack) = (S::ZERO, S::ZERO, S::ZERO);
        if self.on_support {
            // Flywheels go on with the support.
            return;
        }
        let flywheels = last.flywheel[0] + last.flywheel[1];
        match self.clutching {
            Clutching::Permanent => entries.impact = entries.impact + flywheels,
            Clutching::Ideal => entries.brake = entries.brake + flywheels,
            Clutching::Real | Clutching::Rigid => return,
        }
        last.flywheel = [S::ZERO; 2];
    }

    /// Flywheels that are locked go through an impact with the block.
    fn passes_impacts(&self) -> bool {
        self.clutching != Clutching::Real
    }

    fn state_of_affairs(&mut self, balance: Balance<S>) {
        self.entries.kinetic = balance.kinetic;
        self.entries.potential = balance.potential;
        self.entries.stored = balance.stored();
        self.last = Some(balance);
    }
}

impl<S: Real> Observer<S> for Ledger<S> {
    fn device_interval(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.swing.reaches(interval.fastest().to_f64());
        let first = self.balance(interval.side, &output.snapshot(interval.from));
        match self.last {
            None => self.entries.initial = first.kinetic + first.potential + first.stored(),
            Some(last) => self.attribute(&last, &first),
        }
        self.since = Since::default();
        if !self.swing.is_weak() {
            self.lent = [S::ZERO; 2];
        }
        let sums = integral(interval.from, interval.to, S::HALF / self.frequency, |time| {
            let snapshot = output.snapshot(time);
            let spent = &snapshot.device.spent;
            let input = self.input(interval.side, &snapshot);
            [input, spent.clutch, spent.brake, spent.bearing, spent.rack, spent.kinematics]
        });
        let Entries { input, clutch, brake, bearing, rack, kinematics, .. } = &mut self.entries;
        for (entry, sum) in [input, clutch, brake, bearing, rack, kinematics].into_iter().zip(sums) {
            *entry = *entry + sum;
        }
        self.state_of_affairs(self.balance(interval.side, &output.snapshot(interval.to)));
    }

    fn device_at_rest(&mut self, output: &dyn DeviceOutput<S>, interval: &MonotoneInterval<S>) {
        self.device_interval(output, interval);
    }

    fn event(&mut self, event: Event, _time: S, state: &BlockState<S>) {
        self.swing.begins(event, state);
        let Some(mut last) = self.last else {
            // Before any motion: a block that uplifts has stood.
            if event == Event::Uplift {
                self.last = Some(Balance::default());
            }
            return;
        };
        let kinetic = S::HALF * state.velocity * state.velocity;
        match event {
            Event::Impact => {
                let left = if last.kinetic > S::ZERO { kinetic / last.kinetic } else { S::ONE };
                // An ideal clutch lets go at the impact, or holds on: the next interval shows.
                let with_flywheels = !self.on_support && matches!(self.clutching, Clutching::Permanent | Clutching::Rigid);
                let device = last.slow(left, with_flywheels);
                self.entries.impact = self.entries.impact + last.kinetic - kinetic + device;
                last.kinetic = kinetic;
                self.since.impact = true;
            }
            Event::Switch | Event::Coupling | Event::Uplift => {
                if matches!(self.clutching, Clutching::Real | Clutching::Rigid) {
                    self.entries.clutch = self.entries.clutch + last.kinetic - kinetic;
                    last.kinetic = kinetic;
                }
                self.since.switch |= event != Event::Uplift;
            }
            Event::Rest => {
                self.rest(&mut last);
                self.since = Since { stood: true, ..Since::default() };
            }
            Event::Turn | Event::Slip | Event::Overturned => return,
        }
        self.state_of_affairs(last);
    }
}

#[cfg(test)]
mod tests;
