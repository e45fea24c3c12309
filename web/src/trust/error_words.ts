/** How accurate a shown result is, as `sprag simulate` says it. */
import { texts } from "../texts";

const words = texts.views.trust;

/** The error of a run by its summary; null where none was asked for. */
export function errorWords(summary: Record<string, unknown>): string | null {
  const error = summary["error_estimate"];
  if (typeof error !== "object" || error === null) {
    return null;
  }
  const { outcome_certain: certain, peak_rotation: absolute, as_wanted: asWanted } = error as Record<string, unknown>;
  const peak = summary["peak_rotation"];
  if (certain === false) {
    return words.doubt;
  }
  if (typeof peak !== "number" || typeof absolute !== "number") {
    return words.certain;
  }
  const short = (value: number): string => value.toExponential(1).replace("+", "");
  const relative = peak === 0 ? 0 : absolute / Math.abs(peak);
  return words.within(short(absolute), short(relative)) + (asWanted === false ? words.more : "");
}
