/** The one loop of frames: moves the cursor while the page plays, and draws what has asked for it, once a frame. */
import type { Store } from "./store";

// A tab that was hidden, or a machine that stood still, goes on from where it was.
const LONGEST_FRAME_S = 0.1;

const jobs = new Set<() => void>();
let asked = false;
let lastMs: number | null = null;
let store: Store | null = null;

function frame(nowMs: number): void {
  asked = false;
  const playing = store?.playing === true;
  if (store !== null && playing) {
    const passedS = lastMs === null ? 0 : Math.min((nowMs - lastMs) / 1000, LONGEST_FRAME_S);
    lastMs = nowMs;
    store.time += passedS * store.speed;
    if (store.time >= store.durationS) {
      store.playing = false;
    }
  } else {
    lastMs = null;
  }
  const now = [...jobs];
  jobs.clear();
  now.forEach((job) => job());
  if (store?.playing === true) {
    ask();
  }
}

function ask(): void {
  if (!asked) {
    asked = true;
    requestAnimationFrame(frame);
  }
}

/** Draws by `job` at the next frame; asking again before it changes nothing. */
export function drawSoon(job: () => void): void {
  jobs.add(job);
  ask();
}

/** Moves the cursor of `moved` while it plays, and lets whatever shows the cursor draw at the same frame. */
export function startClock(moved: Store): void {
  store = moved;
  moved.subscribe("playing", () => {
    if (moved.playing && moved.time >= moved.durationS) {
      moved.time = 0;
    }
    if (moved.playing) {
      ask();
    }
  });
}
