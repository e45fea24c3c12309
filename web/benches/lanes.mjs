// Cells a second of the lanes on one core of Node's engine, which is Chromium's: Figure 8's map of 64 x 64 cells, both pulses, all devices, as
// `cargo bench --bench maps` has it natively. Prints a line a geometry: its name, cells a second with SIMD and without.
import { readFile } from "node:fs/promises";

const core = new URL("../src/core/", import.meta.url);
const PASSES = 9;

async function module(folder, name) {
  const glue = await import(new URL(`${folder}/${name}.js`, core));
  await glue.default({ module_or_path: await readFile(new URL(`${folder}/${name}_bg.wasm`, core)) });
  return glue;
}

const page = await module("page", "sprag_page");
const [, text] = JSON.parse(page.examples()).find(([name]) => name === "figure08");
const cells = Uint32Array.from({ length: 64 * 64 }, (_, cell) => cell);

/** The rows of blocks of a whole map of every device, under both pulses. */
function blocks(geometry) {
  const rows = [];
  for (const motion of ["sine", "cosine"]) {
    const scene = new page.Scene(new page.Scene(text, [], []).set([`block.geometry="${geometry}"`, `ground.0.motion="${motion}"`]), [], []);
    for (const device of [0, 1, 2]) {
      scene.cells(device, cells, (blocks) => {
        rows.push(blocks);
        // A result a block: it is not asked what becomes of them.
        return new Float64Array((blocks.length / 9) * 3);
      });
    }
  }
  return rows;
}

const simd = await module("lanes-simd", "sprag_lanes");
const plain = await module("lanes", "sprag_lanes");
for (const geometry of ["full", "slender"]) {
  const rows = blocks(geometry);
  const rate = (lanes) => {
    let least = Infinity;
    for (let pass = 0; pass < PASSES; pass++) {
      const start = performance.now();
      rows.forEach((blocks) => lanes.pulses(blocks));
      least = Math.min(least, performance.now() - start);
    }
    return Math.round((rows.length * cells.length * 1000) / least);
  };
  console.log(geometry, rate(simd), rate(plain));
}
