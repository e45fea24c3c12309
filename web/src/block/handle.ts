/** The block as a handle: tilt it by pointer or arrow keys and let go, and it rocks freely without ground motion. */
import { inline, listSettings } from "../controls/draft";
import type { About } from "../engine";
import { say } from "../dom";
import { lookUp } from "../map/axis";
import type { Store } from "../store";
import { texts } from "../texts";
import { listOf } from "./geometry";
import type { Stage } from "./stage";

/** Largest tilt, θ/α: a block that is let go beyond 1 overturns. */
const MOST = 1.3;
const KEY_STEP = 0.05;

/** Makes the canvas of `stage`, within the focusable `frame`, a handle; `hint` says how far the block is tilted. */
export function makeHandle(stage: Stage, frame: HTMLElement, hint: HTMLElement, store: Store): void {
  let held: { x: number; heightM: number } | null = null;
  let ratio: number | null = null;
  const alpha = () => store.run?.about.slendernessRad ?? 0;
  const show = (next: number | null) => {
    ratio = next === null ? null : Math.round(Math.min(Math.max(next, -MOST), MOST) * 100) / 100;
    stage.tilt = ratio === null ? null : ratio * alpha();
    say(hint, ratio === null ? texts.page.block.hint : texts.page.block.tilted(ratio));
  };
  const letGo = () => {
    if (ratio !== null) {
      void release(store, ratio, () => show(null));
    }
  };
  const at = (event: PointerEvent): [number, number] => {
    const box = stage.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };

  const { canvas } = stage;
  canvas.addEventListener("pointerdown", (event) => {
    const [x, y] = at(event);
    const grabbed = stage.grab(x, y);
    if (grabbed && event.button === 0) {
      store.playing = false;
      held = { x, heightM: grabbed.heightM };
      canvas.setPointerCapture(event.pointerId);
      show(0);
    }
  });
  canvas.addEventListener("pointermove", (event) => {
    const [x, y] = at(event);
    if (held) {
      show(Math.atan2(stage.metres(x - held.x), held.heightM) / (alpha() || 1));
    } else {
      canvas.classList.toggle("grab", stage.grab(x, y) !== null);
    }
  });
  canvas.addEventListener("pointerup", () => {
    held = null;
    // A click without a drag tilts nothing.
    if (ratio !== null && Math.abs(ratio) >= 0.01) {
      letGo();
    } else {
      show(null);
    }
  });
  canvas.addEventListener("pointercancel", () => {
    held = null;
    show(null);
  });

  frame.addEventListener("keydown", (event) => {
    if (event.target !== frame || event.ctrlKey || event.altKey || event.metaKey) {
      return;
    }
    const step = event.key === "ArrowRight" ? KEY_STEP : event.key === "ArrowLeft" ? -KEY_STEP : 0;
    if (step !== 0) {
      store.playing = false;
      show((ratio ?? 0) + step);
    } else if (event.key === "Enter") {
      letGo();
    } else if (event.key === "Escape") {
      show(null);
    } else {
      return;
    }
    event.preventDefault();
  });
  frame.addEventListener("blur", () => {
    if (held === null) {
      show(null);
    }
  });
}

/** Lets the blocks of the scene go from θ/α = `ratio`; `shown` is called once that run is there, or has failed. */
async function release(store: Store, ratio: number, shown: () => void): Promise<void> {
  const finish = () => {
    stop.forEach((end) => end());
    shown();
  };
  const stop = [store.subscribe("run", finish), store.subscribe("message", () => store.message !== "" && finish())];
  try {
    // The last run may be that of another block.
    const about = await store.engine.about(store.source);
    const settings = settingsOfRelease(about, ratio);
    if (listOf(about.resolved, "ground").length > 0) {
      const keys = settings.map((setting) => setting.slice(0, setting.indexOf("=")));
      store.shaken = { about, settings: keys.map((key) => `${key}=${inline(lookUp(about.resolved, key))}`) };
    }
    store.restart(true);
    store.setSetting(...settings);
  } catch (problem) {
    store.fail(problem);
  }
}

function settingsOfRelease(about: About, ratio: number): string[] {
  const vertical = listOf(about.resolved, "vertical").length > 0 ? ["vertical=[]"] : [];
  return [`block.initial_rotation_ratio=${ratio}`, "block.initial_velocity_ratio=0", ...listSettings(about, "ground", []), ...vertical];
}
