// Every control is used.
import assert from "node:assert/strict";
import { test } from "node:test";
import { downloaded, keep, open, texts, until } from "./browser.mjs";
import { hold, holdable, isHeld, letGo } from "./hold.mjs";
import { EXAMPLES, alert, anotherDigest, choose, enter, opened, shownDigest, thisDigest, toml } from "./shell.mjs";
import { sections } from "./views.mjs";

const words = texts.page;

test("every number of block and ground changes the run, and its first value brings it back", async (t) => {
  const { page, first } = await opened(t);
  const { size, slenderness, restitution, massRatio, amplitude, frequency } = words.controls;
  for (const name of [size, slenderness, restitution, massRatio, amplitude, frequency]) {
    const typed = page.getByRole("spinbutton", { name, exact: true });
    const own = await typed.inputValue();
    assert.notEqual(own, "", name);
    await enter(typed, Number(own) * 0.93);
    await anotherDigest(page, first);
    await enter(typed, own);
    await thisDigest(page, first);
    const slider = page.getByRole("slider", { name, exact: true });
    await slider.focus();
    await page.keyboard.press("ArrowRight");
    await anotherDigest(page, first);
    await enter(typed, own);
    await thisDigest(page, first);
  }
});

test("a box that is left empty, or with what is no number, shows its number again", async (t) => {
  const { page, first } = await opened(t);
  const { map } = sections(page);
  await until("a map", () => map.getByRole("application").count());
  for (const box of [
    page.getByRole("spinbutton", { name: words.controls.size, exact: true }),
    map.getByLabel(texts.views.map.to).first(),
  ]) {
    const own = await box.inputValue();
    for (const typed of ["", "1e"]) {
      await box.fill("");
      await box.pressSequentially(typed);
      await box.press("Tab");
      assert.equal(await box.inputValue(), own);
    }
  }
  assert.equal(await shownDigest(page), first);
});

test("a control of several devices shows what they have alike", async (t) => {
  const { page, first } = await opened(t);
  const sigma = page.getByRole("spinbutton", { name: words.controls.massRatio, exact: true });
  const mount = page.getByLabel(words.controls.mount, { exact: true });
  assert.deepEqual([await sigma.inputValue(), await mount.inputValue()], ["0.5", "centre-of-mass"]);
  const text = await toml(page).inputValue();
  const pair = 'kind = "clutched-pair"\nmass_ratio = ';
  await toml(page).fill(text.replace(`${pair}0.5`, `${pair}1.5\nmount = "base-corners"`));
  await anotherDigest(page, first);
  assert.deepEqual([await sigma.inputValue(), await mount.inputValue()], ["", ""]);
});

test("a base that slides is said, since it is not drawn", async (t) => {
  const { page, first } = await opened(t);
  // A (A − μ) g T²/(2μ), as in the test of the command.
  const newmark = ((0.4 * 0.25 * 9.80665 * 0.25) / 0.3).toFixed(4);
  await toml(page).fill(
    '[block]\nsize_m = 1.0\nslenderness_deg = 23.0\nfriction_coefficient = 0.15\nrestitution = "geometric"\n[[device]]\nkind = "none"\n' +
      '[[ground]]\nmotion = "rectangular"\namplitude_g = 0.4\nduration_s = 0.5\n',
  );
  const slid = await anotherDigest(page, first);
  assert.ok(await page.getByText(words.results.slides("none", 0, Number(newmark), -Number(newmark))).isVisible());
  await choose(page, EXAMPLES.freeRocking);
  await anotherDigest(page, slid);
  assert.equal(await page.getByText("the base slides").count(), 0);
});

/** Tilts the block and lets it go. */
async function release(page) {
  await page.getByRole("application", { name: words.block.handle }).focus();
  for (let step = 0; step < 4; step += 1) {
    await page.keyboard.press("ArrowRight");
  }
  await page.keyboard.press("Enter");
}

test("the block is dragged, let go, and shaken again", async (t) => {
  const { page, first } = await opened(t);
  await release(page);
  const free = await anotherDigest(page, first);
  assert.notEqual(free, first);
  await page.getByRole("button", { name: words.block.shake }).click();
  await thisDigest(page, first);
});

test("a block that is shaken again keeps what was changed since it was let go", async (t) => {
  const { page, first } = await opened(t);
  const resize = (sizeM) => enter(page.getByRole("spinbutton", { name: words.controls.size, exact: true }), sizeM);
  await resize("2.5");
  const larger = await anotherDigest(page, first);
  await resize("2");
  await thisDigest(page, first);
  await release(page);
  const free = await anotherDigest(page, first);
  assert.doesNotMatch(await toml(page).inputValue(), /ground\.0/, "its map goes with the ground motion");
  await resize("2.5");
  await anotherDigest(page, free);
  await page.getByRole("button", { name: words.block.shake }).click();
  await thisDigest(page, larger);
  assert.match(await toml(page).inputValue(), /ground\.0\.frequency_hz[^]*ground\.0\.amplitude_m_s2/);
});

test("a block that was let go gives another scene no ground motion", async (t) => {
  const { page, first } = await opened(t);
  await release(page);
  await anotherDigest(page, first);
  const shake = page.getByRole("button", { name: words.block.shake });
  assert.ok(await shake.isVisible());
  await choose(page, EXAMPLES.freeRocking);
  assert.ok(!(await shake.isVisible()));
});

