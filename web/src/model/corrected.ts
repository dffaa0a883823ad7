// Events that were taken back. The log keeps them, but the day is as if they had not been reported.

import type { TakenEvent } from '../api/types'

/** The corrections of a log, by the number of the event that each took back. */
export type Corrections = ReadonlyMap<number, TakenEvent>

export function correctionsOf(events: readonly TakenEvent[]): Corrections {
  return new Map(
    events.flatMap((taken) => (taken.event.type === 'corrected' ? [[taken.event.event, taken]] : [])),
  )
}

/** The event that an event took back; undefined if it is no correction, or is not among them. */
export function takenBackBy({ event }: TakenEvent, events: readonly TakenEvent[]): TakenEvent | undefined {
  return event.type === 'corrected' ? events.find(({ seq }) => seq === event.event) : undefined
}

/** The events that hold, without those that were taken back. */
export function withoutCorrected(events: readonly TakenEvent[]): TakenEvent[] {
  const corrections = correctionsOf(events)
  return events.filter(({ seq }) => !corrections.has(seq))
}
