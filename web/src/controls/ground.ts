/** Controls of the ground motion: a pulse by its amplitude and frequency, or a record by its scale. */
import { numberOf } from "../block/geometry";
import { choice, el, say } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { fieldset, type Group } from "./block";
import type { Draft, Table } from "./draft";
import { numberField } from "./field";

const words = texts.page.controls;
const AMPLITUDES = ["amplitude_ratio", "amplitude_g", "amplitude_m_s2"];
const others = (key: string, all: string[]) => all.filter((name) => name !== key);

/** The controls of the ground motion. */
export function groundControls(draft: Draft, store: Store): Group {
  const kind = choice(words.motion, Object.entries(words.motions), (motion) => setMotion(draft, store, motion));
  const amplitude = numberField({ label: words.amplitude, from: 0, to: 15, step: 0.05 }, (value) =>
    draft.setGround("amplitude_m_s2", value, others("amplitude_m_s2", AMPLITUDES)),
  );
  const velocity = numberField({ label: words.velocity, from: 0, to: 3, step: 0.01 }, (value) =>
    draft.setGround("velocity_amplitude_m_s", value),
  );
  const frequency = numberField({ label: words.frequency, from: 0.1, to: 8, step: 0.01 }, (value) =>
    draft.setGround("frequency_hz", value, ["frequency_ratio"]),
  );
  const duration = numberField({ label: words.duration, from: 0.02, to: 4, step: 0.01 }, (value) =>
    draft.setGround("duration_s", value, ["duration_ratio"]),
  );
  const scale = numberField({ label: words.scale, from: 0, to: 4, step: 0.01 }, (value) => draft.setGround("scale", value));
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
    amplitude.root.hidden = draft.amplitudeMS2() === null;
    amplitude.show(draft.amplitudeMS2());
    velocity.root.hidden = motion !== "mavroeidis-papageorgiou";
    velocity.show(numberOf(table ?? {}, "velocity_amplitude_m_s"));
    frequency.root.hidden = draft.frequencyHz() === null;
    frequency.show(draft.frequencyHz());
    duration.root.hidden = draft.durationS() === null;
    duration.show(draft.durationS());
    scale.root.hidden = motion !== "record";
    scale.show(numberOf(table ?? {}, "scale") ?? 1);
    file.hidden = motion !== "record";
    say(file, `${words.file}: ${String(table?.["file"] ?? "")}`);
    several.hidden = draft.grounds.length < 2;
    say(several, words.several(draft.grounds.length));
  };
  const fields = [amplitude, velocity, frequency, duration, scale].map(({ root }) => root);
  return { root: fieldset(words.ground, kind.root, file, several, ...fields), show };
}

/** Another kind of motion, as strong and as fast as the present one where that has a strength and a frequency. */
function setMotion(draft: Draft, store: Store, motion: string): void {
  if (motion === "none") {
    draft.replaceGrounds([]);
    return;
  }
  const amplitude = draft.amplitudeMS2() ?? 4;
  const frequency = draft.frequencyHz() ?? 1.25;
  const pulse = (table: Table): Table => ({ motion, ...table });
  const tables: Record<string, () => Table> = {
    rectangular: () => pulse({ amplitude_m_s2: amplitude, duration_s: draft.durationS() ?? 0.25 }),
    "mavroeidis-papageorgiou": () => pulse({ velocity_amplitude_m_s: 0.8, frequency_hz: frequency, oscillations: 2, phase_deg: 0 }),
    record: () => pulse({ file: store.source.records[0]?.name ?? "" }),
  };
  const table = tables[motion]?.() ?? pulse({ amplitude_m_s2: amplitude, frequency_hz: frequency });
  draft.replaceGrounds([table, ...draft.grounds.slice(1)]);
}
