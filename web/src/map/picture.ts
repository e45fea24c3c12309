/** A map as an SVG document. */
import { escaped, heightOf } from "./drawing";
import { type Entry, SWATCH_PX, swatchSvg } from "./legend";
import type { Panel } from "./panel";

const PANEL_PX = 380;
const CURVES_PX = 720;
const HEADING_PX = 64;
const LEGEND_PX = 30;
const ENTRY_PX = 210;
/** Least dots of the cells a pixel: programs smooth images that they enlarge. */
const DOTS = 3;

/** An SVG document of `panels` side by side, with title and legend. */
export function mapSvg(title: string, panels: readonly { name: string; panel: Panel }[], legend: readonly Entry[]): string {
  const [first] = panels;
  if (first === undefined) {
    return "";
  }
  const panelPx = first.panel.hasCells ? PANEL_PX : CURVES_PX;
  const plot = first.panel.plotOf(panelPx);
  const width = panelPx * panels.length;
  const across = Math.max(Math.floor(width / ENTRY_PX), 1);
  const body = HEADING_PX + heightOf(plot);
  const height = body + LEGEND_PX * Math.ceil(legend.length / across) + 14;
  const letters = 'fill="currentColor" font-family="system-ui, sans-serif"';
  const drawn = panels.map(({ name, panel }, index) => {
    const image = `<image x="${plot.left}" y="${plot.top}" width="${plot.width}" height="${plot.height}" preserveAspectRatio="none" href="${dataUrl(panel.canvas)}"/>`;
    return (
      `<g transform="translate(${index * panelPx} ${HEADING_PX})">${panel.hasCells ? image : ""}${panel.svg(plot)}` +
      `<text x="${plot.left}" y="-8" font-size="13" ${letters}>${escaped(name)}</text></g>`
    );
  });
  const entries = legend.map((entry, index) => {
    const [x, y] = [16 + (index % across) * ENTRY_PX, body + 8 + LEGEND_PX * Math.floor(index / across)];
    return (
      `<g transform="translate(${x} ${y})">${swatchSvg(entry)}` +
      `<text x="${SWATCH_PX.width + 6}" y="12" font-size="12" ${letters}>${escaped(entry.name)}</text></g>`
    );
  });
  return (
    `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" color="#222222">` +
    `<rect width="100%" height="100%" fill="#ffffff"/><text x="16" y="28" font-size="16" ${letters}>${escaped(title)}</text>` +
    `${drawn.join("")}${entries.join("")}</svg>\n`
  );
}

/** The cells as PNG, every cell of several dots. */
function dataUrl(cells: HTMLCanvasElement): string {
  const factor = Math.max(Math.ceil((DOTS * PANEL_PX) / Math.max(cells.width, cells.height)), 1);
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [cells.width * factor, cells.height * factor];
  const context = canvas.getContext("2d");
  if (context !== null) {
    context.imageSmoothingEnabled = false;
    context.drawImage(cells, 0, 0, canvas.width, canvas.height);
  }
  return canvas.toDataURL("image/png");
}
