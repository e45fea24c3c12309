/** The parts of a map that are lines and letters, as SVG: for the page and for the file alike. */
import type { Boundary } from "../engine";
import type { Span } from "./ticks";

/** An axis as it is drawn. */
export interface DrawnAxis {
  span: Span;
  title: string;
}

/** Where the cells are in a panel (px). */
export interface Plot {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** Room around the cells (px): numbers and title of the axes. */
export const ROOM = { left: 52, top: 8, right: 12, bottom: 42 };

const FONT_PX = 11;
const TITLE_PX = 12;
/** Least distance between labels (px): across, up. */
const LABEL_PX = [56, 34] as const;

/** Height over width: of cells, of curves. */
const SHAPE = { cells: 0.8, curves: 0.45 };

/** The place of cells or curves in a panel `width` px wide. */
export function plotOf(width: number, what: keyof typeof SHAPE): Plot {
  const across = Math.max(width - ROOM.left - ROOM.right, 40);
  return { left: ROOM.left, top: ROOM.top, width: across, height: Math.round(across * SHAPE[what]) };
}

/** Height of the panel of `plot` (px). */
export function heightOf(plot: Plot): number {
  return plot.top + plot.height + ROOM.bottom;
}

/** Frame, ticks and titles. Lines and letters have the colour of the text. */
export function axesSvg(plot: Plot, x: DrawnAxis, y: DrawnAxis): string {
  const { left, top, width, height } = plot;
  const bottom = top + height;
  const tick = (x1: number, y1: number, x2: number, y2: number): string => `<line x1="${x1}" y1="${y1}" x2="${x2}" y2="${y2}"/>`;
  let [lines, letters] = ["", ""];
  for (const { place, text } of x.span.ticks(Math.max(width / LABEL_PX[0], 2))) {
    const at = px(left + place * width);
    lines += tick(at, bottom, at, bottom + (text === "" ? 3 : 5));
    letters += text === "" ? "" : `<text x="${at}" y="${bottom + 17}" text-anchor="middle">${text}</text>`;
  }
  for (const { place, text } of y.span.ticks(Math.max(height / LABEL_PX[1], 2))) {
    const at = px(bottom - place * height);
    lines += tick(left - (text === "" ? 3 : 5), at, left, at);
    letters += text === "" ? "" : `<text x="${left - 8}" y="${at + 4}" text-anchor="end">${text}</text>`;
  }
  const title = (text: string, where: string, room: number): string => {
    // An average letter is half as wide as high.
    const size = Math.min(TITLE_PX, Math.max((2 * room) / Math.max(text.length, 1), 8));
    return `<text ${where} text-anchor="middle" font-size="${px(size)}">${escaped(text)}</text>`;
  };
  const middle = top + height / 2;
  return (
    `<g stroke="currentColor" fill="none" stroke-width="1"><rect x="${left}" y="${top}" width="${width}" height="${height}"/>${lines}</g>` +
    `<g fill="currentColor" font-size="${FONT_PX}" font-family="system-ui, sans-serif">${letters}` +
    title(x.title, `x="${px(left + width / 2)}" y="${bottom + 35}"`, width) +
    `${title(y.title, `x="14" y="${px(middle)}" transform="rotate(-90 14 ${px(middle)})"`, height)}</g>`
  );
}

/** `drawn`, without what lies outside the plot. */
export function insideSvg({ left, top, width, height }: Plot, drawn: string): string {
  return `<svg x="${left}" y="${top}" width="${width}" height="${height}" viewBox="${left} ${top} ${width} ${height}">${drawn}</svg>`;
}

/** Boundaries between outcomes: dark lines with a light edge, which are seen on all colours. */
export function boundariesSvg(plot: Plot, x: Span, y: Span, boundaries: readonly Boundary[]): string {
  const at = (vertices: Float64Array, index: number): string =>
    `${px(plot.left + x.place(vertices[index] ?? 0) * plot.width)} ${px(plot.top + (1 - y.place(vertices[index + 1] ?? 0)) * plot.height)}`;
  const path = boundaries
    .map(({ vertices }) => {
      const places = Array.from({ length: vertices.length >> 1 }, (_, index) => at(vertices, 2 * index));
      // Vertices are far closer to each other than pixels.
      return `M${places.filter((place, index) => index === 0 || index === places.length - 1 || place !== places[index - 1]).join("L")}`;
    })
    .join("");
  const stroke = (colour: string, width: number): string =>
    `<path d="${path}" fill="none" stroke="${colour}" stroke-width="${width}" stroke-linejoin="round"/>`;
  return path === "" ? "" : stroke("#ffffff", 3) + stroke("#111111", 1.2);
}

/** Curves of a cut: one a device, broken where there is no value. */
export function curveSvg(plot: Plot, x: Span, y: Span, xs: Float64Array, ys: Float64Array, colour: string, dashes: string): string {
  let [path, pen] = ["", "M"];
  xs.forEach((value, index) => {
    const height = ys[index] ?? Number.NaN;
    if (Number.isNaN(height)) {
      pen = "M";
    } else {
      path += `${pen}${px(plot.left + x.place(value) * plot.width)} ${px(plot.top + (1 - y.place(height)) * plot.height)}`;
      pen = "L";
    }
  });
  return `<path d="${path}" fill="none" stroke="${colour}" stroke-width="1.5" stroke-dasharray="${dashes}"/>`;
}

/** A ring around a place (0 to 1 on both axes), seen on all colours; dashed for the scene, whole for the cursor. */
export function ringSvg(plot: Plot, across: number, up: number, dashed: boolean): string {
  const [x, y] = [px(plot.left + across * plot.width), px(plot.top + (1 - up) * plot.height)];
  const ring = (colour: string, width: number, dashes: string): string =>
    `<circle cx="${x}" cy="${y}" r="7" fill="none" stroke="${colour}" stroke-width="${width}" stroke-dasharray="${dashes}"/>`;
  return ring("#ffffff", 4, "none") + ring("#111111", 2, dashed ? "3 2.5" : "none");
}

/** `text` where SVG is written by hand. */
export function escaped(text: string): string {
  return text.replace(/[&<>"]/g, (character) => `&#${character.charCodeAt(0)};`);
}

function px(value: number): number {
  return Math.round(value * 10) / 10;
}
