// Calls of the core that wait until the test lets them go.
import { until } from "./browser.mjs";

/** For `prepare` of `open`: calls can be held. */
export const holdable = (page) =>
  page.addInitScript(() => {
    const held = { names: [], calls: [] };
    window.held = held;
    const Plain = window.Worker;
    window.Worker = class extends Plain {
      postMessage(message) {
        const name = message.task?.call.name;
        const send = () => super.postMessage(message);
        if (held.names.includes(name)) {
          held.calls.push({ name, send });
        } else {
          send();
        }
      }
    };
  });

/** Holds calls with these names, and no others, from here on. */
export const hold = (page, ...names) => page.evaluate((names) => void (window.held.names = names), names);

/** Waits until a call is held. */
export const isHeld = (page, name) =>
  until(`a call of ${name}`, () => page.evaluate((name) => window.held.calls.some((call) => call.name === name), name));

/** Lets go those that are held. */
export const letGo = (page, name) =>
  page.evaluate((name) => {
    const { calls } = window.held;
    window.held.calls = calls.filter((call) => call.name !== name);
    calls.filter((call) => call.name === name).forEach(({ send }) => send());
  }, name);
