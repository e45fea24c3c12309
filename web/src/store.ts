/**
 * The state of the page: the scene, what is played, its run, the cursor and the last failure. Whoever shows a part of it subscribes to that
 * part; nobody asks the engine for a run but this file.
 */
import type { About, Engine, Run, Source } from "./engine";
import { mayMoveByItself } from "./motion_preference";
import { endS, overturns } from "./response";

/**
 * What a subscriber hears of: `scene` (source or what is played), `run` (a new run), `working` (a run begins or ends), `time` (the cursor
 * moves), `playing` (starts, stops or changes speed), `selected` (another device), `message` (a failure is shown or dismissed).
 */
export type Topic = "scene" | "run" | "working" | "time" | "playing" | "selected" | "message";

const FALL_S = 1.2;

function endOf(run: Run): number {
  return Math.max(0, ...run.responses.map((response) => endS(response) + (overturns(response) ? FALL_S : 0)));
}

/** The state of the page. */
export class Store {
  /** Version, examples, keys and everything else that is computed. */
  readonly engine: Engine;
  /** Settings that bring back what letting a block go has taken away, and its scene; null where nothing was, and once another scene is opened. */
  shaken: { about: About; settings: string[] } | null = null;
  private scene: Source = { text: "", records: [] };
  private preview: Source | null = null;
  private latestRun: Run | null = null;
  private ran: Source | null = null;
  private cursorS = 0;
  private endS = 0;
  /** The last one, mostly the pair, until another is chosen. */
  private device = Infinity;
  private isPlaying = false;
  private factor = 1;
  private failure = "";
  /** Whether that failure came before the scene that is run. */
  private isOld = false;
  private restarts: boolean | null = null;
  private wanted: Source | null = null;
  private isWorking = false;
  private pending = new Map<string, string>();
  private isSetting = false;
  private readonly subscribers = new Map<Topic, Set<() => void>>();

  constructor(engine: Engine) {
    this.engine = engine;
  }

  /** The scene. It stays while another block is played. */
  get source(): Source {
    return this.scene;
  }

  /** What is run and shown: the scene, or the block that is played in its place. */
  get played(): Source {
    return this.preview ?? this.scene;
  }

  /** Whether a block is played in the place of the scene. */
  get isPreview(): boolean {
    return this.preview !== null;
  }

  /** The last run that ended well; null before the first. */
  get run(): Run | null {
    return this.latestRun;
  }

  /** Whether the last run is that of the scene, and no change of the scene is under way. */
  get isUpToDate(): boolean {
    return this.ran === this.scene && !this.isSetting;
  }

  /** Whether a run is under way. */
  get working(): boolean {
    return this.isWorking;
  }

  /** Cursor of animation and histories (s), from 0 to `durationS`. */
  get time(): number {
    return this.cursorS;
  }

  set time(seconds: number) {
    const within = Math.min(Math.max(seconds, 0), this.durationS);
    if (within !== this.cursorS) {
      this.cursorS = within;
      this.notify("time");
    }
  }

  /** End of the longest response of the run, and time to see an overturned block go down (s). */
  get durationS(): number {
    return this.endS;
  }

  /** Whether the cursor moves by itself. */
  get playing(): boolean {
    return this.isPlaying;
  }

  set playing(playing: boolean) {
    if (playing !== this.isPlaying) {
      this.isPlaying = playing;
      this.notify("playing");
    }
  }

  /** Seconds of motion a second: 1, or less in slow motion. */
  get speed(): number {
    return this.factor;
  }

  set speed(factor: number) {
    this.factor = factor;
    this.notify("playing");
  }

  /** Number of the device whose forces and clutch are shown in the histories. */
  get selected(): number {
    return Math.max(Math.min(this.device, (this.latestRun?.responses.length ?? 1) - 1), 0);
  }

  set selected(device: number) {
    this.device = device;
    this.notify("selected");
  }

  /** What went wrong last, one line; empty when nothing did or it was dismissed. */
  get message(): string {
    return this.failure;
  }

