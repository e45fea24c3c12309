/** A worker: the core, and the last scenes that it was given. */
import { SAMPLE, type Source } from "../engine";
import initLanes, { pulses, simd } from "../core/lanes/sprag_lanes";
import initPage, { digests, examples, faults, near_fault_csv, record, Scene, version } from "../core/page/sprag_page";
import type { Call, FromWorker, Task, ToWorker } from "./messages";

const scenes = new Map<number, Scene>();

function answer(message: FromWorker, transfer: Transferable[] = []): void {
  postMessage(message, { transfer });
}

function opened(number: number, source: Source | null): Scene {
  const kept = scenes.get(number);
  if (kept) {
    return kept;
  }
  const { text, records } = source ?? { text: "", records: [] };
  const scene = new Scene(
    text,
    records.map((file) => file.name),
    records.map((file) => file.bytes),
  );
  scenes.set(number, scene);
  return scene;
}

/** The scene of a task; a task without one asks for none. */
function sceneOf({ scene }: Task): Scene {
  return opened(scene?.number ?? -1, scene?.source ?? null);
}

function run(call: Call, task: Task): unknown {
  switch (call.name) {
    case "examples":
      return (JSON.parse(examples()) as [string, string][]).map(([name, text]) => {
        // Each its own, as arrays are handed over.
        const records = text.includes(SAMPLE) ? [{ name: SAMPLE, bytes: near_fault_csv() }] : [];
        return { name, title: /^title = "(.*)"/m.exec(text)?.[1] ?? name, text, records };
      });
    case "faults":
      return faults().map((name) => ({ name, text: name }));
    case "digests":
      return JSON.parse(digests());
    case "record":
      return JSON.parse(record(call.file.name, call.file.bytes, call.units, call.timeStepS));
    case "about":
      return JSON.parse(sceneOf(task).about());
    case "keys":
      return JSON.parse(sceneOf(task).keys());
    case "set":
      return sceneOf(task).set(call.settings);
    case "simulate":
      return { about: JSON.parse(sceneOf(task).about()), ...sceneOf(task).simulate() };
    case "map":
      return sceneOf(task).map();
    case "cells":
      return sceneOf(task).cells(call.device, call.cells, pulses);
    case "boundaries":
      return sceneOf(task).boundaries(call.device, call.outcome, pulses);
    case "cell":
      return sceneOf(task).cell(call.column, call.row);
    case "loop":
      return sceneOf(task).closed_loop(
        call.injected.map((injected) => injected.fault),
        Float64Array.from(call.injected, (injected) => injected.atS),
      );
  }
}

/** The arrays in a result, which are handed over instead of copied. */
function arrays(value: unknown): Transferable[] {
  if (ArrayBuffer.isView(value)) {
    return [value.buffer as ArrayBuffer];
  }
  return value !== null && typeof value === "object" ? Object.values(value).flatMap(arrays) : [];
}

addEventListener("message", ({ data }: MessageEvent<ToWorker>) => {
  if ("modules" in data) {
    const { page, lanes } = data.modules;
    Promise.all([initPage({ module_or_path: page }), initLanes({ module_or_path: lanes })]).then(
      () => answer({ ready: { version: version(), simd: simd() } }),
      (problem: unknown) => answer({ failure: String(problem), broke: true }),
    );
    return;
  }
  for (const number of data.task.forget) {
    scenes.get(number)?.free();
    scenes.delete(number);
  }
  try {
    const result = run(data.task.call, data.task);
    answer({ result }, arrays(result));
  } catch (problem) {
    // What the core refuses is an Error with one line; anything else leaves its memory in a state that nobody knows.
    const broke = problem instanceof WebAssembly.RuntimeError || problem instanceof RangeError;
    answer({ failure: problem instanceof Error ? problem.message : String(problem), broke });
  }
});
