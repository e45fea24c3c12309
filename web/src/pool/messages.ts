/** What the pool and its workers say to each other. */
import type { Injected, RecordFile, Source } from "../engine";

/** The compiled modules, which every worker shares. */
export interface Modules {
  page: WebAssembly.Module;
  lanes: WebAssembly.Module;
}

/** Work for a worker. */
export type Call =
  | { name: "examples" | "faults" | "digests" | "about" | "keys" | "simulate" | "map" }
  | { name: "set"; settings: string[] }
  | { name: "record"; file: RecordFile; units: string | undefined; timeStepS: number | undefined }
  | { name: "cells"; device: number; cells: Uint32Array }
  | { name: "boundaries"; device: number; outcome: Uint8Array }
  | { name: "cell"; column: number; row: number }
  | { name: "loop"; injected: Injected[] };

/** A call, and the scene that it is about: by its number, and whole where the worker does not have it. */
export interface Task {
  call: Call;
  scene: { number: number; source: Source | null } | null;
  /** Numbers of scenes that the worker need not keep any more. */
  forget: number[];
}

/** To a worker: first the modules, then tasks. */
export type ToWorker = { modules: Modules } | { task: Task };

/** From a worker: that it is ready, or what a task came to. A worker that `broke` is of no use any more. */
export type FromWorker = { ready: { version: string; simd: boolean } } | { result: unknown } | { failure: string; broke: boolean };
