// The map: filled, read, played, fixed, kept.
import assert from "node:assert/strict";
import { test } from "node:test";
import { downloaded, keep, open, texts, until } from "./browser.mjs";
import { colours, digest, filled, panels, said, sections } from "./views.mjs";
import { EXAMPLES, alert, anotherDigest, choose, enter, opened, thisDigest, toml } from "./shell.mjs";

const words = texts.views.map;
const OVERTURNED = ["54 20 38 255", "213 94 0 255"];

/** Rows of a CSV file as objects; no field of a map has a comma. */
function rows(bytes) {
  const [head, ...lines] = bytes
    .toString()
    .trim()
    .split("\n")
    .map((line) => line.split(","));
  return lines.map((line) => Object.fromEntries(head.map((name, index) => [name, line[index]])));
}

test("cells, shares, table and pictures of a map say the same", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  const { map } = sections(page);
  const table = await downloaded(page, map.getByRole("button", { name: words.csv }));
  assert.equal(table.name, "map.csv");
  const all = rows(table.bytes);
  const devices = [...new Set(all.map((row) => row.device))];
  assert.equal(await panels(page).count(), devices.length);
  for (const [index, device] of devices.entries()) {
    const own = all.filter((row) => row.device === device);
    const fallen = own.filter((row) => row.outcome.startsWith("overturned"));
    const counts = await colours(panels(page).nth(index));
    const dark = OVERTURNED.reduce((sum, colour) => sum + (counts[colour] ?? 0), 0);
    assert.equal(dark, fallen.length, `${device}: as many dark dots as overturned rows`);
    assert.equal(
      Object.values(counts).reduce((sum, count) => sum + count),
      own.length,
    );
    assert.ok(fallen.length > 0 && fallen.length < own.length);
    assert.ok(own.every((row) => (row.peak_rotation === "") === row.outcome.startsWith("overturned")));
    const share = words.share(((100 * fallen.length) / own.length).toFixed(1));
    assert.equal((await map.getByText(share, { exact: true }).count()) > 0, true, share);
  }
  const svg = (await downloaded(page, map.getByRole("button", { name: words.svg }))).bytes.toString();
  assert.equal(svg.match(/<image /g).length, devices.length);
  assert.ok(devices.every((device) => svg.includes(`>${device}<`)) && svg.startsWith("<svg xmlns="));
  const png = (await downloaded(page, map.getByRole("button", { name: words.png }))).bytes;
  assert.deepEqual(
    [...png.subarray(1, 4)],
    [..."PNG"].map((letter) => letter.charCodeAt(0)),
  );
  assert.ok(png.readUInt32BE(16) > 1000, "wide enough for print");
  await keep(page, "map");
});

test("a cell under the pointer is played, and a click makes it the scene", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  const before = await digest(page);
  const panel = panels(page).first();
  const box = await panel.locator("canvas").boundingBox();
  await page.mouse.move(box.x + 0.8 * box.width, box.y + 0.3 * box.height);
  await until("an outcome", async () => /ω_g\/p .*: .*(rocks|overturns|no rocking)/.test(await said(page).textContent()));
  const { map } = sections(page);
  await until("a block that is played", () => map.getByRole("button", { name: words.use }).isVisible());
  const played = await until("another run", async () => {
    const now = await digest(page);
    return now !== before && now;
  });
  await map.getByRole("button", { name: words.back }).click();
  await until("the scene again", async () => (await digest(page)) === before);
  await page.mouse.move(box.x + 0.8 * box.width + 1, box.y + 0.3 * box.height);
  await page.mouse.click(box.x + 0.8 * box.width, box.y + 0.3 * box.height);
  await until("the same block as the scene", async () => (await digest(page)) === played);
  await until("no block in the place of the scene", async () => !(await map.getByRole("button", { name: words.use }).isVisible()));
  // The scene is another point of the same map: nothing is filled again.
  assert.equal(await map.getByText(/cells a device, in/).count(), 1);
});

test("arrow keys move over cells, Enter takes one", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  const before = await digest(page);
  await panels(page).nth(1).focus();
  await page.keyboard.press("ArrowRight");
  const first = await said(page).textContent();
  const values = first
    .match(/ω_g\/p ([\d.]+), .*?([\d.]+): /)
    .slice(1, 3)
    .map(Number);
  assert.ok(values[0] > 3 && values[0] < 3.3 && Math.abs(values[1] - 3) < 0.1, `one cell to the right of the scene, 3 and 3: ${first}`);
  await page.keyboard.press("Shift+ArrowUp");
  const second = await said(page).textContent();
  assert.notEqual(second, first);
  await page.keyboard.press("ArrowDown");
  assert.notEqual(await said(page).textContent(), second);
  await page.keyboard.press("Enter");
  await until(
    "the block as the scene",
    async () => (await digest(page)) !== before && !(await sections(page).map.getByRole("button", { name: words.use }).isVisible()),
  );
});

