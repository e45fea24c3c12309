/** The order in which a map is filled: coarse cells first, then finer ones, in parts that take a fraction of a second. */
import type { MapAbout } from "../engine";

/** Distances between the cells of a level, the coarsest first. */
const STRIDES = [8, 4, 2, 1];

/** Cells of a part: at first, and at most. */
const FIRST = 64;
const MOST = 4096;

/** Time that a part should take (ms): shorter than anyone waits, longer than its messages. */
const PART_MS = 60;

/** Numbers of the cells of a level that no coarser one has. */
export function level(columns: number, rows: number, stride: number): number[] {
  const coarser = stride < (STRIDES[0] ?? 1) ? 2 * stride : 0;
  const cells: number[] = [];
  for (let row = 0; row < rows; row += stride) {
    for (let column = 0; column < columns; column += stride) {
      if (!coarser || row % coarser || column % coarser) {
        cells.push(row * columns + column);
      }
    }
  }
  return cells;
}

/** Works out all cells of a map by `work`, so many parts at once; `signal` ends it, and so does the first part that fails. */
export async function fillMap(
  map: MapAbout,
  work: (device: number, cells: Uint32Array) => Promise<void>,
  atOnce: number,
  signal: AbortSignal,
): Promise<void> {
  const [columns, rows] = [map.x.length, map.y.length];
  const sizes = map.devices.map(() => FIRST);
  for (const stride of STRIDES) {
    const cells = level(columns, rows, stride);
    for (const device of map.devices.keys()) {
      let next = 0;
      const parts = async (): Promise<void> => {
        while (next < cells.length) {
          const size = sizes[device] ?? FIRST;
          const part = Uint32Array.from(cells.slice(next, next + size));
          next += part.length;
          const begun = performance.now();
          try {
            await work(device, part);
          } catch (problem) {
            next = cells.length;
            throw problem;
          }
          const took = Math.max(performance.now() - begun, 1);
          // Parts wait for each other, so that this is at most what it takes; lanes are full in multiples of 64.
          const better = Math.round((part.length * PART_MS) / took / FIRST) * FIRST;
          sizes[device] = Math.min(Math.max(better, FIRST), 2 * size, MOST);
        }
      };
      signal.throwIfAborted();
      await Promise.all(Array.from({ length: atOnce }, parts));
    }
  }
}
