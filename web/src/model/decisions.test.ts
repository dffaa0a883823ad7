import { describe, expect, it } from 'vitest'
import type { Proposal, TakenEvent } from '../api/types'
import {
  canBeTakenBack,
  decidedLately,
  decidedSince,
  expectedNext,
  isSameAdvice,
  kindOfNumber,
  nextOf,
  ranked,
  Steady,
  waitingOf,
  waitOf,
  worthOf,
  leadOf,
  numberOf,
} from './decisions'
import { events, state } from './fixtures/liveDay'
import type { DayRecord } from './record'
import { timeOf } from './time'

const proposal: Proposal = {
  aircraft: 'A01',
  at: 'V1',
  time: '06:00:00',
  seq: 4,
  to: 'V2',
  policy: 'prices',
  took_us: 900,
  alternatives: [
    {
      to: 'V1',
      value: 843.2,
      worth_usd: 843.2,
      flight_profit_usd: 0,
      passengers: 0,
      stand_price_usd: 3.27,
      ...there('06:15:00'),
    },
    {
      to: 'V2',
      value: 849.6,
      worth_usd: 849.6,
      flight_profit_usd: 144.21,
      passengers: 4,
      stand_price_usd: 43.15,
      passenger_price_usd: 2.5,
      ...there('07:39:14'),
    },
    {
      to: 'V3',
      impossible: { rule: 'no_stand_free', reason: 'full' },
      flight_profit_usd: 75.37,
      passengers: 4,
      ...there('07:06:12'),
    },
    {
      to: 'V4',
      value: 837.61,
      worth_usd: 837.61,
      flight_profit_usd: 30.83,
      passengers: 4,
      ...there('07:00:00'),
    },
    { to: 'V5', flight_profit_usd: 12, passengers: 1, ...there('07:00:00') },
  ],
}

function there(ready: string) {
  return { arrival: '06:45:00', ready, stands: 6, stands_taken: 4 }
}

describe('waiting aircraft', () => {
  it('are in the order in which they became ready, at full vertiports first', () => {
    expect(waitingOf(state).map((one) => one.id)).toEqual(['A05'])
    const all = {
      ...state,
      aircraft: state.aircraft.map((one) => ({ ...one, needs_decision: true, ready: '06:30:00' })),
    }
    expect(waitingOf(all).map((one) => one.isFull)).toEqual([true, true, false, false, false])
  })

  it('are followed by the aircraft that are ready next', () => {
    expect(nextOf(state, 2).map((one) => one.id)).toEqual(['A01', 'A02'])
    const evening = { ...state, now: '07:10:00' }
    expect(nextOf(evening, 2).map((one) => one.id)).toEqual(['A02', 'A03'])
    expect(nextOf(evening, 2, new Set(['A02'])).map((one) => one.id)).toEqual(['A03'])
  })
})

it('an aircraft decided after the state has no expected decision', () => {
  const taken = (seq: number, event: object) => ({ seq, event }) as TakenEvent
  const since = decidedSince(
    [
      taken(3, { type: 'decided', aircraft: 'A01', to: 'V2' }),
      taken(4, { type: 'decided', aircraft: 'A02', to: 'V2' }),
      taken(5, { type: 'departed', aircraft: 'A03' }),
    ],
    3,
  )
  expect([...since]).toEqual(['A02'])
  const leg = (aircraft: number) => ({ aircraft, decided: 100, is_expected: true })
  const record = {
    aircraft: [{ id: 'A01' }, { id: 'A02' }],
    legs: [leg(0), leg(1)],
  } as unknown as DayRecord
  expect(expectedNext(record, 90, 5, since).map((one) => one.leg.aircraft)).toEqual([0])
})

it('a list keeps its order while it is held', () => {
  const list = (...ids: string[]) => ids.map((id) => ({ id }))
  const steady = new Steady<{ id: string }>()
  steady.of(list('a', 'b'), false)
  expect(steady.of(list('c', 'b'), true)).toEqual(list('a', 'b', 'c'))
  expect(steady.of(list('c', 'b'), false)).toEqual(list('c', 'b'))
})

