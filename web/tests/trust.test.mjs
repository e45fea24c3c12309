// The same bits everywhere, and how right they are.
import assert from "node:assert/strict";
import { test } from "node:test";
import { open, texts, until } from "./browser.mjs";
import { EXAMPLES, choose, shownDigest, toml } from "./shell.mjs";
import { filled, panels, sections } from "./views.mjs";

const words = texts.views.trust;
const noSimd = {
  // A machine without SIMD refuses every module that has it.
  prepare: (page) =>
    page.addInitScript(() => {
      const validate = WebAssembly.validate;
      WebAssembly.validate = (bytes) => validate(bytes) && !new Uint8Array(bytes.buffer ?? bytes).includes(0xfd);
    }),
};

/** Computes the digests on the page: rows of scene, computed, expected, verdict. */
async function computed(page) {
  const { trust } = sections(page);
  await trust.getByRole("button", { name: words.compute }).click();
  await until("digests", () => trust.getByRole("table", { name: words.caption }).count());
  const rows = await trust.getByRole("table", { name: words.caption }).locator("tbody tr").all();
  return Promise.all(rows.map((row) => row.locator("th, td").allTextContents()));
}

test("digests of the shipped scenes are those of firmware and command", async (t) => {
  const page = await open(t);
  const rows = await computed(page);
  assert.ok(rows.length >= 3, "Figures 5 and 10 and the near-fault scene");
  for (const [scene, own, expected, verdict] of rows) {
    assert.match(own, /^[0-9a-f]{8,16}$/);
    assert.equal(own, expected, scene);
    assert.equal(verdict, words.equal);
  }
  await until("a verdict", () => sections(page).trust.getByText(words.all(rows.length)).isVisible());
});

test("without SIMD the page says so, and every bit is the same", async (t) => {
  const found = [];
  for (const options of [{}, noSimd]) {
    const page = await open(t, options);
    const { trust } = sections(page);
    await until("what runs", () => trust.getByText(words.simd, { exact: true }).count());
    const simd = await trust.getByText(words.simdYes, { exact: true }).count();
    assert.equal(simd, options === noSimd ? 0 : 1);
    assert.equal(await trust.getByText(words.simdNo, { exact: true }).count(), 1 - simd);
    const digests = (await computed(page)).map((row) => row[1]);
    await choose(page, EXAMPLES.figure08);
    const run = await shownDigest(page);
    await filled(page);
    const cells = await panels(page)
      .locator("canvas")
      .evaluateAll((all) => all.map((canvas) => canvas.toDataURL()));
    found.push({ digests, run, cells });
  }
  assert.deepEqual(found[0], found[1]);
});

test("errors are reported for every device when they are asked for", async (t) => {
  const page = await open(t);
  const { trust } = sections(page);
  await until("a run", () => trust.getByText(words.noError).count());
  await trust.getByRole("button", { name: words.ask }).click();
  await until("errors", async () => (await trust.getByText(words.noError).count()) === 0);
  const facts = await trust.locator("dd").allTextContents();
  const errors = facts.filter((fact) => /peak θ\/α within \d\.\de-?\d+ \(\d\.\de-?\d+ of it\)|outcome certain|outcome in doubt/.test(fact));
  assert.equal(errors.length, 3, facts.join("\n"));
  assert.match(await toml(page).inputValue(), /level = "normal"/);
});
