/** Draws one device: ground, block, rack and flywheels to scale. */
import { flywheelBar, type Surface } from "../colours";
import { placed, travel, type Shape } from "./geometry";
import type { Pose } from "./motion";
import { depthM, roomForGroundM } from "./room";

/**
 * Draws a device with the middle of its base at the origin of `context`, x to the right and y up in m; `pixelM` is the length of a pixel,
 * `groundM` how far the ground is from where it began, `widthM` how much of it can be seen.
 */
export function drawDevice(
  context: CanvasRenderingContext2D,
  shape: Shape,
  pose: Pose,
  colours: Surface,
  accent: string,
  pixelM: number,
  groundM: number,
  widthM: number,
): void {
  drawGround(context, shape, colours, pixelM, groundM, widthM / 2 + roomForGroundM(shape));
  if (shape.flywheels > 0 && shape.mount.at === "height") {
    drawRack(context, shape, shape.mount.heightM, pose, colours, pixelM);
  }
  if (shape.flywheels > 0 && shape.mount.at === "corners") {
    drawCornerRack(context, shape, pose, -1, colours, pixelM);
    drawCornerRack(context, shape, pose, 1, colours, pixelM);
  }
  drawBlock(context, shape, pose.rotationRad, colours, accent, pixelM);
  if (shape.flywheels > 0 && shape.mount.at === "height") {
    const [x, y] = placed(shape, pose.rotationRad, 0, shape.mount.heightM);
    disc(context, x, y, 4 * pixelM, colours.ink, colours.ink, pixelM);
  }
}

function drawGround(
  context: CanvasRenderingContext2D,
  shape: Shape,
  colours: Surface,
  pixelM: number,
  groundM: number,
  half: number,
): void {
  const depth = depthM(shape);
  context.fillStyle = colours.guide;
  context.fillRect(-half, -depth, 2 * half, depth);
  context.strokeStyle = colours.ground;
  context.lineWidth = 2 * pixelM;
  line(context, -half, 0, half, 0);
  context.lineWidth = pixelM;
  const pitch = 0.2 * shape.halfHeightM;
  for (let x = Math.ceil(-half / pitch) * pitch; x < half; x += pitch) {
    line(context, x, 0, x - 0.5 * depth, -0.6 * depth);
  }
  // A mark that stays where the ground began, so that its motion can be seen.
  context.fillStyle = colours.ink;
  context.beginPath();
  context.moveTo(-groundM, -0.55 * depth);
  context.lineTo(-groundM - 5 * pixelM, -0.95 * depth);
  context.lineTo(-groundM + 5 * pixelM, -0.95 * depth);
  context.fill();
}

function drawBlock(
  context: CanvasRenderingContext2D,
  shape: Shape,
  rotationRad: number,
  colours: Surface,
  accent: string,
  pixelM: number,
): void {
  const { halfWidthM: b, halfHeightM: h } = shape;
  context.beginPath();
  for (const [x, y] of [
    [-b, 0],
    [b, 0],
    [b, 2 * h],
    [-b, 2 * h],
  ] as const) {
    const [px, py] = placed(shape, rotationRad, x, y);
    context.lineTo(px, py);
  }
  context.closePath();
  context.fillStyle = colours.block;
  context.globalAlpha = 0.88;
  context.fill();
  context.globalAlpha = 1;
  context.strokeStyle = accent;
  context.lineWidth = 2.5 * pixelM;
  context.lineJoin = "round";
  context.stroke();
  // The line from the toe that it stands on to the centre of mass: R at α.
  const toe = rotationRad >= 0 ? b : -b;
  const [cx, cy] = placed(shape, rotationRad, 0, h);
  context.strokeStyle = colours.muted;
  context.lineWidth = pixelM;
  context.setLineDash([4 * pixelM, 4 * pixelM]);
  line(context, toe, 0, cx, cy);
  context.setLineDash([]);
  disc(context, cx, cy, 3 * pixelM, colours.page, colours.muted, pixelM);
}

