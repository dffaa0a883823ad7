import { describe, expect, it } from 'vitest'
import { NONE } from './arrays'
import { fleetRows, standRows } from './bars'
import type { Outlook } from '../api/types'
import { Charges } from './charges'
import { legsOf } from './expectedLegs'
import { neededText, neededTrace, prices } from './fixtures/tiny'
import { Fleet, Phase } from './motion'
import { nominal } from './nominal'
import type { DayRecord, LegRecord } from './record'
import { timeOf } from './time'
import { parseScenario, recordOf } from './traces'

const scenario = parseScenario(neededText)
const record = recordOf(scenario, neededTrace, 'greedy')
const BATTERY_KWH = 60
const RESERVE_KWH = 10

function chargesOf(of: DayRecord): Charges {
  return new Charges(of)
}

/** A leg without what the trace knows about its charge. */
function unknown({ charge_kwh: _, ...leg }: LegRecord): LegRecord {
  return leg
}

describe('a day that charges as needed', () => {
  it('has the same charges as the program', () => {
    const charges = chargesOf({ ...record, legs: record.legs.map(unknown) })
    record.legs.forEach(({ decided, charge_kwh }, index) => {
      expect(BATTERY_KWH * charges.before(index, decided)).toBeCloseTo(charge_kwh ?? NaN, 3)
    })
  })

  it('takes off once the battery has the energy and the reserve', () => {
    const charges = chargesOf(record)
    const waits = record.legs.filter((leg) => leg.charged !== undefined && leg.charged > leg.decided)
    expect(waits.length).toBeGreaterThan(5)
    for (const leg of waits) {
      const index = record.legs.indexOf(leg)
      const needs_kwh = nominal(scenario, leg).energy_kwh + RESERVE_KWH
      const [before, then] = [-1, 0].map((by) => charges.before(index, (leg.charged ?? 0) + by) * BATTERY_KWH)
      expect(then).toBeGreaterThan(needs_kwh - 1e-3)
      expect(before).toBeLessThan(needs_kwh)
    }
  })

  it('has delays beyond the wait, and is ready after the turnaround', () => {
    expect(record.legs[1]).toMatchObject({
      decided: timeOf('07:00:00'),
      charged: timeOf('07:09:43'),
      departs: timeOf('07:14:16'),
      planned: { departs: timeOf('07:09:43'), arrives: timeOf('07:20:35'), ready: timeOf('07:24:35') },
    })
    expect(record.legs[0]?.planned).toBeUndefined()
  })

  it('stands at its origin until it takes off', () => {
    const fleet = new Fleet(record)
    const frame = fleet.frame()
    fleet.show(timeOf('07:06:00'), frame)
    expect([frame.phases[0], frame.stands[0]]).toEqual([Phase.delayed, 2])
    fleet.show(timeOf('07:06:52'), frame)
    expect(frame.phases[0]).toBe(Phase.flying)
  })

  it('has bars of charging with the charge at both ends', () => {
    const [first, flight] = fleetRows(record)[1]?.bars ?? []
    expect(first).toMatchObject({ kind: 'charge', begins: timeOf('07:00:00'), ends: timeOf('07:09:43') })
    expect((first?.charge?.begins ?? 0) * BATTERY_KWH).toBeCloseTo(17.98, 3)
    expect((first?.charge?.ends ?? 0) * BATTERY_KWH).toBeCloseTo(24.157 + RESERVE_KWH, 1)
    expect(flight).toMatchObject({ kind: 'delay', begins: timeOf('07:09:43'), ends: timeOf('07:14:16') })
  })

  it('charges on a stand until it leaves or is full', () => {
    const bars = standRows(record).flatMap((row) => row.bars)
    const charging = bars.filter((bar) => bar.kind === 'charge')
    expect(charging.every((bar) => (bar.charge?.ends ?? NaN) >= (bar.charge?.begins ?? NaN))).toBe(true)
    const last = charging.findLast((bar) => bar.aircraft === 0)
    expect(last?.charge?.ends).toBeCloseTo(1, 6)
    expect(last?.ends).toBeGreaterThan(timeOf('08:53:17'))
    expect(last?.ends).toBeLessThanOrEqual(timeOf('09:03:17'))
    // In the morning, an aircraft that is decided at once charges next to its stand.
    expect(charging.some((bar) => bar.leg === NONE)).toBe(false)
  })
})

describe('a day that charges to full', () => {
  it('has no charges at its bars', () => {
    const rows = [...fleetRows(prices()), ...standRows(prices())]
    expect(rows.every(({ bars }) => bars.every((bar) => bar.charge === undefined))).toBe(true)
  })

  it('is ready when the curve, the charger and the turnaround allow it', () => {
    const full = { ...scenario, operations: { ...scenario.operations, charging: 'to_full' as const } }
    const ground_s = (from: number, to: number) => nominal(full, { aircraft: 0, from, to }).ground_s
    // From the program's trace of the day with `charging` removed.
    expect([ground_s(2, 0), ground_s(2, 1), ground_s(1, 2), ground_s(0, 1)]).toEqual([1333, 1353, 1321, 1329])
  })
})

describe('the energy of a flight', () => {
  it('is that of the corridor and of the self-discharge, not of the straight line', () => {
    const [type] = scenario.aircraft_types
    const longer = {
      ...scenario,
      distance_mi: scenario.distance_mi.map((row) => row.map((miles) => 2 * miles)),
      aircraft_types: [{ ...type, self_discharge_per_h: 0.1 }],
    } as typeof scenario
    const flight = record.legs.find((leg) => leg.from !== leg.to)
    if (flight === undefined) throw new Error('nothing flies')
    const plan = nominal(longer, flight)
    expect(plan.energy_kwh).toBeGreaterThan(2 * nominal(scenario, flight).energy_kwh)
    const outlook = { seq: 1, legs: [legOf(flight)] } as unknown as Outlook
    const [expected] = legsOf(outlook, longer)
    expect(expected?.energy_kwh).toBe(plan.energy_kwh)
    const legs = expected === undefined ? [] : [{ ...expected, charge_kwh: BATTERY_KWH }]
    const arriving = chargesOf({ ...record, legs }).arriving(0)
    expect(arriving * BATTERY_KWH).toBeCloseTo(Math.max(0, BATTERY_KWH - plan.energy_kwh), 3)
  })

  it('is that of the trace, if the trace has it', () => {
    const flown_kwh = record.legs[0]?.energy_kwh?.toString() ?? ''
    expect(neededTrace).toContain(`,${flown_kwh},`)
    const [leg] = recordOf(scenario, neededTrace.replace(`,${flown_kwh},`, ',12.5,')).legs
    expect(leg?.energy_kwh).toBe(12.5)
  })

  /** A leg as an outlook has it. */
  function legOf(leg: LegRecord) {
    const id = (vertiport: number) => scenario.vertiports[vertiport]?.id
    const [aircraft, from, to] = [scenario.aircraft[leg.aircraft]?.id, id(leg.from), id(leg.to)]
    const times = { time: leg.decided, arrival: leg.arrives, ready: leg.ready }
    return { aircraft, from, to, ...times, passengers: 1, profit_usd: 0, is_taken: false }
  }
})
