/** Elements of the page, made in one line each. */

/** What an element of a view may be given. */
export interface Given {
  class?: string;
  text?: string;
  /** Attributes as HTML has them. */
  at?: Record<string, string>;
  children?: (Node | string)[];
}

/** A new element. */
export function element<Tag extends keyof HTMLElementTagNameMap>(tag: Tag, given: Given = {}): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  if (given.class !== undefined) {
    made.className = given.class;
  }
  if (given.text !== undefined) {
    made.textContent = given.text;
  }
  for (const [name, value] of Object.entries(given.at ?? {})) {
    made.setAttribute(name, value);
  }
  made.append(...(given.children ?? []));
  return made;
}

/** A button that does `pressed`. */
export function button(text: string, pressed: () => void): HTMLButtonElement {
  const made = element("button", { text, at: { type: "button" } });
  made.addEventListener("click", pressed);
  return made;
}

/** A list of `choices` (value and text) that calls `chosen` with a value. */
export function select(choices: readonly (readonly [string, string])[], chosen: (value: string) => void): HTMLSelectElement {
  const made = element("select");
  setChoices(made, choices);
  made.addEventListener("change", () => chosen(made.value));
  return made;
}

/** Replaces what can be chosen; the value stays where it can. */
export function setChoices(list: HTMLSelectElement, choices: readonly (readonly [string, string])[]): void {
  const before = list.value;
  list.replaceChildren(...choices.map(([value, text]) => element("option", { text, at: { value } })));
  if (choices.some(([value]) => value === before)) {
    list.value = before;
  }
}

/** A number that calls `given` when it is changed; an empty or wrong one is not passed on. */
export function numberInput(attributes: Record<string, string>, given: (value: number) => void): HTMLInputElement {
  const made = element("input", { at: { type: "number", step: "any", ...attributes } });
  made.addEventListener("change", () => {
    if (made.value !== "" && made.checkValidity()) {
      given(made.valueAsNumber);
    }
  });
  return made;
}

/** `control` with its name above it. */
export function labelled(name: string, control: HTMLElement): HTMLLabelElement {
  return element("label", { class: "labelled", children: [element("span", { text: name }), control] });
}

/** Gives `content` to the user as a file called `name`. */
export function download(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  element("a", { at: { href: address, download: name } }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** `text` where XML or HTML is written by hand. */
export function escaped(text: string): string {
  return text.replace(/[&<>"]/g, (character) => `&#${character.charCodeAt(0)};`);
}
