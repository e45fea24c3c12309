// The parts of map and controller that need no browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { runnerImport } from "vite";

const load = async (name) =>
  (await runnerImport(fileURLToPath(new URL(`../src/${name}.ts`, import.meta.url)), { configFile: false, logLevel: "error" })).module;

const { Field, UNKNOWN } = await load("map/field");
const { Span, tickText } = await load("map/ticks");
const { bandColour, bandLimits, bandOf, OUTCOME_COLOURS, LIGHT_TO_DARK } = await load("map/classes");
const { isAxis, mapIdentity, suggestedPair } = await load("map/axis");
const { Filling } = await load("map/filling");
const { mapCsv } = await load("map/table");
const { fillMap } = await load("pool/fill_map");
const { resampled } = await load("loop/series");
const { stretches } = await load("stretches");
const { errorWords } = await load("trust/error_words");

/** Cells of one device with the outcome `of(cell)`. */
const cells = (numbers, of) => ({
  device: 0,
  cells: Uint32Array.from(numbers),
  outcome: Uint8Array.from(numbers, of),
  peakRotation: Float64Array.from(numbers, () => 0.5),
  peakAcceleration: Float64Array.from(numbers, () => 1.5),
});

/** Numbers of the cells at every `width`th column and row that are not at every `2 width`th, or are, if `all`. */
const level = (columns, rows, width, all) =>
  Array.from({ length: columns * rows }, (_, cell) => cell).filter((cell) => {
    const on = (step) => (cell % columns) % step === 0 && Math.floor(cell / columns) % step === 0;
    return on(width) && (all || !on(2 * width));
  });

test("a coarse cell stands for its neighbours until they come, in whatever order", () => {
  const [columns, rows] = [37, 21];
  const field = new Field(columns, rows);
  const truth = (cell) => (cell * 7919) % 4;
  field.add(cells(level(columns, rows, 8, true), truth));
  assert.ok(
    Array.from({ length: columns * rows }, (_, cell) => field.at(cell)).every((shown) => shown !== null),
    "no hole after the first level",
  );
  assert.equal(field.at(9 * columns + 9), 8 * columns + 8);
  assert.equal(field.outcome[9 * columns + 9], UNKNOWN);
  for (const part of [level(columns, rows, 4), level(columns, rows, 2), level(columns, rows, 1)]) {
    field.add(cells(part.slice().reverse(), truth));
  }
  assert.ok(field.whole);
  for (let cell = 0; cell < columns * rows; cell += 1) {
    assert.equal(field.at(cell), cell);
    assert.equal(field.outcome[cell], truth(cell));
  }
  assert.equal(field.overturned, Array.from(field.outcome).filter((outcome) => outcome >= 2).length);
});

test("a map of which a part fails asks for no more parts", async () => {
  const axis = new Float64Array(256);
  let asked = 0;
  const work = async () => {
    asked += 1;
    const number = asked;
    await new Promise(setImmediate);
    if (number === 3) {
      throw new Error("part 3");
    }
  };
  const map = { devices: ["a", "b"], x: axis, y: axis };
  await assert.rejects(fillMap(map, work, 4, new AbortController().signal), /part 3/);
  const before = asked;
  // The parts that were under way end.
  for (let turn = 0; turn < 20; turn += 1) {
    await new Promise(setImmediate);
  }
  assert.equal(asked, before);
});

