// The sections below the block, as a user finds them.
import assert from "node:assert/strict";
import { texts, until } from "./browser.mjs";

const { map: words, loop, trust } = texts.views;

/** Sections by their headings. */
export const sections = (page) => ({
  map: page.getByRole("region", { name: words.title }),
  loop: page.getByRole("region", { name: loop.title, exact: true }),
  trust: page.getByRole("region", { name: trust.title }),
});

/** Panels of the map: of one device each. */
export const panels = (page) => sections(page).map.getByRole("application");

/** What the map says of the cell at the cursor. */
export const said = (page) => sections(page).map.getByRole("status");

/** Scrolls to the map and waits until all its cells are known. */
export async function filled(page) {
  const { map } = sections(page);
  await map.scrollIntoViewIfNeeded();
  await until("a whole map", () => map.getByText(/cells a device, in/).count());
  // The last cells are drawn at the next frame.
  await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  assert.ok((await panels(page).count()) > 0);
}

/** Colours of the cells of a panel: how many cells have each. */
export const colours = (panel) =>
  panel.locator("canvas").evaluate((canvas) => {
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const counts = {};
    for (let at = 0; at < data.length; at += 4) {
      const colour = data.slice(at, at + 4).join(" ");
      counts[colour] = (counts[colour] ?? 0) + 1;
    }
    return counts;
  });

/** The digest of what is shown. */
export const digest = (page) =>
  until("a digest", async () => {
    const facts = sections(page).trust;
    const text = await facts.locator("dt", { hasText: trust.digest }).locator("xpath=following-sibling::dd[1]").allTextContents();
    return /^[0-9a-f]{16}$/.test(text[0] ?? "") && text[0];
  });