test("a change that is made while the one before it is run stays", async (t) => {
  const { page, first } = await opened(t, { prepare: holdable });
  const add = async (kind, name) => {
    await page.getByLabel(words.controls.addDevice, { exact: true }).selectOption(kind);
    await until(name, async () => (await toml(page).inputValue()).includes(name));
  };
  await hold(page, "simulate");
  await add("inerter", "inerter 2");
  await isHeld(page, "simulate");
  await add("clutched-pair", "clutched-pair 2");
  await letGo(page, "simulate");
  await anotherDigest(page, first);
  // The first run is shown, and the second one is under way.
  await add("inerter", "inerter 3");
  assert.match(await toml(page).inputValue(), /clutched-pair 2/);
});

test("time goes where it is put, from event to event, and to the end", async (t) => {
  const { page } = await opened(t);
  const place = page.getByLabel(words.transport.time, { exact: true });
  const at = async () => Number(await place.inputValue());
  const { next, previous } = words.transport;
  await place.focus();
  await page.keyboard.press("Home");
  await until("the beginning", async () => (await at()) === 0);
  const times = [];
  for (let step = 0; step < 3; step += 1) {
    await page.getByRole("button", { name: next, exact: true }).click();
    await page.waitForTimeout(60);
    times.push(await at());
  }
  assert.ok(times[0] > 0 && times[1] >= times[0] && times[2] >= times[1], times.join());
  await page.getByRole("button", { name: previous, exact: true }).click();
  await until("the event before", async () => (await at()) <= times[2]);
});

test("a number that is typed stays while the change before it comes in", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.controller);
  const box = (name) => page.getByRole("spinbutton", { name, exact: true });
  const has = (setting) => until(setting, async () => (await toml(page).inputValue()).includes(setting));
  const { size, slenderness } = words.controls;
  const { latency, rate } = texts.views.loop;
  await box(latency).scrollIntoViewIfNeeded();
  for (const [before, changed, typed, kept] of [
    [size, ["2.5", "size_m = 2.5"], slenderness, ["12", "slenderness_deg = 12"]],
    [latency, ["2", "latency_s = 0.002"], rate, ["1000", "rate_hz = 1000"]],
  ]) {
    await enter(box(before), changed[0]);
    await box(typed).fill(kept[0]);
    await has(changed[1]);
    // Longer than whoever shows the scene waits for the next change.
    await page.waitForTimeout(600);
    assert.equal(await box(typed).inputValue(), kept[0]);
    await box(typed).press("Tab");
    await has(kept[1]);
  }
});

test("every button, list and number of the page can be used without harm", async (t) => {
  const page = await open(t, { permissions: ["clipboard-read", "clipboard-write"] });
  await choose(page, EXAMPLES.controller);
  const selector = "button:visible:enabled, select:visible:enabled, input:visible:enabled:not([type=file])";
  const done = new Set();
  for (let round = 0; round < 400; round += 1) {
    // What a control does may add and remove others: one at a time, each name once.
    const found = await page.locator(selector).evaluateAll(
      (all, done) => {
        const name = (element) =>
          `${element.tagName} ${element.type} ${element.getAttribute("aria-label") ?? element.labels?.[0]?.textContent ?? element.textContent}`;
        const index = all.findIndex((element) => !done.includes(name(element)));
        return index < 0 ? null : { index, name: name(all[index]) };
      },
      [...done],
    );
    if (found === null) {
      break;
    }
    done.add(found.name);
    const control = page.locator(selector).nth(found.index);
    const [tag, type] = found.name.split(" ");
    if (tag === "BUTTON") {
      await control.click({ timeout: 5000 }).catch(() => undefined);
    } else if (tag === "SELECT") {
      const values = await control.locator("option:enabled").evaluateAll((options) => options.map((option) => option.value));
      await control.selectOption(values.at(-1)).catch(() => undefined);
    } else if (type === "checkbox") {
      await control.click();
    } else {
      await control.focus();
      await page.keyboard.press("ArrowUp");
      await page.keyboard.press("Tab");
    }
  }
  assert.ok(done.size > 40, `${done.size} controls used`);
  await keep(page, "after-every-control");
  // Whatever they did, the page still runs a scene.
  await choose(page, EXAMPLES.nearFault);
  const digest = await shownDigest(page);
  assert.match(digest, /^[0-9a-f]{16}$/);
  assert.equal((await alert(page).innerText()).trim(), "");
});

test("results are downloaded", async (t) => {
  const { page } = await opened(t);
  const { toml, csv, svg, png } = words.scene;
  const file = async (name) => {
    const { name: suggested, bytes } = await downloaded(page, page.getByRole("button", { name, exact: true }));
    assert.equal(suggested, name);
    return bytes;
  };
  assert.match((await file(toml)).toString(), /\[block\]/);
  const lines = (await file(csv)).toString().trim().split("\n");
  assert.ok(lines.length > 100 && lines.every((line) => line.split(",").length === lines[0].split(",").length));
  assert.match((await file(svg)).toString(), /^(<\?xml[^>]*>\s*)?<svg[^]*<\/svg>\s*$/);
  assert.equal((await file(png)).subarray(1, 4).toString(), "PNG");
});
