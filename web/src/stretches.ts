/** Codes over time, such as which flywheel is engaged: where they stay the same. */

/** A stretch of time with one value. */
export interface Stretch {
  from: number;
  to: number;
  value: number;
}

/** Where `values` stay the same; each holds until the next time. */
export function stretches(time: Float64Array, values: Uint8Array): Stretch[] {
  const found: Stretch[] = [];
  time.forEach((from, index) => {
    const value = values[index] ?? 0;
    const last = found.at(-1);
    if (last !== undefined) {
      last.to = from;
    }
    if (last === undefined || last.value !== value) {
      found.push({ from, to: from, value });
    }
  });
  return found;
}
