/** Opens the scene of the page's address, or the first one; keeps the address up to date. */
import { debounce } from "../dom";
import type { RecordFile, Source } from "../engine";
import { startText } from "../start";
import type { Store } from "../store";
import { texts } from "../texts";
import { isPacked, pack, unpack } from "./address";

const QUIET_MS = 400;

let fits = true;

/** Whether the address of the page has room for the scene. */
export function fitsAddress(): boolean {
  return fits;
}

/** Opens what the address says, now and whenever it is changed by hand, and writes every other scene into it. */
export async function openAddress(store: Store): Promise<void> {
  let written = "";
  const write = async () => {
    const { text } = store.source;
    const packed = text === startText ? "" : await pack(text);
    // The scene may have changed while it was packed.
    if (text !== store.source.text) {
      return;
    }
    fits = packed !== null;
    const fragment = packed ?? "";
    written = fragment;
    if (fragment !== location.hash) {
      history.replaceState(null, "", fragment === "" ? location.pathname + location.search : fragment);
    }
  };
  addEventListener("hashchange", () => {
    const { hash } = location;
    if (hash === written) {
      return;
    }
    if (isPacked(hash)) {
      written = hash;
      void read(store, hash);
    } else if (hash === "") {
      written = hash;
      store.open({ text: startText, records: [] });
    }
  });
  if (isPacked(location.hash)) {
    await read(store, location.hash);
  } else {
    store.setSource({ text: startText, records: [] });
  }
  store.subscribe(
    "scene",
    debounce(QUIET_MS, () => void write().catch((problem: unknown) => store.fail(problem))),
  );
}

async function read(store: Store, fragment: string): Promise<void> {
  const text = await unpack(fragment).catch(() => null);
  const source = text === null ? { text: startText, records: [] } : await withRecords(store, text);
  store.open(source);
  if (text === null) {
    store.fail(texts.page.scene.broken);
  }
}

/** The record files that a scene names. */
export function recordsOf(text: string): string[] {
  return Array.from(text.matchAll(/\bfile\s*=\s*["'](.+?)["']/g), ([, name]) => name ?? "");
}

/** The scene with the records that it names and that are at hand: those of the examples, and those of the scene before. */
async function withRecords(store: Store, text: string): Promise<Source> {
  const shipped = (await store.engine.examples()).flatMap(({ records }) => records);
  const atHand = new Map<string, RecordFile>([...shipped, ...store.source.records].map((file) => [file.name, file]));
  const named = recordsOf(text);
  return { text, records: named.flatMap((name) => atHand.get(name) ?? []) };
}
