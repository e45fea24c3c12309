/** Histories of a closed loop: truth and estimates, and lanes. */
import type uPlot from "uplot";
import type { About, Loop } from "../engine";
import { el } from "../dom";
import { texts } from "../texts";
import { onTheme } from "../theme";
import { type Curve, type Frame, chartIn } from "./chart";
import { laneKey, laneNames, lanePainter } from "./lanes";
import { curvesOf, largest } from "./series";

const words = texts.views.loop;

/** Estimates beyond this many times the largest true value are cut off. */
const ESTIMATE_REACH = 1.5;
const CHART_PX = 200;
const LANES_PX = 150;
const ESTIMATED = "#d55e00";
const IDEAL = "#0072b2";

/** The charts. */
export class LoopCharts {
  readonly root = el("div", { role: "group", ariaLabel: words.charts });
  private charts: uPlot[] = [];
  private readonly pointed: (seconds: number) => void;

  /** `pointed` gets the time that the user points at. */
  constructor(pointed: (seconds: number) => void) {
    this.pointed = pointed;
    onTheme(() => this.charts.forEach((chart) => chart.redraw(false)));
  }

  /** Shows `loop` of a scene, with marks at the times of faults. */
  show(loop: Loop, about: About, faults: readonly number[]): void {
    const curves = curvesOf(loop, about);
    this.charts.forEach((chart) => chart.destroy());
    // What is below stays where it is meanwhile.
    this.root.style.minHeight = `${this.root.offsetHeight}px`;
    this.root.replaceChildren();
    const chart = (label: string, drawn: Curve[], own: Pick<Frame, "heightPx" | "vertical"> & Partial<Frame>): void => {
      const place = el("div", { role: "img", ariaLabel: label });
      this.root.append(el("figure", { className: "loop-chart" }, el("figcaption", { textContent: label }), place));
      this.charts.push(chartIn(place, curves.time, drawn, { faults, pointed: this.pointed, ...own }));
    };
    this.charts = [];
    const [rotation, rotationEstimated, rotationIdeal] = curves.rotation;
    chart(words.rotation, [estimated(rotationEstimated), truth(rotation), ideal(rotationIdeal)], {
      heightPx: CHART_PX,
      vertical: 1.1 * Math.max(largest(rotation), Math.min(largest(rotationIdeal), 2), 0.1),
    });
    for (const [label, [own, estimate]] of [
      [words.velocity, curves.velocity],
      [words.push, curves.push],
    ] as const) {
      const reach = Math.min(largest(estimate), ESTIMATE_REACH * largest(own));
      chart(label, [estimated(estimate), truth(own)], { heightPx: CHART_PX, vertical: 1.1 * Math.max(largest(own), reach, 0.1) });
    }
    chart(words.lanes, [], { heightPx: LANES_PX, vertical: laneNames(), below: lanePainter(loop) });
    this.root.append(laneKey());
    this.root.style.minHeight = "";
  }

  /** Puts the cursor at `seconds`, unless the user points at a chart. */
  setTime(seconds: number): void {
    if (!this.root.matches(":hover")) {
      this.charts.forEach((chart) => chart.setCursor({ left: chart.valToPos(seconds, "x"), top: 10 }));
    }
  }
}

function truth(values: Float64Array): Curve {
  return { name: words.true, values, colour: "", width: 1.2 };
}

/** Wider than the true motion on top of it, so that both show where they agree. */
function estimated(values: Float64Array): Curve {
  return { name: words.estimated, values, colour: ESTIMATED, width: 2.4 };
}

function ideal(values: Float64Array): Curve {
  return { name: words.idealPair, values, colour: IDEAL, width: 1.2, dashes: [6, 3] };
}
