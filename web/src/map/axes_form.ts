/** Which quantities the map is drawn over. */
import type { Axis, Key } from "../engine";
import { choice, el } from "../dom";
import { numberBox, setChoices, showNumber } from "../number_box";
import { texts } from "../texts";
import { MOST_CELLS, isAxis, suggested } from "./axis";
import { keyName } from "./key_name";

/** Both axes; no `y` in a cut. */
export interface Axes {
  x: Axis;
  y: Axis | null;
}

const words = texts.views.map;

/** Controls of both axes. */
export class AxesForm {
  readonly root: HTMLElement;
  private axes: Axes | null = null;
  private keys: readonly Key[] = [];
  private readonly fields: { x: Fields; y: Fields };

  /** `chosen` gets axes that a scene can have, `refused` a line about others. */
  constructor(chosen: (axes: Axes) => void, refused: (line: string) => void) {
    const change = (which: "x" | "y", axis: Axis | null): void => {
      if (this.axes === null || (axis === null && which === "x")) {
        return;
      }
      const axes: Axes = which === "y" ? { ...this.axes, y: axis } : { ...this.axes, x: axis ?? this.axes.x };
      if (axis !== null && !isAxis(axis)) {
        refused(words.wrongAxis);
        return;
      }
      // The next change may come before the scene has this one.
      this.show(axes, this.keys);
      chosen(axes);
    };
    const key = (name: string): Axis | null => {
      const found = this.keys.find((other) => other.key === name);
      return found === undefined ? null : suggested(found);
    };
    this.fields = { x: new Fields("x", key, (axis) => change("x", axis)), y: new Fields("y", key, (axis) => change("y", axis)) };
    this.root = el("div", { className: "map-axes" }, this.fields.x.root, this.fields.y.root);
  }

  /** The axes that are shown; null where the scene cannot have any. */
  get shown(): Axes | null {
    return this.axes;
  }

  /** Shows `axes` of a scene with these keys. */
  show(axes: Axes | null, keys: readonly Key[]): void {
    [this.axes, this.keys] = [axes, keys];
    this.root.hidden = axes === null;
    if (axes !== null) {
      this.fields.x.show(axes.x, keys, axes.y?.key ?? null);
      this.fields.y.show(axes.y, keys, axes.x.key);
    }
  }
}

/** Controls of one axis. */
class Fields {
  readonly root: HTMLFieldSetElement;
  private axis: Axis | null = null;
  private readonly key: HTMLSelectElement;
  private readonly from: HTMLInputElement;
  private readonly to: HTMLInputElement;
  private readonly cells: HTMLInputElement;
  private readonly scale: HTMLSelectElement;
  private readonly optional: boolean;

  constructor(which: "x" | "y", suggest: (key: string) => Axis | null, changed: (axis: Axis | null) => void) {
    this.optional = which === "y";
    const change = (part: Partial<Axis>): void => {
      if (this.axis !== null) {
        // What is refused stays in its box, and goes with the next change.
        this.axis = { ...this.axis, ...part };
        changed(this.axis);
      }
    };
    const key = choice(words.key, [], (name) => changed(suggest(name)));
    const from = numberBox(words.from, {}, (value) => change({ from: value }));
    const to = numberBox(words.to, {}, (value) => change({ to: value }));
    const cells = numberBox(words.cells, { min: 2, max: MOST_CELLS, whole: true }, (value) => change({ cells: value }));
    const scale = choice(words.scale, Object.entries(words.scales), (name) => change({ scale: name === "logarithmic" ? name : "linear" }));
    [this.key, this.scale, this.from, this.to, this.cells] = [key.select, scale.select, from.input, to.input, cells.input];
    const legend = el("legend", { textContent: words.axis[which] });
    this.root = el("fieldset", {}, legend, key.root, from.root, to.root, cells.root, scale.root);
  }

  show(axis: Axis | null, keys: readonly Key[], other: string | null): void {
    this.axis = axis;
    const offered = keys.filter((key) => key.key === axis?.key || (key.value !== null && key.key !== other));
    const choices = offered.map((key) => [key.key, keyName(key.key, keys)] as const);
    setChoices(this.key, this.optional ? [["", words.cut], ...choices] : choices);
    this.key.value = axis?.key ?? "";
    for (const control of [this.from, this.to, this.cells, this.scale]) {
      control.disabled = axis === null;
    }
    if (axis !== null) {
      showNumber(this.from, String(axis.from));
      showNumber(this.to, String(axis.to));
      showNumber(this.cells, String(axis.cells));
      this.scale.value = axis.scale;
    }
  }
}
