/** What came of it: a row a device, which is also where the device of the histories is chosen. */
import { deviceLook } from "../colours";
import { el, say } from "../dom";
import type { Response } from "../engine";
import type { Store } from "../store";
import { texts } from "../texts";
import { onTheme } from "../theme";
import { numberOf, tableOf } from "./geometry";

/** The table of results, with a live text of the outcomes. */
export function results(store: Store): HTMLElement {
  const words = texts.page.results;
  const body = el("tbody");
  const head = el("tr", {}, ...words.columns.map((text) => el("th", { scope: "col", textContent: text })));
  const table = el("table", { className: "results" }, el("caption", { textContent: words.caption }), el("thead", {}, head), body);
  const slides = el("p", { className: "hint" });
  const live = el("p", { className: "hidden", role: "status" });
  const show = () => {
    const { run } = store;
    if (!run) {
      return;
    }
    const focused = body.contains(document.activeElement);
    body.replaceChildren(...run.responses.map((response, index) => row(store, response, index)));
    if (focused) {
      body.querySelector<HTMLInputElement>("input:checked")?.focus();
    }
    say(slides, run.responses.map(slide).join(" "));
    say(live, texts.page.block.picture(run));
  };
  store.subscribe("run", show);
  store.subscribe("selected", show);
  onTheme(show);
  const scroll = el("div", { className: "scroll", tabIndex: 0, role: "region" }, table);
  scroll.setAttribute("aria-label", words.caption);
  return el("div", {}, scroll, slides, live);
}

/** How a base slides; empty where it does not. */
function slide({ device, summary }: Response): string {
  const sliding = tableOf(summary["sliding"]);
  const [from, most, end] = ["first_slip_time_s", "peak_slide_m", "residual_displacement_m"].map((key) => numberOf(sliding, key));
  return from == null ? "" : texts.page.results.slides(device, from, most ?? 0, end ?? 0);
}

function row(store: Store, response: Response, index: number): HTMLElement {
  const { summary } = response;
  const chosen = el("input", { type: "radio", name: "device", checked: store.selected === index });
  chosen.addEventListener("change", () => (store.selected = index));
  const swatch = el("span", { className: "swatch" });
  swatch.style.background = deviceLook(index).colour;
  const name = el("label", { className: "device" }, chosen, swatch, el("span", { textContent: response.device }));
  return el(
    "tr",
    {},
    el("th", { scope: "row" }, name),
    cell(texts.page.outcome(String(summary["outcome"] ?? ""))),
    cell(figure(summary["peak_rotation"], 3)),
    cell(figure(summary["impacts"], 0)),
    cell(figure(summary["clutch_switches"], 0)),
    cell(figure(summary["peak_force_ratio"], 3)),
  );
}

function cell(text: string): HTMLElement {
  return el("td", { textContent: text });
}

/** A number of a summary with so many decimals, or a dash. */
export function figure(value: unknown, decimals: number): string {
  return typeof value === "number" && Number.isFinite(value) ? value.toFixed(decimals) : "–";
}
