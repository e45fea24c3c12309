/** Faults that the user puts in. */
import type { Injected } from "../engine";
import { button, choice, el } from "../dom";
import { numberBox, setChoices } from "../number_box";
import { texts } from "../texts";
import { shortText } from "../map/ticks";

const words = texts.views.loop;

/** Which faults are put in, and when. */
export class InjectionForm {
  readonly root: HTMLFieldSetElement;
  /** In the order in which they were put in. */
  injected: Injected[] = [];
  private faults: readonly { name: string; text: string }[] = [];
  private readonly kind: HTMLSelectElement;
  private readonly at: HTMLInputElement;
  private readonly list = el("ul", { className: "loop-injected", ariaLabel: words.injected });
  private readonly changed: () => void;

  constructor(changed: () => void) {
    this.changed = changed;
    const kind = choice(words.injectKind, [], () => undefined);
    const at = numberBox(words.injectAt, { min: 0 }, () => undefined);
    [this.kind, this.at] = [kind.select, at.input];
    this.at.value = "1";
    const inject = button(words.injectButton, () => this.add());
    this.root = el("fieldset", {}, el("legend", { textContent: words.inject }), kind.root, at.root, inject, this.list);
  }

  /** Offers `faults`. */
  offer(faults: readonly { name: string; text: string }[]): void {
    this.faults = faults;
    setChoices(
      this.kind,
      faults.map(({ name, text }) => [name, text]),
    );
  }

  /** Suggests an instant within the motion. */
  suggest(seconds: number): void {
    if (this.injected.length === 0) {
      this.at.value = String(Number(seconds.toFixed(2)));
    }
  }

  private add(): void {
    if (this.kind.value !== "" && this.at.value !== "" && this.at.reportValidity()) {
      this.set([...this.injected, { fault: this.kind.value, atS: this.at.valueAsNumber }]);
    }
  }

  private set(injected: Injected[]): void {
    this.injected = injected;
    const item = (one: Injected): HTMLElement => {
      const text = this.faults.find(({ name }) => name === one.fault)?.text ?? one.fault;
      const withdraw = button("×", () => this.set(this.injected.filter((other) => other !== one)));
      withdraw.ariaLabel = words.withdraw(text);
      return el("li", {}, words.at(text, shortText(one.atS)), " ", withdraw);
    };
    this.list.replaceChildren(...injected.map(item));
    this.changed();
  }
}
