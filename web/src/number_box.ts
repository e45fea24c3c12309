/** A number that is typed, below a label. */
import { el } from "./dom";

let boxes = 0;

/** Numbers that are being typed. */
const typed = new WeakSet<HTMLInputElement>();
/** What `showNumber` was given last. */
const shown = new WeakMap<HTMLInputElement, string>();

/** From here on, what is typed into `input` is not replaced by `showNumber` before it is done. */
export function keepTyped(input: HTMLInputElement): void {
  input.addEventListener("input", () => typed.add(input));
  // Before what else listens to them, which shows what it makes of the number.
  for (const done of ["blur", "change"]) {
    input.addEventListener(done, () => typed.delete(input));
  }
  // Without a number that counts, the one before does.
  input.addEventListener("blur", () => {
    if (input.value === "") {
      input.value = shown.get(input) ?? "";
    }
  });
}

/** A labelled number; `given` is called when it is changed, and says what is wrong with one that `usual` excludes. */
export function numberBox(label: string, usual: { min?: number; max?: number; whole?: boolean }, given: (value: number) => void) {
  const input = el("input", {
    type: "number",
    id: `number-${++boxes}`,
    step: usual.whole === true ? "1" : "any",
    min: String(usual.min ?? ""),
    max: String(usual.max ?? ""),
  });
  keepTyped(input);
  input.addEventListener("change", () => {
    if (input.value !== "") {
      given(input.valueAsNumber);
    }
  });
  return { root: el("div", { className: "field" }, el("label", { htmlFor: input.id, textContent: label }), input), input };
}

/** Shows the number `text`, unless another one is being typed. */
export function showNumber(input: HTMLInputElement, text: string): void {
  shown.set(input, text);
  if (!typed.has(input)) {
    input.value = text;
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
