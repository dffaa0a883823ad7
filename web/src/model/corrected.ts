// Events that were taken back. The log keeps them, but the day is as if they had not been reported.

import type { TakenEvent } from '../api/types'

/** The numbers of the events that were taken back. */
export function correctedOf(events: readonly TakenEvent[]): Set<number> {
  return new Set(events.flatMap(({ event }) => (event.type === 'corrected' ? [event.event] : [])))
}

/** The events that hold, without those that were taken back. */
export function withoutCorrected(events: readonly TakenEvent[]): TakenEvent[] {
  const corrected = correctedOf(events)
  return events.filter(({ seq }) => !corrected.has(seq))
}
