// The controller in closed loop: law, sensors, delay, faults.
import assert from "node:assert/strict";
import { test } from "node:test";
import { downloaded, keep, open, scene, texts, until } from "./browser.mjs";
import { hold, holdable, isHeld, letGo } from "./hold.mjs";
import { EXAMPLES, alert, choose, enter, toml } from "./shell.mjs";
import { sections } from "./views.mjs";

const words = texts.views.loop;

/** A cell of the table of results, by the name of its row. */
async function result(page, name, column = 0) {
  const { loop } = sections(page);
  return (
    await loop
      .getByRole("row", { name: new RegExp(`^${name.replace(/[|()\\/]/g, "\\$&")}`) })
      .getByRole("cell")
      .nth(column)
      .textContent()
  ).trim();
}

const digest = (page) => result(page, words.results.digest);

async function looped(page, before) {
  return until("a closed loop", async () => {
    if ((await sections(page).loop.getByText(words.result, { exact: true }).count()) === 0) {
      return false;
    }
    const now = await digest(page);
    return now !== before && now;
  });
}

async function openLoop(t, options) {
  const page = await open(t, options);
  await choose(page, EXAMPLES.controller);
  await sections(page).loop.scrollIntoViewIfNeeded();
  const first = await looped(page, null);
  assert.match(first, /^[0-9a-f]{16}$/);
  return { page, first };
}

test("law, estimator and sensors are those of the scene's schema", async (t) => {
  const { page } = await openLoop(t);
  const { controller } = JSON.parse(await scene("scene.schema.json")).properties;
  const names = (property) => property.enum ?? property.oneOf.map((one) => one.const);
  const offered = async (label) =>
    (
      await sections(page)
        .loop.getByLabel(label, { exact: true })
        .locator("option")
        .evaluateAll((options) => options.map((option) => option.value))
    ).filter((value) => value !== "");
  assert.deepEqual((await offered(words.law)).sort(), [...names(controller.properties.law)].sort());
  assert.deepEqual((await offered(words.estimator)).sort(), [...names(controller.properties.estimator)].sort());
  assert.deepEqual((await offered(words.suite)).sort(), [...names(controller.properties.sensors.properties.suite)].sort());
});

test("every setting of the controller counts, and the same setting gives the same decisions", async (t) => {
  const { page, first } = await openLoop(t);
  const { loop } = sections(page);
  const settings = [
    [words.law, "resisting", "resisting-predicted"],
    [words.estimator, "kalman", "model-aided"],
    [words.suite, "mpu-6050", "adis16470"],
  ];
  for (const [label, other, own] of settings) {
    await loop.getByLabel(label, { exact: true }).selectOption(other);
    await looped(page, first);
    await loop.getByLabel(label, { exact: true }).selectOption(own);
    await until(`${label} as before`, async () => (await digest(page)) === first);
  }
  const numbers = [
    [words.seed, "2", "1"],
    [words.rate, "1000", "2000"],
    [words.latency, "20", "1"],
  ];
  for (const [label, other, own] of numbers) {
    await enter(loop.getByLabel(label, { exact: true }), other);
    await looped(page, first);
    const share = await result(page, words.results.wrong);
    await enter(loop.getByLabel(label, { exact: true }), own);
    await until(`${label} as before`, async () => (await digest(page)) === first);
    if (label === words.latency) {
      assert.ok(parseFloat(share) > parseFloat(await result(page, words.results.wrong)), "20 ms more delay, more wrong decisions");
    }
  }
  assert.match(await toml(page).inputValue(), /latency_s = 0.001/);
});

test("a seed is shown with all its digits", async (t) => {
  const { page } = await openLoop(t);
  const seed = sections(page).loop.getByLabel(words.seed, { exact: true });
  await enter(seed, "1234567890123457");
  await until("the seed of the scene", async () => (await toml(page).inputValue()).includes("seed = 1234567890123457"));
  // Longer than the section waits for the next change.
  await page.waitForTimeout(600);
  assert.equal(await seed.inputValue(), "1234567890123457");
});

