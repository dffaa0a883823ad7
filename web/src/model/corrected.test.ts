import { expect, it } from 'vitest'
import { correctionsOf, takenBackBy, withoutCorrected } from './corrected'
import { events, scenario, south } from './fixtures/liveDay'
import { Reports } from './reports'
import type { TakenEvent } from '../api/types'

const closed = events.find(({ event }) => event.type === 'closed')
const corrected = [
  ...events,
  {
    seq: 99,
    event: { type: 'corrected', event: closed?.seq ?? 0, time: '07:00:00' },
  } as unknown as TakenEvent,
]

it('an event that was taken back is none for the day, and stays in the log', () => {
  const reports = new Reports(scenario)
  for (const event of withoutCorrected(corrected)) reports.take(event)
  expect(reports.closures.some((one) => 'vertiport' in one && one.vertiport === south)).toBe(false)
  expect(corrected).toHaveLength(events.length + 1)
})

it('a correction and the event that it took back lead to each other', () => {
  const correction = corrected.at(-1)
  expect([...correctionsOf(corrected)]).toEqual([[closed?.seq, correction]])
  expect(correction && takenBackBy(correction, corrected)).toBe(closed)
  // The console keeps the latest events only.
  expect(correction && takenBackBy(correction, [correction])).toBeUndefined()
  expect(closed && takenBackBy(closed, corrected)).toBeUndefined()
})
