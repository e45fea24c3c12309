/** A pool of workers without shared memory, so that any static server will do. */
import type { Source } from "../engine";
import type { Call, FromWorker, Modules, Task, ToWorker } from "./messages";

/** How urgent a job is: what a user waits for goes before the cells of a map. */
export type Urgency = "now" | "later";

interface Job {
  call: Call;
  source: Source | null;
  signal: AbortSignal | null;
  resolve: (result: unknown) => void;
  reject: (problem: unknown) => void;
  /** Workers that it has broken. */
  broken: number;
}

interface Member {
  worker: Worker;
  job: Job | null;
  isReady: boolean;
  /** Numbers of the scenes that it has, the oldest first. */
  scenes: number[];
  forget: number[];
}

/** Scenes that a worker keeps: that of the page, and the blocks that were played last. */
const KEPT_SCENES = 4;

/** Workers that a job may break before it is given up. */
const MOST_BROKEN = 2;

/** The scene with no other records than those that its text may name: each is copied into the memory of the worker. */
function withNamed({ text, records }: Source): Source {
  // A text may write quotes and backslashes in other ways.
  return { text, records: records.filter(({ name }) => text.includes(name) || /["\\]/.test(name)) };
}

/** A pool of workers. */
export class Workers {
  private readonly members: Member[] = [];
  private readonly waiting: Record<Urgency, Job[]> = { now: [], later: [] };
  private readonly numbers = new WeakMap<Source, number>();
  private scenes = 0;
  /** What the first worker said of the core. */
  readonly ready: Promise<{ version: string; simd: boolean }>;
  private isReady!: (core: { version: string; simd: boolean }) => void;
  private hasFailed!: (problem: Error) => void;

  constructor(
    private readonly modules: Modules,
    size: number,
  ) {
    this.ready = new Promise((resolve, reject) => {
      this.isReady = resolve;
      this.hasFailed = reject;
    });
    for (let index = 0; index < size; index++) {
      this.hire();
    }
  }

  /** Workers that are alive. */
  get size(): number {
    return this.members.length;
  }

  /** Runs `call` about `source`. Rejects with the reason of `signal` once that is aborted. */
  run<T>(call: Call, source: Source | null, urgency: Urgency = "now", signal: AbortSignal | null = null): Promise<T> {
    return new Promise<T>((resolve, reject) => {
      const job: Job = { call, source, signal, resolve: (result) => resolve(result as T), reject, broken: 0 };
      if (signal?.aborted) {
        reject(signal.reason);
        return;
      }
      signal?.addEventListener("abort", () => {
        this.waiting[urgency] = this.waiting[urgency].filter((other) => other !== job);
        reject(signal.reason);
      });
      this.waiting[urgency].push(job);
      if (this.members.length === 0) {
        this.hire();
      }
      this.assign();
    });
  }

  private hire(): void {
    const worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
    const member: Member = { worker, job: null, isReady: false, scenes: [], forget: [] };
    worker.addEventListener("message", ({ data }: MessageEvent<FromWorker>) => this.hear(member, data));
    worker.addEventListener("error", (event) => this.dismiss(member, event.message));
    worker.addEventListener("messageerror", () => this.dismiss(member, "its answer cannot be read"));
    this.members.push(member);
    this.send(member, { modules: this.modules });
  }

  private hear(member: Member, message: FromWorker): void {
    if ("ready" in message) {
      member.isReady = true;
      this.isReady(message.ready);
    } else if ("failure" in message && message.broke) {
      this.dismiss(member, message.failure);
    } else {
      const { job } = member;
      member.job = null;
      if ("failure" in message) {
        // It may be the scene that cannot be read.
        const number = job?.source ? this.numbers.get(job.source) : undefined;
        member.forget.push(...member.scenes.filter((scene) => scene === number));
        member.scenes = member.scenes.filter((scene) => scene !== number);
        job?.reject(new Error(message.failure));
      } else {
        job?.resolve(message.result);
      }
    }
    this.assign();
  }

  /** A worker that broke is replaced, and its job given to another; a job that breaks them, or a worker that never was ready, is the end. */
  private dismiss(member: Member, why: string): void {
    member.worker.terminate();
    this.members.splice(this.members.indexOf(member), 1);
    const { job } = member;
    if (!member.isReady) {
      const problem = new Error(`the core does not start: ${why}`);
      this.hasFailed(problem);
      if (this.members.length === 0) {
        // Nobody is left to do what waits.
        Object.values(this.waiting).forEach((jobs) => jobs.splice(0).forEach((job) => job.reject(problem)));
      }
      return;
    }
    this.hire();
    if (job) {
      job.broken += 1;
      if (job.broken < MOST_BROKEN && !job.signal?.aborted) {
        this.waiting.now.unshift(job);
      } else {
        job.reject(new Error(`the worker stopped: ${why}`));
      }
    }
    this.assign();
  }

  private assign(): void {
    for (const member of this.members) {
      if (member.isReady && !member.job) {
        const job = this.waiting.now.shift() ?? this.waiting.later.shift();
        if (job) {
          member.job = job;
          this.send(member, { task: this.task(member, job) });
        }
      }
    }
  }

  private task(member: Member, { call, source }: Job): Task {
    const forget = member.forget.splice(0);
    if (!source) {
      return { call, scene: null, forget };
    }
    const number = this.numbers.get(source) ?? ++this.scenes;
    this.numbers.set(source, number);
    const has = member.scenes.includes(number);
    if (!has) {
      member.scenes.push(number);
      forget.push(...member.scenes.splice(0, member.scenes.length - KEPT_SCENES));
    }
    return { call, scene: { number, source: has ? null : withNamed(source) }, forget };
  }

  private send(member: Member, message: ToWorker): void {
    member.worker.postMessage(message);
  }
}