describe('a proposal', () => {
  it('ranks possible choices by worth, those without a worth last', () => {
    const { possible, impossible } = ranked(proposal)
    expect(possible.map((one) => one.to)).toEqual(['V2', 'V1', 'V4', 'V5'])
    expect(impossible.map((one) => one.to)).toEqual(['V3'])
  })

  it('has worths if the policy has prices, and the values it compares otherwise', () => {
    const unpriced = {
      ...proposal,
      policy: 'mlp-paper',
      alternatives: [{ to: 'V2', value: 1.5, flight_profit_usd: 5, passengers: 4, ...there('07:00:00') }],
    }
    expect(kindOfNumber(proposal)).toBe('worth')
    expect(kindOfNumber(unpriced)).toBe('none')
    expect(kindOfNumber({ ...unpriced, policy: 'greedy' })).toBe('dollars_per_hour')
  })

  it('ranks by what the policy compares, the advised choice first, and then by worth', () => {
    const considered = new Set(['V4', 'V1'])
    const alternatives = proposal.alternatives.map((one) => ({
      ...one,
      value: considered.has(one.to) ? (one.worth_usd ?? 0) + 20 : null,
    }))
    const learned = { ...proposal, policy: 'gcaps-x', to: 'V4', alternatives }
    expect(ranked(learned).possible.map((one) => one.to)).toEqual(['V4', 'V1', 'V2', 'V5'])
    const [first, , third] = ranked(learned).possible
    expect(first && numberOf(first)).toBeCloseTo(857.61)
    expect(third && worthOf(third)?.value_usd).toBeUndefined()
  })

  it('is the same advice while the choice, its rank and the rules are the same', () => {
    const changed = (to: string, more: object) => ({
      ...proposal,
      alternatives: proposal.alternatives.map((one) => (one.to === to ? { ...one, ...more } : one)),
    })
    expect(isSameAdvice(proposal, changed('V2', { value: 850, worth_usd: 850 }))).toBe(true)
    expect(isSameAdvice(proposal, changed('V4', { value: 846, worth_usd: 846 }))).toBe(false)
    expect(isSameAdvice(proposal, changed('V3', { impossible: undefined }))).toBe(false)
    expect(isSameAdvice(proposal, { ...proposal, to: 'V4' })).toBe(false)
  })

  it('has the lead of the advised choice over the next, with the part that differs most', () => {
    const lead = leadOf(proposal)
    const [first, second] = ranked(proposal).possible
    expect(lead?.of).toBe(second?.to)
    expect(lead?.by).toBeCloseTo((first?.worth_usd ?? 0) - (second?.worth_usd ?? 0))
    expect(lead?.part?.by_usd).toBeGreaterThan(0)
    expect(leadOf({ ...proposal, alternatives: proposal.alternatives.slice(0, 1) })).toBeUndefined()
  })

  it('is worth the sum of its parts', () => {
    const [, flight, , , unpriced] = proposal.alternatives
    const worth = flight && worthOf(flight)
    expect(worth).toMatchObject({
      flight_usd: 144.21,
      stand_usd: -43.15,
      worth_usd: 849.6,
    })
    expect((worth?.flight_usd ?? 0) + (worth?.onward_usd ?? 0) - 43.15).toBeCloseTo(849.6)
    expect(unpriced && worthOf(unpriced)).toBeUndefined()
  })

  it('has choices that wait for charge', () => {
    const decided = timeOf('06:00:00')
    const choice = { takeoff: '06:12:30', needs_kwh: 38.2 }
    expect(waitOf(choice, decided)).toEqual({ takeoff: timeOf('06:12:30'), needs_kwh: 38.2 })
    expect(waitOf({ ...choice, takeoff: '06:00:00' }, decided)).toBeUndefined()
    expect(waitOf({}, decided)).toBeUndefined()
  })
})

describe('latest decisions', () => {
  it('are listed newest first, without undone ones', () => {
    const decided = decidedLately(events, 10)
    expect(decided.map((one) => `${one.aircraft} ${one.to}`)).toEqual([
      'A03 North',
      'A03 East',
      'A02 South',
      'A01 East',
    ])
    expect(decided[2]).toMatchObject({
      insteadOf: 'North',
      reason: 'the crew lives there',
      policy: undefined,
    })
  })

  it('can be undone until the next event of the aircraft', () => {
    expect(decidedLately(events, 10).map((one) => one.canBeUndone)).toEqual([true, false, false, false])
    expect(canBeTakenBack(events, 'A03', 16)).toBe(true)
    expect(canBeTakenBack(events, 'A01', 1)).toBe(false)
    expect(canBeTakenBack(events, 'A05', 17)).toBe(true)
  })
})
