/** Whether the user has asked the system for less motion: nothing starts to move by itself then. */
const reduced = matchMedia("(prefers-reduced-motion: reduce)");

/** Whether motion may start without being asked for. */
export function mayMoveByItself(): boolean {
  return !reduced.matches;
}
