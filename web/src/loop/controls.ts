/** Law, estimator, sensors, delay: the controller of a scene. */
import { element, labelled, numberInput, select } from "../elements";
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
    const choose = (names: Record<string, string>, key: string): HTMLSelectElement =>
      select(Object.entries(names), (value) => set(`controller.${key}="${value}"`));
    this.law = choose(words.laws, "law");
    this.estimator = choose(words.estimators, "estimator");
    this.suite = choose(words.suites, "sensors.suite");
    this.latency = numberInput({ min: "0", max: "100", step: "any" }, (milliseconds) => set(`controller.latency_s=${milliseconds / 1000}`));
    this.rate = numberInput({ min: "100", max: "100000" }, (rate) => set(`controller.rate_hz=${rate}`));
    this.seed = numberInput({ min: "0", step: "1" }, (seed) => set(`controller.sensors.seed=${seed}`));
    const controls = [
      labelled(words.law, this.law),
      labelled(words.estimator, this.estimator),
      labelled(words.suite, this.suite),
      labelled(words.latency, this.latency),
      labelled(words.rate, this.rate),
      labelled(words.seed, this.seed),
    ];
    this.root = element("fieldset", { children: [element("legend", { text: words.title }), ...controls] });
  }

  /** Shows the values of a resolved scene. */
  show(resolved: unknown): void {
    const controller = part(resolved, "controller");
    const sensors = part(controller, "sensors");
    choose(this.law, part(controller, "law"));
    choose(this.estimator, part(controller, "estimator"));
    choose(this.suite, part(sensors, "suite"));
    const number = (value: unknown, scale: number): string =>
      typeof value === "number" ? String(Number((scale * value).toPrecision(12))) : "";
    this.latency.value = number(part(controller, "latency_s"), 1000);
    this.rate.value = number(part(controller, "rate_hz"), 1);
    this.seed.value = number(part(sensors, "seed"), 1);
  }
}

/** A value that the list does not have (sensors one by one) is the scene's own. */
function choose(list: HTMLSelectElement, value: unknown): void {
  list.querySelector('option[value=""]')?.remove();
  if (![...list.options].some((option) => option.value === value)) {
    list.prepend(element("option", { text: words.unset, at: { value: "", disabled: "" } }));
  }
  list.value = typeof value === "string" ? value : "";
}

function part(table: unknown, key: string): unknown {
  return typeof table === "object" && table !== null ? (table as Record<string, unknown>)[key] : undefined;
}
