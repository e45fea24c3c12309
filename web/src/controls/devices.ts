/** Controls of the devices: which there are, σ, mount and kind of clutch. */
import { numberOf } from "../block/geometry";
import { button, choice, el } from "../dom";
import { deviceLook } from "../colours";
import { onTheme } from "../theme";
import { texts } from "../texts";
import { fieldset, type Group } from "./block";
import { type Draft, nameOf, shared, type Table } from "./draft";
import { numberField } from "./field";

const words = texts.page.controls;
const MOST_DEVICES = 16;

/** Devices whose inertance is a ratio, and so has a slider. */
const bySigma = (table: Table) => table["kind"] !== "none" && numberOf(table, "mass_ratio") !== null;
const hasDevice = (table: Table) => table["kind"] !== "none";
const isTied = (table: Table) => table["mount"] === "tying-point";
const isPair = (table: Table) => table["kind"] === "clutched-pair";

/** The controls of the devices. */
export function deviceControls(draft: Draft): Group {
  const list = el("ul", { className: "devices" });
  const sigma = numberField({ label: words.massRatio, from: 0, to: 2, step: 0.01 }, (value) =>
    draft.setDevices(bySigma, "mass_ratio", value),
  );
  const mount = choice(words.mount, Object.entries(words.mounts), (value) => setMount(draft, value));
  const height = numberField({ label: words.mountHeight, from: 0.1, to: 10, step: 0.05 }, (value) =>
    draft.setDevices(isTied, "mount_height_m", value),
  );
  const clutch = choice(words.engagement, Object.entries(words.engagements), (value) => draft.setDevices(isPair, "engagement", value));
  const add = choice(words.addDevice, [["", words.add], ...Object.entries(words.kinds)], (kind) => {
    add.select.value = "";
    const likeSigma = draft.devices.map((table) => numberOf(table, "mass_ratio")).find((value) => value !== null) ?? 0.5;
    const name = freeName(draft, kind);
    draft.replaceDevices([...draft.devices, { kind, ...(kind === "none" ? {} : { mass_ratio: likeSigma }), ...(name ? { name } : {}) }]);
  });
  let shown = "";
  const show = () => {
    const names = draft.about?.devices.map(({ name }) => name) ?? [];
    // Rebuilt only where it differs, so that the focus stays.
    if (shown !== JSON.stringify(names)) {
      shown = JSON.stringify(names);
      list.replaceChildren(...names.map((name, index) => item(draft, name, index)));
    }
    sigma.root.hidden = !draft.devices.some(bySigma);
    sigma.show(numberOf(shared(draft.devices.filter(bySigma)), "mass_ratio"));
    mount.root.hidden = !draft.devices.some(hasDevice);
    mount.select.value = String(shared(draft.devices.filter(hasDevice), { mount: "centre-of-mass" })["mount"] ?? "");
    const tied = draft.devices.filter(isTied);
    height.root.hidden = tied.length === 0;
    height.show(numberOf(shared(tied), "mount_height_m"));
    const pairs = draft.devices.filter(isPair);
    // Plates and springs are set in the text; this list has no word for them.
    clutch.root.hidden = pairs.length === 0 || pairs.some((pair) => pair["clutch"] !== undefined);
    clutch.select.value = String(shared(pairs, { engagement: "ideal" })["engagement"] ?? "");
    add.root.hidden = names.length >= MOST_DEVICES;
  };
  onTheme(() => {
    shown = "";
    show();
  });
  return { root: fieldset(words.devices, list, sigma.root, mount.root, height.root, clutch.root, add.root), show };
}

function item(draft: Draft, name: string, index: number): HTMLElement {
  const swatch = el("span", { className: "swatch" });
  swatch.style.background = deviceLook(index).colour;
  const remove = button("×", () => draft.replaceDevices(draft.devices.filter((_, other) => other !== index)));
  remove.setAttribute("aria-label", words.remove(name));
  remove.title = words.remove(name);
  // A scene has one device at least.
  remove.disabled = draft.devices.length < 2;
  return el("li", {}, swatch, el("span", { textContent: name }), remove);
}

/** A name for a second device of a kind, whose names must differ; null where the kind itself is free. */
function freeName(draft: Draft, kind: string): string | null {
  const taken = new Set(draft.devices.map(nameOf));
  if (!taken.has(kind)) {
    return null;
  }
  let number = 2;
  while (taken.has(`${kind} ${number}`)) {
    number++;
  }
  return `${kind} ${number}`;
}

function setMount(draft: Draft, mount: string): void {
  const halfHeight = (draft.about?.sizeM ?? 1) * Math.cos(draft.about?.slendernessRad ?? 0);
  const devices = draft.devices.map((table) => {
    if (!hasDevice(table)) {
      return table;
    }
    // Height and pulley are of some mounts only.
    const kept = Object.entries(table).filter(([key]) => !["mount", "mount_height_m", "pulley_ratio"].includes(key));
    const tied = mount === "tying-point" ? { mount_height_m: Number((1.5 * halfHeight).toPrecision(3)) } : {};
    return { ...Object.fromEntries(kept), mount, ...tied };
  });
  draft.replaceDevices(devices);
}
