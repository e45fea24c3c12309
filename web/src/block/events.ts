/** Impacts and clutch switches of a device, in order of time: what one can step to. */
import type { Response } from "../engine";

/** An event of a response. */
export interface Event {
  timeS: number;
  /** An impact, or the flywheel that is engaged from then on (0 none). */
  kind: "impact" | 0 | 1 | 2;
}

/** The events of a response. */
export function eventsOf(response: Response): Event[] {
  const events: Event[] = Array.from(response.impactsS, (timeS) => ({ timeS, kind: "impact" as const }));
  const { engaged, timeS } = response;
  for (let i = 1; i < engaged.length; i++) {
    const now = engaged[i] ?? 0;
    if (now !== engaged[i - 1]) {
      events.push({ timeS: timeS[i] ?? 0, kind: now === 1 ? 1 : now === 2 ? 2 : 0 });
    }
  }
  return events.sort((a, b) => a.timeS - b.timeS);
}

/** The first event after `time`, or the last one before it. */
export function eventFrom(events: Event[], time: number, direction: 1 | -1): Event | null {
  const near = 1e-9;
  const found = direction === 1 ? events.find(({ timeS }) => timeS > time + near) : events.findLast(({ timeS }) => timeS < time - near);
  return found ?? null;
}
