// The scene in the address.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, texts, until } from "./browser.mjs";
import { EXAMPLES, alert, anotherDigest, choose, shownDigest, thisDigest, toml } from "./shell.mjs";

const words = texts.page;

test("a link that is opened again gives the same digest", async (t) => {
  const page = await open(t);
  await choose(page, EXAMPLES.nearFault);
  const shipped = await shownDigest(page);
  const size = page.getByRole("spinbutton", { name: words.controls.size });
  await size.fill("2.4");
  await size.press("Tab");
  const digest = await anotherDigest(page, shipped);
  const hash = await until("the scene in the address", async () => {
    const now = new URL(page.url()).hash;
    return now.startsWith("#s=") && now;
  });
  await page.waitForTimeout(600);
  const again = await open(t, { hash: new URL(page.url()).hash });
  await thisDigest(again, digest);
  assert.match(await toml(again).inputValue(), /size_m = 2\.4/);
  assert.ok(hash.length < 2000, "short enough to be sent");
});

for (const [what, change] of [
  ["cut off", (hash) => hash.slice(0, hash.length / 2)],
  ["changed", (hash) => hash.replace(/.{8}$/, "%%%%%%%%")],
  ["of nothing", () => "#s="],
]) {
  test(`an address that is ${what} gives a line and the first example`, async (t) => {
    const page = await open(t);
    const first = await anotherDigest(page, null);
    await choose(page, EXAMPLES.figure08);
    const hash = await until("the scene in the address", async () => new URL(page.url()).hash);
    const broken = await open(t, { hash: change(hash) });
    await until("a line", async () => (await alert(broken).innerText()).includes(words.scene.broken));
    await thisDigest(broken, first);
  });
}
