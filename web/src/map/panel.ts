/** The map of one device: cells on a canvas, axes and marks above them, and who points at a cell. */
import { el } from "../dom";
import { texts } from "../texts";
import { type DrawnAxis, type Plot, axesSvg, heightOf, insideSvg, plotOf, ringSvg } from "./drawing";

/** A cell by its place. */
export interface Place {
  column: number;
  row: number;
}

/** What the user does with a panel. */
export interface Reaction {
  /** Points at a cell. */
  point(place: Place): void;
  /** Takes the cell that was pointed at last. */
  take(): void;
  /** Goes back. */
  back(): void;
  /** The cell that was pointed at last. */
  cursor(): Place | null;
}

/** Cells that a step takes with Shift. */
const STRIDE = 8;

/** A panel. */
export class Panel {
  readonly root: HTMLElement;
  /** One dot a cell. */
  readonly canvas = el("canvas", { ariaHidden: "true" });
  private readonly share = el("span", { className: "map-share" });
  private readonly plotArea: HTMLElement;
  private readonly lines = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly marks = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  private readonly columns: number;
  private readonly rows: number;
  private readonly x: DrawnAxis;
  private readonly y: DrawnAxis;
  private plot: Plot;
  /** What is drawn between axes and marks: boundaries, curves. */
  private over: (plot: Plot) => string = () => "";
  /** Whether there are cells, and not curves. */
  readonly hasCells: boolean;
  private rings: { across: number; up: number; dashed: boolean }[] = [];

  constructor(device: string, columns: number, rows: number, x: DrawnAxis, y: DrawnAxis, describedBy: string, reaction: Reaction) {
    [this.columns, this.rows, this.x, this.y] = [columns, rows, x, y];
    this.hasCells = rows > 1;
    this.plot = this.plotOf(320);
    [this.canvas.width, this.canvas.height] = [columns, rows];
    this.lines.setAttribute("aria-hidden", "true");
    this.marks.setAttribute("aria-hidden", "true");
    this.plotArea = el(
      "div",
      { className: "map-plot", tabIndex: 0, role: "application", ariaLabel: texts.views.map.panel(device) },
      this.canvas,
      this.lines,
      this.marks,
    );
    this.plotArea.setAttribute("aria-describedby", describedBy);
    const caption = el("figcaption", {}, el("strong", { textContent: device }), this.share);
    this.root = el("figure", { className: "map-panel" }, caption, this.plotArea);
    this.listen(reaction);
    new ResizeObserver(() => this.layOut()).observe(this.plotArea);
  }

  /** Says how much of the cells overturn. */
  setShare(text: string): void {
    if (this.share.textContent !== text) {
      this.share.textContent = text;
    }
  }

  /** Shows `image`, whose lowest row is that of the largest y. */
  paint(image: ImageData): void {
    this.canvas.getContext("2d")?.putImageData(image, 0, 0);
  }

  /** Draws `over` above the cells. */
  setOver(over: (plot: Plot) => string): void {
    this.over = over;
    this.drawLines();
  }

  /** Rings around places from 0 to 1. */
  setRings(rings: { across: number; up: number; dashed: boolean }[]): void {
    this.rings = rings;
    this.drawMarks();
  }

  /** Where cells or curves are in a picture of this width. */
  plotOf(width: number): Plot {
    return plotOf(width, this.hasCells ? "cells" : "curves");
  }

  /** Axes and what is above the cells, in `plot`. */
  svg(plot: Plot): string {
    return axesSvg(plot, this.x, this.y) + insideSvg(plot, this.over(plot));
  }

  private layOut(): void {
    const width = Math.floor(this.plotArea.clientWidth);
    if (width < 60) {
      return;
    }
    this.plot = this.plotOf(width);
    const { left, top, width: across, height } = this.plot;
    this.plotArea.style.height = `${heightOf(this.plot)}px`;
    this.canvas.style.cssText = `left:${left}px;top:${top}px;width:${across}px;height:${height}px`;
    this.drawLines();
    this.drawMarks();
  }

  private drawLines(): void {
    this.lines.innerHTML = this.svg(this.plot);
  }

  private drawMarks(): void {
    this.marks.innerHTML = this.rings.map(({ across, up, dashed }) => ringSvg(this.plot, across, up, dashed)).join("");
  }

  private listen(reaction: Reaction): void {
    const at = (event: PointerEvent): Place | null => {
      const box = this.canvas.getBoundingClientRect();
      const [across, up] = [(event.clientX - box.left) / box.width, (box.bottom - event.clientY) / box.height];
      const inside = across >= 0 && across < 1 && up >= 0 && up < 1;
      return inside ? { column: Math.floor(across * this.columns), row: Math.floor(up * this.rows) } : null;
    };
    const point = (event: PointerEvent): void => {
      const place = at(event);
      if (place !== null) {
        reaction.point(place);
      }
    };
    this.plotArea.addEventListener("pointermove", point);
    this.plotArea.addEventListener("pointerdown", point);
    this.plotArea.addEventListener("click", (event) => {
      // A finger has no other way to look before it takes; the button below is for it.
      if (event instanceof PointerEvent && event.pointerType !== "touch" && at(event) !== null) {
        reaction.take();
      }
    });
    this.plotArea.addEventListener("keydown", (event) => this.key(event, reaction));
  }

  private key(event: KeyboardEvent, reaction: Reaction): void {
    const size = event.shiftKey ? STRIDE : 1;
    const steps: Record<string, [number, number]> = {
      ArrowLeft: [-size, 0],
      ArrowRight: [size, 0],
      ArrowDown: [0, -size],
      ArrowUp: [0, size],
    };
    const step = steps[event.key];
    if (step !== undefined) {
      const from = reaction.cursor() ?? { column: this.columns >> 1, row: this.rows >> 1 };
      const within = (value: number, count: number): number => Math.min(Math.max(value, 0), count - 1);
      reaction.point({ column: within(from.column + step[0], this.columns), row: within(from.row + step[1], this.rows) });
    } else if (event.key === "Enter") {
      reaction.take();
    } else if (event.key === "Escape") {
      reaction.back();
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  }
}
