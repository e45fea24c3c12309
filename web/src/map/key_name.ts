/** Names of keys for people. */
import type { Key } from "../engine";
import { texts } from "../texts";
import { lookUp } from "./axis";

/** The keys of a resolved scene, with their words where those depend on it: a slender block is lifted from gα on. */
export function named(keys: readonly Key[], resolved: unknown): Key[] {
  const isSlender = lookUp(resolved, "block.geometry") === "slender";
  return keys.map((key) => (isSlender && key.key.endsWith(".amplitude_ratio") ? { ...key, words: texts.views.slenderAmplitude } : key));
}

/** What `key` is, which of several tables it belongs to, and its unit. */
export function keyName(key: string, keys: readonly Key[]): string {
  const parts = key.split(".");
  const general = parts.map((part) => (/^\d+$/.test(part) ? "N" : part)).join(".");
  const found = keys.find((other) => other.key === key);
  const words = found?.words ?? texts.views.quantities[general] ?? (parts.at(-1) ?? key).replaceAll("_", " ");
  const [list, number] = parts;
  // Of one motion it goes without saying which; a device is always named by its number.
  const several = list === "device" || keys.some((other) => other.key.startsWith(`${list}.1.`));
  const of = number !== undefined && /^\d+$/.test(number) && several ? `, ${list} ${Number(number) + 1}` : "";
  const unit = found?.unit ?? "";
  return unit === "" ? `${words}${of}` : `${words}${of} (${unit})`;
}
