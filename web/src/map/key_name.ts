/** Names of keys for people. */
import type { Key } from "../engine";
import { texts } from "../texts";

/** What `key` is, which of several tables it belongs to, and its unit. */
export function keyName(key: string, keys: readonly Key[]): string {
  const parts = key.split(".");
  const general = parts.map((part) => (/^\d+$/.test(part) ? "N" : part)).join(".");
  const words = texts.views.quantities[general] ?? (parts.at(-1) ?? key).replaceAll("_", " ");
  const [list, number] = parts;
  // Of one motion it goes without saying which; a device is always named by its number.
  const several = list === "device" || keys.some((other) => other.key.startsWith(`${list}.1.`));
  const of = number !== undefined && /^\d+$/.test(number) && several ? `, ${list} ${Number(number) + 1}` : "";
  const unit = keys.find((other) => other.key === key)?.unit ?? "";
  return unit === "" ? `${words}${of}` : `${words}${of} (${unit})`;
}
