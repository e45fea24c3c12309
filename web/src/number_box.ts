/** A number that is typed, below a label. */
import { el } from "./dom";

let boxes = 0;

/** Numbers that are being typed: what else comes in meanwhile does not replace them. */
const typed = new WeakSet<HTMLInputElement>();

/** A labelled number; `given` is called when it is changed, but not with one that `allowed` excludes. */
export function numberBox(label: string, allowed: { min?: number; max?: number; whole?: boolean }, given: (value: number) => void) {
  const input = el("input", {
    type: "number",
    id: `number-${++boxes}`,
    step: allowed.whole === true ? "1" : "any",
    min: String(allowed.min ?? ""),
    max: String(allowed.max ?? ""),
  });
  input.addEventListener("input", () => typed.add(input));
  input.addEventListener("blur", () => typed.delete(input));
  input.addEventListener("change", () => {
    typed.delete(input);
    if (input.value !== "" && input.checkValidity()) {
      given(input.valueAsNumber);
    }
  });
  return { root: el("div", { className: "field" }, el("label", { htmlFor: input.id, textContent: label }), input), input };
}

/** Shows `value`, unless another one is being typed. */
export function showNumber(input: HTMLInputElement, value: number): void {
  if (!typed.has(input)) {
    input.value = String(value);
  }
}

/** Replaces what can be chosen from a list; what was chosen stays where it can. */
export function setChoices(list: HTMLSelectElement, choices: readonly (readonly [string, string])[]): void {
  const before = list.value;
  list.replaceChildren(...choices.map(([value, textContent]) => el("option", { value, textContent })));
  if (choices.some(([value]) => value === before)) {
    list.value = before;
  }
}
