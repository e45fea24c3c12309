// The page around the views, as a user finds it.
import { open, texts, until } from "./browser.mjs";

const words = texts.page;

/** Titles of scenes that ship. */
export const EXAMPLES = {
  figure08: "Figure 8",
  freeRocking: "Free rocking",
  nearFault: "Near-fault motion",
  controller: "Closed loop under a near-fault motion",
};

/** Opens the page as `open` does, and waits for the digest of its first run. */
export async function opened(t, options) {
  const page = await open(t, options);
  return { page, first: await anotherDigest(page, null) };
}

/** Opens a shipped scene, and waits until it has run. */
export async function choose(page, title) {
  const list = page.getByLabel(words.controls.example, { exact: true });
  await until("a list of examples", async () => (await list.locator("option", { hasText: title }).count()) > 0);
  // The first run may still be under way, and would be taken for this one.
  const before = await until("a run", () => shownDigest(page));
  await list.selectOption({ label: title });
  await until(`a run of ${title}`, async () => (await toml(page).inputValue()).includes(title) && (await shownDigest(page)) !== before);
}

/** Types `value` into `box` and leaves it, which is when it counts. */
export async function enter(box, value) {
  await box.fill(String(value));
  await box.press("Tab");
}

/** The text of the scene. */
export const toml = (page) => page.getByLabel(words.scene.edit);

/** The digest of the run that is shown; null before the first. */
export async function shownDigest(page) {
  const text = await page.locator("p", { hasText: words.scene.digest }).locator("code").textContent();
  return /^[0-9a-f]{16}$/.test(text) ? text : null;
}

/** Waits for another digest than `before`, and returns it. */
export const anotherDigest = (page, before) =>
  until("another run", async () => {
    const now = await shownDigest(page);
    return now !== null && now !== before && now;
  });

/** Waits for this digest. */
export const thisDigest = (page, digest) => until(`the run ${digest}`, async () => (await shownDigest(page)) === digest);

/** What went wrong last, as the page says it. */
export const alert = (page) => page.getByRole("alert");

/** Drops a file with this name and content on the page. `content` is a string, bytes, or a number of megabytes of zeros. */
export async function drop(page, name, content) {
  await dropAll(page, [[name, content]]);
}

/** Drops files of these names and contents on the page together. */
export async function dropAll(page, files) {
  const plain = files.map(([name, content]) => [name, content instanceof Uint8Array ? [...content] : content]);
  const transfer = await page.evaluateHandle((files) => {
    const megabyte = new Uint8Array(1_000_000);
    const parts = (content) =>
      typeof content === "string" ? [content] : typeof content === "number" ? Array(content).fill(megabyte) : [new Uint8Array(content)];
    const transfer = new DataTransfer();
    files.forEach(([name, content]) => transfer.items.add(new File(parts(content), name)));
    return transfer;
  }, plain);
  for (const kind of ["dragenter", "dragover", "drop"]) {
    await page.dispatchEvent("body", kind, { dataTransfer: transfer });
  }
}
