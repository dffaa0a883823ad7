import { expect, it } from 'vitest'
import type { PolicyResult, StudyResult } from '../api/types'
import {
  axisAround,
  dailyDifferences,
  estimate,
  headlineOf,
  isMoreThanChance,
  pairedDifference,
  pStatement,
} from './studies'

function policy(name: string, mean: number, more: Partial<PolicyResult> = {}): PolicyResult {
  return {
    name,
    description: '',
    sees: 'present',
    profit_usd: { mean, standard_deviation: 20, half_width_95: 10 },
    daily_profit_usd: [mean - 1, mean + 1],
    revenue_usd: 0,
    passenger_cost_usd: 0,
    energy_cost_usd: 0,
    flight_cost_usd: 0,
    aircraft_cost_usd: 0,
    site_cost_usd: 0,
    passengers: 0,
    spilled_passengers: 0,
    load_factor: 0,
    flights: 0,
    repositioning_flights: 0,
    holds: 0,
    ...more,
  }
}

function minus(mean: number, p_value: number | null): Pick<PolicyResult, 'minus_first'> {
  const half_width_95 = p_value === null ? null : 5
  return {
    minus_first: {
      profit_usd: { mean, standard_deviation: 8, half_width_95 },
      p_value,
      days_ahead: 2,
      days_behind: 0,
    },
  }
}

const result = (...policies: PolicyResult[]): StudyResult => ({
  program_version: '0',
  first_seed: 1,
  policies,
})

it('states the lead of the best policy over the first', () => {
  const headline = headlineOf(result(policy('greedy', 100), policy('prices', 140, minus(40, 0.0004))))
  expect(headline).toEqual({
    policy: 'prices',
    profit: '$140',
    share: undefined,
    lead: {
      other: 'greedy',
      difference: '+\u2060$40',
      interval: '+\u2060$35 to +\u2060$45',
      p: 'p < 0.001',
      isSignificant: true,
    },
  })
})

it('reverses the difference if the first is the best', () => {
  const headline = headlineOf(
    result(policy('a', 100), policy('b', 70, minus(-30, 0.2)), policy('plan', 200, { sees: 'whole-day' })),
  )
  expect(headline?.policy).toBe('a')
  expect(headline?.lead).toMatchObject({
    other: 'b',
    difference: '+\u2060$30',
    interval: '+\u2060$25 to +\u2060$35',
    isSignificant: false,
  })
})

it('has no lead with one policy, and no interval with one day', () => {
  expect(headlineOf(result(policy('a', 100)))?.lead).toBeUndefined()
  expect(headlineOf(result(policy('plan', 100, { sees: 'whole-day' })))).toBeUndefined()
  const one = headlineOf(result(policy('a', 100), policy('b', 130, minus(30, null))))
  expect(one?.lead).toMatchObject({ interval: undefined, p: 'p unknown', isSignificant: false })
  const bounded = policy('a', 100, { bound_share: { mean: 0.9512, standard_deviation: 0, half_width_95: 0 } })
  expect(headlineOf(result(bounded))?.share).toBe('95.1 %')
})

it('formats numbers', () => {
  expect(pStatement(0.0213)).toBe('p = 0.021')
  expect(estimate({ mean: 37148.6, standard_deviation: null, half_width_95: null })).toBe('$37,149')
  expect(estimate({ mean: -1200, standard_deviation: 2, half_width_95: 1310.4 }, true)).toBe(
    '−\u2060$1,200 ± 1,310',
  )
})

it('sorts the days by difference', () => {
  const one = policy('b', 0, { daily_profit_usd: [5, 9, 1] })
  const first = policy('a', 0, { daily_profit_usd: [4, 10, 1] })
  expect(dailyDifferences(one, first)).toEqual([
    { day: 0, difference_usd: 1 },
    { day: 2, difference_usd: 0 },
    { day: 1, difference_usd: -1 },
  ])
})

it('has axes with round steps', () => {
  expect(axisAround([30_120, 37_800], 5)).toEqual({
    from: 30_000,
    to: 38_000,
    ticks: [30_000, 32_000, 34_000, 36_000, 38_000],
  })
  expect(axisAround([-3, 0, 4], 4).ticks).toEqual([-5, 0, 5])
  expect(axisAround([7], 4)).toMatchObject({ from: 5, to: 10 })
})

it('pairs the days of two studies, with the interval of the service', () => {
  // Student's t for 2 degrees of freedom is 4.3027; divided by the root of 3 days it is 2.4841.
  const profit_usd = { mean: 200, standard_deviation: 100, half_width_95: 248.41 }
  const before = policy('greedy', 200, { profit_usd, daily_profit_usd: [100, 200, 300] })
  const now = policy('greedy', 210, { daily_profit_usd: [109, 210, 311], profit_usd: { mean: 210 } })
  const difference = pairedDifference(now, before)
  expect(difference?.mean).toBeCloseTo(10)
  expect(difference?.half_width_95).toBeCloseTo(2.4841)
  expect(difference && isMoreThanChance(difference)).toBe(true)
  const backwards = pairedDifference(policy('greedy', 0, { daily_profit_usd: [311, 210, 109] }), before)
  expect(backwards && isMoreThanChance(backwards)).toBe(false)
  expect(pairedDifference(now, policy('greedy', 1, { daily_profit_usd: [1] }))).toBeUndefined()
})

it('is never significant after a single day', () => {
  const day = (profit: number) =>
    policy('greedy', profit, { profit_usd: { mean: profit }, daily_profit_usd: [profit] })
  const difference = pairedDifference(day(12), day(10))
  expect(difference).toEqual({ mean: 2, half_width_95: null })
  expect(difference && isMoreThanChance(difference)).toBe(false)
})
