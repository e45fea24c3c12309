/** What is drawn of a run at a time: worked out once a run, so that a frame only looks it up. */
import type { Response, Run } from "../engine";
import { longest, overturns } from "../response";
import { shapesOf, travel, type Shape } from "./geometry";

/** A device at an instant. */
export interface Pose {
  rotationRad: number;
  /** Angles of the first and second flywheel. */
  firstRad: number;
  secondRad: number;
  /** 0 none, 1 first, 2 second, 3 both. */
  engaged: number;
  /** Whether the block is lost. */
  overturned: boolean;
}

/** The motion of one device. */
export interface DeviceMotion {
  shape: Shape;
  response: Response;
  overturned: boolean;
  firstRad: Float64Array;
  secondRad: Float64Array;
  /** Rotations after the end of an overturned block, every `FALL_STEP_S`. */
  fall: Float64Array;
}

/** The motion of ground and devices. */
export interface Motion {
  groundS: Float64Array;
  groundM: Float64Array;
  /** Largest distance of the ground from where it began (m). */
  groundPeakM: number;
  devices: DeviceMotion[];
}

const FALL_STEP_S = 1 / 120;

/** The motion of a run. */
export function motionOf(run: Run): Motion {
  const shapes = shapesOf(run.about);
  const shaken = longest(run.responses);
  const groundS = shaken?.timeS ?? new Float64Array(1);
  const groundM = displacement(groundS, shaken?.groundMS2 ?? new Float64Array(1));
  const devices = run.responses.flatMap((response, index) => {
    const shape = shapes[index];
    return shape ? [deviceMotion(shape, response, run.about.frequencyParameter1S, run.about.slendernessRad)] : [];
  });
  return { groundS, groundM, groundPeakM: groundM.reduce((peak, x) => Math.max(peak, Math.abs(x)), 0), devices };
}

function deviceMotion(shape: Shape, response: Response, p: number, alpha: number): DeviceMotion {
  const { timeS, rotationRad, engaged } = response;
  const firstRad = new Float64Array(timeS.length);
  const secondRad = new Float64Array(timeS.length);
  const speeds = [0, 0];
  let before = travel(shape, rotationRad[0] ?? 0);
  for (let i = 1; i < timeS.length; i++) {
    const now = travel(shape, rotationRad[i] ?? 0);
    const turn = (now - before) / shape.pinionM;
    const dt = (timeS[i] ?? 0) - (timeS[i - 1] ?? 0);
    for (const [k, angles] of [firstRad, secondRad].entries()) {
      const held = shape.flywheels === 1 ? k === 0 : ((engaged[i - 1] ?? 0) & (k + 1)) !== 0;
      // A flywheel that is let go is drawn as coasting without loss; the core does not hand over its speed.
      const step = held ? turn : shape.coasts ? (speeds[k] ?? 0) * dt : 0;
      angles[i] = (angles[i - 1] ?? 0) + step;
      if (held && dt > 0) {
        speeds[k] = turn / dt;
      }
    }
    before = now;
  }
  const overturned = overturns(response);
  const last = timeS.length - 1;
  const fall = overturned ? fallFrom(rotationRad[last] ?? 0, response.velocityRadS[last] ?? 0, p, alpha) : new Float64Array();
  return { shape, response, overturned, firstRad, secondRad, fall };
}

/**
 * How a block goes down after its response ends, until it lies on its side: a block alone on ground at rest, for display only. Responses that
 * end where the block is lost, such as those of the slender model, would leave it hanging in the air.
 */
function fallFrom(rotationRad: number, velocityRadS: number, p: number, alpha: number): Float64Array {
  const side = Math.sign(rotationRad) || 1;
  const angles: number[] = [];
  // It has been found to overturn, so it is helped over the edge where it hangs there.
  let angle = Math.abs(rotationRad);
  let speed = Math.max(side * velocityRadS, 0.1 * p * alpha);
  while (angle < Math.PI / 2 && angles.length < 2000) {
    speed += Math.max(-p * p * Math.sin(alpha - angle), 0.02 * p * p) * FALL_STEP_S;
    angle = Math.min(angle + speed * FALL_STEP_S, Math.PI / 2);
    angles.push(side * angle);
  }
  return Float64Array.from(angles);
}

/**
 * Displacement of the ground, for display only: its acceleration integrated twice (trapezia). A velocity that is left at the end of a motion
 * that has come to rest is an error of the record's baseline, and is taken out evenly over the motion.
 */
export function displacement(timeS: Float64Array, groundMS2: Float64Array): Float64Array {
  const count = timeS.length;
  const velocity = new Float64Array(count);
  let lastShaken = 0;
  for (let i = 1; i < count; i++) {
    const dt = (timeS[i] ?? 0) - (timeS[i - 1] ?? 0);
    velocity[i] = (velocity[i - 1] ?? 0) + (((groundMS2[i] ?? 0) + (groundMS2[i - 1] ?? 0)) / 2) * dt;
    if (Math.abs(groundMS2[i] ?? 0) > 1e-9) {
      lastShaken = i;
    }
  }
  const atRest = lastShaken < count - 1;
  const endS = timeS[lastShaken] ?? 0;
  const drift = atRest && endS > 0 ? (velocity[lastShaken] ?? 0) / endS : 0;
  const moved = new Float64Array(count);
  const corrected = (i: number) => (atRest && i > lastShaken ? 0 : (velocity[i] ?? 0) - drift * (timeS[i] ?? 0));
  for (let i = 1; i < count; i++) {
    const dt = (timeS[i] ?? 0) - (timeS[i - 1] ?? 0);
    moved[i] = (moved[i - 1] ?? 0) + ((corrected(i) + corrected(i - 1)) / 2) * dt;
  }
  return moved;
}

/** Index of the last sample at or before `time`. */
export function sampleAt(timeS: Float64Array, time: number): number {
  let low = 0;
  let high = timeS.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if ((timeS[middle] ?? 0) <= time) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

/** A value between samples. */
export function valueAt(timeS: Float64Array, values: Float64Array, time: number): number {
  const i = sampleAt(timeS, time);
  const t0 = timeS[i] ?? 0;
  const t1 = timeS[i + 1] ?? t0;
  const v0 = values[i] ?? 0;
  const part = t1 > t0 ? Math.min((time - t0) / (t1 - t0), 1) : 0;
  return v0 + part * ((values[i + 1] ?? v0) - v0);
}

/** Writes the pose of a device at `time` into `pose`, so that a frame makes no object. */
export function poseAt(device: DeviceMotion, time: number, pose: Pose): void {
  const { timeS, rotationRad, engaged } = device.response;
  pose.engaged = engaged[sampleAt(timeS, time)] ?? 0;
  pose.firstRad = valueAt(timeS, device.firstRad, time);
  pose.secondRad = valueAt(timeS, device.secondRad, time);
  const afterS = time - (timeS[timeS.length - 1] ?? 0);
  if (device.overturned && afterS >= 0) {
    const { fall } = device;
    const step = Math.min(Math.floor(afterS / FALL_STEP_S), fall.length - 1);
    pose.rotationRad = fall[step] ?? rotationRad[rotationRad.length - 1] ?? 0;
    pose.engaged = 0;
    pose.overturned = true;
  } else {
    pose.rotationRad = valueAt(timeS, rotationRad, time);
    pose.overturned = false;
  }
}
