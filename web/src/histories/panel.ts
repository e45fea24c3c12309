/** The histories of the run: ground, rotation, velocity and force, linked with the animation by the cursor. */
import { tableOf } from "../block/geometry";
import { drawSoon } from "../clock";
import { deviceLook, flywheelTint, surface } from "../colours";
import { el, say } from "../dom";
import type { Response, Run } from "../engine";
import { longest, overturns } from "../response";
import type { Store } from "../store";
import { texts } from "../texts";
import { onTheme } from "../theme";
import { spans, type Samples } from "./align";
import { chart, type Chart, type Curve, type Marks } from "./chart";

const G = 9.80665;
/** Rotation θ/α up to which an overturning block is drawn. */
const LOST = 1.25;
const NONE: Marks = { tints: [], ticksS: new Float64Array(), guides: [0] };

/** The section of the histories. */
export function historyPanel(store: Store): HTMLElement {
  const words = texts.page.histories;
  const moved = (time: number) => {
    store.playing = false;
    store.time = time;
  };
  const make = (title: string, label: string | null = null) => chart(title, words.chart(title), label, moved);
  const charts = [make(words.ground), make(words.rotation), make(words.velocity), make(words.force, words.time)] as const;
  const key = el("ul", { className: "key" });
  const legend = el("p", { className: "hint" });
  const hint = el("p", { className: "hint" });
  const root = el(
    "section",
    { className: "card histories", id: "histories" },
    el("h2", { textContent: words.heading }),
    key,
    legend,
    el("div", { className: "charts" }, ...charts.map((one) => one.root)),
    hint,
  );
  const show = () => {
    if (store.run) {
      showRun(charts, store.run, store.selected, store.durationS);
      key.replaceChildren(...store.run.responses.map((response, index) => keyOf(response, index)));
      say(hint, words.hint(tableOf(tableOf(store.run.about.resolved)["block"])["geometry"] === "slender"));
      say(legend, words.legend(store.run.responses[store.selected]?.device ?? ""));
    }
  };
  const cursor = () => charts.forEach((one) => one.cursor(store.time));
  for (const topic of ["run", "selected"] as const) {
    store.subscribe(topic, () => drawSoon(show));
  }
  onTheme(() => drawSoon(show));
  store.subscribe("time", () => drawSoon(cursor));
  new ResizeObserver(() => charts.forEach((one) => one.resize())).observe(root);
  return root;
}

function showRun(charts: readonly [Chart, Chart, Chart, Chart], run: Run, selected: number, endS: number): void {
  const { responses, about } = run;
  const chosen = responses[selected] ?? responses[0];
  if (!chosen) {
    return;
  }
  const alpha = about.slendernessRad;
  const speed = about.frequencyParameter1S * alpha;
  const count = shownSamples(chosen, alpha);
  const marks: Marks = {
    tints: ([1, 2] as const).map((flywheel) => ({
      colour: flywheelTint(flywheel),
      // An inerter is engaged all the time; a tint would say nothing.
      spans:
        about.devices[selected]?.kind === "clutched-pair"
          ? spans(chosen.timeS.subarray(0, count), chosen.engaged.subarray(0, count), flywheel)
          : [],
    })),
    ticksS: chosen.impactsS,
    guides: [0],
  };
  const curves = (values: (response: Response) => Float64Array) =>
    responses.map((response, index) => {
      const count = shownSamples(response, alpha);
      return curve(response.timeS.subarray(0, count), values(response).subarray(0, count), index, index === selected);
    });
  const shaken = longest(responses) ?? chosen;
  const ground: Curve = {
    ...samples(shaken.timeS, scaled(shaken.groundMS2, 1 / G)),
    colour: surface().ground,
    dashes: [],
    strong: false,
  };
  const [groundChart, rotationChart, velocityChart, forceChart] = charts;
  const threshold = about.upliftThresholdG;
  groundChart.show([ground], { ...NONE, guides: [0, threshold, -threshold] }, endS);
  rotationChart.show(
    curves(({ rotationRad }) => scaled(rotationRad, 1 / alpha)),
    { ...marks, guides: [0, 1, -1] },
    endS,
  );
  velocityChart.show(
    curves(({ velocityRadS }) => scaled(velocityRadS, 1 / speed)),
    { ...marks, ticksS: NONE.ticksS },
    endS,
  );
  forceChart.show(curves(force), { ...marks, ticksS: NONE.ticksS }, endS);
}

/** How many samples are drawn: the fall of a block that is lost would make everything else small. */
function shownSamples(response: Response, alpha: number): number {
  const { rotationRad } = response;
  if (!overturns(response)) {
    return rotationRad.length;
  }
  return Math.min(rotationRad.findLastIndex((rotation) => Math.abs(rotation) < LOST * alpha) + 2, rotationRad.length);
}

/** Both flywheels' force; one at most is engaged. */
function force({ firstForceRatio, secondForceRatio }: Response): Float64Array {
  return firstForceRatio.map((first, i) => first + (secondForceRatio[i] ?? 0));
}

function scaled(values: Float64Array, factor: number): Float64Array {
  return values.map((value) => value * factor);
}

function samples(timeS: Float64Array, values: Float64Array): Samples {
  return { timeS, values };
}

function curve(timeS: Float64Array, values: Float64Array, index: number, strong: boolean): Curve {
  const { colour, dashes } = deviceLook(index);
  return { timeS, values, colour, dashes, strong };
}

/** A device in the key: its line and its name. */
function keyOf(response: Response, index: number): HTMLElement {
  const { colour, dashes } = deviceLook(index);
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
  for (const [name, value] of Object.entries({ x1: "0", x2: "34", y1: "6", y2: "6", stroke: colour, "stroke-width": "2" })) {
    line.setAttribute(name, value);
  }
  line.setAttribute("stroke-dasharray", dashes.join(" "));
  svg.setAttribute("width", "34");
  svg.setAttribute("height", "12");
  svg.setAttribute("aria-hidden", "true");
  svg.append(line);
  return el("li", {}, svg, el("span", { textContent: response.device }));
}
