import { expect, it } from 'vitest'
import { HORIZON_S, decidedBefore, impactOf } from './impact'
import type { DayRecord, LegRecord } from './record'

const NOW = 7 * 3600

function leg(aircraft: number, to: number, minutes: number, more: Partial<LegRecord> = {}): LegRecord {
  const decided = NOW + 60 * minutes
  return {
    aircraft,
    from: 0,
    to,
    decided,
    departs: decided,
    arrives: decided + 1800,
    ready: decided + 3600,
    passengers: 4,
    profit_usd: 90,
    is_expected: true,
    ...more,
  }
}

function record(...legs: LegRecord[]): DayRecord {
  const ids = ['V1', 'V2', 'V3']
  return {
    aircraft: ['A01', 'A02', 'A03'].map((id) => ({ id })),
    vertiports: ids.map((id) => ({ id })),
    legs,
  } as unknown as DayRecord
}

it('equal continuations of a day have no impact', () => {
  const asItIs = record(leg(0, 1, 5), leg(1, 2, 10, { is_expected: false }), leg(0, 1, 130))
  const whatIf = record(leg(0, 1, 5), leg(1, 1, 10, { is_expected: false }), leg(0, 2, 130))
  const impact = impactOf(asItIs, whatIf, NOW)
  expect(impact).toEqual({
    until: NOW + HORIZON_S,
    aircraft: [],
    passengers: { asItIs: 4, whatIf: 4 },
    pairs: [],
    places: [],
  })
})

it('aircraft with other destinations are affected, with their passengers and vertiports', () => {
  const asItIs = record(leg(0, 1, 5), leg(1, 2, 10), leg(2, 1, 20, { passengers: 3 }))
  const whatIf = record(leg(0, 1, 6), leg(1, 0, 10, { passengers: 0 }), leg(2, 2, 15, { passengers: 3 }))
  const impact = impactOf(asItIs, whatIf, NOW)
  expect(impact.aircraft.map(({ id }) => id)).toEqual(['A02', 'A03'])
  expect(impact.aircraft[0]).toMatchObject({ asItIs: { to: 2 }, whatIf: { to: 0 } })
  expect(impact.passengers).toEqual({ asItIs: 11, whatIf: 7 })
  expect(impact.pairs).toEqual([
    { from: 'V1', to: 'V2', more: -3 },
    { from: 'V1', to: 'V3', more: -1 },
  ])
  expect(impact.places).toEqual([{ id: 'V2', more: -1 }])
})

it('an aircraft without further legs in one continuation is affected', () => {
  const impact = impactOf(record(leg(0, 1, 5), leg(0, 2, 60)), record(leg(0, 1, 5)), NOW)
  expect(impact.aircraft).toMatchObject([{ id: 'A01', asItIs: { to: 2 }, whatIf: undefined }])
})

it('a leg that moves across the end of the two hours has no impact', () => {
  const impact = impactOf(record(leg(0, 1, 5), leg(0, 2, 119)), record(leg(0, 1, 5), leg(0, 2, 121)), NOW)
  expect(impact.aircraft).toEqual([])
})

it('marks of later legs are left out', () => {
  const day = record(leg(0, 1, 5), leg(0, 2, 130))
  const difference = { twin: undefined, isElsewhere: true }
  const differing = new Map([0, 1].map((index) => [index, difference]))
  expect([...decidedBefore(differing, day, NOW + HORIZON_S).keys()]).toEqual([0])
})
