/** What the colours and dashes of a map mean. */
import { el } from "../dom";

/** An entry: cells of a colour, or a curve where there are dashes (`none` for a whole one). */
export interface Entry {
  name: string;
  colour: string;
  dashes?: string;
}

/** Size of a swatch (px). */
export const SWATCH_PX = { width: 30, height: 16 };

/** The sample of an entry as SVG, its corner at 0, 0. */
export function swatchSvg({ colour, dashes }: Entry): string {
  const { width, height } = SWATCH_PX;
  return dashes === undefined
    ? `<rect x="6.5" y="0.5" width="16" height="${height - 1}" fill="${colour}" stroke="currentColor"/>`
    : `<path d="M0 ${height / 2}H${width}" stroke="${colour}" stroke-width="2" stroke-dasharray="${dashes}"/>`;
}

/** An item of the legend on the page. */
export function legendItem(entry: Entry): HTMLLIElement {
  const sample = el("span", { className: "map-swatch" });
  sample.innerHTML = `<svg width="${SWATCH_PX.width}" height="${SWATCH_PX.height}" aria-hidden="true">${swatchSvg(entry)}</svg>`;
  return el("li", {}, sample, entry.name);
}
