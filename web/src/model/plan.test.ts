import { describe, expect, it } from 'vitest'
import type { Outlook } from '../api/types'
import { outlook, scenario } from './fixtures/liveDay'
import { recordOfPlan } from './plan'
import { timeOf } from './time'

/** The service's answer before the first event. */
const plan: Outlook = {
  ...outlook,
  seq: 0,
  legs: outlook.legs.map((leg) => ({ ...leg, is_taken: false })),
}

describe('a plan of the morning', () => {
  const record = recordOfPlan(scenario, plan)

  it('is a record with every leg, all of them expected', () => {
    expect(record.legs).toHaveLength(plan.legs.length)
    expect(record.legs.every((leg) => leg.is_expected)).toBe(true)
    const [leg, first] = [record.legs[0], plan.legs[0]]
    if (leg === undefined || first === undefined) throw new Error('the plan has legs')
    expect(leg).toMatchObject({
      decided: timeOf(first.time),
      departs: timeOf(first.time),
      arrives: timeOf(first.arrival),
      ready: timeOf(first.ready),
      passengers: first.passengers,
      profit_usd: first.profit_usd,
    })
    const names = [record.aircraft[leg.aircraft], record.vertiports[leg.from], record.vertiports[leg.to]]
    expect(names.map((one) => one?.id)).toEqual([first.aircraft, first.from, first.to])
  })

  it('adds up to the service’s expected profit', () => {
    const legs_usd = record.legs.reduce((sum, leg) => sum + leg.profit_usd, 0)
    expect(legs_usd).toBeCloseTo(plan.totals.profit_usd, 2)
  })

  it('contains no reports, and has the forecast demand', () => {
    expect(record.outages).toEqual([])
    expect(record.demand?.passengers).toEqual(scenario.forecast ?? scenario.demand)
  })

  it('is cut off at the current time of the day', () => {
    const until = record.legs[5]?.decided ?? 0
    const cut = recordOfPlan(scenario, plan, until)
    expect(cut.legs.length).toBeGreaterThan(5)
    expect(cut.legs.length).toBeLessThan(record.legs.length)
    expect(Math.max(...cut.legs.map((leg) => leg.decided))).toBe(until)
  })
})
