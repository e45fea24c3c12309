/** What the law wants of the true motion, the command, the clutches and the supervisor's state, as bars over time. */
import type uPlot from "uplot";
import { flywheelBar } from "../colours";
import type { Loop } from "../engine";
import { el } from "../dom";
import { legendItem } from "../map/legend";
import { texts } from "../texts";
import { type Stretch, stretches } from "../stretches";

const words = texts.views.loop;

const GROUND = "#777777";
/** First and second flywheel, as in the pictures of `sprag loop`. */
const WHEELS = [flywheelBar(1), flywheelBar(2)] as const;
const FAULT = "#960050";
/** Other states of the supervisor, in turn. */
const STATES = ["#5a6b7a", "#7d8c99", "#94a3ae", "#4f7f6a"] as const;

interface Lane {
  stretches: Stretch[];
  /** Colours of the bars from top to bottom; none where there is no bar. */
  colours: (value: number) => string[];
  text: (value: number) => string;
}

/** Draws the lanes of `loop`, the first on top, into a chart whose vertical axis counts them. */
export function lanePainter(loop: Loop): (chart: uPlot) => void {
  const wheels = (value: number): string[] => WHEELS.filter((_, index) => (value >> index) & 1);
  const none = (): string => "";
  const state = (value: number): string => loop.states[value] ?? "";
  const isFault = (value: number): boolean => state(value).toLowerCase() === "fault";
  const lanes: Lane[] = [
    { stretches: stretches(loop.timeS, loop.ideal), colours: (value) => (value === 1 ? [GROUND] : []), text: none },
    { stretches: stretches(loop.timeS, loop.command), colours: wheels, text: none },
    { stretches: stretches(loop.timeS, loop.engaged), colours: wheels, text: none },
    {
      stretches: stretches(loop.timeS, loop.state),
      colours: (value) => [isFault(value) ? FAULT : (STATES[value % STATES.length] ?? GROUND)],
      text: state,
    },
  ];
  return (chart) => lanes.forEach((lane, index) => drawLane(chart, lane, lanes.length - 1 - index));
}

/** Names of the lanes from the lowest. */
export function laneNames(): string[] {
  return [...words.laneNames].reverse();
}

/** What the colours mean. */
export function laneKey(): HTMLElement {
  const entries = [
    [GROUND, words.wanted],
    [WHEELS[0], words.wheels[1] ?? ""],
    [WHEELS[1], words.wheels[2] ?? ""],
    [FAULT, words.fault],
  ] as const;
  return el("ul", { className: "key" }, ...entries.map(([colour, name]) => legendItem({ name, colour })));
}

function drawLane(chart: uPlot, lane: Lane, from: number): void {
  const { ctx, bbox } = chart;
  const [bottom, top] = [chart.valToPos(from + 0.12, "y", true), chart.valToPos(from + 0.88, "y", true)];
  const within = (time: number): number => Math.min(Math.max(chart.valToPos(time, "x", true), bbox.left), bbox.left + bbox.width);
  ctx.save();
  ctx.font = `${11 * devicePixelRatio}px system-ui`;
  ctx.textBaseline = "middle";
  for (const stretch of lane.stretches) {
    const [left, right] = [within(stretch.from), within(stretch.to)];
    if (right <= left) {
      continue;
    }
    const colours = lane.colours(stretch.value);
    colours.forEach((colour, index) => {
      const height = (bottom - top) / colours.length;
      ctx.fillStyle = colour;
      ctx.fillRect(left, top + index * height, Math.max(right - left, 1), height);
    });
    const text = lane.text(stretch.value);
    if (text !== "" && ctx.measureText(text).width + 8 < right - left) {
      ctx.fillStyle = "#ffffff";
      ctx.fillText(text, left + 4, (top + bottom) / 2);
    }
  }
  ctx.restore();
}
