/** Impacts and clutch switches of a device, in order of time: what one can step to. */
import type { Response } from "../engine";
import { stretches } from "../stretches";

/** An event of a response. */
export interface Event {
  timeS: number;
  /** An impact, or the flywheels that are engaged from then on (0 none, 3 both). */
  kind: "impact" | 0 | 1 | 2 | 3;
}

/** The events of a response. */
export function eventsOf(response: Response): Event[] {
  const events: Event[] = Array.from(response.impactsS, (timeS) => ({ timeS, kind: "impact" as const }));
  for (const { from, value } of stretches(response.timeS, response.engaged).slice(1)) {
    events.push({ timeS: from, kind: value === 1 || value === 2 || value === 3 ? value : 0 });
  }
  return events.sort((a, b) => a.timeS - b.timeS);
}

/** The first event after `time`, or the last one before it. */
export function eventFrom(events: Event[], time: number, direction: 1 | -1): Event | null {
  const near = 1e-9;
  const found = direction === 1 ? events.find(({ timeS }) => timeS > time + near) : events.findLast(({ timeS }) => timeS < time - near);
  return found ?? null;
}
