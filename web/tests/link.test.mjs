// The scene in the address.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, texts, until } from "./browser.mjs";
import { EXAMPLES, alert, anotherDigest, choose, enter, opened, shownDigest, thisDigest, toml } from "./shell.mjs";

const words = texts.page;

/** The address of the page, once the scene is in it. */
const sceneAddress = (page) =>
  until("the scene in the address", async () => {
    const now = new URL(page.url()).hash;
    return now.startsWith("#s=") && now;
  });

test("a link that is opened again gives the same digest", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.nearFault);
  const shipped = await shownDigest(page);
  await enter(page.getByRole("spinbutton", { name: words.controls.size }), "2.4");
  const digest = await anotherDigest(page, shipped);
  const hash = await sceneAddress(page);
  await page.waitForTimeout(600);
  const again = await open(t, { hash: new URL(page.url()).hash });
  await thisDigest(again, digest);
  assert.match(await toml(again).inputValue(), /size_m = 2\.4/);
  assert.ok(hash.length < 2000, "short enough to be sent");
});

test("the way back leads to the scene of each address", async (t) => {
  const { page, first } = await opened(t);
  await choose(page, EXAMPLES.figure08);
  const second = await anotherDigest(page, first);
  const hash = await sceneAddress(page);
  const again = await open(t);
  await thisDigest(again, first);
  await again.evaluate((to) => {
    location.hash = to;
  }, hash);
  await thisDigest(again, second);
  await again.waitForTimeout(600);
  await again.evaluate(() => history.back());
  await thisDigest(again, first);
  await again.evaluate(() => history.forward());
  await thisDigest(again, second);
});

test("an address whose event is still to come is not written over", async (t) => {
  const { page, first } = await opened(t);
  await choose(page, EXAMPLES.figure08);
  const second = await anotherDigest(page, first);
  const hash = await sceneAddress(page);
  const { page: again } = await opened(t);
  await enter(again.getByRole("spinbutton", { name: words.controls.size, exact: true }), "2.5");
  // As back and forward do, before the page hears of it.
  await again.evaluate((to) => history.replaceState(null, "", to), hash);
  await again.waitForTimeout(1000);
  assert.equal(new URL(again.url()).hash, hash);
  await again.evaluate(() => dispatchEvent(new HashChangeEvent("hashchange")));
  await thisDigest(again, second);
});

test("a scene that is too long for a link is said to be, and no link is copied", async (t) => {
  const { page } = await opened(t, { permissions: ["clipboard-read", "clipboard-write"] });
  const short = await toml(page).inputValue();
  await toml(page).fill(`${short}# ${"x".repeat(200_000)}\n`);
  const says = (line) =>
    until(line, async () => {
      await page.getByRole("button", { name: words.scene.link, exact: true }).click();
      return page.getByText(line, { exact: true }).isVisible();
    });
  await says(words.scene.tooLong);
  await page.evaluate(() => navigator.clipboard.writeText("before"));
  await says(words.scene.tooLong);
  assert.equal(await page.evaluate(() => navigator.clipboard.readText()), "before");
  await toml(page).fill(short);
  await says(words.scene.copied);
});

for (const [what, prepare] of [
  ["refuses", () => void (navigator.clipboard.writeText = () => Promise.reject(new Error("no")))],
  ["has no clipboard", () => void Object.defineProperty(navigator, "clipboard", { value: undefined })],
]) {
  test(`a link is not said to be copied where the browser ${what}`, async (t) => {
    const { page } = await opened(t, { permissions: ["clipboard-read", "clipboard-write"] });
    const link = page.getByRole("button", { name: words.scene.link, exact: true });
    const copied = page.getByText(words.scene.copied, { exact: true });
    await link.click();
    await until("a copy", () => copied.isVisible());
    await page.evaluate(prepare);
    await link.click();
    await until("a line", async () => (await alert(page).innerText()).includes(words.scene.copyFailed));
    assert.equal(await copied.isVisible(), false);
  });
}

for (const [what, change] of [
  ["cut off", (hash) => hash.slice(0, hash.length / 2)],
  ["changed", (hash) => hash.replace(/.{8}$/, "%%%%%%%%")],
  ["of nothing", () => "#s="],
]) {
  test(`an address that is ${what} gives a line and the first example`, async (t) => {
    const { page, first } = await opened(t);
    await choose(page, EXAMPLES.figure08);
    const hash = await until("the scene in the address", async () => new URL(page.url()).hash);
    const broken = await open(t, { hash: change(hash) });
    await until("a line", async () => (await alert(broken).innerText()).includes(words.scene.broken));
    await thisDigest(broken, first);
  });
}
