/** One line about what went wrong, until it is dismissed, and a quiet word while something is computed. */
import { button, el, say } from "./dom";
import type { Store } from "./store";
import { texts } from "./texts";

// Short runs do not make the word flicker.
const QUIET_MS = 300;

/** The status region. */
export function statusLine(store: Store): HTMLElement {
  const text = el("span");
  const line = el(
    "div",
    { className: "failure", hidden: true },
    text,
    button(texts.page.dismiss, () => store.dismiss()),
  );
  const alert = el("div", { role: "alert" }, line);
  const working = el("p", { className: "working" });
  store.subscribe("message", () => {
    line.hidden = store.message === "";
    say(text, store.message);
  });
  let timer = 0;
  store.subscribe("working", () => {
    clearTimeout(timer);
    if (store.working) {
      timer = window.setTimeout(() => say(working, texts.page.working), QUIET_MS);
    } else {
      say(working, "");
    }
  });
  return el("div", { className: "status" }, alert, working);
}

/** Shows what nobody has caught as one line, too. */
export function catchAll(store: Store): void {
  addEventListener("unhandledrejection", (event) => store.fail(event.reason));
  addEventListener("error", (event) => {
    // Observers that cannot finish in one frame say so by an error that harms nothing.
    if (!event.message.startsWith("ResizeObserver")) {
      store.fail(texts.page.frameFailed(event.message));
    }
  });
}
