/** The map of a scene as it is filled by the workers. */
import { inline } from "../controls/draft";
import type { Axis, Boundary, Engine, MapAbout, Source } from "../engine";
import { lookUp } from "./axis";
import { Field } from "./field";

/** A map that is filled, or has been. */
export class Filling {
  readonly source: Source;
  readonly about: MapAbout;
  readonly axes: { x: Axis; y: Axis | null };
  /** `[map]` of the source as a setting. */
  readonly setting: string;
  /** One a device. */
  readonly fields: Field[];
  /** Of every device, once they were asked for. */
  boundaries: Boundary[][] | null = null;
  /** Until it ended (s). */
  seconds = 0;
  /** Whether cells are on their way. */
  running = false;
  private readonly abort = new AbortController();

  private constructor(source: Source, about: MapAbout, axes: { x: Axis; y: Axis | null }, resolved: unknown) {
    [this.source, this.about, this.axes] = [source, about, axes];
    this.setting = `map=${inline(lookUp(resolved, "map"))}`;
    this.fields = about.devices.map(() => new Field(about.x.length, about.y.length));
  }

  /** A map of `source`, whose `[map]` is `axes`, without cells. */
  static async of(engine: Engine, source: Source, axes: { x: Axis; y: Axis | null }, resolved: unknown): Promise<Filling> {
    return new Filling(source, await engine.mapAbout(source), axes, resolved);
  }

  /** Share of the cells that are known. */
  get share(): number {
    const known = this.fields.reduce((sum, field) => sum + field.known, 0);
    return known / (this.fields.length * this.about.x.length * this.about.y.length);
  }

  /** Whether every cell is known. */
  get whole(): boolean {
    return this.fields.every((field) => field.whole);
  }

  /** Whether `stop` was called. */
  get stopped(): boolean {
    return this.abort.signal.aborted;
  }

  /** Fills it; `changed` is called after every part. */
  async fill(engine: Engine, changed: () => void): Promise<void> {
    const from = performance.now();
    this.running = true;
    try {
      await engine.map(
        this.source,
        (part) => {
          if (!this.stopped) {
            this.fields[part.device]?.add(part);
            changed();
          }
        },
        this.abort.signal,
      );
    } finally {
      this.running = false;
      this.seconds = (performance.now() - from) / 1000;
    }
  }

  /** Traces the boundaries of all devices. */
  async trace(engine: Engine): Promise<void> {
    this.boundaries = await Promise.all(
      this.fields.map((field, device) => engine.boundaries(this.source, device, field.outcome, this.abort.signal)),
    );
  }

  /** Ends filling and tracing. */
  stop(): void {
    this.running = false;
    this.abort.abort();
  }
}
