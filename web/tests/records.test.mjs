// Own records: dropped, refused, and never sent anywhere.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, scene, texts, until } from "./browser.mjs";
import { EXAMPLES, alert, anotherDigest, choose, drop, dropAll, opened, shownDigest, thisDigest, toml } from "./shell.mjs";

const words = texts.page.records;

/** A near-harmonic motion of 3 s with 2 m/s² that starts and ends at rest. */
const MOTION = `time_s,acceleration_m_s2\n${Array.from({ length: 301 }, (_, index) => {
  const time = index / 100;
  return `${time.toFixed(2)},${(2 * Math.sin((2 * Math.PI * time) / 1.5) * Math.sin((Math.PI * time) / 3) ** 2).toFixed(6)}`;
}).join("\n")}\n`;

test("a record that is dropped shakes the block", async (t) => {
  const { page, first: before } = await opened(t);
  await drop(page, "own.csv", MOTION);
  await anotherDigest(page, before);
  assert.match(await toml(page).inputValue(), /file = "own.csv"/);
  await until("what the record is", () => page.getByText(/own\.csv: .*301 samples of 0\.01 s/).count());
});

test("the shipped record, dropped, gives the digest of the shipped scene", async (t) => {
  const { page } = await opened(t);
  await choose(page, EXAMPLES.nearFault);
  const shipped = await shownDigest(page);
  const bytes = await scene("near_fault.csv");
  await choose(page, EXAMPLES.figure08);
  await choose(page, EXAMPLES.nearFault);
  await drop(page, "near_fault.csv", bytes.toString());
  await thisDigest(page, shipped);
});

test("a link asks for an own record of the shipped one's name, and takes the shipped one itself", async (t) => {
  const page = await open(t, { permissions: ["clipboard-read", "clipboard-write"] });
  await choose(page, EXAMPLES.nearFault);
  const shipped = await shownDigest(page);
  const hash = () =>
    until("the scene in the address", async () => {
      const now = new URL(page.url()).hash;
      return /^#[so]=/.test(now) && now;
    });
  const toShipped = await hash();
  await page.getByRole("button", { name: texts.page.scene.link, exact: true }).click();
  await until("a copy without a warning", () => page.getByText(texts.page.scene.copied, { exact: true }).isVisible());
  await drop(page, "near_fault.csv", MOTION);
  const own = await anotherDigest(page, shipped);
  const toOwn = await until("another address", async () => (await hash()) !== toShipped && hash());
  await page.getByRole("button", { name: texts.page.scene.link, exact: true }).click();
  await until("a warning", () => page.getByText(texts.page.scene.linkRecords).isVisible());

  await page.evaluate((to) => void (location.hash = to), toShipped);
  await thisDigest(page, shipped);

  const other = await open(t, { hash: toOwn });
  await until("a line", async () => /no record "near_fault.csv"/.test(await alert(other).innerText()));
  assert.equal(await shownDigest(other), null);
  await drop(other, "near_fault.csv", MOTION);
  await thisDigest(other, own);
});

test("a shipped scene that is pasted has its record", async (t) => {
  const { page, first } = await opened(t, { permissions: ["clipboard-read", "clipboard-write"] });
  const text = (await scene("near_fault.toml")).toString();
  await page.evaluate((text) => navigator.clipboard.writeText(text), text);
  await page.getByRole("button", { name: texts.page.scene.paste, exact: true }).click();
  const pasted = await anotherDigest(page, first);
  await choose(page, EXAMPLES.figure08);
  await choose(page, EXAMPLES.nearFault);
  await thisDigest(page, pasted);
});

test("a scene that is dropped is opened, with the records beside it", async (t) => {
  const { page, first } = await opened(t);
  const text = (await toml(page).inputValue()).replace(/size_m = .*/, "size_m = 3.25");
  await drop(page, "scene.toml", text);
  const larger = await anotherDigest(page, first);
  assert.equal(await toml(page).inputValue(), text);
  const block = "block = { size_m = 2.0, slenderness_deg = 10.0 }";
  const shaken = `${block}\ndevice = [{ kind = "none" }]\nground = [{ motion = "record", file = "own.csv" }]\n`;
  await dropAll(page, [
    ["own.csv", MOTION],
    ["SCENE.TOML", shaken],
  ]);
  await anotherDigest(page, larger);
  assert.equal(await toml(page).inputValue(), shaken);
});

test("units are asked for where a record has none", async (t) => {
  const { page, first: before } = await opened(t);
  await drop(page, "bare.txt", MOTION.replace(/^.*\n/, "").replace(/^.*,/gm, ""));
  await until("the question", () => page.getByLabel(words.units).isVisible());
  assert.equal(await shownDigest(page), before, "nothing is lost");
  await page.getByLabel(words.units).selectOption({ index: 1 });
  await page.getByLabel(words.step).fill("0.01");
  await page.getByRole("button", { name: words.again }).click();
  await anotherDigest(page, before);
});

test("a record is not said to be unreadable where it is the scene that is broken", async (t) => {
  const { page } = await opened(t);
  const text = await toml(page).inputValue();
  await toml(page).fill(text.replace("size_m", "sizes_m"));
  await until("a line", async () => /sizes_m/.test(await alert(page).innerText()));
  await alert(page).getByRole("button", { name: texts.page.dismiss }).click();
  await drop(page, "own.csv", MOTION);
  await until("the line again", async () => /^scene:\d+: block\.sizes_m/.test(await alert(page).innerText()));
  assert.equal(await page.getByText(words.unreadable("own.csv", ""), { exact: false }).count(), 0);
});

for (const [what, name, content, line] of [
  ["a binary file", "picture.at2", Uint8Array.from({ length: 5000 }, (_, index) => (index * 7919) % 256), /picture\.at2/],
  ["an empty file", "empty.csv", "", /empty\.csv/],
  ["a file of 200 MB", "huge.csv", 200, /huge\.csv.*200 MB/],
]) {
  test(`${what} gives one line and takes nothing away`, async (t) => {
    const { page, first: before } = await opened(t);
    await drop(page, name, content);
    await until("a line", async () => line.test(await page.locator("body").innerText()));
    const said = (await alert(page).allInnerTexts()).join("\n");
    assert.ok(said.trim().split("\n").length <= 3, said);
    assert.equal(await shownDigest(page), before);
    await drop(page, "own.csv", MOTION);
    await anotherDigest(page, before);
  });
}
