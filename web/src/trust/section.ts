/** Why the page can be believed: version, errors, and digests that anybody can compute again. */
import "./trust.css";
import type { DigestCheck, Engine } from "../engine";
import { button, el } from "../dom";
import { grid } from "../loop/results";
import type { Store } from "../store";
import { texts } from "../texts";
import { mountView } from "../view";
import { errorWords } from "./error_words";

const words = texts.views.trust;

/** Settings that ask for errors. */
const ASK = 'accuracy={ level = "normal" }';

function mount(root: HTMLElement, engine: Engine, store: Store): void {
  root.classList.add("trust");
  const facts = el("dl");
  const ask = button(words.ask, () => store.setSetting(ASK));
  const digests = el("div");
  const status = el("p", { role: "status" });
  const compute = button(words.compute, () => void computeDigests());
  root.append(el("p", { className: "hint", textContent: words.about }), facts, ask, compute, status, digests);

  async function computeDigests(): Promise<void> {
    compute.disabled = true;
    status.textContent = words.computing;
    try {
      const checks = await engine.digests();
      digests.replaceChildren(digestTable(checks));
      const different = checks.filter((check) => !isEqual(check)).length;
      status.textContent = different === 0 ? words.all(checks.length) : words.some(different, checks.length);
    } catch (problem) {
      status.textContent = "";
      store.fail(problem);
    }
    compute.disabled = false;
  }

  function showFacts(): void {
    const { run } = store;
    const errors = run?.responses.map((response) => ({ device: response.device, error: errorWords(response.summary) })) ?? [];
    ask.hidden = errors.every(({ error }) => error !== null);
    const rows: [string, string][] = [
      [words.version, engine.version],
      [words.simd, engine.simd ? words.simdYes : words.simdNo],
      [words.workers, String(engine.workers)],
      ...(run === null ? [] : [[words.digest, run.digest] as [string, string]]),
      ...errors.map(({ device, error }) => [words.error(device), error ?? words.noError] as [string, string]),
    ];
    facts.replaceChildren(...rows.flatMap(([name, value]) => [el("dt", { textContent: name }), el("dd", { textContent: value })]));
  }
  store.subscribe("run", showFacts);
  store.subscribe("message", showFacts);
  showFacts();
}

function isEqual({ computed, expected }: DigestCheck): boolean {
  return computed === expected;
}

function digestTable(checks: readonly DigestCheck[]): HTMLTableElement {
  return grid(
    words.caption,
    words.columns,
    checks.map((check) => [check.scene, check.computed, check.expected, isEqual(check) ? words.equal : words.different]),
  );
}

mountView("trust", words.title, mount);
