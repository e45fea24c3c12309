/** The map below the block: which block comes through which motion, every point to be played. */
import "./map.css";
import { Stage } from "../block/stage";
import { button, choice, el, say } from "../dom";
import type { About, Engine, Key } from "../engine";
import type { Store } from "../store";
import { texts } from "../texts";
import { mountView } from "../view";
import { type Axes, AxesForm } from "./axes_form";
import { axisToml, mapIdentity, suggestedPair, valueOf } from "./axis";
import { mapDownloads } from "./downloads";
import { Filling } from "./filling";
import { keyName, named } from "./key_name";
import type { Place } from "./panel";
import { Playing } from "./playing";
import { Sheet, outcomesOf } from "./sheet";
import { shortText } from "./ticks";

const words = texts.views.map;
const LIVE = "map-live";

/** The section. */
class MapSection {
  private readonly engine: Engine;
  private readonly store: Store;
  private readonly playing: Playing;
  private readonly form: AxesForm;
  private readonly fillButton = button(words.fill, () => this.fillOrStop());
  private readonly shows = choice(words.show, Object.entries(words.shows), () => this.sheet?.show(this.shown()));
  private readonly boundaries = button(words.boundaries, () => void this.toggleBoundaries());
  private readonly progress = el("progress", { max: 1, value: 0, ariaLabel: words.title });
  private readonly note = el("span");
  private readonly place = el("div");
  private readonly live = el("p", { id: LIVE, role: "status" });
  private readonly played = el("div", { hidden: true });
  private readonly downloads: HTMLElement;
  /** What a cut has not. */
  private readonly onlyOfCells: HTMLElement[];
  private about: About | null = null;
  private keys: Key[] = [];
  private filling: Filling | null = null;
  private identity = "";
  private sheet: Sheet | null = null;
  private cursor: Place | null = null;
  private latest = 0;
  private inSight = false;

  constructor(root: HTMLElement, engine: Engine, store: Store) {
    [this.engine, this.store] = [engine, store];
    this.playing = new Playing(engine, store);
    this.form = new AxesForm(
      (axes) => this.setAxes(axes),
      (line) => store.fail(line),
    );
    this.boundaries.ariaPressed = "false";
    this.downloads = mapDownloads(store, () =>
      this.filling === null || this.sheet === null ? null : { title: this.about?.title ?? "", filling: this.filling, sheet: this.sheet },
    );
    this.onlyOfCells = [this.shows.root, this.boundaries];
    this.buildPlayed();
    const row = el("div", { className: "buttons" }, this.fillButton, this.progress, this.note, ...this.onlyOfCells, this.downloads);
    const about = el("p", { className: "hint", textContent: words.about });
    root.append(about, this.form.root, row, this.place, this.live, this.played);
    store.subscribe("scene", () => void this.sceneChanged());
    new IntersectionObserver((entries) => {
      this.inSight = entries.some((entry) => entry.isIntersecting);
      this.fillIfSeen();
    }).observe(root);
    void this.sceneChanged();
  }

  private shown(): "outcome" | "peak" {
    return this.shows.select.value === "peak" ? "peak" : "outcome";
  }

  /** The block of the cell at the cursor, where the eye is, and what can be done with it. */
  private buildPlayed(): void {
    const stage = new Stage(this.store);
    const frame = el("div", { className: "frame" }, stage.canvas);
    stage.observe(frame);
    const line = el("p", { className: "notice" }, words.playing);
    line.append(
      button(words.use, () => this.take()),
      button(words.back, () => this.back()),
    );
    this.played.append(line, frame);
  }

  /** Keeps the map where the new scene is a point of it, and starts another one where it is not. */
  private async sceneChanged(): Promise<void> {
    this.played.hidden = !this.store.isPreview;
    const { source } = this.store;
    if (this.store.isPreview || source.text === "") {
      return;
    }
    this.latest += 1;
    const number = this.latest;
    try {
      const [about, keys] = await Promise.all([this.engine.about(source), this.engine.keys(source)]);
      if (number !== this.latest) {
        return;
      }
      [this.about, this.keys] = [about, named(keys, about.resolved)];
      this.form.show(about.map ?? suggestedPair(keys), this.keys);
      await this.renew(about);
    } catch (problem) {
      if (number === this.latest) {
        this.store.fail(problem);
      }
    }
  }

  private async renew(about: About): Promise<void> {
    const { source } = this.store;
    const identity = about.map === null ? "" : mapIdentity(about.map, about.resolved, source.records);
    if (identity !== this.identity || this.filling === null) {
      this.filling?.stop();
      this.playing.forget();
      [this.filling, this.sheet, this.cursor, this.identity] = [null, null, null, identity];
      say(this.live, about.map === null ? words.noMap : "");
      this.boundaries.ariaPressed = "false";
      if (about.map === null) {
        this.place.replaceChildren();
      } else {
        // The panels before stay until there are others, so that nothing jumps.
        let filling: Filling;
        try {
          filling = await Filling.of(this.engine, source, about.map, about.resolved);
        } catch (problem) {
          if (identity === this.identity) {
            this.place.replaceChildren();
            this.showProgress();
            this.store.fail(problem);
          }
          return;
        }
        if (identity !== this.identity) {
          return;
        }
        this.filling = filling;
        this.sheet = new Sheet(filling, this.keys, LIVE, {
          point: (place) => this.point(place),
          take: () => this.take(),
          back: () => this.back(),
          cursor: () => this.cursor ?? this.ownCell(),
        });
        this.sheet.show(this.shown());
        this.place.replaceChildren(this.sheet.root);
      }
      this.showProgress();
      this.fillIfSeen();
    }
    this.mark();
  }

