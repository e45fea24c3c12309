/** The colours of the cells of a field. */
import { texts } from "../texts";
import { type Colour, LIGHT_TO_DARK, OUTCOME_COLOURS, bandColour, bandLimits, bandOf, hex, overturned } from "./classes";
import type { Entry } from "./legend";
import type { Field } from "./field";
import { tickText } from "./ticks";

/** What the colours show. */
export type Shown = "outcome" | "peak";

/** No rocking, overturned without an impact: the same in outcomes and bands. */
const [STILL, , FALLEN] = OUTCOME_COLOURS;

/** Colours of outcomes, or of bands up to the largest peak. */
export class Painter {
  /** In the order of the legend. */
  readonly legend: Entry[];
  private readonly dotOf: (outcome: number, peak: number) => number;

  constructor(shown: Shown, largest: number) {
    if (shown === "outcome") {
      this.legend = LIGHT_TO_DARK.map((outcome) => ({
        name: texts.views.map.outcomes[outcome] ?? "",
        colour: hex(OUTCOME_COLOURS[outcome] ?? STILL),
      }));
      const dots = OUTCOME_COLOURS.map(dot);
      this.dotOf = (outcome) => dots[outcome] ?? 0;
      return;
    }
    const limits = bandLimits(largest);
    const colours = limits.map((_, band) => bandColour(band, limits.length));
    const text = (value: number): string => tickText(value, limits[1] ?? 1);
    const band = (low: number, index: number): Entry => {
      const high = limits[index + 1];
      return { name: texts.views.map.band(text(low), high === undefined ? null : text(high)), colour: hex(colours[index] ?? STILL) };
    };
    this.legend = [
      { name: texts.views.map.outcomes[0] ?? "", colour: hex(STILL) },
      ...limits.map(band),
      { name: texts.views.map.overturns, colour: hex(FALLEN) },
    ];
    const [still, fallen, bands] = [dot(STILL), dot(FALLEN), colours.map(dot)];
    this.dotOf = (outcome, peak) => (overturned(outcome) ? fallen : outcome === 0 ? still : (bands[bandOf(limits, peak)] ?? 0));
  }

  /** Paints `field` into `image`, one dot a cell, the lowest row at the bottom; what is not known stays clear. */
  paint(field: Field, image: ImageData): void {
    const dots = new Uint32Array(image.data.buffer);
    const { columns, rows } = field;
    for (let row = 0; row < rows; row += 1) {
      const start = (rows - 1 - row) * columns;
      for (let column = 0; column < columns; column += 1) {
        const cell = field.at(row * columns + column);
        dots[start + column] = cell === null ? 0 : this.dotOf(field.outcome[cell] ?? 0, field.peak[cell] ?? Number.NaN);
      }
    }
  }
}

/** A colour as a number whose bytes are those of a dot. */
function dot([red, green, blue]: Colour): number {
  return new Uint32Array(Uint8Array.of(red, green, blue, 255).buffer)[0] ?? 0;
}
