/** The controller in closed loop: the code of the firmware, its estimates beside the truth, its commands and its faults. */
import "./loop.css";
import type { About, Engine, Loop, Source } from "../engine";
import { button, debounce, download, el, say } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { mountView } from "../view";
import { ControllerForm, FIRST_CONTROLLER } from "./controls";
import { InjectionForm } from "./injection";
import { LoopCharts } from "./loop_charts";
import { faultLog, faultsOf, resultTable } from "./results";

const words = texts.views.loop;

/** Scenes change faster than loops run: the last one is run after this long (ms). */
const REST_MS = 150;

/** The section. */
class LoopSection {
  private readonly engine: Engine;
  private readonly store: Store;
  private readonly none: HTMLElement;
  private readonly body: HTMLElement;
  private readonly form: ControllerForm;
  private readonly injection: InjectionForm;
  private readonly status = el("p", { role: "status" });
  private readonly tables = el("div", { className: "loop-tables" });
  private readonly downloads = el("div", { className: "buttons", hidden: true });
  private readonly charts: LoopCharts;
  private readonly soon = debounce(REST_MS, () => void this.look());
  private latest = 0;
  private wanted = false;
  private running = false;
  private inSight = false;
  private loop: Loop | null = null;

  constructor(root: HTMLElement, engine: Engine, store: Store) {
    [this.engine, this.store] = [engine, store];
    this.form = new ControllerForm((setting) => store.setSetting(setting));
    this.injection = new InjectionForm(() => this.soon());
    this.charts = new LoopCharts((seconds) => {
      store.time = seconds;
    });
    const add = button(words.add, () => store.setSetting(...FIRST_CONTROLLER));
    this.none = el("div", {}, el("p", { textContent: words.none }), add);
    const remove = button(words.remove, () => store.setSetting("controller="));
    const forms = el("div", { className: "loop-forms" }, this.form.root, this.injection.root);
    this.body = el("div", {}, forms, this.status, this.tables, this.charts.root, this.downloads, remove);
    this.body.hidden = true;
    this.downloads.append(
      button(words.csv, () => this.save(words.csv, "text/csv", (loop) => loop.csv)),
      button(words.svg, () => this.save(words.svg, "image/svg+xml", (loop) => loop.svg)),
    );
    root.classList.add("loop");
    root.append(el("p", { className: "hint", textContent: words.about }), this.none, this.body);
    store.subscribe("scene", () => this.soon());
    store.subscribe("time", () => {
      if (this.inSight) {
        this.charts.setTime(store.time);
      }
    });
    new IntersectionObserver((entries) => {
      this.inSight = entries.some((entry) => entry.isIntersecting);
      void this.run();
    }).observe(root);
    engine
      .faults()
      .then((faults) => this.injection.offer(faults))
      .catch((problem: unknown) => store.fail(problem));
    this.soon();
  }

  /** Shows the controller of what is played, or that there is none. */
  private async look(): Promise<void> {
    this.latest += 1;
    const number = this.latest;
    const source = this.store.played;
    if (source.text === "") {
      return;
    }
    try {
      const about = await this.engine.about(source);
      if (number !== this.latest) {
        return;
      }
      [this.none.hidden, this.body.hidden] = [about.hasController, !about.hasController];
      [this.current, this.wanted] = [about.hasController ? { about, source } : null, true];
      if (about.hasController) {
        this.form.show(about.resolved);
        await this.run();
      }
    } catch (problem) {
      if (source === this.store.played) {
        this.store.fail(problem);
      }
    }
  }

  private current: { about: About; source: Source } | null = null;

  /** Runs the loop if it is in sight; of those that come meanwhile only the last. */
  private async run(): Promise<void> {
    if (this.running || !this.wanted || !this.inSight) {
      return;
    }
    this.running = true;
    while (this.wanted && this.current !== null) {
      this.wanted = false;
      const { about, source } = this.current;
      say(this.status, words.working);
      try {
        const loop = await this.engine.loop(source, this.injection.injected);
        this.show(loop, about);
        say(this.status, "");
      } catch (problem) {
        say(this.status, `${words.failed} ${problem instanceof Error ? problem.message : String(problem)}`);
      }
    }
    this.running = false;
  }

  private show(loop: Loop, about: About): void {
    this.loop = loop;
    this.downloads.hidden = false;
    this.tables.replaceChildren(resultTable(loop), faultLog(loop));
    this.charts.show(
      loop,
      about,
      faultsOf(loop).map((fault) => fault.timeS),
    );
    this.injection.suggest((loop.timeS.at(-1) ?? 0) / 3);
  }

  private save(name: string, type: string, text: (loop: Loop) => string): void {
    if (this.loop !== null) {
      download(name, text(this.loop), type);
    }
  }
}

mountView("loop", words.title, (root, engine, store) => void new LoopSection(root, engine, store));
