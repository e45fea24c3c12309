/** Faults that the user puts in. */
import type { Injected } from "../engine";
import { button, element, labelled, numberInput, select, setChoices } from "../elements";
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
  private readonly list = element("ul", { class: "loop-injected", at: { "aria-label": words.injected } });
  private readonly changed: () => void;

  constructor(changed: () => void) {
    this.changed = changed;
    this.kind = select([], () => undefined);
    this.at = numberInput({ min: "0" }, () => undefined);
    this.at.value = "1";
    this.root = element("fieldset", {
      children: [
        element("legend", { text: words.inject }),
        labelled(words.injectKind, this.kind),
        labelled(words.injectAt, this.at),
        button(words.injectButton, () => this.add()),
        this.list,
      ],
    });
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
    if (this.kind.value !== "" && this.at.value !== "" && this.at.checkValidity()) {
      this.set([...this.injected, { fault: this.kind.value, atS: this.at.valueAsNumber }]);
    }
  }

  private set(injected: Injected[]): void {
    this.injected = injected;
    const item = (one: Injected): HTMLElement => {
      const text = this.faults.find(({ name }) => name === one.fault)?.text ?? one.fault;
      const withdraw = button("×", () => this.set(this.injected.filter((other) => other !== one)));
      withdraw.setAttribute("aria-label", words.withdraw(text));
      return element("li", { children: [words.at(text, shortText(one.atS)), " ", withdraw] });
    };
    this.list.replaceChildren(...injected.map(item));
    this.changed();
  }
}
