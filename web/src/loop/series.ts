/** The curves and lanes of a closed loop, as they are drawn. */
import type { About, Loop } from "../engine";

/** Curves over the ticks of a loop. */
export interface Curves {
  time: Float64Array;
  /** θ/α: true, estimated, of the ideal pair. */
  rotation: [Float64Array, Float64Array, Float64Array];
  /** θ̇/(pα): true, estimated. */
  velocity: [Float64Array, Float64Array];
  /** Driving moment D/(p²α): true, estimated. */
  push: [Float64Array, Float64Array];
}

/** Dimensionless curves of `loop` of a scene. */
export function curvesOf(loop: Loop, { slendernessRad, frequencyParameter1S }: About): Curves {
  const over = (values: Float64Array, scale: number): Float64Array => values.map((value) => value / scale);
  const [alpha, p] = [slendernessRad, frequencyParameter1S];
  return {
    time: loop.timeS,
    rotation: [
      over(loop.rotationRad, alpha),
      over(loop.rotationEstimatedRad, alpha),
      over(resampled(loop.idealPair.timeS, loop.idealPair.rotationRad, loop.timeS), alpha),
    ],
    velocity: [over(loop.velocityRadS, p * alpha), over(loop.velocityEstimatedRadS, p * alpha)],
    push: [over(loop.push1S2, p * p * alpha), over(loop.pushEstimated1S2, p * p * alpha)],
  };
}

/** `values` at `times`, on straight lines between their own times; NaN outside. */
export function resampled(ownTimes: Float64Array, values: Float64Array, times: Float64Array): Float64Array {
  let next = 0;
  return times.map((time) => {
    while (next < ownTimes.length && (ownTimes[next] ?? Infinity) < time) {
      next += 1;
    }
    const [before, after] = [ownTimes[next - 1], ownTimes[next]];
    const [low, high] = [values[next - 1], values[next]];
    if (after === time && high !== undefined) {
      return high;
    }
    if (before === undefined || after === undefined || low === undefined || high === undefined) {
      return Number.NaN;
    }
    return low + ((time - before) / (after - before)) * (high - low);
  });
}

/** Largest |value| of those that are numbers. */
export function largest(values: Float64Array): number {
  return values.reduce((peak, value) => (Math.abs(value) > peak ? Math.abs(value) : peak), 0);
}
