// The built page in a real Chromium, served from a sub-path by a static server on 127.0.0.1.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { mkdir, readFile } from "node:fs/promises";
import { after } from "node:test";
import { extname, join, normalize, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";
import { runnerImport } from "vite";

const web = fileURLToPath(new URL("..", import.meta.url));
const dist = process.env.SPRAG_PAGE || join(web, "dist");
const SUB_PATH = "/some/where/";
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm", ".svg": "image/svg+xml" };

/** The texts of the page, by which its elements are found. */
export const { texts } = (await runnerImport(join(web, "src/texts/index.ts"), { configFile: false, logLevel: "error" })).module;

/** A file of the repository's scenes. */
export const scene = (name) => readFile(join(web, "../scenes", name));

async function serve() {
  const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, "http://localhost").pathname);
    const name = normalize(path.endsWith("/") ? `${path}index.html` : path);
    const body = name.startsWith(SUB_PATH) ? await readFile(join(dist, name.slice(SUB_PATH.length))).catch(() => null) : null;
    response.writeHead(body === null ? 404 : 200, { "content-type": TYPES[extname(name)] ?? "application/octet-stream" });
    response.end(body);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  return server;
}

let started;

/** One browser for all tests of a file, which have contexts of their own. */
function browser() {
  started ??= chromium.launch({ executablePath: process.env.SPRAG_CHROMIUM || "/usr/bin/chromium", args: ["--no-sandbox"] });
  return started;
}

after(async () => (await started)?.close());

/**
 * Opens the page once for a test `t`, which closes it. `options`: those of a browser context, `hash` of the address,
 * `prepare(page)` before the page is loaded, `mayFail`: errors on the console are no fault. The page has `faults`, what went wrong in it.
 */
export async function open(t, { hash = "", prepare, mayFail = false, ...options } = {}) {
  const server = await serve();
  const context = await (await browser()).newContext({ viewport: { width: 1024, height: 900 }, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const faults = [];
  page.on("pageerror", (error) => faults.push(error.stack ?? error.message));
  page.on(
    "console",
    (message) => message.type() === "error" && !message.location().url.endsWith("favicon.ico") && faults.push(message.text()),
  );
  const own = `http://127.0.0.1:${server.address().port}`;
  page.on("request", (request) => {
    const local = ["data:", "blob:"].includes(new URL(request.url()).protocol) || request.url().startsWith(own);
    if (!local) {
      faults.push(`asks for ${request.url()}`);
    }
  });
  t.after(async () => {
    await context.close();
    server.close();
    if (!mayFail) {
      assert.deepEqual(faults, [], "the page reports no errors and asks nobody else for anything");
    }
  });
  await prepare?.(page);
  page.address = `${own}${SUB_PATH}`;
  await page.goto(page.address + hash);
  return page;
}

/** Keeps a picture of the whole page, or of `part` of it alone, in the folder that SPRAG_SCREENSHOTS names, from the root. */
export async function keep(page, name, part) {
  const named = process.env.SPRAG_SCREENSHOTS;
  if (named) {
    const folder = resolve(web, "..", named);
    await mkdir(folder, { recursive: true });
    const path = join(folder, `${name}.png`);
    await (part ? part.screenshot({ path }) : page.screenshot({ path, fullPage: true }));
  }
}

/** Waits until `found()` gives something that is true, and returns it; fails after `seconds` with `what`. */
export async function until(what, found, seconds = 30) {
  const end = Date.now() + 1000 * seconds;
  for (;;) {
    const value = await found();
    if (value) {
      return value;
    }
    assert.ok(Date.now() < end, `${what} within ${seconds} s`);
    await new Promise((later) => setTimeout(later, 30));
  }
}

/** Bytes of the file that a press of `button` gives. */
export async function downloaded(page, button) {
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}