test("ticks are round, inside, at their values, and few", () => {
  for (const [from, to, scale] of [
    [0.2, 8, "linear"],
    [-0.003, 0.004, "linear"],
    [0.2, 8, "logarithmic"],
    [1e-4, 1e5, "logarithmic"],
    [2, 3, "logarithmic"],
    [1e6, 5e6, "linear"],
    [1e6, 1.2e6, "linear"],
    [-1.2e-5, -1e-5, "linear"],
  ]) {
    const span = Span.ofCells(
      Float64Array.from({ length: 64 }, (_, cell) =>
        scale === "linear" ? from + ((to - from) * cell) / 63 : from * (to / from) ** (cell / 63),
      ),
      scale,
    );
    assert.ok(Math.abs(span.place(from) - 1 / 128) < 1e-9 && Math.abs(span.place(to) - 127 / 128) < 1e-9, "cells lie half a cell inside");
    const ticks = span.ticks(6);
    const labelled = ticks.filter(({ text }) => text !== "");
    assert.ok(labelled.length >= 2 && labelled.length <= 14, `${from} to ${to}: ${labelled.map(({ text }) => text)}`);
    for (const { place, text } of labelled) {
      assert.ok(place >= -1e-9 && place <= 1 + 1e-9);
      assert.ok(Math.abs(span.place(Number(text.replaceAll("\u2212", "-"))) - place) < 1e-6, text);
    }
  }
  assert.equal(tickText(-0.5, 0.1), "\u22120.5");
  const [low, step] = [1e6, 5e4];
  const texts = [0, 1, 2, 3, 4].map((index) => tickText(low + index * step, step));
  assert.deepEqual(texts, ["1e6", "1.05e6", "1.1e6", "1.15e6", "1.2e6"]);
});

test("bands are round and few, find their values, and fall in brightness", () => {
  const grey = ([red, green, blue]) => 0.299 * red + 0.587 * green + 0.114 * blue;
  for (const largest of [0.003, 0.9, 1.07, 4.4, 12, 99, 3e5]) {
    const limits = bandLimits(largest);
    assert.ok(limits.length >= 5 && limits.length <= 15 && limits.at(-1) <= largest);
    limits.forEach((limit, band) => {
      assert.equal(bandOf(limits, limit), band, `${limit} of ${largest}`);
      assert.equal(bandOf(limits, limit + 0.49 * limits[1]), band);
    });
    assert.equal(bandOf(limits, 10 * largest), limits.length - 1);
    const greys = limits.map((_, band) => grey(bandColour(band, limits.length)));
    assert.ok(greys.every((value, band) => band === 0 || greys[band - 1] - value > 5));
  }
  const greys = LIGHT_TO_DARK.map((outcome) => grey(OUTCOME_COLOURS[outcome]));
  assert.ok(greys.every((value, place) => place === 0 || greys[place - 1] - value > 45));
});

test("a map is the same for every scene that is a point of it, and no other", () => {
  const axes = {
    x: { key: "ground.0.frequency_ratio", from: 0.2, to: 8, cells: 64, scale: "linear" },
    y: { key: "ground.0.amplitude_ratio", from: 1, to: 10, cells: 64, scale: "linear" },
  };
  const scene = (frequency, amplitude, restitution, title = "a") => ({
    title,
    block: { restitution },
    ground: [{ motion: "sine", frequency_ratio: frequency, amplitude_ratio: amplitude }],
    map: { ...axes, overturned_at: "no-return" },
  });
  const identity = (...values) => mapIdentity(axes, scene(...values), []);
  assert.equal(identity(3, 3, 0.85), identity(5, 1, 0.85, "b"));
  assert.notEqual(identity(3, 3, 0.85), identity(3, 3, 0.9));
  const [own, other] = ["1", "2"].map((text) => ({ name: "own.csv", bytes: new TextEncoder().encode(text) }));
  const shaken = (frequency, record) => mapIdentity(axes, scene(frequency, 3, 0.85), [record]);
  assert.notEqual(shaken(3, own), identity(3, 3, 0.85));
  assert.equal(shaken(3, own), shaken(5, own));
  assert.notEqual(shaken(3, own), shaken(3, other), "two files of one name");
});

test("a cell that is taken keeps the whole map of its scene", async () => {
  const x = { key: "controller.latency_s", from: 0, to: 0.05, cells: 16, scale: "linear" };
  const engine = { mapAbout: async () => ({ devices: [], x: [], y: [] }) };
  const resolved = { map: { x, overturned_at: "slenderness", laws: ["resisting", "look-ahead"] } };
  const { setting } = await Filling.of(engine, { text: "", records: [] }, { x, y: null }, resolved);
  const axis = '{ key = "controller.latency_s", from = 0, to = 0.05, cells = 16, scale = "linear" }';
  assert.equal(setting, `map={ x = ${axis}, overturned_at = "slenderness", laws = ["resisting", "look-ahead"] }`);
});