  /** Sets the cursor to the beginning with the next run, and plays it if `plays`. */
  restart(plays = mayMoveByItself()): void {
    this.restarts = plays;
  }

  /** Opens another scene, and runs it from its beginning. */
  open(source: Source): void {
    this.shaken = null;
    this.restart();
    this.setSource(source);
  }

  /** Makes `source` the scene and runs it. */
  setSource(source: Source): void {
    this.pending.clear();
    this.scene = source;
    this.preview = null;
    this.notify("scene");
    this.want(source);
  }

  /** Changes values of the scene: `block.size_m=2`. While a change is under way, the latest value of a key is kept. */
  setSetting(...settings: string[]): void {
    for (const setting of settings) {
      const key = setting.slice(0, setting.indexOf("="));
      this.pending.delete(key);
      this.pending.set(key, setting);
    }
    void this.applySettings();
  }

  /** Plays another block without replacing the scene: the cell of a map below the pointer. */
  play(source: Source): void {
    this.preview = source;
    this.notify("scene");
    this.want(source);
  }

  /** Ends `play`: the scene is shown again. */
  unplay(): void {
    if (this.preview !== null) {
      this.setSource(this.scene);
    }
  }

  /** Makes what is played the scene. */
  fix(): void {
    if (this.preview !== null) {
      this.scene = this.preview;
      this.preview = null;
      this.notify("scene");
    }
  }

  /** Calls `changed` at every change of `topic`, until the function that is returned is called. */
  subscribe(topic: Topic, changed: () => void): () => void {
    const set = this.subscribers.get(topic) ?? new Set();
    this.subscribers.set(topic, set.add(changed));
    return () => set.delete(changed);
  }

  /** Shows one line about what went wrong, until a scene that comes later has been run; an `AbortError` is no failure. */
  fail(problem: unknown): void {
    if (problem instanceof DOMException && problem.name === "AbortError") {
      return;
    }
    this.failure = problem instanceof Error ? problem.message : String(problem);
    this.isOld = false;
    this.notify("message");
  }

  /** Takes the line of `fail` away. */
  dismiss(): void {
    if (this.failure !== "") {
      this.failure = "";
      this.notify("message");
    }
  }

  private notify(topic: Topic): void {
    this.subscribers.get(topic)?.forEach((changed) => changed());
  }

  private async applySettings(): Promise<void> {
    if (this.isSetting) {
      return;
    }
    this.isSetting = true;
    let isLost = false;
    while (this.pending.size > 0) {
      const base = this.scene;
      const settings = [...this.pending.values()];
      this.pending.clear();
      try {
        const text = await this.engine.set(base, settings);
        if (base === this.scene) {
          const later = new Map(this.pending);
          this.setSource({ text, records: base.records });
          this.pending = later;
        } else {
          isLost = true;
        }
      } catch (problem) {
        this.fail(problem);
        isLost = true;
      }
    }
    this.isSetting = false;
    if (isLost) {
      // Controls go back to what the scene says.
      this.notify("scene");
      this.notify("run");
    }
  }

  private begin(): void {
    if (this.restarts !== null && this.wanted === null) {
      this.time = 0;
      this.playing = this.restarts;
      this.restarts = null;
    }
  }

  /** Runs `source`; of those that come meanwhile only the last. */
  private want(source: Source): void {
    this.wanted = source;
    this.isOld = true;
    if (!this.isWorking) {
      void this.runWanted();
    }
  }

  private async runWanted(): Promise<void> {
    this.isWorking = true;
    this.notify("working");
    while (this.wanted !== null) {
      const source = this.wanted;
      this.wanted = null;
      try {
        const run = await this.engine.simulate(source);
        [this.latestRun, this.ran] = [run, source];
        this.endS = endOf(run);
        this.cursorS = Math.min(this.cursorS, this.durationS);
        if (this.isOld && this.wanted === null) {
          this.dismiss();
        }
        this.notify("run");
        this.begin();
      } catch (problem) {
        if (this.wanted === null) {
          this.fail(problem);
        }
      }
    }
    this.isWorking = false;
    this.notify("working");
  }
}
