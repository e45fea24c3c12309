/** A number that is set by a slider or typed, with one label. */
import { el } from "../dom";
import { keepTyped, showNumber } from "../number_box";

/** What a number may be. The slider has the usual range; what is typed may lie outside of it, and the core says where that is wrong. */
export interface Range {
  label: string;
  from: number;
  to: number;
  step: number;
}

/** A slider and a number, which show one value. */
export interface NumberField {
  root: HTMLElement;
  /** Shows a value, but where the user is typing; null leaves both empty. */
  show(value: number | null): void;
}

let count = 0;

/** A field; `changed` is called with every value of the slider, and with typed ones once they are a number. */
export function numberField({ label, from, to, step }: Range, changed: (value: number) => void): NumberField {
  const id = `field-${++count}`;
  const slider = el("input", { type: "range", min: String(from), max: String(to), step: String(step) });
  const typed = el("input", { type: "number", step: "any", id });
  const name = el("label", { htmlFor: id, textContent: label });
  slider.setAttribute("aria-label", label);
  keepTyped(typed);
  slider.addEventListener("input", () => {
    typed.value = slider.value;
    changed(Number(slider.value));
  });
  typed.addEventListener("change", () => {
    if (typed.value.trim() !== "" && Number.isFinite(Number(typed.value))) {
      slider.value = typed.value;
      changed(Number(typed.value));
    }
  });
  const show = (value: number | null) => {
    if (document.activeElement === typed && typed.value !== "" && value !== null && Number(typed.value) === value) {
      return;
    }
    const text = value === null ? "" : String(Number(value.toPrecision(5)));
    showNumber(typed, text);
    if (document.activeElement !== slider && value !== null) {
      slider.value = text;
    }
  };
  return { root: el("div", { className: "number" }, name, slider, typed), show };
}
