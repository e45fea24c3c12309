/** All controls, and the list of examples. */
import { choice, el, say } from "../dom";
import type { RecordFile } from "../engine";
import { startText } from "../start";
import type { Store } from "../store";
import { texts } from "../texts";
import { blockControls } from "./block";
import { deviceControls } from "./devices";
import { Draft } from "./draft";
import { groundControls } from "./ground";
import { recordControls } from "../records";

/** The section of the controls. */
export function controlPanel(store: Store): HTMLElement {
  const draft = new Draft(store);
  const groups = [groundControls(draft, store), blockControls(draft), deviceControls(draft)];
  const show = () => {
    if (store.isUpToDate) {
      draft.take();
      groups.forEach((group) => group.show());
    }
  };
  store.subscribe("run", show);
  // A block that is played becomes the scene without another run.
  store.subscribe("scene", show);
  return el(
    "div",
    { className: "controls" },
    el("h2", { textContent: texts.page.controls.heading }),
    examples(store),
    ...groups.map(({ root }) => root),
    recordControls(store),
    warnings(store),
  );
}

function examples(store: Store): HTMLElement {
  const words = texts.page.controls;
  let shipped: { name: string; title: string; text: string; records: RecordFile[] }[] = [];
  const list = choice(words.example, [["", words.own]], (name) => {
    const example = shipped.find((one) => one.name === name);
    if (example) {
      store.open({ text: example.text, records: example.records });
    }
  });
  store.engine
    .examples()
    .then((found) => {
      shipped = [{ name: "start", title: texts.page.controls.start, text: startText, records: [] }, ...found];
      const options = shipped.map(({ name, title }) => el("option", { value: name, textContent: title || name }));
      list.select.append(...options);
      list.select.value = shipped.find(({ text }) => text === store.source.text)?.name ?? "";
    })
    .catch((problem: unknown) => store.fail(problem));
  store.subscribe("scene", () => {
    list.select.value = shipped.find(({ text }) => text === store.source.text)?.name ?? "";
  });
  return list.root;
}

/** The core's remarks on the scene. */
function warnings(store: Store): HTMLElement {
  const list = el("ul");
  const box = el("details", { className: "warnings", hidden: true }, el("summary"), list);
  store.subscribe("run", () => {
    const found = store.run?.about.warnings ?? [];
    box.hidden = found.length === 0;
    say(box.querySelector("summary") ?? box, `${texts.page.warnings} (${found.length})`);
    list.replaceChildren(...found.map((text) => el("li", { textContent: text })));
  });
  return box;
}
