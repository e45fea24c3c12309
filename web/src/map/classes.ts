/** The classes of cells that a map shows, and their colours: outcomes, or bands of the peak rotation. As in the pictures of `sprag map`. */

/** Red, green, blue. */
export type Colour = readonly [number, number, number];

/** Outcomes as tables of `sprag` name them, by their numbers in `Cells`. */
export const OUTCOME_NAMES = ["no-rocking", "safe", "overturned-without-impact", "overturned-after-impact"] as const;

/** Colours of the outcomes: blue and orange for colour-blind readers, from light to dark for grey print. */
export const OUTCOME_COLOURS: readonly [Colour, Colour, Colour, Colour] = [
  [248, 248, 246],
  [158, 202, 225],
  [54, 20, 38],
  [213, 94, 0],
];

/** Numbers of the outcomes from the lightest to the darkest. */
export const LIGHT_TO_DARK = [0, 1, 3, 2] as const;

/** From pale yellow through green to deep blue. */
const STOPS: readonly Colour[] = [
  [240, 246, 200],
  [168, 218, 180],
  [77, 180, 190],
  [38, 120, 180],
  [30, 50, 130],
];

/** Bands of a spectrum, at most. */
const BANDS = 14;

/** Whether a block with this outcome lies on the ground. */
export function overturned(outcome: number): boolean {
  return outcome >= 2;
}

/** Round limits of bands from 0 up to `largest`. */
export function bandLimits(largest: number): number[] {
  const rough = Math.max(largest / BANDS, 1e-12);
  const decade = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * decade).find((size) => size >= rough) ?? rough;
  return Array.from({ length: Math.floor(largest / step) + 1 }, (_, index) => index * step);
}

/** Number of the band of `value`: of the last limit that is not above it. */
export function bandOf(limits: readonly number[], value: number): number {
  const step = limits[1] ?? Infinity;
  return Math.min(Math.max(Math.floor(value / step + 1e-9), 0), limits.length - 1);
}

/** Colour of a band of several: brightness falls all the way. */
export function bandColour(band: number, bands: number): Colour {
  const place = (bands > 1 ? band / (bands - 1) : 0) * (STOPS.length - 1);
  const below = Math.min(Math.floor(place), STOPS.length - 2);
  const [from, to] = [STOPS[below] ?? [0, 0, 0], STOPS[below + 1] ?? [0, 0, 0]];
  const mix = (part: 0 | 1 | 2): number => Math.round(from[part] + (place - below) * (to[part] - from[part]));
  return [mix(0), mix(1), mix(2)];
}

/** As pages and pictures have it. */
export function hex(colour: Colour): string {
  return `#${colour.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}
