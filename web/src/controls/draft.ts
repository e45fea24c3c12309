/**
 * What the controls show and change: tables of the scene with every default. A change is made here first, so that the next one stands on it
 * although the run that shows it is still under way.
 *
 * Controls are in SI units; a value is written by the key that the scene has for it, since that may be an axis of its map.
 */
import { listOf, numberOf, tableOf } from "../block/geometry";
import type { About } from "../engine";
import type { Store } from "../store";

/** A table of a scene. */
export type Table = Record<string, unknown>;

/** A key that may state a quantity, and the SI value of its 1. */
type Unit = [key: string, si: number];

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

  /** Sets a key of the block. */
  setBlock(key: string, value: number): void {
    this.block = { ...this.block, [key]: value };
    this.store.setSetting(`block.${key}=${inline(value)}`);
  }

  /** Sets the size R (m), by p where the scene says that. */
  setSize(sizeM: number): void {
    if (numberOf(this.block, "frequency_parameter_1_s") === null) {
      this.setBlock("size_m", sizeM);
    } else {
      this.setBlock("frequency_parameter_1_s", rounded(this.frequencyParameter(sizeM)));
    }
  }

  /** Sets a key of all devices that `has` picks. */
  setDevices(has: (table: Table) => boolean, key: string, value: unknown): void {
    this.devices = this.devices.map((table) => (has(table) ? { ...table, [key]: value } : table));
    const settings = this.devices.flatMap((table, index) => (has(table) ? [`device.${index}.${key}=${inline(value)}`] : []));
    this.store.setSetting(...settings);
  }

  /** Sets the list of devices. */
  replaceDevices(devices: Table[]): void {
    this.devices = devices;
    this.replace("device", devices);
  }

  /** A quantity of the first ground motion in SI units; null where it has none. */
  ground(quantity: Quantity): number | null {
    const table = this.grounds[0] ?? {};
    const [key, si] = this.unitOf(quantity) ?? [quantity, 1];
    const value = numberOf(table, key);
    return value === null ? null : rounded(value * si);
  }

  /** Sets a quantity of the first ground motion. */
  setGround(quantity: Quantity, value: number): void {
    const [key, si] = this.unitOf(quantity) ?? [quantity, 1];
    const stated = rounded(value / si);
    this.grounds = this.grounds.map((table, index) => (index === 0 ? { ...table, [key]: stated } : table));
    this.store.setSetting(`ground.0.${key}=${inline(stated)}`);
  }

  /** Sets the kind of the first ground motion; everything else of it stays. */
  setMotion(motion: string): void {
    this.grounds = this.grounds.map((table, index) => (index === 0 ? { ...table, motion } : table));
    this.store.setSetting(`ground.0.motion=${inline(motion)}`);
  }

  /** Sets the list of ground motions. */
  replaceGrounds(grounds: Table[]): void {
    this.grounds = grounds;
    this.replace("ground", grounds);
  }

  private replace(list: List, tables: Table[]): void {
    const settings = listSettings(this.about, list, tables);
    if (this.about && settings.length > 1) {
      // What is gone cannot be left out again.
      this.about = { ...this.about, map: null };
    }
    this.store.setSetting(...settings);
  }

  /** p (1/s) of a block of the size R (m). */
  private frequencyParameter(sizeM: number): number {
    return Math.sqrt(G / ((numberOf(this.block, "inertia_ratio") ?? 4 / 3) * sizeM));
  }

  /** By the block as it is here, for the last run may be that of another one. */
  private unitOf(quantity: Quantity): Unit | undefined {
    const table = this.grounds[0] ?? {};
    const p = numberOf(this.block, "frequency_parameter_1_s") ?? this.frequencyParameter(numberOf(this.block, "size_m") ?? 1);
    const alpha = ((numberOf(this.block, "slenderness_deg") ?? 0) * Math.PI) / 180;
    const threshold = this.block["geometry"] === "slender" ? alpha : Math.tan(alpha);
    const ratios: Partial<Record<Quantity, Unit[]>> = {
      amplitude_m_s2: [
        ["amplitude_g", G],
        ["amplitude_ratio", threshold * G],
      ],
      frequency_hz: [["frequency_ratio", p / (2 * Math.PI)]],
      duration_s: [["duration_ratio", 1 / p]],
    };
    const units: Unit[] = [[quantity, 1], ...(ratios[quantity] ?? [])];
    return units.find(([key]) => numberOf(table, key) !== null);
  }
}

/** Quantities of a ground motion that have a control, by their keys in SI units. */
export type Quantity = "amplitude_m_s2" | "velocity_amplitude_m_s" | "frequency_hz" | "duration_s" | "scale";

/** A list of tables of a scene. */
type List = "device" | "ground";

/** The settings that make `tables` the `list` of the scene; its map goes where they do not have an axis of it. */
export function listSettings(about: About | null, list: List, tables: Table[]): string[] {
  return [`${list}=${inline(tables)}`, ...(losesAxis(about, list, tables) ? ["map="] : [])];
}

/** Whether an axis of the map is over a table of `list` that is not among `tables` at its place, or over a value that it has lost. */
export function losesAxis(about: About | null, list: List, tables: Table[]): boolean {
  const axes = about?.map ? [about.map.x, about.map.y].flatMap((axis) => axis ?? []) : [];
  return axes.some(({ key }) => {
    const [of, index, name = ""] = key.split(".");
    const before = listOf(about?.resolved, list)[Number(index)] ?? {};
    const after = tables[Number(index)] ?? {};
    const has = (table: Table) => (table[name] ?? null) !== null;
    return of === list && (!tables[Number(index)] || nameOf(before) !== nameOf(after) || (has(before) && !has(after)));
  });
}

/** What all of `tables` have alike, those without a key by `defaults`: a control of several devices shows nothing else. */
export function shared(tables: Table[], defaults: Table = {}): Table {
  const [first = {}, ...others] = tables.map((table) => ({ ...defaults, ...table }));
  return Object.fromEntries(Object.entries(first).filter(([key, value]) => others.every((other) => other[key] === value)));
}

/** What tells a device from others; ground motions have no name. */
export function nameOf(device: Table): string {
  return String(device["name"] ?? device["kind"]);
}

/** A number without the last digits, which a conversion has made up. */
function rounded(value: number): number {
  return Number(value.toPrecision(12));
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
