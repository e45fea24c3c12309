/** Short ways to make elements. */

type Properties<K extends keyof HTMLElementTagNameMap> = Partial<Omit<HTMLElementTagNameMap[K], "style" | "list" | "form">> & {
  role?: string | null;
};

/** An element with properties (not attributes) and children. */
export function el<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Properties<K> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** A button with a text. */
export function button(text: string, pressed: () => void): HTMLButtonElement {
  const made = el("button", { type: "button", textContent: text });
  made.addEventListener("click", pressed);
  return made;
}

let choices = 0;

/** A list of values to choose one from, below a label. */
export function choice(label: string, options: [value: string, text: string][], chosen: (value: string) => void) {
  const select = el("select", {}, ...options.map(([value, text]) => el("option", { value, textContent: text })));
  select.addEventListener("change", () => chosen(select.value));
  // A label around a list would take the list's texts into its name.
  select.id = `choice-${++choices}`;
  return { root: el("div", { className: "field" }, el("label", { htmlFor: select.id, textContent: label }), select), select };
}

/** Sets a text only where it changes, so that a live region speaks once. */
export function say(element: HTMLElement, text: string): void {
  if (element.textContent !== text) {
    element.textContent = text;
  }
}

/** Calls `act` once `quietMs` have passed since the last call. */
export function debounce(quietMs: number, act: () => void): () => void {
  let timer = 0;
  return () => {
    clearTimeout(timer);
    timer = window.setTimeout(act, quietMs);
  };
}

/** Gives a file to the user. */
export function download(name: string, content: BlobPart, type: string): void {
  const link = el("a", { href: URL.createObjectURL(new Blob([content], { type })), download: name });
  link.click();
  // The browser has taken the file by then.
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
