/** The room that a device is drawn in, ground and air included. */
import type { Shape } from "./geometry";

/** Half the width that a device is drawn in (m): room for most of the block on its side, or for the ground to move. */
export function halfSpanM(shape: Shape): number {
  return shape.halfWidthM + 1.5 * shape.halfHeightM;
}

/** How far the ground is drawn away from the middle at most (m). */
export function roomForGroundM(shape: Shape): number {
  return 0.3 * shape.halfHeightM;
}

/** Height that a device is drawn in (m): ground below, air above, also above the corner of a squat block that turns. */
export function heightM(shape: Shape): number {
  const { halfHeightM, halfWidthM } = shape;
  return Math.max(2.45 * halfHeightM, depthM(shape) + 2.05 * Math.hypot(halfHeightM, halfWidthM));
}

/** Height of ground below the base (m). */
export function depthM(shape: Shape): number {
  return 0.2 * shape.halfHeightM;
}