test("while a cell is played, controls change the scene, and downloads are of the cell", async (t) => {
  const { page, first } = await opened(t);
  const { map } = sections(page);
  const { controls, scene } = texts.page;
  const axis = (key, from, to) => `{ key = "${key}", from = ${from}, to = ${to}, cells = 8 }`;
  const axes = `[map]\nx = ${axis("block.size_m", 1, 5)}\ny = ${axis("device.2.mass_ratio", 0.2, 1.5)}\n`;
  const text = (await toml(page).inputValue()).replace(/\[map\][^]*/, axes);
  await toml(page).fill(text);
  await map.scrollIntoViewIfNeeded();
  await until("a map of 8 x 8", () => map.getByText(/^64 cells a device, in/).count());
  const isSize = (sizeM) =>
    until(`a size of ${sizeM} m`, async () => {
      const shown = await page.getByRole("spinbutton", { name: controls.size, exact: true }).inputValue();
      return Number(shown) === sizeM;
    });
  const play = async (key) => {
    await panels(page).first().focus();
    await page.keyboard.press(key);
    await until("a block that is played", () => map.getByRole("button", { name: words.use }).isVisible());
    return anotherDigest(page, first);
  };
  await play("Shift+ArrowRight");
  await map.getByRole("button", { name: words.use }).click();
  await isSize(5);
  await toml(page).fill(text);
  await thisDigest(page, first);
  await isSize(2);

  const played = await play("Shift+ArrowLeft");
  await isSize(2);
  const { bytes } = await downloaded(page, page.getByRole("button", { name: scene.toml, exact: true }));
  await page.getByLabel(controls.addDevice, { exact: true }).selectOption("none");
  const changed = await until("another device", async () => {
    const now = await toml(page).inputValue();
    return now.includes("none 2") && now;
  });
  assert.deepEqual(
    [...changed.matchAll(/\bmass_ratio = ([\d.]+)/g)].map(([, ratio]) => Number(ratio)),
    [0.5, 0.5],
  );
  assert.match(changed, /size_m = 2(\.0)?\n/);
  await anotherDigest(page, played);
  await toml(page).fill(bytes.toString());
  await thisDigest(page, played);
});

test("axes, scale, bands, cut and boundaries", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  const { map } = sections(page);
  const up = map.getByRole("group", { name: words.axis.y });
  const across = map.getByRole("group", { name: words.axis.x });
  const outcomes = await colours(panels(page).first());
  await map.getByLabel(words.show).selectOption("peak");
  await until("bands", async () => Object.keys(await colours(panels(page).first())).length > Object.keys(outcomes).length);
  await map.getByLabel(words.show).selectOption("outcome");

  await map.getByRole("button", { name: words.boundaries }).click();
  await until("boundaries", async () => (await panels(page).first().locator("svg path").count()) > 0);
  await keep(page, "boundaries");
  await keep(page, "map-section", sections(page).map);

  await enter(across.getByLabel(words.cells), "40");
  await until("a narrower map", () =>
    panels(page)
      .first()
      .locator("canvas")
      .evaluate((canvas) => canvas.width === 40),
  );
  await across.getByLabel(words.scale).selectOption("logarithmic");
  await until("ticks of equal factors", () =>
    panels(page)
      .first()
      .locator("svg text", { hasText: /^0\.5$/ })
      .count(),
  );
  await filled(page);
  await enter(across.getByLabel(words.from), "99");
  await until("a line about the axis", () => page.getByText(words.wrongAxis).isVisible());
  await alert(page).getByRole("button", { name: texts.page.dismiss }).click();
  await enter(up.getByLabel(words.cells), "5000");
  await until("a line about the cells", () => page.getByText(words.wrongAxis).isVisible());

  await up.getByLabel(words.key).selectOption("");
  await until("one panel for a cut", async () => (await panels(page).count()) === 1);
  await until("a curve a device", async () => (await panels(page).first().locator("svg path").count()) >= 3);
  await filled(page);
  await keep(page, "cut");
});

