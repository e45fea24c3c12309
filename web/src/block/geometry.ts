/**
 * Where the parts of a block are. Lengths in m, x to the right and y up from the middle of the base at rest; a positive rotation tilts to
 * the right, about the right corner.
 */
import type { About } from "../engine";

/** Where a device is attached. */
export type Mount = { at: "height"; heightM: number } | { at: "corners" };

/** What the drawing of one device needs of its scene. */
export interface Shape {
  halfWidthM: number;
  halfHeightM: number;
  /** 0, 1 or 2. */
  flywheels: number;
  /** Radius of each flywheel: a plate of the block's material and thickness, whose mass is σ times the block's. */
  flywheelM: number;
  /** Radius of its pinion: flywheel radius / √2, with which such a plate has the inertance σ m. */
  pinionM: number;
  mount: Mount;
  /** Whether a flywheel that is let go keeps its speed. */
  coasts: boolean;
}

/** A table of the scene with every default; what is not a table counts as an empty one. */
export function tableOf(value: unknown): Record<string, unknown> {
  return typeof value === "object" && value !== null && !Array.isArray(value) ? (value as Record<string, unknown>) : {};
}

/** A list of tables of the scene. */
export function listOf(scene: unknown, key: string): Record<string, unknown>[] {
  const list = tableOf(scene)[key];
  return Array.isArray(list) ? list.map(tableOf) : [];
}

/** A number of a table, or null. */
export function numberOf(table: Record<string, unknown>, key: string): number | null {
  const value = table[key];
  return typeof value === "number" ? value : null;
}

/** The shapes of the devices of a scene, in its order. */
export function shapesOf(about: About): Shape[] {
  const halfWidthM = about.sizeM * Math.sin(about.slendernessRad);
  const halfHeightM = about.sizeM * Math.cos(about.slendernessRad);
  const tables = listOf(about.resolved, "device");
  return about.devices.map(({ kind, massRatio }, index) => {
    const table = tables[index] ?? {};
    const flywheels = kind === "none" ? 0 : kind === "inerter" ? 1 : 2;
    const height = numberOf(table, "mount_height_m");
    const mount: Mount =
      table["mount"] === "base-corners"
        ? { at: "corners" }
        : { at: "height", heightM: table["mount"] === "tying-point" && height !== null ? height : halfHeightM };
    // Larger ones than there is room for are drawn as large as there is room.
    const area = massRatio * 4 * halfWidthM * halfHeightM;
    const flywheelM = Math.min(Math.max(Math.sqrt(area / Math.PI), 0.04 * about.sizeM), 0.52 * halfHeightM);
    return {
      halfWidthM,
      halfHeightM,
      flywheels,
      flywheelM,
      pinionM: flywheelM / Math.SQRT2,
      mount,
      coasts: kind === "clutched-pair" && (table["engagement"] ?? "ideal") !== "ideal",
    };
  });
}

/** Where the point (x, y) of the block is at a rotation. */
export function placed(shape: Shape, rotationRad: number, x: number, y: number): [number, number] {
  const pivot = rotationRad >= 0 ? shape.halfWidthM : -shape.halfWidthM;
  const cos = Math.cos(rotationRad);
  const sin = Math.sin(rotationRad);
  return [pivot + (x - pivot) * cos + y * sin, y * cos - (x - pivot) * sin];
}

/** Travel of the rack at a rotation: of the tying point to the right, or of the corner that is lifted. */
export function travel(shape: Shape, rotationRad: number): number {
  if (shape.mount.at === "corners") {
    return 2 * shape.halfWidthM * Math.sin(Math.abs(rotationRad)) * Math.sign(rotationRad);
  }
  return placed(shape, rotationRad, 0, shape.mount.heightM)[0];
}
