/** Controls of the ground motion: a pulse by its amplitude and frequency, or a record by its scale. */
import { choice, el, say } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { fieldset, type Group } from "./block";
import type { Draft, Quantity, Table } from "./draft";
import { numberField, type Range } from "./field";

const words = texts.page.controls;

/** Pulses of an amplitude and a frequency. */
const ALIKE = ["sine", "cosine", "half-sine", "ricker"];

/** The controls of the ground motion. */
export function groundControls(draft: Draft, store: Store): Group {
  const kind = choice(words.motion, Object.entries(words.motions), (motion) => setMotion(draft, store, motion));
  const field = (quantity: Quantity, range: Range) => ({
    quantity,
    ...numberField(range, (value) => draft.setGround(quantity, value)),
  });
  const fields = [
    field("amplitude_m_s2", { label: words.amplitude, from: 0, to: 15, step: 0.05 }),
    field("velocity_amplitude_m_s", { label: words.velocity, from: 0, to: 3, step: 0.01 }),
    field("frequency_hz", { label: words.frequency, from: 0.1, to: 8, step: 0.01 }),
    field("duration_s", { label: words.duration, from: 0.02, to: 4, step: 0.01 }),
    field("scale", { label: words.scale, from: 0, to: 4, step: 0.01 }),
  ];
  const file = el("p", { className: "hint" });
  const several = el("p", { className: "hint" });
  const show = () => {
    const table = draft.grounds[0];
    const motion = String(table?.["motion"] ?? "none");
    kind.select.value = motion;
    // Without a record at hand there is none to choose.
    for (const option of kind.select.options) {
      option.disabled = option.value === "record" && motion !== "record" && store.source.records.length === 0;
    }
    for (const { quantity, root, show } of fields) {
      const value = draft.ground(quantity);
      // Pulses can be scaled, too; their amplitude says the same. A slider that passes 1 stays.
      const isIdle = quantity === "scale" && motion !== "record" && value === 1;
      root.hidden = value === null || (isIdle && !root.contains(document.activeElement));
      show(value);
    }
    file.hidden = motion !== "record";
    say(file, `${words.file}: ${String(table?.["file"] ?? "")}`);
    several.hidden = draft.grounds.length < 2;
    say(several, words.several(draft.grounds.length));
  };
  return { root: fieldset(words.ground, kind.root, file, several, ...fields.map(({ root }) => root)), show };
}

/** Another kind of motion, as strong and as fast as the present one where that has a strength and a frequency, as scaled and as late. */
export function setMotion(draft: Draft, store: Store, motion: string): void {
  if (ALIKE.includes(motion) && ALIKE.includes(String(draft.grounds[0]?.["motion"]))) {
    draft.setMotion(motion);
    return;
  }
  if (motion === "none") {
    // Neither shaken nor tilted it would stand still.
    if (!draft.block["initial_rotation_ratio"] && !draft.block["initial_velocity_ratio"]) {
      draft.setBlock("initial_rotation_ratio", 0.7);
    }
    draft.replaceGrounds([]);
    return;
  }
  const amplitude = draft.ground("amplitude_m_s2") ?? 4;
  const frequency = draft.ground("frequency_hz") ?? 1.25;
  const { scale, start_s } = draft.grounds[0] ?? {};
  const pulse = (table: Table): Table => ({ motion, ...table, scale, start_s });
  const tables: Record<string, () => Table> = {
    rectangular: () => pulse({ amplitude_m_s2: amplitude, duration_s: draft.ground("duration_s") ?? 0.25 }),
    "mavroeidis-papageorgiou": () => pulse({ velocity_amplitude_m_s: 0.8, frequency_hz: frequency, oscillations: 2, phase_deg: 0 }),
    // The last one is what was dropped.
    record: () => pulse({ file: store.source.records.at(-1)?.name ?? "" }),
  };
  const table = tables[motion]?.() ?? pulse({ amplitude_m_s2: amplitude, frequency_hz: frequency });
  draft.replaceGrounds([table, ...draft.grounds.slice(1)]);
}
