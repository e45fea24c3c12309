/** Play and pause, speed, the place in time, steps from event to event, and sound. */
import { drawSoon } from "../clock";
import { button, choice, el, say } from "../dom";
import type { Store } from "../store";
import { texts } from "../texts";
import { eventFrom, eventsOf, type Event } from "./events";
import { Knocks } from "./sound";

const SPEEDS = [1, 1 / 2, 1 / 5, 1 / 20];

/** The row of buttons below the blocks. */
export function transport(store: Store): HTMLElement {
  const { transport: words } = texts.page;
  const play = button(words.play, () => (store.playing = !store.playing));
  play.className = "primary play";
  const spoken = el("p", { className: "event", role: "status" });
  const back = button(words.previous, () => step(store, -1, spoken));
  const next = button(words.next, () => step(store, 1, spoken));
  const speed = choice(
    words.speed,
    SPEEDS.map((factor) => [String(factor), factor === 1 ? "1" : `1/${Math.round(1 / factor)}`]),
    (value) => (store.speed = Number(value)),
  );
  const place = el("input", { type: "range", min: "0", step: "any", value: "0" });
  const clock = el("output", { className: "clock" });
  place.addEventListener("input", () => {
    store.playing = false;
    store.time = Number(place.value);
  });
  const scrub = el("label", { className: "field scrub" }, el("span", { textContent: words.time }), place);

  const knocks = new Knocks(store);
  const sound = el("input", { type: "checkbox" });
  sound.addEventListener("change", () => (knocks.on = sound.checked));

  const show = () => {
    place.value = String(store.time);
    const text = `${store.time.toFixed(2)} s`;
    say(clock, text);
  };
  store.subscribe("time", () => drawSoon(show));
  store.subscribe("run", () => {
    place.max = String(store.durationS);
    say(spoken, "");
    drawSoon(show);
  });
  store.subscribe("playing", () => {
    play.textContent = store.playing ? words.pause : words.play;
    speed.select.value = String(store.speed);
    // Read aloud when it stops, not sixty times a second.
    place.setAttribute("aria-valuetext", words.seconds(store.time));
  });
  place.addEventListener("change", () => place.setAttribute("aria-valuetext", words.seconds(store.time)));
  addEventListener("keydown", (event) => {
    if (event.key === " " && !event.ctrlKey && !event.altKey && !event.metaKey && !takesSpace(event.target)) {
      event.preventDefault();
      store.playing = !store.playing;
    }
  });
  return el(
    "div",
    { className: "transport" },
    play,
    back,
    next,
    scrub,
    clock,
    speed.root,
    el("label", { className: "check" }, sound, words.sound),
    spoken,
  );
}

function step(store: Store, direction: 1 | -1, spoken: HTMLElement): void {
  const response = store.run?.responses[store.selected];
  if (!response) {
    return;
  }
  store.playing = false;
  const event: Event | null = eventFrom(eventsOf(response), store.time, direction);
  if (event) {
    store.time = event.timeS;
  }
  say(spoken, event ? texts.page.transport.event(response.device, event.kind, event.timeS) : texts.page.transport.noEvent(response.device));
}

/** Whether the space bar means something to the element that has the focus. */
function takesSpace(target: EventTarget | null): boolean {
  return (
    target instanceof Element &&
    target.closest("input, select, textarea, button, a, summary, [contenteditable], [role=application], [data-keys]") !== null
  );
}
