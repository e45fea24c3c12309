/** Opens the scene of the page's address, or the first one; keeps the address up to date. */
import { debounce } from "../dom";
import { SAMPLE, type RecordFile, type Source } from "../engine";
import { startText } from "../start";
import type { Store } from "../store";
import { texts } from "../texts";
import { isOwn, isPacked, pack, unpack } from "./address";

const QUIET_MS = 400;

let fits = true;

/** Whether the address of the page has room for the scene. */
export function fitsAddress(): boolean {
  return fits;
}

/** Opens what the address says, now and whenever it is changed by hand, and writes every other scene into it. */
export async function openAddress(store: Store): Promise<void> {
  let written = "";
  let seen = location.hash;
  const write = async () => {
    const { source } = store;
    const hasOwn = ownRecords(source).some(({ name }) => name === SAMPLE);
    const packed = source.text === startText ? "" : await pack(source.text, hasOwn);
    // The scene may have changed while it was packed, and the address too, whose event is still to come.
    if (source !== store.source || location.hash !== seen) {
      return;
    }
    fits = packed !== null;
    const fragment = packed ?? "";
    written = seen = fragment;
    if (fragment !== location.hash) {
      history.replaceState(null, "", fragment === "" ? location.pathname + location.search : fragment);
    }
  };
  addEventListener("hashchange", () => {
    const { hash } = location;
    seen = hash;
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
  const source = text === null ? { text: startText, records: [] } : await withRecords(store, text, isOwn(fragment));
  store.open(source);
  if (text === null) {
    store.fail(texts.page.scene.broken);
  }
}

/** The record files that a scene names. */
export function recordsOf(text: string): string[] {
  const named = text.matchAll(/\bfile\s*=\s*(?:("(?:[^"\\\n]|\\.)+")|'([^'\n]+)')/g);
  return Array.from(named, ([, basic, literal]) => literal ?? unquoted(basic ?? '""'));
}

/** A basic string of TOML; mostly it is one of JSON. */
function unquoted(basic: string): string {
  try {
    return String(JSON.parse(basic));
  } catch {
    return basic.slice(1, -1);
  }
}

/** Files of the user that a scene names. */
export function ownRecords({ text, records }: Source): RecordFile[] {
  const named = recordsOf(text);
  return records.filter(({ name, own }) => own === true && named.includes(name));
}

/** A scene that is pasted or dropped, with the records `beside` it, those at hand, and that of the examples where it names it and there is none. */
export async function given(store: Store, text: string, beside: RecordFile[] = []): Promise<Source> {
  const before = store.source.records.filter(({ name }) => beside.every((other) => other.name !== name));
  const records = [...before, ...beside];
  const lacksSample = recordsOf(text).includes(SAMPLE) && !records.some(({ name }) => name === SAMPLE);
  return { text, records: lacksSample ? [...records, ...(await withRecords(store, text, false)).records] : records };
}

/** The scene with the records that it names and that are at hand: those of the scene before, and of the examples unless they are not meant. */
async function withRecords(store: Store, text: string, hasOwn: boolean): Promise<Source> {
  const before = store.source.records;
  const shipped = (await store.engine.examples()).flatMap(({ records }) => records);
  const files = hasOwn ? before.filter(({ own }) => own) : [...before, ...shipped];
  const atHand = new Map(files.map((file) => [file.name, file]));
  const named = recordsOf(text);
  return { text, records: named.flatMap((name) => atHand.get(name) ?? []) };
}
