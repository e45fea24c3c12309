/** A map as a table: one row a cell and device. */
import { OUTCOME_NAMES, overturned } from "./classes";
import { UNKNOWN } from "./field";
import type { Filling } from "./filling";

/**
 * The columns of map.csv of `sprag map`: devices one after another, of each cells row by
 * row from the lowest, each from the left. Cells that are not known are left out.
 */
export function mapCsv({ about, fields }: Filling): string {
  const lines = [
    ["device", about.xKey, ...(about.yKey === null ? [] : [about.yKey]), "outcome", "peak_rotation", "peak_acceleration"].join(","),
  ];
  fields.forEach((field, device) => {
    const name = quoted(about.devices[device] ?? "");
    field.outcome.forEach((outcome, cell) => {
      if (outcome === UNKNOWN) {
        return;
      }
      const y = about.yKey === null ? "" : `,${number(about.y[Math.floor(cell / field.columns)] ?? Number.NaN)}`;
      const peaks = [field.peak, field.acceleration].map((all) => {
        const peak = all[cell] ?? Number.NaN;
        return overturned(outcome) || Number.isNaN(peak) ? "" : number(peak);
      });
      lines.push(`${name},${number(about.x[cell % field.columns] ?? Number.NaN)}${y},${OUTCOME_NAMES[outcome] ?? ""},${peaks.join(",")}`);
    });
  });
  return `${lines.join("\n")}\n`;
}

/** Reads back to the same number, and is written as `sprag` writes it. */
function number(value: number): string {
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e16)) {
    return value.toExponential().replace("+", "");
  }
  const text = String(value);
  return Number.isInteger(value) ? `${text}.0` : text;
}

function quoted(text: string): string {
  return /[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
}
