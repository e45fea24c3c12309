/** Controls of the block: R, α, η. */
import { numberOf } from "../block/geometry";
import { el, say } from "../dom";
import { texts } from "../texts";
import type { Draft } from "./draft";
import { numberField } from "./field";

/** A group of controls, which shows the draft whenever it has changed. */
export interface Group {
  root: HTMLElement;
  show(): void;
}

/** A fieldset with a legend. */
export function fieldset(legend: string, ...children: HTMLElement[]): HTMLElement {
  return el("fieldset", {}, el("legend", { textContent: legend }), ...children);
}

/** The controls of the block. */
export function blockControls(draft: Draft): Group {
  const words = texts.page.controls;
  const size = numberField({ label: words.size, from: 0.2, to: 10, step: 0.05 }, (value) => draft.setSize(value));
  const slenderness = numberField({ label: words.slenderness, from: 2, to: 40, step: 0.25 }, (value) =>
    draft.setBlock("slenderness_deg", value),
  );
  const restitution = numberField({ label: words.restitution, from: 0.5, to: 1, step: 0.005 }, (value) =>
    draft.setBlock("restitution", value),
  );
  const initial = numberField({ label: words.initial, from: -1.2, to: 1.2, step: 0.01 }, (value) =>
    draft.setBlock("initial_rotation_ratio", value),
  );
  const word = el("p", { className: "hint", hidden: true });
  return {
    root: fieldset(words.block, size.root, slenderness.root, restitution.root, word, initial.root),
    show: () => {
      size.show(draft.about?.sizeM ?? null);
      slenderness.show(numberOf(draft.block, "slenderness_deg"));
      restitution.show(draft.about?.restitution ?? null);
      initial.show(numberOf(draft.block, "initial_rotation_ratio"));
      const said = draft.block["restitution"];
      word.hidden = typeof said !== "string";
      say(word, typeof said === "string" ? words.restitutionWord(said) : "");
    },
  };
}
