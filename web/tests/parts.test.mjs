/** Parts of the page that need no browser: what is drawn of a run, what an address holds, what a control writes. */
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { createServer } from "vite";

let server;
const load = (module) => server.ssrLoadModule(`/src/${module}.ts`);

before(async () => {
  const root = fileURLToPath(new URL("..", import.meta.url));
  server = await createServer({ root, server: { middlewareMode: true, hmr: false, ws: false }, appType: "custom", logLevel: "error" });
});
after(() => server.close());

test("curves over one axis keep every sample, also two of one time", async () => {
  const { align } = await load("histories/align");
  const curves = [
    { timeS: Float64Array.of(0, 1, 1, 3), values: Float64Array.of(5, 6, 7, 8) },
    { timeS: Float64Array.of(0, 0.5, 1), values: Float64Array.of(1, 2, 3) },
  ];
  const [times, ...columns] = align(curves);
  assert.deepEqual(
    times,
    [...times].sort((a, b) => a - b),
  );
  for (const [index, { timeS, values }] of curves.entries()) {
    const kept = times.flatMap((time, row) => (columns[index][row] === null ? [] : [[time, columns[index][row]]]));
    assert.deepEqual(
      kept,
      Array.from(timeS, (time, i) => [time, values[i]]),
    );
  }
});

test("spans begin and end where the engaged flywheel changes", async () => {
  const { spans } = await load("histories/align");
  const timeS = Float64Array.of(0, 1, 2, 3, 4);
  assert.deepEqual(spans(timeS, Uint8Array.of(0, 1, 1, 2, 1), 1), [
    [1, 3],
    [4, 4],
  ]);
  assert.deepEqual(spans(timeS, Uint8Array.of(0, 1, 1, 2, 1), 2), [[3, 4]]);
  // 3 is both.
  assert.deepEqual(spans(timeS, Uint8Array.of(1, 3, 2, 0, 0), 1), [[0, 2]]);
  assert.deepEqual(spans(timeS, Uint8Array.of(1, 3, 2, 0, 0), 2), [[1, 3]]);
});

