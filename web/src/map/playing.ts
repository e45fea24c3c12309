/** The block of a cell, played in the place of the scene. */
import type { Engine, Source } from "../engine";
import type { Store } from "../store";
import type { Filling } from "./filling";
import type { Place } from "./panel";

/** A pointer that crosses cells plays the one on which it rests this long (ms). */
const REST_MS = 70;

/** Plays cells, the latest only. */
export class Playing {
  private readonly engine: Engine;
  private readonly store: Store;
  private timer = 0;
  private latest = 0;
  /** The source that is played for a place, or will be. */
  private current: { place: Place; ready: Promise<boolean> } | null = null;

  constructor(engine: Engine, store: Store) {
    [this.engine, this.store] = [engine, store];
  }

  /** Plays the block of a cell soon. */
  soon(filling: Filling, place: Place): void {
    clearTimeout(this.timer);
    this.current = null;
    this.timer = window.setTimeout(() => void this.now(filling, place), REST_MS);
  }

  /** Plays it, and makes it the scene. */
  async take(filling: Filling, place: Place): Promise<void> {
    clearTimeout(this.timer);
    if (await this.now(filling, place)) {
      this.store.fix();
    }
  }

  /** Plays nothing that was asked for before. */
  forget(): void {
    clearTimeout(this.timer);
    this.latest += 1;
    this.current = null;
  }

  /** Whether it is what is played in the end. */
  private now(filling: Filling, place: Place): Promise<boolean> {
    const { current } = this;
    if (current !== null && current.place.column === place.column && current.place.row === place.row && this.store.isPreview) {
      return current.ready;
    }
    this.latest += 1;
    const ready = this.start(filling, place, this.latest);
    this.current = { place, ready };
    return ready;
  }

  private async start(filling: Filling, place: Place, number: number): Promise<boolean> {
    try {
      const source = await this.sourceOf(filling, place);
      if (number !== this.latest) {
        return false;
      }
      this.store.play(source);
      return true;
    } catch (problem) {
      this.store.fail(problem);
      return false;
    }
  }

  /** The scene of a cell, with the map that it is on. */
  private async sourceOf({ source, setting }: Filling, { column, row }: Place): Promise<Source> {
    const { records } = source;
    const text = await this.engine.cell(source, column, row);
    return { text: await this.engine.set({ text, records }, [setting]), records };
  }
}