test("axes are suggested of what the scene sets, and wrong ones refused", () => {
  const key = (name, value) => ({ key: name, value, unit: "", range: "", description: "" });
  const pair = suggestedPair([
    key("block.size_m", 2),
    key("block.restitution", 0.85),
    key("ground.0.amplitude_g", null),
    key("ground.0.scale", 1),
  ]);
  assert.deepEqual([pair.x.key, pair.y.key], ["block.size_m", "ground.0.scale"]);
  assert.ok(isAxis(pair.x) && isAxis(pair.y));
  assert.equal(suggestedPair([key("block.size_m", 2)]), null);
  for (const wrong of [
    { from: 3, to: 2 },
    { cells: 1 },
    { cells: 2.5 },
    { cells: 5000 },
    { from: 0, scale: "logarithmic" },
    { to: Number.NaN },
  ]) {
    assert.ok(!isAxis({ ...pair.x, ...wrong }), JSON.stringify(wrong));
  }
});

test("the table of a map reads back to the same numbers", () => {
  const x = Float64Array.of(1, 0.1, 1e-7);
  const y = Float64Array.of(2.5, 1e17);
  const field = new Field(3, 2);
  field.add({
    device: 0,
    cells: Uint32Array.of(0, 1, 2, 3, 5),
    outcome: Uint8Array.of(0, 1, 2, 3, 1),
    peakRotation: Float64Array.of(0, 1 / 3, NaN, NaN, 2),
    peakAcceleration: Float64Array.of(0, 1.5, NaN, NaN, NaN),
  });
  const csv = mapCsv({ about: { devices: ['a, "b"'], x, y, xKey: "block.size_m", yKey: "ground.0.scale" }, fields: [field] });
  const lines = csv.trim().split("\n");
  assert.equal(lines[0], "device,block.size_m,ground.0.scale,outcome,peak_rotation,peak_acceleration");
  assert.equal(lines.length, 6, "a cell that is not known is left out");
  assert.deepEqual(lines.slice(1, 3), ['"a, ""b""",1.0,2.5,no-rocking,0.0,0.0', '"a, ""b""",0.1,2.5,safe,0.3333333333333333,1.5']);
  assert.equal(lines[3], '"a, ""b""",1e-7,2.5,overturned-without-impact,,');
  assert.equal(lines[4], '"a, ""b""",1.0,1e17,overturned-after-impact,,');
  assert.equal(lines[5], '"a, ""b""",1e-7,1e17,safe,2.0,', "loops have no peak of the acceleration");
});

test("the ideal pair is on its own lines between its samples", () => {
  const own = resampled(Float64Array.of(0, 1, 1, 3), Float64Array.of(0, 2, 5, 9), Float64Array.of(-1, 0, 0.5, 1, 2, 3, 4));
  assert.deepEqual([...own], [NaN, 0, 1, 2, 7, 9, NaN]);
  assert.deepEqual(stretches(Float64Array.of(0, 1, 2, 3), Uint8Array.of(1, 1, 0, 0)), [
    { from: 0, to: 2, value: 1 },
    { from: 2, to: 3, value: 0 },
  ]);
});

test("an error is said with its doubt", () => {
  const summary = (estimate, peak = 0.5) => ({
    peak_rotation: peak,
    error_estimate: { as_wanted: true, outcome_certain: true, peak_rotation: 1e-9, ...estimate },
  });
  assert.equal(errorWords({ peak_rotation: 0.5 }), null);
  assert.match(errorWords(summary({})), /1\.0e-9 \(2\.0e-9 of it\)$/);
  assert.match(errorWords(summary({ as_wanted: false })), /more than was asked for/);
  assert.match(errorWords(summary({ outcome_certain: false })), /doubt/);
  assert.doesNotMatch(errorWords(summary({}, null)), /within/);
});
