/** Files of the user, dropped on the page or chosen, which stay on this machine: a record becomes the ground motion of the scene, and a scene is opened. */
import { button, choice, el, say } from "./dom";
import { listSettings } from "./controls/draft";
import type { RecordAbout, RecordFile } from "./engine";
import { given, recordsOf } from "./scene/open";
import type { Store } from "./store";
import { texts } from "./texts";

/** Largest record that is taken (MB): it is copied into the memory of every worker that runs it. */
export const MOST_MB = 50;

const UNITS = ["g", "m/s2", "cm/s2", "mm/s2", "in/s2", "ft/s2"];

/** The controls of own records; the whole page takes a dropped file. */
export function recordControls(store: Store): HTMLElement {
  const words = texts.page.records;
  let last: RecordFile | null = null;
  const said = el("p", { className: "hint", role: "status" });
  const chooser = el("input", { type: "file", className: "file", multiple: true });
  const units = choice(words.units, [["", words.asFile], ...UNITS.map((unit): [string, string] => [unit, unit])], () => undefined);
  const step = el("input", { type: "number", min: "0", step: "any" });
  const stepField = el("label", { className: "field" }, el("span", { textContent: words.step }), step);

  const take = async (file: RecordFile) => {
    last = file;
    again.hidden = false;
    const timeStepS = Number(step.value);
    const options = { ...(units.select.value ? { units: units.select.value } : {}), ...(timeStepS > 0 ? { timeStepS } : {}) };
    try {
      say(said, describe(await store.engine.record(file, options)));
    } catch (problem) {
      const line = problem instanceof Error ? problem.message : String(problem);
      const asks = /units|time step/i.test(line);
      const text = asks ? words.needs(file.name, line) : words.unreadable(file.name, line);
      say(said, text);
      more.open ||= asks;
      store.fail(text);
      (/time step/i.test(line) ? step : units.select).focus({ preventScroll: !asks });
      return;
    }
    // What is wrong from here on is the scene.
    await shake(store, file, options).catch((problem: unknown) => store.fail(problem));
  };
  const open = async (files: File[]) => {
    const large = files.find(({ size }) => size > MOST_MB * 1e6);
    if (large) {
      store.fail(words.tooLarge(large.name, large.size / 1e6, MOST_MB));
      return;
    }
    try {
      const scene = files.find(({ name }) => /\.toml$/i.test(name));
      const records = await Promise.all(files.filter((file) => file !== scene).map(read));
      if (scene) {
        store.open(await given(store, await scene.text(), records));
        return;
      }
      for (const record of records) {
        await take(record);
      }
    } catch (problem) {
      store.fail(words.unreadable(files.map(({ name }) => name).join(", "), String(problem)));
    }
  };
  const again = button(words.again, () => {
    if (last) {
      void take(last);
    }
  });
  again.hidden = true;
  chooser.addEventListener("change", () => {
    // The same file may be chosen again.
    void open([...(chooser.files ?? [])]).finally(() => (chooser.value = ""));
  });
  takeDrops(open);
  const label = el("label", { className: "field" }, el("span", { textContent: words.choose }), chooser);
  const more = el("details", {}, el("summary", { textContent: `${words.units}, ${words.step}` }), units.root, stepField, again);
  return el(
    "fieldset",
    {},
    el("legend", { textContent: words.heading }),
    el("p", { className: "hint", textContent: words.drop }),
    label,
    more,
    said,
  );
}

async function read(file: File): Promise<RecordFile> {
  return { name: file.name, bytes: new Uint8Array(await file.arrayBuffer()), own: true };
}

function describe(about: RecordAbout): string {
  const { name, format, units, samples, timeStepS, pgaMS2, pgvMS, warnings } = about;
  return [texts.page.records.about(name, format, units, samples, timeStepS, pgaMS2, pgvMS), ...warnings].join(". ");
}

/** Makes the record the only ground motion of the scene, but where the scene names it already. */
async function shake(store: Store, file: RecordFile, options: { units?: string; timeStepS?: number }): Promise<void> {
  const { source, engine } = store;
  const table = {
    motion: "record",
    file: file.name,
    scale: 1,
    ...(options.units === undefined ? {} : { units: options.units }),
    ...(options.timeStepS === undefined ? {} : { time_step_s: options.timeStepS }),
  };
  const records = [...source.records.filter(({ name }) => name !== file.name), file];
  // What was said of units and time step has to go into the scene.
  const waitsForIt = recordsOf(source.text).includes(file.name) && Object.keys(options).length === 0;
  const text = waitsForIt
    ? source.text
    : await engine.set({ text: source.text, records }, listSettings(store.run?.about ?? null, "ground", [table]));
  store.open({ text, records });
}

/** Takes files that are dropped anywhere on the page, and shows that it does while one is above it. */
function takeDrops(open: (files: File[]) => Promise<void>): void {
  const veil = el("div", { className: "veil", hidden: true, textContent: texts.page.records.dropping });
  document.body.append(veil);
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") === true;
  addEventListener("dragover", (event) => {
    if (hasFiles(event)) {
      event.preventDefault();
      veil.hidden = false;
    }
  });
  addEventListener("dragleave", (event) => {
    if (event.relatedTarget === null) {
      veil.hidden = true;
    }
  });
  addEventListener("drop", (event) => {
    veil.hidden = true;
    const files = [...(event.dataTransfer?.files ?? [])];
    if (files.length > 0) {
      event.preventDefault();
      void open(files);
    }
  });
}
