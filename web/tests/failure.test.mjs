// What goes wrong is said in a line, and nothing is lost.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, texts, until } from "./browser.mjs";
import { EXAMPLES, alert, anotherDigest, choose, shownDigest, thisDigest, toml } from "./shell.mjs";
import { filled, sections } from "./views.mjs";

const words = texts.page;

test("a scene with an unknown key is refused by its name, and goes on when it is mended", async (t) => {
  const page = await open(t);
  const before = await anotherDigest(page, null);
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

test("a tab that was frozen goes on without a jump and without a heap of frames", async (t) => {
  const page = await open(t, { prepare: countFrames });
  await anotherDigest(page, null);
  await page.getByLabel(words.transport.speed).selectOption({ index: 3 });
  const place = page.getByLabel(words.transport.time, { exact: true });
  await until("a block that moves", async () => Number(await place.inputValue()) > 0.02);
  const session = await page.context().newCDPSession(page);
  await session.send("Page.setWebLifecycleState", { state: "frozen" });
  await new Promise((later) => setTimeout(later, 3000));
  await session.send("Page.setWebLifecycleState", { state: "active" });
  const [before, frames] = [Number(await place.inputValue()), await page.evaluate(() => window.frames_seen)];
  await page.waitForTimeout(500);
  const [after, later] = [Number(await place.inputValue()), await page.evaluate(() => window.frames_seen)];
  assert.ok(after - before < 0.5, `${after - before} s of motion in half a second at 1/20`);
  assert.ok(later - frames < 200, `${later - frames} frames in half a second`);
  await until("a block that still moves", async () => Number(await place.inputValue()) > after);
});

test("a worker that dies is said, or replaced, and the page goes on", async (t) => {
  const page = await open(t, { prepare: keepWorkers, mayFail: true });
  const before = await anotherDigest(page, null);
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

/** Counts frames that the page asks for. */
const countFrames = (page) =>
  page.addInitScript(() => {
    window.frames_seen = 0;
    const request = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) =>
      request((time) => {
        window.frames_seen += 1;
        draw(time);
      });
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
