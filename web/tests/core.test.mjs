// The core without a browser: the bits of both kinds of lanes, what it refuses, and the size of the built page.
import assert from "node:assert/strict";
import { readFile, readdir } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const core = fileURLToPath(new URL("../src/core/", import.meta.url));
const dist = fileURLToPath(new URL("../dist/", import.meta.url));

/** Largest folder of the page, compressed (bytes). */
const LARGEST = 1_500_000;

async function module(folder, name) {
  const glue = await import(join(core, folder, `${name}.js`));
  await glue.default({ module_or_path: await readFile(join(core, folder, `${name}_bg.wasm`)) });
  return glue;
}

const page = await module("page", "sprag_page");
const [plain, simd] = [await module("lanes", "sprag_lanes"), await module("lanes-simd", "sprag_lanes")];
const example = (name) => JSON.parse(page.examples()).find(([known]) => known === name)[1];
const records = { names: ["near_fault.csv"], contents: [page.near_fault_csv()] };
const scene = (text) => new page.Scene(text, records.names, records.contents);

test("digests are those of firmware and command", () => {
  const checks = JSON.parse(page.digests());
  assert.equal(checks.length, 6);
  checks.forEach((check) => assert.equal(check.computed, check.expected, check.scene));
});

test("the record made here is the one that ships", async () => {
  const shipped = await readFile(new URL("../../scenes/near_fault.csv", import.meta.url));
  assert.ok(shipped.equals(Buffer.from(page.near_fault_csv())));
});

test("lanes with SIMD and without give the same bits", () => {
  assert.deepEqual([plain.simd(), simd.simd()], [false, true]);
  const cells = Uint32Array.from({ length: 64 * 64 }, (_, cell) => cell);
  for (const geometry of ["full", "slender"]) {
    const map = scene(scene(example("figure08")).set([`block.geometry="${geometry}"`]));
    for (const device of [0, 1, 2]) {
      const [one, other] = [plain, simd].map((lanes) => map.cells(device, cells, lanes.pulses));
      assert.ok(one.outcome.some((outcome) => outcome > 1) && one.outcome.includes(1));
      assert.deepEqual(one.outcome, other.outcome);
      assert.ok(Buffer.from(one.peakRotation.buffer).equals(Buffer.from(other.peakRotation.buffer)), `${geometry}, device ${device}`);
    }
  }
});

test("the lanes with SIMD are full of it", async () => {
  // The first byte of every instruction of SIMD.
  const count = async (folder) => (await readFile(join(core, folder, "sprag_lanes_bg.wasm"))).filter((byte) => byte === 0xfd).length;
  assert.ok((await count("lanes-simd")) > 20 * (await count("lanes")));
});

test("a cell that is played is the cell of the map", () => {
  const map = scene(example("figure08"));
  const [column, row] = [20, 30];
  const [outcome] = map.cells(1, Uint32Array.of(row * 64 + column), simd.pulses).outcome;
  const { responses } = scene(map.cell(column, row)).simulate();
  const names = ["no-rocking", "safe", "overturned-without-impact", "overturned-after-impact"];
  assert.equal(JSON.parse(responses[1].summary).outcome, names[outcome]);
});

test("what it refuses is one line that names it", () => {
  const text = example("near_fault");
  for (const [work, named] of [
    [() => scene(text.replace("size_m", "sizem")), /sizem.*size_m/],
    [() => new page.Scene(text, [], []), /near_fault\.csv/],
    [() => new page.Scene(text, records.names, [Uint8Array.of(0, 159, 146, 150)]), /near_fault\.csv/],
    [() => scene(text).set(["block.size_m=-1"]), /block\.size_m.*-1/],
    [() => scene(text).map(), /map/],
    [() => scene(text).closed_loop(["a spanner"], [1]), /a spanner/],
    [() => scene(example("figure08")).cells(3, Uint32Array.of(0), simd.pulses), /3/],
    [() => scene(example("figure08")).cells(0, Uint32Array.of(64 * 64), simd.pulses), /4096/],
    [() => scene(example("figure08")).boundaries(0, Uint8Array.of(1), simd.pulses), /whole map/],
    [() => page.record("x.csv", Uint8Array.of(1, 2, 3), "furlong", 0.01), /furlong/],
    [() => simd.pulses(Float64Array.of(9, 0, 0, 0, 0, 0, 0, 0, 0)), /rows/],
  ]) {
    assert.throws(work, (problem) => {
      assert.ok(problem instanceof Error && !problem.message.includes("\n"), String(problem));
      assert.match(problem.message, named);
      return true;
    });
  }
});

test("the page is small", async () => {
  const files = await readdir(dist, { recursive: true, withFileTypes: true });
  let size = 0;
  for (const file of files.filter((entry) => entry.isFile())) {
    size += gzipSync(await readFile(join(file.parentPath, file.name)), { level: 9 }).length;
  }
  console.log(`# the page has ${size} bytes, compressed`);
  assert.ok(size <= LARGEST, `${size} bytes of at most ${LARGEST}`);
});
