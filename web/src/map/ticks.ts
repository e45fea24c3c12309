/** Ticks of the axes of a map. */

/** How an axis is divided. */
export type Scale = "linear" | "logarithmic";

/** A tick: its place from 0 to 1 along the axis, and its text; empty for one without. */
export interface Tick {
  place: number;
  text: string;
}

/** The values that an axis shows, from edge to edge. */
export class Span {
  private readonly scale: Scale;
  private readonly low: number;
  private readonly high: number;

  /** From `low` to `high`, and `beyond` of that at both ends. */
  constructor(low: number, high: number, scale: Scale, beyond = 0) {
    this.scale = scale;
    const [first, last] = [this.on(low), this.on(high)];
    [this.low, this.high] = [first - beyond * (last - first), last + beyond * (last - first)];
  }

  /** Of cells with these values: half a cell beyond the first and the last. */
  static ofCells(values: Float64Array, scale: Scale): Span {
    return new Span(values[0] ?? 0, values.at(-1) ?? 1, scale, 0.5 / Math.max(values.length - 1, 1));
  }

  /** Place of `value`, 0 and 1 at the edges. */
  place(value: number): number {
    return (this.on(value) - this.low) / (this.high - this.low);
  }

  /** Ticks for about `target` labels. */
  ticks(target: number): Tick[] {
    const [low, high] = [this.low, this.high];
    const at = (along: number, text: string): Tick => ({ place: (along - low) / (high - low), text });
    if (this.scale === "linear") {
      const step = roundStep((high - low) / target);
      return steps(low, high, step).map((value) => at(value, tickText(value, step)));
    }
    const decades = steps(Math.floor(low), Math.ceil(high), 1);
    const inside = ({ place }: Tick): boolean => place >= 0 && place <= 1;
    const powers = decades.flatMap((power) => {
      const digits = high - low > 2 ? [1] : high - low > 0.7 ? [1, 2, 5] : [1, 2, 3, 4, 5, 6, 7, 8, 9];
      return [1, 2, 3, 4, 5, 6, 7, 8, 9].map((digit) => {
        const value = digit * 10 ** power;
        return at(power + Math.log10(digit), digits.includes(digit) ? tickText(value, 10 ** power) : "");
      });
    });
    return powers.filter(inside);
  }

  private on(value: number): number {
    return this.scale === "logarithmic" ? Math.log10(value) : value;
  }
}

/** 1, 2 or 5 times a power of ten, not below `rough`. */
function roundStep(rough: number): number {
  const decade = 10 ** Math.floor(Math.log10(rough));
  return ([1, 2, 5, 10].find((factor) => factor * decade >= rough * (1 - 1e-9)) ?? 10) * decade;
}

function steps(low: number, high: number, step: number): number[] {
  const [first, last] = [Math.ceil(low / step - 1e-9), Math.floor(high / step + 1e-9)];
  return Array.from({ length: Math.max(last - first + 1, 0) }, (_, index) => (first + index) * step);
}

/** `value` with the decimals that values `step` apart need, and a true minus sign. */
export function tickText(value: number, step: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-3 || size >= 1e5)) {
    const power = (number: number): number => Math.floor(Math.log10(number) + 1e-9);
    const text = value.toExponential(Math.min(Math.max(power(size) - power(step), 0), 15));
    return text.replace(/\.?0*e\+?/, "e").replaceAll("-", "\u2212");
  }
  const decimals = Math.min(Math.max(-Math.floor(Math.log10(step) + 1e-9), 0), 12);
  return value.toFixed(decimals).replace("-", "\u2212");
}

/** `value` in few digits, for sentences. */
export function shortText(value: number): string {
  return String(Number(value.toPrecision(4))).replace("-", "\u2212");
}
