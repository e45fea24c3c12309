/** Samples of several responses over one axis of time, as uPlot wants them. */
import { stretches } from "../stretches";

/** A curve of its own times. */
export interface Samples {
  timeS: Float64Array;
  values: Float64Array;
}

/**
 * All times in order, and the values of each curve at its own times, null between. Two samples of a curve that share a time, a discontinuity,
 * both stay.
 */
export function align(curves: Samples[]): [number[], ...(number | null)[][]] {
  const next = curves.map(() => 0);
  const times: number[] = [];
  const columns: (number | null)[][] = curves.map(() => []);
  const total = curves.reduce((sum, { timeS }) => sum + timeS.length, 0);
  let taken = 0;
  while (taken < total) {
    let time = Infinity;
    curves.forEach(({ timeS }, c) => (time = Math.min(time, timeS[next[c] ?? 0] ?? Infinity)));
    // A NaN would never be taken.
    if (time === Infinity) {
      break;
    }
    times.push(time);
    curves.forEach(({ timeS, values }, c) => {
      const i = next[c] ?? 0;
      const here = timeS[i] === time;
      columns[c]?.push(here ? (values[i] ?? null) : null);
      if (here) {
        next[c] = i + 1;
        taken++;
      }
    });
  }
  return [times, ...columns];
}

/** Spans of time in which a flywheel is engaged. */
export function spans(timeS: Float64Array, engaged: Uint8Array, flywheel: 1 | 2): [from: number, to: number][] {
  const own = engaged.map((flywheels) => flywheels & flywheel);
  return stretches(timeS, own).flatMap(({ from, to, value }): [number, number][] => (value === flywheel ? [[from, to]] : []));
}
