/** The colours of the cells of a field. */
import { texts } from "../texts";
import { type Colour, LIGHT_TO_DARK, OUTCOME_COLOURS, bandColour, bandLimits, bandOf, overturned } from "./classes";
import type { Field } from "./field";
import { tickText } from "./ticks";

/** What the colours show. */
export type Shown = "outcome" | "peak";

/** An entry of the legend. */
export interface Entry {
  name: string;
  colour: Colour;
}

/** No rocking, overturned without an impact: the same in outcomes and bands. */
const [STILL, , FALLEN] = OUTCOME_COLOURS;

/** Colours of outcomes, or of bands up to the largest peak. */
export class Painter {
  /** In the order of the legend. */
  readonly legend: Entry[];
  private readonly colourOf: (outcome: number, peak: number) => Colour;

  constructor(shown: Shown, largest: number) {
    if (shown === "outcome") {
      this.legend = LIGHT_TO_DARK.map((outcome) => ({
        name: texts.views.map.outcomes[outcome] ?? "",
        colour: OUTCOME_COLOURS[outcome] ?? STILL,
      }));
      this.colourOf = (outcome) => OUTCOME_COLOURS[outcome] ?? STILL;
      return;
    }
    const limits = bandLimits(largest);
    const colours = limits.map((_, band) => bandColour(band, limits.length));
    const text = (value: number): string => tickText(value, limits[1] ?? 1);
    const band = (low: number, index: number): Entry => {
      const high = limits[index + 1];
      return { name: texts.views.map.band(text(low), high === undefined ? null : text(high)), colour: colours[index] ?? STILL };
    };
    this.legend = [
      { name: texts.views.map.outcomes[0] ?? "", colour: STILL },
      ...limits.map(band),
      { name: texts.views.map.overturns, colour: FALLEN },
    ];
    this.colourOf = (outcome, peak) => (overturned(outcome) ? FALLEN : outcome === 0 ? STILL : (colours[bandOf(limits, peak)] ?? STILL));
  }

  /** Paints `field` into `image`, one dot a cell, the lowest row at the bottom; what is not known stays clear. */
  paint(field: Field, image: ImageData): void {
    const dots = new Uint32Array(image.data.buffer);
    const { columns, rows } = field;
    const little = new Uint8Array(Uint32Array.of(1).buffer)[0] === 1;
    for (let row = 0; row < rows; row += 1) {
      const start = (rows - 1 - row) * columns;
      for (let column = 0; column < columns; column += 1) {
        const cell = field.at(row * columns + column);
        if (cell === null) {
          dots[start + column] = 0;
          continue;
        }
        const [red, green, blue] = this.colourOf(field.outcome[cell] ?? 0, field.peak[cell] ?? Number.NaN);
        dots[start + column] = little
          ? (0xff000000 | (blue << 16) | (green << 8) | red) >>> 0
          : ((red << 24) | (green << 16) | (blue << 8) | 0xff) >>> 0;
      }
    }
  }
}
