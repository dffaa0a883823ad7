import { describe, expect, it } from 'vitest'
import { greedyTrace, prices, pricesTrace, scenario, scenarioText } from './fixtures/tiny'
import { timeOf } from './time'
import { FileError, fixedCost, isTrace, parseScenario, recordOf } from './traces'

function faultOf(read: () => unknown): unknown {
  try {
    read()
  } catch (error) {
    if (error instanceof FileError) return error.fault
    throw error
  }
  return undefined
}

describe('a scenario and a trace', () => {
  const record = prices()

  it('make a record with every row as a leg', () => {
    expect(record.legs).toHaveLength(20)
    expect(record.vertiports.map(({ id }) => id)).toEqual(['North, shore', 'East', 'South'])
    expect(record.legs[0]).toMatchObject({
      aircraft: 0,
      from: 2,
      to: 1,
      passengers: 4,
      is_expected: false,
      policy: 'prices',
    })
    expect(record.legs[0]?.profit_usd).toBeCloseTo(412.2546 - 137.4182 - 4.8096, 3)
  })

  it('add up to the profit that the program prints', () => {
    const legs_usd = record.legs.reduce((sum, leg) => sum + leg.profit_usd, 0)
    expect(legs_usd - fixedCost(scenario())).toBeCloseTo(2860.02, 2)
  })

  it('show a delay as a later departure, with the plan', () => {
    const late = record.legs[1]
    expect(late).toMatchObject({
      decided: timeOf('07:00:00'),
      departs: timeOf('07:04:33'),
      arrives: timeOf('07:15:14'),
    })
    expect(late?.planned).toEqual({
      departs: timeOf('07:00:00'),
      arrives: timeOf('07:10:41'),
      ready: timeOf('07:18:56'),
    })
    expect(record.legs[0]?.planned).toBeUndefined()
  })

  it('show the delay by an outage', () => {
    const held = record.legs[7]
    expect(held?.ready).toBe(timeOf('08:11:55'))
    expect(held?.planned?.ready).toBe(timeOf('08:02:43'))
  })

  it('close a route in both directions', () => {
    const times = { since: timeOf('07:30:00'), until: timeOf('08:00:00') }
    expect(record.closures).toEqual([
      { from: 1, to: 2, ...times },
      { from: 2, to: 1, ...times },
    ])
  })

  it('are read with the line endings of Windows', () => {
    const text = `\uFEFF${pricesTrace.replaceAll('\n', '\r\n')}`
    expect(recordOf(parseScenario(`\uFEFF${scenarioText}`), text).legs).toHaveLength(20)
  })
})

describe('a file in another format', () => {
  it('is rejected as a scenario', () => {
    expect(faultOf(() => parseScenario('{'))).toEqual({ what: 'no-json' })
    expect(faultOf(() => parseScenario('null'))).toEqual({ what: 'no-scenario', format: undefined })
    const result = '{"format": "vertifleet-result/1"}'
    expect(faultOf(() => parseScenario(result))).toEqual({
      what: 'no-scenario',
      format: 'vertifleet-result/1',
    })
  })

  it('is rejected as a trace', () => {
    expect(isTrace(greedyTrace)).toBe(true)
    expect(isTrace(scenarioText)).toBe(false)
    expect(faultOf(() => recordOf(scenario(), 'update,reward\n1,2\n'))).toEqual({
      what: 'no-trace',
      begins: 'update,reward',
    })
  })

  it('is rejected with its line and column', () => {
    const of = (from: string, to: string) =>
      faultOf(() => recordOf(scenario(), pricesTrace.replace(from, to)))
    expect(of('ready', 'done')).toEqual({ what: 'missing-column', column: 'ready' })
    expect(of('A02,East', 'A02,West')).toEqual({ what: 'unknown-id', line: 3, column: 'from', value: 'West' })
    expect(of('A02,East,', 'A02,')).toEqual({ what: 'columns', line: 3, found: 10, wanted: 11 })
    expect(of('07:10:59', '7.10')).toEqual({ what: 'unreadable', line: 4, column: 'arrival', value: '7.10' })
    expect(of('07:19:21,A01', '06:19:21,A01')).toEqual({ what: 'out-of-order', line: 5 })
  })
})
