import { expect, it } from 'vitest'
import { demandByPeriod, Earnings } from './earnings'
import { prices, scenario } from './fixtures/tiny'
import { timeOf } from './time'
import { fixedCost } from './traces'

const record = prices()
const earnings = new Earnings(record, fixedCost(scenario()))

it('a day begins with the cost of its fleet and ends with its profit', () => {
  expect(earnings.at(timeOf('06:59:59'))).toEqual({
    profit_usd: -150,
    passengers: 0,
    flights: 0,
    repositioning_flights: 0,
    holds: 0,
  })
  expect(earnings.at(timeOf('10:00:00')).profit_usd).toBeCloseTo(2860.02, 2)
  expect(earnings.total_usd).toBeCloseTo(2860.02, 2)
  expect(earnings.range).toEqual([-150, earnings.total_usd])
})

it('a flight counts from its decision on', () => {
  expect(earnings.at(timeOf('07:00:00'))).toMatchObject({ passengers: 12, flights: 3, holds: 0 })
  expect(earnings.at(timeOf('10:00:00'))).toMatchObject({ flights: 14, holds: 6 })
})

it('every passenger is counted in one period', () => {
  const periods = demandByPeriod(record)
  expect(periods.map(({ begins }) => begins)).toEqual([timeOf('07:00:00'), timeOf('08:00:00')])
  expect(periods.reduce((sum, { carried }) => sum + carried, 0)).toBe(earnings.at(Infinity).passengers)
  for (const { wanted, carried } of periods) expect(carried).toBeLessThanOrEqual(wanted)
})

it('a day without decisions earns nothing', () => {
  const idle = new Earnings({ ...record, legs: [] })
  expect([idle.total_usd, idle.range, idle.at(0).profit_usd]).toEqual([0, [0, 0], 0])
})
