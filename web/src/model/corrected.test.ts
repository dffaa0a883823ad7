import { expect, it } from 'vitest'
import { correctedOf, withoutCorrected } from './corrected'
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
  expect(correctedOf(corrected)).toEqual(new Set([closed?.seq]))
  const reports = new Reports(scenario)
  for (const event of withoutCorrected(corrected)) reports.take(event)
  expect(reports.closures.some((one) => 'vertiport' in one && one.vertiport === south)).toBe(false)
  expect(corrected).toHaveLength(events.length + 1)
})
