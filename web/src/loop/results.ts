/** What a closed loop came to, and its event log, as tables. */
import type { Loop } from "../engine";
import { el } from "../dom";
import { texts } from "../texts";
import { OUTCOME_NAMES } from "../map/classes";
import { shortText } from "../map/ticks";

const words = texts.views.loop;

/** An entry of the event log. */
export interface FaultEntry {
  timeS: number;
  code: number;
  fault: string;
}

/** Faults of `loop` in the order in which they were entered. */
export function faultsOf(loop: Loop): FaultEntry[] {
  const faults = loop.summary["faults"];
  const entry = (value: unknown): FaultEntry => {
    const of = table(value);
    return { timeS: number(of["time_s"]) ?? Number.NaN, code: number(of["code"]) ?? 0, fault: String(of["fault"] ?? "") };
  };
  return Array.isArray(faults) ? faults.map(entry) : [];
}

/** The closed loop beside the ideal pair. */
export function resultTable(loop: Loop): HTMLTableElement {
  const { results } = words;
  const { summary } = loop;
  const decisions = table(summary["decisions"]);
  const text = (value: unknown, written: (value: number) => string): string => {
    const found = number(value);
    return found === null ? words.noValue : written(found);
  };
  const peak = (value: unknown): string => text(value, shortText);
  const delay = (value: unknown): string => text(value, (seconds) => words.milliseconds((1e3 * seconds).toFixed(2)));
  const rows: [string, string, string][] = [
    [results.outcome, outcome(summary["outcome"]), outcome(summary["ideal_outcome"])],
    [results.peak, peak(summary["peak_rotation"]), peak(summary["ideal_peak_rotation"])],
    [results.wrong, text(decisions["wrong_share"], (share) => words.percent((100 * share).toFixed(2))), ""],
    [results.delayMedian, delay(decisions["delay_median_s"]), ""],
    [results.delay95, delay(decisions["delay_95_s"]), ""],
    [results.switches, words.switchesOf(number(decisions["switches"]) ?? 0, number(decisions["ideal_switches"]) ?? 0), ""],
    [results.state, String(summary["controller_state"] ?? ""), ""],
    [results.digest, loop.digest, ""],
  ];
  return grid(words.result, ["", results.closed, results.ideal], rows);
}

/** The faults of `loop`. */
export function faultLog(loop: Loop): HTMLElement {
  const faults = faultsOf(loop);
  if (faults.length === 0) {
    return el("p", { textContent: `${words.log}: ${words.noFaults}` });
  }
  return grid(
    words.log,
    words.logColumns,
    faults.map(({ timeS, code, fault }) => [timeS.toFixed(4), String(code), fault]),
  );
}

/** A table with a caption; the first column is the head of its row. */
export function grid(caption: string, columns: readonly string[], rows: readonly (readonly string[])[]): HTMLTableElement {
  const cell = (textContent: string): HTMLElement => el("td", { textContent });
  const heading = (textContent: string, scope: string): HTMLElement => el("th", { textContent, scope });
  const head = columns.map((column) => (column === "" ? el("td") : heading(column, "col")));
  const line = ([first = "", ...others]: readonly string[]): HTMLElement => el("tr", {}, heading(first, "row"), ...others.map(cell));
  return el(
    "table",
    {},
    el("caption", { textContent: caption }),
    el("thead", {}, el("tr", {}, ...head)),
    el("tbody", {}, ...rows.map(line)),
  );
}

function outcome(name: unknown): string {
  const place = OUTCOME_NAMES.findIndex((known) => known === name);
  return place < 0 ? String(name ?? "") : (texts.views.map.outcomes[place] ?? "");
}

function number(value: unknown): number | null {
  return typeof value === "number" ? value : null;
}

function table(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null ? (value as Record<string, unknown>) : {};
}
