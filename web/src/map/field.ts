/** What is known of the cells of one device while a map is filled. */
import type { Cells } from "../engine";
import { overturned } from "./classes";

/** Widest neighbourhood that a cell stands for. */
const WIDEST = 64;

/** Outcome of a cell that nothing is known of. */
export const UNKNOWN = 255;

/** Cells of one device. */
export class Field {
  readonly columns: number;
  readonly rows: number;
  /** Outcomes of the cells that have come; `UNKNOWN` for others. */
  readonly outcome: Uint8Array;
  /** Their max |θ|/α; NaN where overturned. */
  readonly peak: Float64Array;
  /** Their max |θ̈|/(p²α); NaN where overturned. */
  readonly acceleration: Float64Array;
  /** Number of the cell that is shown in the place of each; meaningless where `width` is 0. */
  readonly shown: Uint32Array;
  /** Width of the neighbourhood that the shown cell stands for; 1 for the cell itself, 0 for none. */
  private readonly width: Uint8Array;
  /** Cells that have come. */
  known = 0;
  /** Those of them that overturn. */
  overturned = 0;
  /** Largest peak of those that stand. */
  largest = 0;

  constructor(columns: number, rows: number) {
    const count = columns * rows;
    this.columns = columns;
    this.rows = rows;
    this.outcome = new Uint8Array(count).fill(UNKNOWN);
    this.peak = new Float64Array(count).fill(Number.NaN);
    this.acceleration = new Float64Array(count).fill(Number.NaN);
    this.shown = new Uint32Array(count);
    this.width = new Uint8Array(count);
  }

  /** Whether every cell has come. */
  get whole(): boolean {
    return this.known === this.outcome.length;
  }

  /** Adds cells; each stands for its neighbours to the right and above until they come. */
  add(part: Cells): void {
    part.cells.forEach((cell, index) => {
      const [outcome, peak] = [part.outcome[index] ?? UNKNOWN, part.peakRotation[index] ?? Number.NaN];
      if (this.outcome[cell] === UNKNOWN) {
        this.known += 1;
        this.overturned += overturned(outcome) ? 1 : 0;
      }
      this.outcome[cell] = outcome;
      this.peak[cell] = peak;
      this.acceleration[cell] = part.peakAcceleration[index] ?? Number.NaN;
      if (!overturned(outcome) && peak > this.largest) {
        this.largest = peak;
      }
      this.spread(cell);
    });
  }

  /** Number of the cell that is shown at `cell`; null where nothing is known. */
  at(cell: number): number | null {
    return this.width[cell] === 0 ? null : (this.shown[cell] ?? null);
  }

  /** A part comes at every second column and row, then at those between: the power of two that divides a place is its distance from others. */
  private spread(cell: number): void {
    const [column, row] = [cell % this.columns, Math.floor(cell / this.columns)];
    let width = 1;
    while (width < WIDEST && column % (2 * width) === 0 && row % (2 * width) === 0) {
      width *= 2;
    }
    const [right, top] = [Math.min(column + width, this.columns), Math.min(row + width, this.rows)];
    for (let y = row; y < top; y += 1) {
      for (let x = column; x < right; x += 1) {
        const at = y * this.columns + x;
        const present = this.width[at] ?? 0;
        // A finer neighbour has come already, or the cell itself.
        if (present === 0 || present >= width) {
          this.shown[at] = cell;
          this.width[at] = width;
        }
      }
    }
    this.shown[cell] = cell;
    this.width[cell] = 1;
  }
}