  /** A map out of sight waits. */
  private fillIfSeen(): void {
    if (this.inSight && this.filling !== null && this.filling.share === 0 && !this.filling.running && !this.filling.stopped) {
      void this.fill(this.filling);
    }
  }

  private async fill(filling: Filling): Promise<void> {
    try {
      const ended = filling.fill(this.engine, () => {
        this.sheet?.later();
        this.showProgress();
      });
      this.showProgress();
      await ended;
    } catch (problem) {
      this.store.fail(problem);
    }
    this.showProgress();
  }

  private fillOrStop(): void {
    const { filling, about } = this;
    if (filling?.running === true) {
      filling.stop();
      this.showProgress();
    } else if (about?.map === null && this.form.shown !== null) {
      this.inSight = true;
      this.setAxes(this.form.shown);
    } else if (about !== null) {
      this.inSight = true;
      this.filling = null;
      void this.renew(about);
    }
  }

  private setAxes({ x, y }: Axes): void {
    const without = this.about?.map?.y != null ? ["map.y="] : [];
    this.store.setSetting(`map.x=${axisToml(x)}`, ...(y === null ? without : [`map.y=${axisToml(y)}`]));
  }

  private showProgress(): void {
    const { filling } = this;
    const running = filling?.running === true;
    const share = filling?.share ?? 0;
    this.progress.value = share;
    this.progress.hidden = !running;
    say(this.fillButton, running ? words.stop : words.fill);
    const cells = filling === null ? 0 : filling.about.x.length * filling.about.y.length;
    this.note.textContent =
      filling === null || share === 0
        ? ""
        : filling.whole && !running
          ? words.whole(cells, filling.seconds.toFixed(2))
          : `${words.filled(Math.floor(100 * share))}${filling.stopped ? `, ${words.stopped}` : ""}`;
    this.boundaries.disabled = filling === null || !filling.whole || running;
    this.onlyOfCells.forEach((control) => (control.hidden = filling?.axes.y === null));
    this.boundaries.title = this.boundaries.disabled ? words.noBoundaries : "";
    this.downloads.hidden = share === 0;
  }

  private async toggleBoundaries(): Promise<void> {
    const { filling, sheet } = this;
    if (filling === null || sheet === null) {
      return;
    }
    const shown = this.boundaries.ariaPressed !== "true";
    this.boundaries.ariaPressed = String(shown);
    try {
      if (shown && filling.boundaries === null) {
        this.note.textContent = words.tracing;
        await filling.trace(this.engine);
        this.showProgress();
      }
      sheet.drawBoundaries(this.boundaries.ariaPressed === "true");
    } catch (problem) {
      this.boundaries.ariaPressed = "false";
      this.showProgress();
      this.store.fail(problem);
    }
  }

  private point(place: Place): void {
    const { filling, cursor } = this;
    if (filling === null || (cursor?.column === place.column && cursor.row === place.row)) {
      return;
    }
    this.cursor = place;
    this.mark();
    const { about } = filling;
    const value = (key: string, number: number): string => `${keyName(key, this.keys)} ${shortText(number)}`;
    const values = [value(about.xKey, about.x[place.column] ?? Number.NaN)];
    if (about.yKey !== null) {
      values.push(value(about.yKey, about.y[place.row] ?? Number.NaN));
    }
    this.live.textContent = words.place(
      values.join(", "),
      outcomesOf(filling, place, (peak) => words.peakOf(shortText(peak))),
    );
    this.playing.soon(filling, place);
  }

  private take(): void {
    if (this.filling !== null && this.cursor !== null) {
      void this.playing.take(this.filling, this.cursor);
    }
  }

  private back(): void {
    this.playing.forget();
    this.cursor = null;
    this.live.textContent = "";
    this.store.unplay();
    this.mark();
  }

  /** What the axes' quantities are in the scene; null where it has not both of them. */
  private ownValues(): { x: number; y: number | null } | null {
    const map = this.about?.map ?? null;
    const value = (key: string): number | null => valueOf(this.about?.resolved, key);
    const [x, y] = map === null ? [null, null] : [value(map.x.key), map.y === null ? null : value(map.y.key)];
    return x === null || (map?.y != null && y === null) ? null : { x, y };
  }

  /** The cell next to the scene. */
  private ownCell(): Place | null {
    const [own, about] = [this.ownValues(), this.filling?.about];
    if (own === null || about === undefined) {
      return null;
    }
    const nearest = (values: Float64Array, wanted: number): number =>
      values.reduce((best, value, index) => (Math.abs(value - wanted) < Math.abs((values[best] ?? 0) - wanted) ? index : best), 0);
    return { column: nearest(about.x, own.x), row: own.y === null ? 0 : nearest(about.y, own.y) };
  }

  private mark(): void {
    this.sheet?.mark(this.cursor, this.ownValues());
  }
}

mountView("map", words.title, (root, engine, store) => void new MapSection(root, engine, store));
