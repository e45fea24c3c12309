/** Builds the page, loads the core, and opens the first scene. */
import "uplot/dist/uPlot.min.css";
import "./style.css";
import { blockPanel } from "./block/panel";
import { startClock } from "./clock";
import { controlPanel } from "./controls/panel";
import { choice, el } from "./dom";
import type { Engine } from "./engine";
import { historyPanel } from "./histories/panel";
import { createEngine } from "./pool";
import { openAddress } from "./scene/open";
import { scenePanel } from "./scene/panel";
import { catchAll, statusLine } from "./status";
import { Store } from "./store";
import { texts } from "./texts";
import { chooseTheme, chosenTheme, type Theme } from "./theme";
import { buildViews } from "./view";
import "./views";

function header(): HTMLElement {
  const { page } = texts;
  const colours = choice(
    page.theme.label,
    (["system", "light", "dark"] as const).map((theme) => [theme, page.theme[theme]]),
    (theme) => chooseTheme(theme as Theme),
  );
  colours.select.value = chosenTheme();
  return el("header", {}, el("div", {}, el("h1", { textContent: page.title }), el("p", { textContent: page.tagline })), colours.root);
}

function build(engine: Engine): Store {
  const store = new Store(engine);
  catchAll(store);
  startClock(store);
  const stage = el("section", { className: "card", id: "block" }, el("h2", { textContent: texts.page.block.heading }), blockPanel(store));
  const controls = el("section", { className: "card", id: "controls" }, controlPanel(store));
  const main = el("main", { id: "main" }, el("div", { className: "top" }, stage, controls, historyPanel(store)));
  document.body.replaceChildren(header(), statusLine(store), main, ...document.querySelectorAll<HTMLElement>(".veil"));
  buildViews(main, engine, store);
  main.append(scenePanel(store));
  document.body.append(el("footer", {}, el("p", { textContent: texts.page.local }), el("p", { textContent: `Sprag ${engine.version}` })));
  return store;
}

async function start(): Promise<void> {
  document.title = texts.page.title;
  document.documentElement.lang = texts.page.language;
  const waiting = document.querySelector("#waiting");
  if (waiting) {
    waiting.textContent = texts.page.loading;
  }
  let engine: Engine;
  try {
    engine = await createEngine();
  } catch (problem) {
    const why = problem instanceof Error ? problem.message : String(problem);
    document.body.replaceChildren(
      header(),
      el("main", {}, el("p", { className: "failure", role: "alert", textContent: texts.page.noEngine(why) })),
    );
    return;
  }
  const store = build(engine);
  await openAddress(store).catch((problem: unknown) => store.fail(problem));
}

void start();