test("an address gives its scene back, and refuses what was cut off, changed or blown up", async () => {
  const { isOwn, isPacked, pack, unpack } = await load("scene/address");
  const text = 'title = "σ, η and 🧱"\n[block]\nslenderness_deg = 10.0\n'.repeat(40);
  const fragment = await pack(text);
  assert.match(fragment, /^#s=[\w-]+$/);
  assert.ok(fragment.length < text.length / 4);
  assert.equal(await unpack(fragment), text);
  const own = await pack(text, true);
  assert.deepEqual([fragment, own].map(isOwn), [false, true]);
  assert.ok(isPacked(fragment) && isPacked(own) && !isPacked("#main"));
  assert.equal(await unpack(own), text);
  for (const broken of [fragment.slice(0, -9), "#s=", "#s=!!!", `#s=AAAA${fragment.slice(3)}`]) {
    await assert.rejects(unpack(broken), broken);
  }
  const { deflateRawSync } = await import("node:zlib");
  await assert.rejects(unpack(`#s=${deflateRawSync(Buffer.alloc(50_000_000, 35)).toString("base64url")}`), RangeError);
  assert.equal(await pack("#".repeat(300_000)), null);
});

test("records are found in a scene by their whole names", async () => {
  const { recordsOf } = await load("scene/open");
  const names = ["plain.csv", "L'Aquila.csv", 'a "b".csv', "back\\slash.csv"];
  const text = `[[ground]]\nfile = "plain.csv"\n[[ground]]\nfile="L'Aquila.csv"\n[[ground]]\nfile = 'a "b".csv'\n`;
  assert.deepEqual(recordsOf(`${text}[[ground]]\nfile = "back\\\\slash.csv"\n`), names);
  assert.deepEqual(recordsOf(`ground = [{ file = "a \\"b\\".csv" }, { file = 'back\\slash.csv' }]`), names.slice(2));
});

test("ground that is pushed and stopped ends where kinematics says", async () => {
  const { displacement } = await load("block/motion");
  // 2 m/s² for 1 s, −2 m/s² for 1 s, then rest: 2 m.
  const timeS = Float64Array.from({ length: 4001 }, (_, i) => i / 1000);
  const push = (time) => (time < 1 ? 2 : time < 2 ? -2 : 0);
  const moved = displacement(timeS, timeS.map(push));
  assert.ok(Math.abs(moved.at(-1) - 2) < 0.01, `${moved.at(-1)}`);
  // The same with an error of its baseline of 0.1 m/s²: some 0.2 m would be added in 2 s, and more in every second after.
  const drifting = displacement(
    timeS,
    timeS.map((time) => (time < 2 ? push(time) + 0.1 : 0)),
  );
  assert.ok(Math.abs(drifting.at(-1) - 2) < 0.02, `${drifting.at(-1)}`);
});

test("a block turns about the toe that it stands on", async () => {
  const { placed, travel } = await load("block/geometry");
  const shape = { halfWidthM: 0.3, halfHeightM: 2, mount: { at: "height", heightM: 2 } };
  for (const rotation of [-0.2, -1e-9, 0, 1e-9, 0.15, Math.PI / 2]) {
    const toe = rotation < 0 ? -0.3 : 0.3;
    assert.deepEqual(
      placed(shape, rotation, toe, 0).map((x) => Math.round(1e12 * x) / 1e12 + 0),
      [toe, 0],
    );
    const [x, y] = placed(shape, rotation, 0, 2);
    assert.ok(Math.abs(Math.hypot(x - toe, y) - Math.hypot(0.3, 2)) < 1e-12);
    assert.ok(Math.abs(travel(shape, rotation) + travel(shape, -rotation)) < 1e-12);
  }
  // To the right by a positive rotation, and on its side at a right angle.
  assert.ok(travel(shape, 0.1) > 0);
  assert.ok(Math.abs(placed(shape, Math.PI / 2, 0.3, 4)[1]) < 1e-12);
});

test("a block stays within its picture as it turns", async () => {
  const { depthM, heightM } = await load("block/room");
  const { placed } = await load("block/geometry");
  for (const halfWidthM of [0.1, 1, 1.5, 2, 10]) {
    const shape = { halfWidthM, halfHeightM: 2, mount: { at: "height", heightM: 2 } };
    for (let rotationRad = 0; rotationRad < Math.PI / 2; rotationRad += 0.01) {
      const [, top] = placed(shape, rotationRad, -halfWidthM, 4);
      assert.ok(top <= heightM(shape) - depthM(shape), `${halfWidthM} m, ${rotationRad} rad`);
    }
  }
});

test("a name is cut to the room that it has", async () => {
  const { fitted } = await load("block/label");
  const context = { measureText: (text) => ({ width: 10 * [...text].length }) };
  assert.equal(fitted(context, "clutched pair", 130), "clutched pair");
  assert.equal(fitted(context, "clutched pair", 129), "clutched pa…");
  assert.equal(fitted(context, "🧱🧱🧱", 20), "🧱…");
  assert.equal(fitted(context, "", 0), "");
  assert.equal(fitted(context, "none", 0), "…");
});

test("steps go to the next and the previous event and stop at the ends", async () => {
  const { eventFrom, eventsOf } = await load("block/events");
  const events = eventsOf({
    impactsS: Float64Array.of(1, 2),
    timeS: Float64Array.of(0, 1.5, 2.5, 3),
    engaged: Uint8Array.of(0, 2, 3, 3),
  });
  assert.deepEqual(
    events.map(({ timeS, kind }) => [timeS, kind]),
    [
      [1, "impact"],
      [1.5, 2],
      [2, "impact"],
      [2.5, 3],
    ],
  );
  assert.equal(eventFrom(events, 1, 1).timeS, 1.5);
  assert.equal(eventFrom(events, 1.5, -1).timeS, 1);
  assert.equal(eventFrom(events, 2.5, 1), null);
  assert.equal(eventFrom(events, 1, -1), null);
});

test("a control writes the key that the scene has, and a map over a lost key goes", async () => {
  const { Draft, listSettings } = await load("controls/draft");
  const settings = [];
  const about = {
    resolved: {
      block: { frequency_parameter_1_s: 1, slenderness_deg: 45, inertia_ratio: 4 / 3 },
      device: [],
      ground: [{ motion: "sine", amplitude_ratio: 2, frequency_hz: 1 }],
    },
    map: { x: { key: "ground.0.amplitude_ratio" }, y: null },
  };
  const draft = new Draft({ run: { about }, setSetting: (...given) => settings.push(...given) });
  draft.take();
  assert.equal(draft.ground("amplitude_m_s2"), 19.6133);
  draft.setGround("amplitude_m_s2", 9.80665);
  draft.setGround("frequency_hz", 2);
  // p = √(3g/(4R)): p = 1/s is 7.355 m, and R = 1.8387 m has p = 2/s.
  draft.setSize((3 * 9.80665) / 16);
  assert.deepEqual(settings, ["ground.0.amplitude_ratio=1", "ground.0.frequency_hz=2", "block.frequency_parameter_1_s=2"]);
  assert.ok(listSettings(about, "ground", []).includes("map="));
  assert.ok(!listSettings(about, "ground", [{ motion: "cosine", amplitude_ratio: 3 }]).includes("map="));
});

test("a quantity is converted by the block as it was set last, not as it was run last", async () => {
  const { Draft } = await load("controls/draft");
  const settings = [];
  const ground = [{ motion: "rectangular", amplitude_ratio: 2, duration_ratio: 3 }];
  for (const [geometry, threshold] of [
    ["full", Math.sqrt(3)],
    ["slender", Math.PI / 3],
  ]) {
    const block = { size_m: 1, slenderness_deg: 10, inertia_ratio: 4 / 3, geometry };
    const about = { resolved: { block, ground, device: [] }, upliftThresholdG: 0.2, frequencyParameter1S: 2.7, map: null };
    const draft = new Draft({ run: { about }, setSetting: (...given) => settings.push(...given) });
    draft.take();
    draft.setBlock("slenderness_deg", 60);
    draft.setGround("amplitude_m_s2", 9.80665);
    const set = Number(settings.at(-1).split("=")[1]);
    assert.ok(Math.abs(set * threshold - 1) < 1e-11, `${geometry}: ${set}`);
    // R = 3g/4 m has p = 1/s.
    draft.setSize(0.75 * 9.80665);
    draft.setGround("duration_s", 2);
    assert.equal(settings.at(-1), "ground.0.duration_ratio=2");
  }
});

test("what devices have alike is shown of them, and nothing else", async () => {
  const { shared } = await load("controls/draft");
  const [inerter, pair] = [{ mass_ratio: 0.5 }, { mass_ratio: 1.5, mount: "base-corners" }];
  assert.deepEqual(shared([inerter, pair], { mount: "centre-of-mass" }), {});
  assert.deepEqual(shared([inerter, { ...pair, mass_ratio: 0.5 }]), inerter);
  assert.deepEqual(shared([inerter], { mount: "centre-of-mass" }), { ...inerter, mount: "centre-of-mass" });
  assert.deepEqual(shared([]), {});
});

test("another kind of motion keeps scale, start and a map over them", async () => {
  const { Draft } = await load("controls/draft");
  const { setMotion } = await load("controls/ground");
  const record = { motion: "record", file: "own.csv", scale: 2, start_s: 1.5 };
  for (const ground of [record, { motion: "sine", amplitude_g: 0.3, frequency_hz: 2, scale: 2, start_s: 1.5 }]) {
    for (const motion of ["ricker", "rectangular", "mavroeidis-papageorgiou", "record"].filter((other) => other !== ground.motion)) {
      const settings = [];
      const about = { resolved: { block: {}, device: [], ground: [ground] }, map: { x: { key: "ground.0.scale" }, y: null } };
      const store = { run: { about }, source: { records: [{ name: "own.csv" }] }, setSetting: (...given) => settings.push(...given) };
      const draft = new Draft(store);
      draft.take();
      setMotion(draft, store, motion);
      const { motion: set, scale, start_s } = draft.grounds[0];
      assert.deepEqual([set, scale, start_s], [motion, 2, 1.5]);
      assert.equal(settings.length, 1, `${settings}`);
    }
  }
});

test("a map goes once with the device that it is over, and with its place", async () => {
  const { Draft } = await load("controls/draft");
  const [none, inerter, pair] = [
    { kind: "none" },
    { kind: "inerter", mass_ratio: 0.5, mount: "tying-point", mount_height_m: 2 },
    { kind: "clutched-pair", name: "pair", mass_ratio: 0.5 },
  ];
  const { mount_height_m: _, ...lower } = inerter;
  const cases = [
    ["device.1.mass_ratio", [none, pair], true],
    ["device.2.mass_ratio", [none, inerter], true],
    ["device.1.mass_ratio", [inerter, pair], true],
    ["device.1.mount_height_m", [none, lower, pair], true],
    ["device.1.mass_ratio", [none, lower, pair], false],
    ["device.1.mass_ratio", [none, inerter], false],
    ["device.1.mass_ratio", [none, inerter, pair, { kind: "inerter", name: "inerter 2" }], false],
    // A key that the scene does not set can be an axis.
    ["device.1.inertance_corner_hz", [none, inerter], false],
    ["block.size_m", [none], false],
  ];
  for (const [key, devices, goes] of cases) {
    const settings = [];
    const about = { resolved: { device: [none, inerter, pair] }, map: { x: { key: "block.restitution" }, y: { key } } };
    const draft = new Draft({ run: { about }, setSetting: (...given) => settings.push(...given) });
    draft.take();
    draft.replaceDevices(devices);
    draft.replaceDevices(devices.slice(0, 1));
    const lost = settings.filter((setting) => setting === "map=").length;
    assert.equal(settings.indexOf("map=") === 1, goes, `${key} ${JSON.stringify(devices)}`);
    assert.equal(lost, key.startsWith("device") ? 1 : 0, "what is gone cannot be left out again");
  }
});

test("the success of a run takes away failures that were there before its scene, and no others", async () => {
  globalThis.matchMedia = () => ({ matches: true });
  const { Store } = await load("store");
  const runs = [];
  const store = new Store({ simulate: () => new Promise((succeed) => runs.push(succeed)) });
  const begin = (text) => store.setSource({ text, records: [] });
  const succeed = async () => {
    runs.shift()({ responses: [] });
    await new Promise(setImmediate);
  };
  begin("first");
  store.fail("its map");
  await succeed();
  assert.equal(store.message, "its map");
  begin("second");
  await succeed();
  assert.equal(store.message, "");
  begin("third");
  begin("fourth");
  store.fail("its map");
  await succeed();
  await succeed();
  assert.deepEqual([store.message, runs.length], ["its map", 0]);
});

test("a worker gets the records that a scene names, and no others", async () => {
  const sent = [];
  globalThis.Worker = class extends EventTarget {
    constructor() {
      super();
      setImmediate(() => this.dispatchEvent(Object.assign(new Event("message"), { data: { ready: { version: "", simd: true } } })));
    }
    postMessage(message) {
      sent.push(message);
    }
  };
  const { Workers } = await load("pool/workers");
  const workers = new Workers({}, 1);
  await workers.ready;
  const records = ["own.csv", "other.csv", 'a "b".csv'].map((name) => ({ name, bytes: new Uint8Array(1) }));
  void workers.run({ name: "about" }, { text: 'ground = [{ motion = "record", file = "own.csv" }, { file = "a \\"b\\".csv" }]', records });
  const { source } = sent.at(-1).task.scene;
  assert.deepEqual(source.records, [records[0], records[2]]);
});

test("workers that cannot be replaced are said, and tried again", async () => {
  let isOffline = false;
  const born = [];
  globalThis.Worker = class extends EventTarget {
    constructor() {
      super();
      born.push(this);
      const data = { ready: { version: "", simd: true } };
      const begun = isOffline ? Object.assign(new Event("error"), { message: "offline" }) : Object.assign(new Event("message"), { data });
      setImmediate(() => this.dispatchEvent(begun));
    }
    postMessage({ task }) {
      if (task) {
        setImmediate(() => this.dispatchEvent(Object.assign(new Event("message"), { data: { result: task.call.name } })));
      }
    }
    terminate() {}
  };
  const { Workers } = await load("pool/workers");
  const workers = new Workers({}, 2);
  await workers.ready;
  isOffline = true;
  born.slice().forEach((worker) => worker.dispatchEvent(Object.assign(new Event("error"), { message: "out of memory" })));
  await assert.rejects(workers.run({ name: "faults" }, null), /offline/);
  await assert.rejects(workers.run({ name: "faults" }, null), /offline/);
  isOffline = false;
  assert.equal(await workers.run({ name: "faults" }, null), "faults");
});

test("values are written as TOML in one line", async () => {
  const { inline } = await load("controls/draft");
  assert.equal(
    inline([{ motion: "record", file: 'a "b".csv', units: null, scale: 1.5 }]),
    '[{ motion = "record", file = "a \\"b\\".csv", scale = 1.5 }]',
  );
  assert.equal(inline([]), "[]");
});
