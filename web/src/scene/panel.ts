/** The scene as text: to edit, copy, paste, download and hand on by a link; results to download; the same run elsewhere. */
import { button, debounce, download, el, say } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { fitsAddress, given, ownRecords } from "./open";
import { downloadPng } from "./png";

const TYPING_MS = 400;
const COMMAND = "sprag simulate scene.toml";
const PYTHON = `import sprag

for run in sprag.simulate(sprag.Scene.read("scene.toml")):
    print(run.device, run.outcome, run.peak_rotation)`;

/** The section of the scene. */
export function scenePanel(store: Store): HTMLElement {
  const words = texts.page.scene;
  const text = el("textarea", { className: "toml", rows: 18, spellcheck: false, autocomplete: "off", wrap: "off" });
  const said = el("span", { className: "said", role: "status" });
  text.addEventListener(
    "input",
    debounce(TYPING_MS, () => store.setSource({ text: text.value, records: store.source.records })),
  );
  store.subscribe("scene", () => {
    if (text.value !== store.source.text) {
      text.value = store.source.text;
    }
  });
  // Where a page has no right to the clipboard there may be none.
  const copy = async (value: () => string, done: () => string = () => words.copied) => {
    say(said, "");
    try {
      await navigator.clipboard.writeText(value());
      say(said, done());
    } catch {
      store.fail(words.copyFailed);
    }
  };
  const paste = async () => {
    try {
      store.open(await given(store, await navigator.clipboard.readText()));
    } catch {
      store.fail(words.pasteFailed);
    }
  };
  const edit = el(
    "div",
    {},
    el("label", { className: "field wide" }, el("span", { textContent: words.edit }), text),
    el(
      "div",
      { className: "buttons" },
      button(words.copy, () => void copy(() => store.source.text)),
      button(words.paste, () => void paste()),
      button(words.link, () => {
        if (fitsAddress()) {
          void copy(
            () => location.href,
            () => linkNote(store),
          );
        } else {
          say(said, words.tooLong);
        }
      }),
      said,
    ),
  );
  const section = el("section", { className: "card scene", id: "scene" }, el("h2", { textContent: words.heading }));
  section.append(el("div", { className: "columns" }, edit, el("div", {}, downloads(store), elsewhere(copy), digest(store))));
  return section;
}

/** What is said after a link was copied: it cannot carry records of the user. */
function linkNote(store: Store): string {
  const words = texts.page.scene;
  return ownRecords(store.source).length > 0 ? `${words.copied}. ${words.linkRecords}` : words.copied;
}

function downloads(store: Store): HTMLElement {
  const words = texts.page.scene;
  return el(
    "div",
    { className: "group" },
    el("h3", { textContent: words.download }),
    el(
      "div",
      { className: "buttons" },
      button(words.toml, () => download(words.toml, store.played.text, "application/toml")),
      button(words.csv, () => store.run && download(words.csv, store.run.csv, "text/csv")),
      button(words.svg, () => store.run && download(words.svg, store.run.svg, "image/svg+xml")),
      button(words.png, () => store.run && downloadPng(store, words.png, store.run.svg)),
    ),
  );
}

function elsewhere(copy: (value: () => string) => Promise<void>): HTMLElement {
  const words = texts.page.scene;
  const block = (heading: string, code: string) => {
    const copyIt = button(words.copy, () => void copy(() => code));
    copyIt.setAttribute("aria-label", `${words.copy}: ${heading}`);
    const pre = el("pre", { tabIndex: 0 }, el("code", { textContent: code }));
    return el("div", { className: "group" }, el("h3", { textContent: heading }), el("div", { className: "code" }, pre, copyIt));
  };
  return el("div", {}, block(words.command, COMMAND), block(words.python, PYTHON));
}

function digest(store: Store): HTMLElement {
  const value = el("code");
  store.subscribe("run", () => say(value, store.run?.digest ?? ""));
  return el("p", { className: "hint" }, `${texts.page.scene.digest}: `, value);
}