test("a number beyond its limits is said in one line, and the scene keeps its own", async (t) => {
  const { page, first } = await openLoop(t);
  for (const [label, wrong, own, line] of [
    [words.latency, "200", "1", /controller\.latency_s is 0\.2, but must be from 0 to 0\.1 s/],
    [words.rate, "50", "2000", /controller\.rate_hz is 50, but must be from 100 to 100000 Hz/],
    [words.seed, "-1", "1", /controller\.sensors\.seed is -1, but must be a whole number/],
  ]) {
    const box = sections(page).loop.getByLabel(label, { exact: true });
    await enter(box, wrong);
    await until(`a line about ${label}`, async () => line.test(await alert(page).innerText()));
    assert.equal((await alert(page).locator("span").innerText()).split("\n").length, 1);
    await until(`${label} of the scene`, async () => (await box.inputValue()) === own);
  }
  assert.equal(await digest(page), first);
});

test("a change that comes while a loop runs is run after it", async (t) => {
  const { page, first } = await openLoop(t, { prepare: holdable });
  const delay = async (milliseconds) => {
    const box = sections(page).loop.getByLabel(words.latency, { exact: true });
    await enter(box, milliseconds);
    await until("the delay", async () => (await toml(page).inputValue()).includes(`latency_s = ${milliseconds / 1000}`));
  };
  const shows = (wanted) => until(`the loop ${wanted}`, async () => (await digest(page)) === wanted);
  await delay(3);
  const last = await looped(page, first);
  await delay(1);
  await shows(first);
  await hold(page, "loop");
  await delay(2);
  await isHeld(page, "loop");
  await hold(page, "about");
  await delay(3);
  await isHeld(page, "about");
  // The loop of 2 ms ends before the page knows what the scene with 3 ms is.
  await letGo(page, "loop");
  assert.notEqual(await looped(page, first), last);
  await hold(page);
  await letGo(page, "about");
  await shows(last);
});

test("an injected fault is found after it began, logged, and withdrawn", async (t) => {
  const { page, first } = await openLoop(t);
  const { loop } = sections(page);
  await until("no fault", () => loop.getByText(words.noFaults).count());
  const kinds = await loop.getByLabel(words.injectKind, { exact: true }).locator("option").allTextContents();
  assert.ok(kinds.length >= 8, kinds.join());
  const failing = kinds.find((kind) => /NaN/.test(kind)) ?? kinds[0];
  await loop.getByLabel(words.injectKind, { exact: true }).selectOption({ label: failing });
  await loop.getByLabel(words.injectAt, { exact: true }).fill("8");
  await loop.getByRole("button", { name: words.injectButton, exact: true }).click();
  const log = loop.getByRole("table", { name: words.log });
  await until("a fault in the log", () => log.count());
  const [time, code, fault] = await log.getByRole("row").nth(1).locator("th, td").allTextContents();
  assert.ok(parseFloat(time) >= 8 && parseFloat(time) < 10, `found at ${time} s`);
  assert.ok(Number(code) > 0 && fault.length > 5, `${code} ${fault}`);
  await keep(page, "controller");
  await keep(page, "controller-section", sections(page).loop);
  await loop.getByRole("button", { name: words.withdraw(failing) }).click();
  await until("no fault again", () => loop.getByText(words.noFaults).count());
  assert.equal(await digest(page), first);
});

test("a controller is added to a scene and taken away", async (t) => {
  const page = await open(t);
  const { loop } = sections(page);
  await loop.scrollIntoViewIfNeeded();
  await loop.getByRole("button", { name: words.add }).click();
  await looped(page, null);
  assert.match(await toml(page).inputValue(), /\[controller\]/);
  assert.equal(await loop.getByRole("img").count(), 4);
  await loop.getByRole("button", { name: words.remove }).click();
  await until("no controller", () => loop.getByRole("button", { name: words.add }).isVisible());
  assert.doesNotMatch(await toml(page).inputValue(), /\[controller/);
});

test("the history of a loop is downloaded", async (t) => {
  const { page } = await openLoop(t);
  const { loop } = sections(page);
  const { name, bytes } = await downloaded(page, loop.getByRole("button", { name: words.csv }));
  assert.equal(name, "loop.csv");
  const [head, ...lines] = bytes.toString().trim().split("\n");
  assert.match(head, /^device,time_s,ground_m_s2,rotation_rad,/);
  const times = lines.map((line) => Number(line.split(",").at(head.split(",").indexOf("time_s") - head.split(",").length)));
  assert.ok(times.length > 1000 && times.every((time, index) => index === 0 || time > times[index - 1]));
  const svg = await downloaded(page, loop.getByRole("button", { name: words.svg }));
  assert.match(svg.bytes.toString(), /^(<\?xml[^>]*>\s*)?<svg/);
});
