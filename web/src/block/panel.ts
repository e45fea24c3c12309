/** The block with everything that belongs to it. */
import { losesAxis } from "../controls/draft";
import { el, button } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { listOf } from "./geometry";
import { makeHandle } from "./handle";
import { results } from "./results";
import { Stage } from "./stage";
import { transport } from "./transport";

/** The section of the block. */
export function blockPanel(store: Store): HTMLElement {
  const words = texts.page.block;
  const stage = new Stage(store);
  const hint = el("p", { className: "hint", id: "block-hint", role: "status", textContent: words.hint });
  const frame = el("div", { className: "frame", tabIndex: 0, role: "application" }, stage.canvas);
  frame.setAttribute("aria-label", words.handle);
  frame.setAttribute("aria-describedby", hint.id);
  stage.observe(frame);
  makeHandle(stage, frame, hint, store);
  frame.addEventListener("keydown", (event) => {
    if (event.key === " " && event.target === frame) {
      event.preventDefault();
      store.playing = !store.playing;
    }
  });
  startByItself(store);
  return el("div", { className: "block" }, frame, hint, preview(store), again(store), transport(store), results(store), stage.legend);
}

/** Plays what is new from its beginning; where the motion is still under way, it goes on with what has changed. */
function startByItself(store: Store): void {
  store.restart();
  store.subscribe("scene", () => {
    if (store.isPreview || store.time >= store.durationS) {
      store.restart();
    }
  });
}

/** A line that says that another block than the scene's is shown, with what can be done about it. */
function preview(store: Store): HTMLElement {
  const words = texts.page.block;
  const line = el(
    "p",
    { className: "notice", hidden: true },
    el("span", { textContent: words.preview }),
    button(words.fix, () => store.fix()),
    button(words.unplay, () => store.unplay()),
  );
  store.subscribe("scene", () => (line.hidden = !store.isPreview));
  return line;
}

/** A button that brings back the ground motion that a drag of the block has taken away. */
function again(store: Store): HTMLElement {
  const line = el("p", { className: "notice", hidden: true });
  line.append(
    el("span", { textContent: texts.page.block.free }),
    button(texts.page.block.shake, () => {
      const { shaken, run } = store;
      if (shaken) {
        // A map that was made meanwhile stays, and one over a device that has gone does not come back.
        const keepsOut = run?.about.map != null || losesAxis(shaken.about, "device", listOf(run?.about.resolved, "device"));
        store.restart();
        store.setSetting(...shaken.settings.filter((setting) => !(keepsOut && setting.startsWith("map="))));
      }
    }),
  );
  store.subscribe("run", () => {
    line.hidden = store.shaken === null || listOf(store.run?.about.resolved, "ground").length > 0;
  });
  return line;
}
