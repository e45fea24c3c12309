/** The engine of the page: the core in a pool of workers. */
import lanesUrl from "./core/lanes/sprag_lanes_bg.wasm?url";
import lanesSimdUrl from "./core/lanes-simd/sprag_lanes_bg.wasm?url";
import pageUrl from "./core/page/sprag_page_bg.wasm?url";
import type {
  About,
  Boundary,
  Cells,
  DigestCheck,
  Engine,
  Key,
  Loop,
  MapAbout,
  RecordAbout,
  RecordFile,
  Response,
  Run,
  Source,
} from "./engine";
import { fillMap } from "./pool/fill_map";
import { Workers } from "./pool/workers";

/** A module that is nothing but an instruction of SIMD. */
const SIMD_MODULE = Uint8Array.of(
  ...[0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11],
);

/** Workers: one a core, but not so many that their memory is felt. */
const MOST_WORKERS = 8;

async function compiled(url: string): Promise<WebAssembly.Module> {
  const answer = await fetch(url);
  if (!answer.ok) {
    throw new Error(`${url}: ${answer.status} ${answer.statusText}`);
  }
  // Servers that do not know the type of a module are many.
  return WebAssembly.compile(await answer.arrayBuffer());
}

/** A response as a worker has it: its summary is JSON. */
type Raw<T> = Omit<T, "summary"> & { summary: string };

function response(raw: Raw<Response>): Response {
  return { ...raw, summary: JSON.parse(raw.summary) as Record<string, unknown> };
}

/** What JSON leaves out is null. */
function complete(about: About): About {
  return { ...about, map: about.map ? { ...about.map, y: about.map.y ?? null } : null };
}

/** Starts the workers and loads the core: the lanes with SIMD where the browser has it. Rejects with one plain line. */
export async function createEngine(): Promise<Engine> {
  const hasSimd = WebAssembly.validate(SIMD_MODULE);
  const [page, lanes] = await Promise.all([compiled(pageUrl), compiled(hasSimd ? lanesSimdUrl : lanesUrl)]);
  const workers = new Workers({ page, lanes }, Math.min(Math.max(navigator.hardwareConcurrency, 2), MOST_WORKERS));
  const { version, simd } = await workers.ready;
  const about = async (source: Source): Promise<About> => complete(await workers.run<About>({ name: "about" }, source));
  const mapAbout = async (source: Source): Promise<MapAbout> => {
    const map = await workers.run<Omit<MapAbout, "yKey"> & { yKey?: string }>({ name: "map" }, source);
    return { ...map, yKey: map.yKey ?? null };
  };
  return {
    version,
    simd,
    get workers() {
      return workers.size;
    },
    examples: () => workers.run({ name: "examples" }, null),
    about,
    keys: (source) => workers.run<Key[]>({ name: "keys" }, source),
    set: (source, settings) => workers.run<string>({ name: "set", settings }, source),
    record: (file: RecordFile, { units, timeStepS }) => workers.run<RecordAbout>({ name: "record", file, units, timeStepS }, null),
    simulate: async (source) => {
      const run = await workers.run<Omit<Run, "responses"> & { responses: Raw<Response>[] }>({ name: "simulate" }, source);
      return { ...run, about: complete(run.about), responses: run.responses.map(response) };
    },
    map: async (source, each, signal) => {
      const map = await mapAbout(source);
      const cells = async (device: number, numbers: Uint32Array): Promise<void> => {
        const call = { name: "cells", device, cells: numbers } as const;
        const found = await workers.run<Omit<Cells, "device" | "cells">>(call, source, "later", signal);
        each({ device, cells: numbers, ...found });
      };
      await fillMap(map, cells, 2 * workers.size, signal);
      return map;
    },
    mapAbout,
    boundaries: async (source, device, outcome, signal) => {
      const call = { name: "boundaries", device, outcome } as const;
      type Found = { boundaries: { left: Uint8Array; right: Uint8Array; vertices: Float64Array }[] };
      const { boundaries } = await workers.run<Found>(call, source, "later", signal);
      return boundaries.map(({ left, right, vertices }): Boundary => ({ left: left[0] ?? 0, right: right[0] ?? 0, vertices }));
    },
    cell: (source, column, row) => workers.run<string>({ name: "cell", column, row }, source),
    faults: () => workers.run({ name: "faults" }, null),
    loop: async (source, injected) => {
      const loop = await workers.run<Omit<Raw<Loop>, "idealPair"> & { idealPair: Raw<Response> }>({ name: "loop", injected }, source);
      return { ...loop, summary: JSON.parse(loop.summary) as Record<string, unknown>, idealPair: response(loop.idealPair) };
    },
    digests: () => workers.run<DigestCheck[]>({ name: "digests" }, null),
  };
}
