// Times are reported; only what no slow machine excuses is a fault.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, texts, until } from "./browser.mjs";
import { EXAMPLES, choose, enter, opened } from "./shell.mjs";
import { filled, sections } from "./views.mjs";

const words = texts.views.map;
const SLOWEST_FRAME_MS = 100;
const SLOWEST_PICTURE_MS = 20_000;

test("the animation goes on while a map is filled", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  await page.getByLabel(texts.page.transport.speed).selectOption({ index: 3 });
  const play = page.getByRole("button", { name: texts.page.transport.play, exact: true });
  if (await play.count()) {
    await play.click();
  }
  await page.evaluate(() => {
    window.frame_times = [];
    const frame = (time) => {
      window.frame_times.push(time);
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  });
  const { map } = sections(page);
  for (const axis of [words.axis.x, words.axis.y]) {
    const cells = map.getByRole("group", { name: axis }).getByLabel(words.cells);
    await enter(cells, "256");
  }
  await filled(page);
  await until("the larger map", () => map.getByText(/^65,536 cells a device, in/).count());
  const times = await page.evaluate(() => window.frame_times);
  const steps = times
    .slice(1)
    .map((time, index) => time - times[index])
    .sort((a, b) => a - b);
  const [median, slow] = [steps[steps.length >> 1], steps[Math.floor(0.95 * steps.length)]];
  t.diagnostic(
    `${steps.length} frames: median ${median.toFixed(1)} ms, 95th percentile ${slow.toFixed(1)} ms, longest ${steps.at(-1).toFixed(0)} ms`,
  );
  t.diagnostic((await map.getByText(/cells a device, in/).textContent()).trim());
  assert.ok(median < SLOWEST_FRAME_MS, `median frame ${median} ms`);
});

test("the first picture comes soon after the page is opened", async (t) => {
  const { page } = await opened(t);
  const ready = await page.evaluate(() => performance.now());
  t.diagnostic(`first run shown ${ready.toFixed(0)} ms after the page was asked for, at most`);
  assert.ok(ready < SLOWEST_PICTURE_MS);
});
