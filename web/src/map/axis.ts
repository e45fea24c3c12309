/** Axes as the scene has them: settings, and what to suggest for a quantity. */
import type { Axis, Key, RecordFile } from "../engine";

/** Cells of an axis that is suggested. */
const CELLS = 128;

/** Most cells of an axis on the page. */
export const MOST_CELLS = 1024;

/** Keys that maps are usually drawn over, the most usual first. */
const USUAL = {
  x: ["ground.0.frequency_ratio", "ground.0.frequency_hz", "block.size_m", "block.frequency_parameter_1_s"],
  y: [
    "ground.0.amplitude_ratio",
    "ground.0.amplitude_g",
    "ground.0.amplitude_m_s2",
    "ground.0.velocity_amplitude_m_s",
    "ground.0.scale",
    "block.slenderness_deg",
  ],
};

/** Keys with an upper end of their own. */
const ENDS: Record<string, [number, number]> = { restitution: [0.5, 1], miss_probability: [0, 1] };

/** An axis around the value of `key`. */
export function suggested(key: Key): Axis {
  const ends = ENDS[key.key.split(".").at(-1) ?? ""];
  const value = key.value ?? 1;
  const rounded = (number: number): number => Number(number.toPrecision(3));
  const [from, to] =
    ends ?? (value > 0 ? [rounded(value / 3), rounded(value * 3)] : value < 0 ? [rounded(value * 3), rounded(value / 3)] : [0, 1]);
  return { key: key.key, from, to, cells: CELLS, scale: "linear" };
}

/** Axes for a scene that has none; null where it has not two numbers. */
export function suggestedPair(keys: readonly Key[]): { x: Axis; y: Axis } | null {
  const set = keys.filter((key) => key.value !== null);
  const first = (usual: string[], but: string): Key | undefined => {
    const found = usual.map((name) => set.find((key) => key.key === name)).find((key) => key !== undefined && key.key !== but);
    return found ?? set.find((key) => key.key !== but);
  };
  const x = first(USUAL.x, "");
  const y = first(USUAL.y, x?.key ?? "");
  return x === undefined || y === undefined ? null : { x: suggested(x), y: suggested(y) };
}

/** Whether the scene can have it. */
export function isAxis(axis: Axis): boolean {
  const cells = Number.isInteger(axis.cells) && axis.cells >= 2 && axis.cells <= MOST_CELLS;
  return cells && axis.from < axis.to && (axis.scale === "linear" || axis.from > 0);
}

/** An axis as a TOML value. */
export function axisToml(axis: Axis): string {
  const { key, from, to, cells, scale } = axis;
  return `{ key = "${key}", from = ${from}, to = ${to}, cells = ${cells}, scale = "${scale}" }`;
}

/** Numbers of records: two files may have one name. */
const numbers = new WeakMap<RecordFile, number>();
let count = 0;

function numberOf(record: RecordFile): number {
  const number = numbers.get(record) ?? ++count;
  numbers.set(record, number);
  return number;
}

/** A resolved scene without the values that the axes set, and without what no cell depends on: equal for scenes with the same map. */
export function mapIdentity({ x, y }: { x: Axis; y: Axis | null }, resolved: unknown, records: readonly RecordFile[]): string {
  const copy: unknown = structuredClone(resolved);
  for (const { key } of y === null ? [x] : [x, y]) {
    const parts = key.split(".");
    const last = parts.pop() ?? "";
    const place = lookUp(copy, parts.join("."));
    if (isTable(place)) {
      delete place[last];
    }
  }
  if (isTable(copy)) {
    delete copy["title"];
  }
  return JSON.stringify([copy, records.map(numberOf)]);
}

/** The number of `key` in a resolved scene; null where there is none. */
export function valueOf(resolved: unknown, key: string): number | null {
  const value = lookUp(resolved, key);
  return typeof value === "number" ? value : null;
}

/** What a resolved scene has at `key`; undefined where it has nothing. */
export function lookUp(resolved: unknown, key: string): unknown {
  return key.split(".").reduce<unknown>((table, part) => (isTable(table) ? table[part] : undefined), resolved);
}

/** Tables and lists alike: numbers are keys of lists. */
function isTable(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