test("the amplitude of a slender block is over gα, in map and histories", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  const says = (threshold) =>
    until(threshold, async () => {
      const titles = await panels(page).first().locator("svg text").allTextContents();
      return titles.includes(`amplitude a_g/(${threshold})`) && (await page.getByText(`±${threshold}, `).isVisible());
    });
  await says("g tan α");
  const text = await toml(page).inputValue();
  await toml(page).fill(text.replace("[block]", '[block]\ngeometry = "slender"'));
  await says("gα");
});

test("an axis is moved beyond its end by its lower end first", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  const across = sections(page).map.getByRole("group", { name: words.axis.x });
  await enter(across.getByLabel(words.from), "99");
  await until("a line about the axis", () => page.getByText(words.wrongAxis).isVisible());
  await enter(across.getByLabel(words.to), "100");
  await until("both ends", async () =>
    /from = 99\nkey = "ground.0.frequency_ratio"\n(scale = .*\n)?to = 100/.test(await toml(page).inputValue()),
  );
  assert.equal(await across.getByLabel(words.from).inputValue(), "99");
});

test("two axes that are changed at once are both changed", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.figure08);
  const { map } = sections(page);
  await map.scrollIntoViewIfNeeded();
  await filled(page);
  // Without a pause between them: the scene has not answered to the first when the second comes.
  await map.getByRole("group", { name: words.axis.x }).evaluate((group) => {
    for (const fieldset of group.parentElement.children) {
      const cells = [...fieldset.querySelectorAll("input")].at(-1);
      cells.value = "30";
      cells.dispatchEvent(new Event("change"));
    }
  });
  await until("a map of 30 x 30", () => map.getByText(/^900 cells a device, in/).count());
});

test("a map that cannot be had is said, without the panels of another, and comes when it is mended", async (t) => {
  const { page, first } = await opened(t);
  await filled(page);
  const { map } = sections(page);
  const text = await toml(page).inputValue();
  const wrong = text.replace("size_m = 2.0", "size_m = 2.5").replace("from = 0.5", "from = -0.5");
  await toml(page).fill(wrong);
  await anotherDigest(page, first);
  const isSaid = async () => /frequency_hz/.test(await alert(page).innerText());
  await until("a line", isSaid);
  await until("no panel", async () => (await panels(page).count()) === 0);
  // Longer than the run that goes well takes.
  await page.waitForTimeout(500);
  assert.ok(await isSaid());
  await alert(page).getByRole("button", { name: texts.page.dismiss }).click();
  await map.getByRole("button", { name: words.fill, exact: true }).click();
  await until("the line again", isSaid);
  await toml(page).fill(text);
  await filled(page);
  await until("no line", async () => (await alert(page).innerText()).trim() === "");
});

test("a map over a device goes with the device", async (t) => {
  const { page, first } = await opened(t);
  const { map } = sections(page);
  await map.scrollIntoViewIfNeeded();
  const own = await toml(page).inputValue();
  await toml(page).fill(own.replace("size_m = 2.0", "size_m = 2.5").replace("ground.0.frequency_hz", "device.2.mass_ratio"));
  const second = await anotherDigest(page, first);
  await page.getByRole("button", { name: texts.page.controls.remove("clutched pair"), exact: true }).click();
  await anotherDigest(page, second);
  await until("no map", () => map.getByText(words.noMap, { exact: true }).isVisible());
  assert.doesNotMatch(await toml(page).inputValue(), /device\.2/);
  assert.equal((await alert(page).innerText()).trim(), "");
});

test("a map is stopped, filled again, and dropped for another scene", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.nearFault);
  const { map } = sections(page);
  const fill = map.getByRole("button", { name: words.fill, exact: true });
  await map.scrollIntoViewIfNeeded();
  await fill.click();
  await until("some cells, not all", () => map.getByText(/^([1-9]|[1-8]\d) % of the cells known$/).count());
  await map.getByRole("button", { name: words.stop, exact: true }).click();
  const stopped = await until("a stopped map", () => map.getByText(new RegExp(`, ${words.stopped}$`)).textContent());
  await page.waitForTimeout(500);
  assert.equal(await map.getByText(new RegExp(`, ${words.stopped}$`)).textContent(), stopped, "no cell comes any more");
  await fill.click();
  await until("a map that is filled again", () => map.getByRole("button", { name: words.stop, exact: true }).count());
  await choose(page, EXAMPLES.figure08);
  await filled(page);
  assert.equal(await map.getByText(words.whole(64 * 64, "").slice(0, 12)).count(), 1, "the map of the other scene");
  assert.equal(await panels(page).count(), 3);
});
