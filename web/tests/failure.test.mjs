// What goes wrong is said in a line, and nothing is lost.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, texts, until } from "./browser.mjs";
import { EXAMPLES, alert, anotherDigest, choose, opened, shownDigest, thisDigest, toml } from "./shell.mjs";
import { filled, sections } from "./views.mjs";

const words = texts.page;

test("a scene with an unknown key is refused by its name, and goes on when it is mended", async (t) => {
  const { page, first: before } = await opened(t);
  const good = await toml(page).inputValue();
  await toml(page).fill(good.replace("size_m", "sizes_m"));
  await until("the line", async () => /sizes_m/.test(await alert(page).innerText()));
  assert.equal((await alert(page).locator("span").innerText()).split("\n").length, 1);
  assert.equal(await shownDigest(page), before);
  await toml(page).fill(good.replace("2.0", "2.25"));
  await anotherDigest(page, before);
  await until("no line", async () => (await alert(page).innerText()).trim() === "");
  await toml(page).fill(good);
  await thisDigest(page, before);
});

test("a tab that was hidden for an hour goes on where it was, without a heap of frames", async (t) => {
  const { page } = await opened(t, { prepare: hideable });
  const place = page.getByLabel(words.transport.time, { exact: true });
  const at = async () => Number(await place.inputValue());
  await page.getByLabel(words.transport.speed).selectOption({ index: 3 });
  await until("a block that moves", async () => (await at()) > 0.02);
  await page.evaluate(() => window.hide());
  // The last frame had been asked for before.
  await page.waitForTimeout(100);
  const before = await at();
  await page.waitForTimeout(500);
  assert.equal(await at(), before, "nothing moves where nobody looks");
  const waiting = await page.evaluate(() => window.show());
  assert.ok(waiting >= 1 && waiting < 10, `${waiting} frames wait for the user`);
  await until("a block that moves again", async () => (await at()) > before);
  assert.ok((await at()) - before < 0.5, "an hour, 180 s at 1/20, is not made up for");
});

test("a worker that dies is said, or replaced, and the page goes on", async (t) => {
  const { page, first: before } = await opened(t, { prepare: keepWorkers, mayFail: true });
  await page.evaluate(() => {
    const [first] = window.workers_seen;
    first.terminate();
    first.dispatchEvent(new ErrorEvent("error", { message: "out of memory" }));
  });
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  assert.notEqual(await shownDigest(page), before);
  const count = Number(
    await sections(page)
      .trust.locator("dt", { hasText: texts.views.trust.workers })
      .locator("xpath=following-sibling::dd[1]")
      .textContent(),
  );
  assert.ok(count >= 1);
});

test("a core that cannot be loaded is said in a line", async (t) => {
  const page = await open(t, { prepare: (page) => page.route(/\.wasm$/, (route) => route.abort()), mayFail: true });
  await until("the line", async () => (await alert(page).allInnerTexts()).join("").includes(words.noEngine("").trim()));
});

/** Lets the test hide the page as browsers do: no frames until it is shown, an hour later. */
const hideable = (page) =>
  page.addInitScript(() => {
    const request = window.requestAnimationFrame.bind(window);
    let [hidden, later, waiting] = [false, 0, []];
    window.requestAnimationFrame = (draw) => (hidden ? waiting.push(draw) : request((time) => draw(time + later)));
    Object.defineProperty(document, "hidden", { get: () => hidden });
    Object.defineProperty(document, "visibilityState", { get: () => (hidden ? "hidden" : "visible") });
    const set = (value) => {
      hidden = value;
      document.dispatchEvent(new Event("visibilitychange", { bubbles: true }));
    };
    window.hide = () => set(true);
    window.show = () => {
      const draws = waiting;
      waiting = [];
      later += 3_600_000;
      set(false);
      draws.forEach((draw) => window.requestAnimationFrame(draw));
      return draws.length;
    };
  });

/** Keeps the page's workers where the test finds them. */
const keepWorkers = (page) =>
  page.addInitScript(() => {
    window.workers_seen = [];
    const Plain = window.Worker;
    window.Worker = class extends Plain {
      constructor(...given) {
        super(...given);
        window.workers_seen.push(this);
      }
    };
  });
