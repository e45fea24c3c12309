/** Law, estimator, sensors, delay: the controller of a scene. */
import { choice, el } from "../dom";
import { numberBox, showNumber } from "../number_box";
import { texts } from "../texts";

const words = texts.views.loop;

/** What a button gives a scene that has no controller: that of scenes/controller.toml. */
export const FIRST_CONTROLLER = [
  "controller.rate_hz=2000",
  'controller.estimator="model-aided"',
  'controller.law="resisting-predicted"',
  "controller.latency_s=0.001",
  'controller.sensors.suite="adis16470"',
  "controller.sensors.seed=1",
];

/** Controls of `[controller]`. */
export class ControllerForm {
  readonly root: HTMLFieldSetElement;
  private readonly law: HTMLSelectElement;
  private readonly estimator: HTMLSelectElement;
  private readonly suite: HTMLSelectElement;
  private readonly latency: HTMLInputElement;
  private readonly rate: HTMLInputElement;
  private readonly seed: HTMLInputElement;

  /** `set` gets a setting `KEY=VALUE`. */
  constructor(set: (setting: string) => void) {
    const list = (label: string, names: Record<string, string>, key: string) =>
      choice(label, Object.entries(names), (value) => set(`controller.${key}="${value}"`));
    const law = list(words.law, words.laws, "law");
    const estimator = list(words.estimator, words.estimators, "estimator");
    const suite = list(words.suite, words.suites, "sensors.suite");
    const latency = numberBox(words.latency, {}, (milliseconds) => set(`controller.latency_s=${milliseconds / 1000}`));
    const rate = numberBox(words.rate, {}, (hertz) => set(`controller.rate_hz=${hertz}`));
    const seed = numberBox(words.seed, { whole: true }, (number) => set(`controller.sensors.seed=${number}`));
    [this.law, this.estimator, this.suite] = [law.select, estimator.select, suite.select];
    [this.latency, this.rate, this.seed] = [latency.input, rate.input, seed.input];
    const fields = [law, estimator, suite, latency, rate, seed].map((one) => one.root);
    this.root = el("fieldset", {}, el("legend", { textContent: words.settings }), ...fields);
  }

  /** Shows the values of a resolved scene. */
  show(resolved: unknown): void {
    const controller = part(resolved, "controller");
    const sensors = part(controller, "sensors");
    showChoice(this.law, part(controller, "law"));
    showChoice(this.estimator, part(controller, "estimator"));
    showChoice(this.suite, part(sensors, "suite"));
    const number = (value: unknown, scale: number): string =>
      typeof value === "number" ? String(Number((scale * value).toPrecision(12))) : "";
    showNumber(this.latency, number(part(controller, "latency_s"), 1000));
    showNumber(this.rate, number(part(controller, "rate_hz"), 1));
    // Every digit of a seed counts.
    showNumber(this.seed, String(part(sensors, "seed") ?? ""));
  }
}

/** A value that the list does not have (sensors one by one) is the scene's own. */
function showChoice(list: HTMLSelectElement, value: unknown): void {
  list.querySelector('option[value=""]')?.remove();
  if (![...list.options].some((option) => option.value === value)) {
    list.prepend(el("option", { textContent: words.unset, value: "", disabled: true }));
  }
  list.value = typeof value === "string" ? value : "";
}

function part(table: unknown, key: string): unknown {
  return typeof table === "object" && table !== null ? (table as Record<string, unknown>)[key] : undefined;
}