function drawRack(context: CanvasRenderingContext2D, shape: Shape, atM: number, pose: Pose, colours: Surface, pixelM: number): void {
  const { flywheelM: r, pinionM, halfWidthM: b, halfHeightM: h } = shape;
  const near = -(b + 0.22 * h + r);
  const far = near - 1.25 * r;
  const u = travel(shape, pose.rotationRad);
  const thick = Math.max(0.025 * h, 3 * pixelM);
  const left = (shape.flywheels === 2 ? far : near) - 0.45 * h - r * 0.3;
  // The support stands on the ground; flywheels ride on it.
  context.strokeStyle = colours.metal;
  context.lineWidth = Math.max(0.04 * h, 4 * pixelM);
  const firstX = shape.flywheels === 2 ? far : near;
  line(context, firstX, 0, firstX, atM + pinionM);
  if (shape.flywheels === 2) {
    line(context, near, 0, near, Math.max(atM - pinionM, 0));
  }
  const [tieX, tieY] = placed(shape, pose.rotationRad, 0, atM);
  const pinX = -(b + 0.12 * h) + u;
  context.strokeStyle = colours.ink;
  context.lineWidth = thick;
  line(context, left + u, atM, pinX, atM);
  context.lineWidth = 0.6 * thick;
  line(context, pinX, atM, tieX, tieY);
  drawTeeth(context, left + u, pinX, atM, thick, pixelM);
  flywheel(context, shape, firstX, atM + pinionM, pose.firstRad, (pose.engaged & 1) !== 0 || shape.flywheels === 1, 1, colours, pixelM);
  if (shape.flywheels === 2) {
    flywheel(context, shape, near, atM - pinionM, -pose.secondRad, (pose.engaged & 2) !== 0, 2, colours, pixelM);
  }
}

/** A vertical rack at a base corner, with the flywheels outside; only the side that is lifted moves. */
function drawCornerRack(context: CanvasRenderingContext2D, shape: Shape, pose: Pose, side: -1 | 1, colours: Surface, pixelM: number): void {
  const { flywheelM, pinionM, halfWidthM: b, halfHeightM: h } = shape;
  const lifted = pose.rotationRad * side < 0;
  const [x, y] = lifted ? placed(shape, pose.rotationRad, side * b, 0) : [side * b, 0];
  const thick = Math.max(0.025 * h, 3 * pixelM);
  const rackX = side * (b + 0.13 * h);
  context.strokeStyle = colours.ink;
  context.lineWidth = thick;
  line(context, rackX, y, rackX, y + 0.9 * h);
  context.lineWidth = 0.6 * thick;
  line(context, rackX, y, x, y);
  for (let k = 0; k < shape.flywheels; k++) {
    const engaged = lifted && (shape.flywheels === 1 || (pose.engaged & (k + 1)) !== 0);
    const angle = lifted ? (k === 0 ? pose.firstRad : pose.secondRad) : 0;
    const centre = side * (b + 0.13 * h + pinionM + k * 0.2 * flywheelM);
    flywheel(context, shape, centre, flywheelM * 1.05 + k * 0.75 * flywheelM, angle, engaged, k === 0 ? 1 : 2, colours, pixelM);
  }
}

function drawTeeth(context: CanvasRenderingContext2D, left: number, right: number, y: number, thick: number, pixelM: number): void {
  const pitch = Math.max(2 * thick, 6 * pixelM);
  context.lineWidth = pixelM * 1.5;
  for (let x = left; x < right; x += pitch) {
    line(context, x, y - 0.9 * thick, x, y + 0.9 * thick);
  }
}

function flywheel(
  context: CanvasRenderingContext2D,
  shape: Shape,
  x: number,
  y: number,
  angle: number,
  engaged: boolean,
  number: 1 | 2,
  colours: Surface,
  pixelM: number,
): void {
  const { flywheelM: r, pinionM } = shape;
  const bar = flywheelBar(number);
  // Filled where it is engaged, hollow where it is free: the difference does not rest on colour.
  context.globalAlpha = engaged ? 0.85 : 0.25;
  disc(context, x, y, r, engaged ? bar : colours.metal, engaged ? bar : colours.metal, pixelM);
  context.globalAlpha = 1;
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
  context.strokeStyle = engaged ? colours.ink : colours.muted;
  context.lineWidth = (engaged ? 2 : 1) * pixelM;
  context.stroke();
  context.beginPath();
  context.arc(x, y, pinionM, 0, 2 * Math.PI);
  context.lineWidth = pixelM;
  context.setLineDash([2 * pixelM, 2 * pixelM]);
  context.stroke();
  context.setLineDash([]);
  // A rack that goes to the right below its pinion turns it anticlockwise.
  for (let spoke = 0; spoke < 3; spoke++) {
    const at = angle + (spoke * 2 * Math.PI) / 3 + Math.PI / 2;
    context.lineWidth = (spoke === 0 ? 3 : 1.2) * pixelM;
    line(context, x, y, x + 0.95 * r * Math.cos(at), y + 0.95 * r * Math.sin(at));
  }
  disc(context, x, y, Math.max(0.08 * r, 2.5 * pixelM), engaged ? colours.ink : colours.page, colours.ink, pixelM);
}

function disc(context: CanvasRenderingContext2D, x: number, y: number, radius: number, fill: string, stroke: string, pixelM: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fillStyle = fill;
  context.fill();
  context.strokeStyle = stroke;
  context.lineWidth = pixelM;
  context.stroke();
}

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
