/** One chart over time: curves, tints behind them, ticks of impacts, and a line at the cursor. */
import uPlot from "uplot";
import { surface } from "../colours";
import { el } from "../dom";
import { align, type Samples } from "./align";

/** A curve of a chart. */
export interface Curve extends Samples {
  colour: string;
  dashes: number[];
  /** Drawn above the others. */
  strong: boolean;
}

/** What is drawn besides curves. */
export interface Marks {
  tints: { colour: string; spans: [from: number, to: number][] }[];
  ticksS: Float64Array;
  guides: number[];
}

/** A chart that stands in the page. */
export interface Chart {
  root: HTMLElement;
  show(curves: Curve[], marks: Marks, endS: number): void;
  cursor(time: number): void;
  resize(): void;
}

const HEIGHT_PX = 150;
const LEFT_PX = 56;

/** A chart with a title; `moved` is called with the time where the pointer is. */
export function chart(title: string, description: string, timeLabel: string | null, moved: (time: number) => void): Chart {
  const place = el("div", { className: "plot", role: "img" });
  place.setAttribute("aria-label", description);
  const root = el("div", { className: "chart" }, el("h3", { textContent: title }), place);
  const line = el("div", { className: "cursor" });
  let plot: uPlot | null = null;
  let look = "";
  let marks: Marks = { tints: [], ticksS: new Float64Array(), guides: [] };
  let endS = 1;
  let time = 0;

  const cursor = (seconds: number) => {
    time = seconds;
    if (plot) {
      line.style.transform = `translateX(${(plot.bbox.width / uPlot.pxRatio) * Math.min(time / endS, 1)}px)`;
    }
  };
  const height = () => HEIGHT_PX + (timeLabel === null ? 0 : 18);
  const resize = () => {
    const width = place.clientWidth;
    if (plot && width > 0 && plot.width !== width) {
      plot.setSize({ width, height: height() });
      cursor(time);
    }
  };
  const build = (curves: Curve[], data: uPlot.AlignedData) => {
    plot?.destroy();
    plot = new uPlot(
      options(
        curves,
        () => marks,
        () => endS,
        timeLabel,
        Math.max(place.clientWidth, 200),
        height(),
      ),
      data,
      place,
    );
    plot.over.append(line);
    follow(plot, moved);
  };
  const show = (curves: Curve[], newMarks: Marks, newEndS: number) => {
    marks = newMarks;
    endS = Math.max(newEndS, 1e-6);
    const data = align(curves);
    // Colours and dashes belong to the plot; everything else is data.
    const newLook = JSON.stringify([surface().ink, curves.map(({ colour, dashes, strong }) => [colour, dashes, strong])]);
    if (plot === null || newLook !== look) {
      look = newLook;
      build(curves, data);
    } else {
      plot.setData(data);
    }
    cursor(time);
  };
  return { root, show, cursor, resize };
}

function follow(plot: uPlot, moved: (time: number) => void): void {
  const { over } = plot;
  const at = (event: PointerEvent) => moved(plot.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
  over.addEventListener("pointerdown", (event) => {
    if (event.button === 0) {
      over.setPointerCapture(event.pointerId);
      at(event);
    }
  });
  over.addEventListener("pointermove", (event) => {
    if (over.hasPointerCapture(event.pointerId)) {
      at(event);
    }
  });
}

function options(
  curves: Curve[],
  marks: () => Marks,
  endS: () => number,
  timeLabel: string | null,
  width: number,
  height: number,
): uPlot.Options {
  const { ink, muted, guide } = surface();
  const axis: uPlot.Axis = {
    stroke: muted,
    font: "12px system-ui, sans-serif",
    labelFont: "12px system-ui, sans-serif",
    grid: { stroke: guide, width: 0.5 },
    ticks: { stroke: guide, width: 0.5, size: 4 },
  };
  return {
    width,
    height,
    padding: [6, 8, 0, 0],
    legend: { show: false },
    cursor: { show: false },
    scales: { x: { time: false, range: () => [0, endS()] }, y: { range: (_, low, high) => valueRange(low, high, marks().guides) } },
    axes: [
      {
        ...axis,
        size: timeLabel === null ? 22 : 40,
        labelSize: 18,
        labelGap: 0,
        gap: 3,
        ...(timeLabel === null ? {} : { label: timeLabel }),
      },
      { ...axis, size: LEFT_PX, gap: 4, space: 28 },
    ],
    series: [
      {},
      ...curves.map(({ colour, dashes, strong }) => ({
        stroke: colour,
        width: strong ? 2 : 1.3,
        dash: dashes,
        spanGaps: true,
        points: { show: false },
      })),
    ],
    hooks: {
      drawClear: [(plot) => drawTints(plot, marks())],
      draw: [(plot) => drawMarks(plot, marks(), ink, muted)],
    },
  };
}

/** Range of the values, with some air; guides that are far outside do not stretch it. */
function valueRange(low: number | null, high: number | null, guides: number[]): [number, number] {
  let [from, to] = [low ?? 0, high ?? 0];
  for (const guide of guides) {
    if (guide <= 1.6 * Math.max(to, -from) && guide >= -1.6 * Math.max(to, -from)) {
      from = Math.min(from, guide);
      to = Math.max(to, guide);
    }
  }
  const air = 0.06 * (to - from) || 0.05;
  return [from - air, to + air];
}

function drawTints(plot: uPlot, { tints }: Marks): void {
  const { ctx, bbox } = plot;
  for (const { colour, spans } of tints) {
    ctx.fillStyle = colour;
    for (const [from, to] of spans) {
      const x0 = plot.valToPos(from, "x", true);
      ctx.fillRect(x0, bbox.top, Math.max(plot.valToPos(to, "x", true) - x0, 0.5), bbox.height);
    }
  }
}

function drawMarks(plot: uPlot, { ticksS, guides }: Marks, ink: string, muted: string): void {
  const { ctx, bbox } = plot;
  const ratio = uPlot.pxRatio;
  ctx.save();
  ctx.strokeStyle = muted;
  ctx.lineWidth = ratio * 0.8;
  ctx.setLineDash([4 * ratio, 3 * ratio]);
  for (const guide of guides) {
    const y = plot.valToPos(guide, "y", true);
    if (y >= bbox.top && y <= bbox.top + bbox.height) {
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
    }
  }
  ctx.setLineDash([]);
  ctx.strokeStyle = ink;
  ctx.lineWidth = ratio;
  ctx.beginPath();
  for (const time of ticksS) {
    const x = plot.valToPos(time, "x", true);
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + 6 * ratio);
  }
  ctx.stroke();
  ctx.restore();
}
