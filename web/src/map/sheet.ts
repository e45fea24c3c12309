/** What is seen of a map: panels side by side, and their legend. */
import type { Key } from "../engine";
import { drawSoon } from "../clock";
import { el } from "../dom";
import { texts } from "../texts";
import { LIGHT_TO_DARK } from "./classes";
import { type DrawnAxis, boundariesSvg, curveSvg } from "./drawing";
import type { Filling } from "./filling";
import { keyName } from "./key_name";
import { type Entry, legendItem } from "./legend";
import { Painter, type Shown } from "./painting";
import { Panel, type Place, type Reaction } from "./panel";
import { Span } from "./ticks";

const words = texts.views.map;

/** Colours of curves in files and on pages, dark or light: Okabe and Ito's for colour-blind readers; dashes for grey print. */
const COLOURS = ["currentColor", "#d55e00", "#0072b2", "#009e73", "#cc79a7"] as const;
const DASHES = ["none", "6 2.5", "10 2.5 1.5 2.5", "1.8 1.8", "14 4"] as const;

function curveLook(device: number): { colour: string; dashes: string } {
  return { colour: COLOURS[device % COLOURS.length] ?? "", dashes: DASHES[device % DASHES.length] ?? "" };
}

/** Panels of a map that is being filled. */
export class Sheet {
  readonly root = el("div");
  readonly panels: { name: string; panel: Panel }[] = [];
  /** What the colours of the legend are. */
  legend: Entry[] = [];
  private readonly filling: Filling;
  private readonly x: DrawnAxis;
  private y: DrawnAxis;
  private readonly legendList = el("ul", { className: "key", ariaLabel: words.legend });
  private readonly images: ImageData[] = [];
  private shown: Shown = "outcome";
  private readonly drawNow = (): void => this.draw();

  constructor(filling: Filling, keys: readonly Key[], describedBy: string, reaction: Reaction) {
    this.filling = filling;
    const { about, axes } = filling;
    this.x = { span: Span.ofCells(about.x, axes.x.scale), title: keyName(about.xKey, keys) };
    const cut = axes.y === null;
    this.y = cut
      ? { span: new Span(0, 1, "linear"), title: words.peak }
      : { span: Span.ofCells(about.y, axes.y?.scale ?? "linear"), title: keyName(about.yKey ?? "", keys) };
    const panel = (name: string): void => {
      this.panels.push({ name, panel: new Panel(name, about.x.length, about.y.length, this.x, this.y, describedBy, reaction) });
    };
    if (cut) {
      panel(about.devices.join(", "));
    } else {
      about.devices.forEach((device) => {
        panel(device);
        this.images.push(new ImageData(about.x.length, about.y.length));
      });
    }
    const grid = el("div", { className: "map-panels" }, ...this.panels.map((one) => one.panel.root));
    this.root.append(grid, this.legendList);
    this.draw();
  }

  /** Shows outcomes or peaks. */
  show(shown: Shown): void {
    this.shown = shown;
    this.later();
  }

  /** Draws at the next frame, however often it is called until then. */
  readonly later = (): void => drawSoon(this.drawNow);

  /** Marks the cell of the cursor, and the scene where its values are on the map. */
  mark(cursor: Place | null, scene: { x: number; y: number | null } | null): void {
    const { about, axes } = this.filling;
    const across = (value: number): number => this.x.span.place(value);
    const up = (value: number | null): number => (axes.y === null || value === null ? 0.5 : this.y.span.place(value));
    const rings = [];
    if (scene !== null) {
      rings.push({ across: across(scene.x), up: up(scene.y), dashed: true });
    }
    if (cursor !== null) {
      rings.push({ across: across(about.x[cursor.column] ?? 0), up: up(about.y[cursor.row] ?? null), dashed: false });
    }
    const inside = rings.filter((ring) => ring.across >= 0 && ring.across <= 1 && ring.up >= 0 && ring.up <= 1);
    this.panels.forEach(({ panel }) => panel.setRings(inside));
  }

  private draw(): void {
    const { fields } = this.filling;
    const largest = Math.max(...fields.map((field) => field.largest));
    if (this.filling.axes.y === null) {
      this.drawCut(largest);
      return;
    }
    const painter = new Painter(this.shown, largest);
    fields.forEach((field, device) => {
      const [panel, image] = [this.panels[device]?.panel, this.images[device]];
      if (panel !== undefined && image !== undefined) {
        painter.paint(field, image);
        panel.paint(image);
        panel.setShare(field.known === 0 ? "" : words.share(((100 * field.overturned) / field.known).toFixed(1)));
      }
    });
    this.setLegend(painter.legend);
  }

  /** Draws boundaries, or takes them away. */
  drawBoundaries(shown: boolean): void {
    const all = shown ? this.filling.boundaries : null;
    this.panels.forEach(({ panel }, device) => {
      panel.setOver((plot) => boundariesSvg(plot, this.x.span, this.y.span, all?.[device] ?? []));
    });
  }

  private drawCut(largest: number): void {
    this.y.span = new Span(0, Math.max(1.05 * largest, 0.1), "linear");
    this.panels[0]?.panel.setOver((plot) =>
      this.filling.fields
        .map((field, device) => {
          const { colour, dashes } = curveLook(device);
          return curveSvg(plot, this.x.span, this.y.span, this.filling.about.x, field.peak, colour, dashes);
        })
        .join(""),
    );
    this.setLegend(this.filling.about.devices.map((name, device) => ({ name, ...curveLook(device) })));
  }

  private setLegend(entries: Entry[]): void {
    const same = entries.length === this.legend.length && entries.every(({ name }, index) => name === this.legend[index]?.name);
    this.legend = entries;
    if (!same) {
      this.legendList.replaceChildren(...entries.map(legendItem));
    }
  }
}

/** What a cell came to, in words, device by device; empty where nothing is known. */
export function outcomesOf(filling: Filling, { column, row }: Place, peakText: (peak: number) => string): string {
  const cell = row * filling.about.x.length + column;
  const all = filling.fields.map((field, device) => {
    const known = field.outcome[cell] ?? 255;
    const outcome = LIGHT_TO_DARK.some((number) => number === known) ? (words.outcomes[known] ?? "") : words.unknown;
    const peak = field.peak[cell] ?? Number.NaN;
    return words.outcomeOf(filling.about.devices[device] ?? "", outcome, Number.isNaN(peak) || known === 0 ? "" : peakText(peak));
  });
  return all.join("; ");
}
