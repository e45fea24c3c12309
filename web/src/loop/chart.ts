/** A chart over the time of a loop: all of them share cursor and zoom. */
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { texts } from "../texts";

/** A curve: its name, values, colour, width and dashes. */
export interface Curve {
  name: string;
  values: Float64Array;
  /** A colour; empty for that of the text. */
  colour: string;
  width: number;
  dashes?: number[];
}

/** What a chart shows besides its curves. */
export interface Frame {
  heightPx: number;
  /** Half the height of the vertical axis around 0, or the names of lanes one above the other. */
  vertical: number | readonly string[];
  /** Draws below the curves. */
  below?: (chart: uPlot) => void;
  /** Times of faults. */
  faults: readonly number[];
  /** The user's cursor is at this time. */
  pointed: (seconds: number) => void;
}

/** Cursor and zoom of all charts of loops. */
const TOGETHER = "loop";
/** Room for numbers and names of lanes (px). */
const LEFT_PX = 76;
const FAULT_COLOUR = "#c0307f";

/** A chart in `root`. */
export function chartIn(root: HTMLElement, time: Float64Array, curves: readonly Curve[], frame: Frame): uPlot {
  const ink = (): string => getComputedStyle(root).color;
  const faint = (): string => "rgb(128 128 128 / 0.25)";
  const { vertical } = frame;
  const lanes = typeof vertical === "number" ? null : vertical;
  const range: [number, number] = typeof vertical === "number" ? [-vertical, vertical] : [0, vertical.length];
  const middles = lanes?.map((_, index) => index + 0.5) ?? [];
  const options: uPlot.Options = {
    width: Math.max(root.clientWidth, 200),
    height: frame.heightPx,
    scales: { x: { time: false }, y: { range: () => range } },
    cursor: { sync: { key: TOGETHER, scales: ["x", null] }, y: false, drag: { x: true, y: false } },
    legend: { show: lanes === null },
    axes: [
      {
        stroke: ink,
        grid: { stroke: faint },
        ticks: { stroke: faint },
        size: 30,
        ...(lanes === null ? {} : { label: texts.views.loop.time, labelSize: 18, labelFont: "12px system-ui" }),
      },
      {
        stroke: ink,
        grid: { stroke: faint, show: lanes === null },
        ticks: { stroke: faint, show: lanes === null },
        size: LEFT_PX,
        ...(lanes === null ? {} : { splits: () => middles, values: () => [...lanes] }),
      },
    ],
    series: [
      { label: texts.views.loop.time, value: (_, value) => (value === null ? "" : value.toFixed(3)) },
      ...curves.map(({ name, colour, width, dashes }) => ({
        label: name,
        stroke: () => (colour === "" ? ink() : colour),
        width,
        ...(dashes === undefined ? {} : { dash: dashes }),
        value: (_: uPlot, value: number | null) => (value === null ? "" : value.toFixed(4).replace(/^-(?=[0.]+$)/, "")),
        points: { show: false },
      })),
    ],
    hooks: {
      ...(frame.below === undefined ? {} : { drawClear: [frame.below] }),
      draw: [(chart) => drawFaults(chart, frame.faults)],
      setCursor: [
        (chart) => {
          const index = chart.cursor.idx;
          if (index != null && chart.over.matches(":hover")) {
            frame.pointed(time[index] ?? 0);
          }
        },
      ],
    },
  };
  // Curves that are not there (before and after the ideal pair's) are gaps.
  const data = curves.map(({ values }) => Array.from(values, (value) => (Number.isFinite(value) ? value : null)));
  const chart = new uPlot(options, [time, ...(lanes === null ? data : [new Array<null>(time.length).fill(null)])], root);
  new ResizeObserver(() => {
    const width = Math.floor(root.clientWidth);
    if (width > 0 && width !== chart.width) {
      chart.setSize({ width, height: frame.heightPx });
    }
  }).observe(root);
  return chart;
}

function drawFaults(chart: uPlot, faults: readonly number[]): void {
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.strokeStyle = FAULT_COLOUR;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([4 * devicePixelRatio, 2 * devicePixelRatio]);
  for (const time of faults) {
    const x = chart.valToPos(time, "x", true);
    if (x >= bbox.left && x <= bbox.left + bbox.width) {
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
    }
  }
  ctx.restore();
}
