/**
 * What the controls show and change: tables of the scene with every default. A change is made here first, so that the next one stands on it
 * although the run that shows it is still under way.
 */
import { listOf, numberOf, tableOf } from "../block/geometry";
import type { About } from "../engine";
import type { Store } from "../store";

/** A table of a scene. */
export type Table = Record<string, unknown>;

const G = 9.80665;

/** The tables that have controls. */
export class Draft {
  block: Table = {};
  devices: Table[] = [];
  grounds: Table[] = [];
  about: About | null = null;

  constructor(private readonly store: Store) {}

  /** Takes the tables of the last run. */
  take(): void {
    this.about = this.store.run?.about ?? null;
    const resolved = this.about?.resolved;
    this.block = { ...tableOf(tableOf(resolved)["block"]) };
    this.devices = listOf(resolved, "device");
    this.grounds = listOf(resolved, "ground");
  }

  /** Sets a key of the block; `instead` are keys that say the same and go. */
  setBlock(key: string, value: unknown, instead: string[] = []): void {
    this.block = change(
      this.block,
      key,
      value,
      instead,
      (table) => this.store.setSetting(`block=${inline(table)}`),
      () => this.store.setSetting(`block.${key}=${inline(value)}`),
    );
  }

  /** Sets keys of all devices that `has` picks. */
  setDevices(has: (table: Table) => boolean, key: string, value: unknown, instead: string[] = []): void {
    this.devices.forEach((table, index) => {
      if (has(table)) {
        this.setDevice(index, key, value, instead);
      }
    });
  }

  /** Sets a key of a device. */
  setDevice(index: number, key: string, value: unknown, instead: string[] = []): void {
    const table = this.devices[index] ?? {};
    this.devices[index] = change(
      table,
      key,
      value,
      instead,
      (whole) => this.store.setSetting(`device.${index}=${inline(whole)}`),
      () => this.store.setSetting(`device.${index}.${key}=${inline(value)}`),
    );
  }

  /** Sets the list of devices. */
  replaceDevices(devices: Table[]): void {
    this.devices = devices;
    this.store.setSetting(`device=${inline(devices)}`);
  }

  /** Sets a key of the first ground motion. */
  setGround(key: string, value: unknown, instead: string[] = []): void {
    const table = this.grounds[0] ?? {};
    this.grounds[0] = change(
      table,
      key,
      value,
      instead,
      (whole) => this.store.setSetting(`ground.0=${inline(whole)}`),
      () => this.store.setSetting(`ground.0.${key}=${inline(value)}`),
    );
  }

  /** Sets the list of ground motions. */
  replaceGrounds(grounds: Table[]): void {
    this.grounds = grounds;
    this.store.setSetting(`ground=${inline(grounds)}`);
  }

  /** Amplitude of the first ground motion (m/s²), whatever key states it; null without one. */
  amplitudeMS2(): number | null {
    const table = this.grounds[0] ?? {};
    const [ratio, g] = [numberOf(table, "amplitude_ratio"), numberOf(table, "amplitude_g")];
    return (
      numberOf(table, "amplitude_m_s2") ?? (g !== null ? g * G : ratio !== null ? ratio * (this.about?.upliftThresholdG ?? 0) * G : null)
    );
  }

  /** Frequency of the first ground motion (Hz). */
  frequencyHz(): number | null {
    const table = this.grounds[0] ?? {};
    const ratio = numberOf(table, "frequency_ratio");
    return numberOf(table, "frequency_hz") ?? (ratio === null ? null : (ratio * this.p()) / (2 * Math.PI));
  }

  /** Duration of the first ground motion (s). */
  durationS(): number | null {
    const table = this.grounds[0] ?? {};
    const ratio = numberOf(table, "duration_ratio");
    return numberOf(table, "duration_s") ?? (ratio === null ? null : ratio / this.p());
  }

  private p(): number {
    return this.about?.frequencyParameter1S ?? 1;
  }
}

/** The table with the key changed: by the whole table where keys have to go with it, since a key that is not there cannot be left out. */
function change(table: Table, key: string, value: unknown, instead: string[], whole: (table: Table) => void, single: () => void): Table {
  const kept = Object.entries(table).filter(([name]) => !instead.includes(name));
  const changed = { ...Object.fromEntries(kept), [key]: value };
  if (kept.length < Object.keys(table).length) {
    whole(changed);
  } else {
    single();
  }
  return changed;
}

/** A value as TOML in one line; what is null is left out. */
export function inline(value: unknown): string {
  if (Array.isArray(value)) {
    return `[${value.map(inline).join(", ")}]`;
  }
  if (typeof value === "object" && value !== null) {
    const items = Object.entries(value).filter(([, item]) => item !== null && item !== undefined);
    return items.length === 0 ? "{}" : `{ ${items.map(([key, item]) => `${key} = ${inline(item)}`).join(", ")} }`;
  }
  // Strings of JSON are basic strings of TOML.
  return JSON.stringify(value);
}
