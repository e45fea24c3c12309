/** What is asked of a response in several places. */
import type { Response } from "./engine";

/** Whether the block lies on the ground in the end. */
export function overturns({ summary }: Response): boolean {
  return String(summary["outcome"]).startsWith("overturned");
}

/** Time of the last sample (s). */
export function endS({ timeS }: Response): number {
  return timeS.at(-1) ?? 0;
}

/** The response that lasts longest, the first of several; null of none. */
export function longest(responses: readonly Response[]): Response | null {
  return responses.reduce<Response | null>((best, next) => (best === null || endS(next) > endS(best) ? next : best), null);
}
