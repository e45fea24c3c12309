// For everyone: screen readers, keyboards, narrow and wide screens, dark and light.
import assert from "node:assert/strict";
import { test } from "node:test";
import { AxeBuilder } from "@axe-core/playwright";
import { keep, open, texts, until } from "./browser.mjs";
import { EXAMPLES, anotherDigest, choose, enter, opened, shownDigest, toml } from "./shell.mjs";
import { filled, panels, said, sections } from "./views.mjs";

const words = texts.page;

/** The page with everything that it can show. */
async function full(t, options) {
  const page = await open(t, options);
  await choose(page, EXAMPLES.controller);
  await sections(page).loop.scrollIntoViewIfNeeded();
  await until("a closed loop", () => sections(page).loop.getByText(texts.views.loop.result, { exact: true }).count());
  const { map: words } = texts.views;
  for (const axis of [words.axis.x, words.axis.y]) {
    const cells = sections(page).map.getByRole("group", { name: axis }).getByLabel(words.cells);
    await enter(cells, "24");
    await until(
      "a map of this size",
      async () => (await toml(page).inputValue()).split("cells = 24").length > (axis === words.axis.y ? 2 : 1),
    );
  }
  await filled(page);
  await sections(page).trust.getByRole("button", { name: texts.views.trust.compute }).click();
  await until("digests", () => sections(page).trust.getByRole("table").count());
  return page;
}

for (const colorScheme of ["light", "dark"]) {
  test(`axe finds no serious fault, ${colorScheme}`, async (t) => {
    const page = await full(t, { colorScheme });
    const { violations } = await new AxeBuilder({ page }).analyze();
    const serious = violations.filter(({ impact }) => impact === "serious" || impact === "critical");
    const named = serious.map(
      ({ id, nodes }) => `${id}: ${nodes.map(({ target, failureSummary }) => `${target.join(" ")} ${failureSummary}`).join("; ")}`,
    );
    assert.deepEqual(named, []);
    await keep(page, `page-1024-${colorScheme}`);
    await keep(page, `block-section-${colorScheme}`, page.locator(".top"));
  });
}

for (const width of [360, 1024, 2560]) {
  test(`nothing sticks out at ${width} px`, async (t) => {
    const page = await full(t, { viewport: { width, height: 900 } });
    const out = await page.evaluate(() => {
      const limit = document.documentElement.clientWidth;
      return document.documentElement.scrollWidth > limit ? `page ${document.documentElement.scrollWidth} of ${limit} px` : "";
    });
    assert.equal(out, "");
    await page.evaluate(() => scrollTo(0, 0));
    await keep(page, `page-${width}`);
  });
}

test("every control has a name, and is reached by Tab with a focus that is seen", async (t) => {
  const page = await full(t, {});
  await page.getByLabel(words.theme.label, { exact: true }).focus();
  const count = await page
    .locator("button:visible:enabled, select:visible:enabled, input:visible:enabled, textarea:visible, [tabindex='0']:visible")
    .count();
  const seen = new Set();
  for (let step = 0; step < 3 * count + 20; step += 1) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => {
      const element = document.activeElement;
      if (element === null || element === document.body) {
        return null;
      }
      element.dataset.walk ??= String(document.querySelectorAll("[data-walk]").length + 1);
      const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(element);
      const name = element.getAttribute("aria-label") || element.labels?.[0]?.textContent || element.textContent || element.title;
      return {
        walk: element.dataset.walk,
        name: (name ?? "").trim(),
        shown: (outlineStyle !== "none" && parseFloat(outlineWidth) > 0) || boxShadow !== "none",
      };
    });
    if (at === null) {
      break;
    }
    assert.ok(at.name !== "", `element ${at.walk} has a name`);
    assert.ok(at.shown, `the focus on “${at.name}” is seen`);
    seen.add(at.walk);
  }
  assert.ok(seen.size >= 0.8 * count, `${seen.size} of ${count} controls reached (a group of radio buttons counts once)`);
});

test("by keyboard alone: an example is chosen, played, and a block taken from its map", async (t) => {
  const { page, first } = await opened(t);
  const list = page.getByLabel(words.controls.example, { exact: true });
  await until("examples", async () => (await list.locator("option").count()) > 3);
  await list.focus();
  for (let step = 0; step < 20 && !(await list.locator("option:checked").textContent()).startsWith(EXAMPLES.figure08); step += 1) {
    await page.keyboard.press("ArrowDown");
  }
  const second = await anotherDigest(page, first);
  const block = page.getByRole("application", { name: words.block.handle });
  await block.focus();
  const playing = () => page.getByRole("button", { name: words.transport.pause, exact: true }).count();
  const before = await playing();
  await page.keyboard.press("Space");
  await until("play or pause", async () => (await playing()) !== before);
  await filled(page);
  await panels(page).first().focus();
  await page.keyboard.press("Shift+ArrowRight");
  await until("what the cell is", async () => (await said(page).textContent()).length > 10);
  await page.keyboard.press("Enter");
  await anotherDigest(page, second);
});

test("a user who wants less motion sees none that was not asked for", async (t) => {
  const { page } = await opened(t, { reducedMotion: "reduce" });
  await page.waitForTimeout(500);
  assert.equal(Number(await page.getByLabel(words.transport.time, { exact: true }).inputValue()), 0);
  await page.getByRole("button", { name: words.transport.play, exact: true }).click();
  await until(
    "motion once it is asked for",
    async () => Number(await page.getByLabel(words.transport.time, { exact: true }).inputValue()) > 0,
  );
  assert.notEqual(await shownDigest(page), null);
});
